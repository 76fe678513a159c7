# SPDX-License-Identifier: MIT
# 32-bit x86 on a 64-bit machine with gcc's multilib. `./check --all` builds the library and
# its short tests with it.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR i686)
set(CMAKE_C_COMPILER gcc)
# The headers of asm/ lie with those of the 64-bit system.
set(CMAKE_C_FLAGS_INIT "-m32 -idirafter /usr/include/x86_64-linux-gnu")
