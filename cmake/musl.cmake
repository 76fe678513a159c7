# SPDX-License-Identifier: MIT
# Linux with musl as its C library. `./check --all` builds the library and its short tests
# with it; the machine's own instruction set is enough, since the others are tested.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR ${CMAKE_HOST_SYSTEM_PROCESSOR})
set(CMAKE_C_COMPILER musl-gcc)
