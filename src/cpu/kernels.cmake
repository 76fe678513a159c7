# SPDX-License-Identifier: MIT
# The kernels, compiled once per instruction set that the compiler and the target have.
set(crevice_kernel_sources
    cpu/kernels/table_tmpl.c
    cpu/kernels/alchemy_tmpl.c cpu/kernels/containment_tmpl.c cpu/kernels/bitmask_tmpl.c cpu/kernels/gtao_tmpl.c cpu/kernels/hbao_tmpl.c
    cpu/kernels/hsao_tmpl.c cpu/kernels/raymarch_tmpl.c cpu/kernels/ssao_tmpl.c
    cpu/kernels/width_tmpl.c cpu/kernels/vao_tmpl.c cpu/kernels/vo_tmpl.c
    cpu/kernels/deinterleave_tmpl.c cpu/kernels/alchemy_deinterleaved_tmpl.c cpu/kernels/bitmask_deinterleaved_tmpl.c cpu/kernels/gtao_deinterleaved_tmpl.c cpu/kernels/hbao_deinterleaved_tmpl.c
    cpu/kernels/vo_deinterleaved_tmpl.c
    cpu/kernels/depth_tmpl.c cpu/kernels/normals_tmpl.c
    cpu/kernels/bilateral13_tmpl.c cpu/kernels/box4_tmpl.c cpu/kernels/edges15_tmpl.c
    cpu/kernels/gauss5_tmpl.c)

# Which sets: all that the compiler has, the fastest that this machine has, or a list. Scalar
# code is always there.
set(CREVICE_ISA all CACHE STRING
    "Instruction sets to compile kernels for: all, native (the fastest of this machine only), or a list (avx2;sse4)")
if(CREVICE_ISA STREQUAL "native")
    execute_process(COMMAND ${CMAKE_C_COMPILER} -march=native -dM -E -x c /dev/null
        OUTPUT_VARIABLE crevice_native ERROR_QUIET)
endif()

# crevice_isa_chosen(RESULT SET [FEATURE...]): whether the set is to be compiled.
function(crevice_isa_chosen result set)
    set(chosen TRUE)
    if(CREVICE_ISA STREQUAL "native")
        get_property(sets GLOBAL PROPERTY CREVICE_SETS)
        foreach(feature IN LISTS ARGN)
            string(TOUPPER "__${feature}__" macro)
            string(REPLACE "." "_" macro "${macro}")
            if(sets OR NOT crevice_native MATCHES "#define ${macro} ")
                set(chosen FALSE)
            endif()
        endforeach()
    elseif(NOT CREVICE_ISA STREQUAL "all" AND NOT set IN_LIST CREVICE_ISA)
        set(chosen FALSE)
    endif()
    set(${result} ${chosen} PARENT_SCOPE)
endfunction()

# crevice_kernels(SET [FEATURE...] [OPTIONS option...]): what the set needs of the machine,
# as the compiler names it after -m and in __builtin_cpu_supports(). The fastest first. In a
# universal binary of macOS each set is compiled for crevice_architecture alone.
set(crevice_sets "/* SPDX-License-Identifier: MIT */\n/* Generated from kernels.cmake. */\n")
function(crevice_kernels set)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "OPTIONS")
    crevice_isa_chosen(is_chosen ${set} ${arg_UNPARSED_ARGUMENTS})
    if(NOT is_chosen)
        return()
    endif()
    set(target crevice_kernels_${set})
    string(TOUPPER ${set} SET)
    add_library(${target} OBJECT ${crevice_kernel_sources})
    target_compile_definitions(${target} PRIVATE CRV_BUILD CRV_STATIC
        CRV__SIMD_NAME=${set} CRV__SIMD_HEADER="cpu/simd/${set}.h")
    target_compile_options(${target} PRIVATE ${arg_OPTIONS})
    set(is_there true)
    foreach(feature IN LISTS arg_UNPARSED_ARGUMENTS)
        target_compile_options(${target} PRIVATE -m${feature})
        string(APPEND is_there " && __builtin_cpu_supports(\"${feature}\")")
    endforeach()
    target_include_directories(${target} PRIVATE
        ${PROJECT_SOURCE_DIR}/include ${CMAKE_CURRENT_SOURCE_DIR})
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:crevice_flags>)
    target_sources(crevice PRIVATE $<TARGET_OBJECTS:${target}>)
    set(line "CRV__SET(${set}, ${SET}, ${is_there})\n")
    if(CMAKE_OSX_ARCHITECTURES)
        set_target_properties(${target} PROPERTIES OSX_ARCHITECTURES ${crevice_architecture})
        set(line "#if defined(__${crevice_architecture}__)\n${line}#endif\n")
    endif()
    set(crevice_sets "${crevice_sets}${line}" PARENT_SCOPE)
    set_property(GLOBAL APPEND PROPERTY CREVICE_SETS ${set})
endfunction()

set(crevice_architectures ${CMAKE_SYSTEM_PROCESSOR})
if(CMAKE_OSX_ARCHITECTURES)
    set(crevice_architectures ${CMAKE_OSX_ARCHITECTURES})
elseif(EMSCRIPTEN)
    set(crevice_architectures wasm)
endif()
if(MSVC OR NOT CMAKE_C_COMPILER_ID MATCHES "GNU|Clang")
    set(crevice_architectures "") # no operators on vectors: plain C only
endif()
foreach(crevice_architecture IN LISTS crevice_architectures)
    if(crevice_architecture MATCHES "^(x86_64|AMD64|i.86)$")
        crevice_kernels(avx512 avx2 fma avx512f avx512bw avx512dq avx512vl
            OPTIONS -mprefer-vector-width=512)
        crevice_kernels(avx2 avx2 fma)
        crevice_kernels(sse4 sse4.1)
    elseif(crevice_architecture MATCHES "^(aarch64|arm64)$")
        crevice_kernels(neon) # every AArch64 has it
    elseif(crevice_architecture STREQUAL "wasm")
        crevice_kernels(wasm OPTIONS -msimd128) # a module is for machines with vectors or without
    endif()
endforeach()
file(CONFIGURE OUTPUT crevice_sets.h CONTENT "${crevice_sets}" @ONLY)
target_include_directories(crevice PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
