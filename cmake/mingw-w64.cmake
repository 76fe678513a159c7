# SPDX-License-Identifier: MIT
# 64-bit Windows by MinGW-w64; tests run under Wine. `./check --all` builds the library and
# its short tests with it.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc)
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

# Runs a program under Wine, which finds the compiler's own libraries (OpenMP's among them)
# and ours. A script, because a list of folders between semicolons is a list to CMake, too.
execute_process(COMMAND ${CMAKE_C_COMPILER} -print-file-name=libgomp-1.dll
    OUTPUT_VARIABLE runtime OUTPUT_STRIP_TRAILING_WHITESPACE)
get_filename_component(runtime "${runtime}" DIRECTORY)
file(CONFIGURE OUTPUT "${CMAKE_BINARY_DIR}/run-under-wine" CONTENT [[#!/bin/sh
export WINEDEBUG=-all
export WINEPREFIX="@CMAKE_BINARY_DIR@/wine"
export WINEPATH="@runtime@;/usr/x86_64-w64-mingw32/lib;@CMAKE_BINARY_DIR@/src"
# Of tests that start at once, one sets Wine up and the others wait.
(
    flock 9
    [ -s "@CMAKE_BINARY_DIR@/wine.lock" ] || { wine wineboot --init 9>&- >/dev/null 2>&1; echo ready >&9; }
) 9>>"@CMAKE_BINARY_DIR@/wine.lock"
exec wine "$@"
]] @ONLY)
set(CMAKE_CROSSCOMPILING_EMULATOR sh "${CMAKE_BINARY_DIR}/run-under-wine")
