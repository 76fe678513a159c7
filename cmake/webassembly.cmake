# SPDX-License-Identifier: MIT
# WebAssembly by Emscripten; tests run under node. `./check --all` builds the library and its
# short tests with it.
execute_process(COMMAND em-config EMSCRIPTEN_ROOT OUTPUT_VARIABLE crevice_emscripten
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(EMSCRIPTEN_SYSTEM_PROCESSOR wasm32)
include(${crevice_emscripten}/cmake/Modules/Platform/Emscripten.cmake)

# The tests are modules for node. The glue of Debian's Emscripten would fetch the module from
# the network, as newer versions of node can; compiled at once it is read from the disk. -O1
# leaves the code as the compiler made it: to go over it again takes longer than the tests.
set(CMAKE_EXE_LINKER_FLAGS_INIT
    "-sALLOW_MEMORY_GROWTH=1 -sEXIT_RUNTIME=1 -sWASM_ASYNC_COMPILATION=0 -O1")
