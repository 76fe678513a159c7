#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What MSVC would refuse in the library, as far as that can be seen without it: words of
other compilers, OpenMP beyond 2.0, and what clang refuses when it stands in for MSVC, with
MinGW's headers. Usage: check_msvc.py ROOT SHADERS VULKAN: the folder of crevice_shaders.h,
empty without Vulkan, and that of Vulkan's headers. Exits 1 and lists faults; 77 if clang or
the headers are missing."""
import glob
import os
import re
import subprocess
import sys
import tempfile

HEADERS = "/usr/x86_64-w64-mingw32/include"
# Kernels are compiled by gcc and clang alone.
KERNELS = ("src/cpu/kernels/", "src/cpu/simd/")
FOREIGN = re.compile(r"\b(__builtin_\w+|__attribute__|__extension__|__typeof__|typeof|__asm\w*)")
LOOP = re.compile(r"#pragma omp[^\n]*\bfor\b[^\n]*\n(?!\s*for \(\w+ = )")

# MinGW's attributes stand where MSVC's may not; and its windows.h wants the intrinsics of
# gcc: the library uses three functions of it.
PRELUDE = """#include <_mingw.h>
#undef __MINGW_ATTRIB_NORETURN
#define __MINGW_ATTRIB_NORETURN
#undef __MINGW_ATTRIB_DEPRECATED
#define __MINGW_ATTRIB_DEPRECATED
"""
WINDOWS = """typedef void *HMODULE, *HANDLE;
typedef long LONG;
typedef struct { unsigned long dwNumberOfProcessors; } SYSTEM_INFO;
typedef int (*FARPROC)(void);
HMODULE LoadLibraryA(const char *name);
FARPROC GetProcAddress(HMODULE from, const char *name);
int FreeLibrary(HMODULE one);
LONG InterlockedIncrement(LONG volatile *counter);
unsigned long WaitForSingleObject(HANDLE one, unsigned long ms);
int CloseHandle(HANDLE one);
void GetSystemInfo(SYSTEM_INFO *out);
#define INFINITE 0xffffffff
"""


def sources(root):
    for folder in ("include", "src"):
        for path in glob.glob(f"{root}/{folder}/**/*.[ch]", recursive=True):
            if not os.path.relpath(path, root).startswith(KERNELS):
                yield path


def faults_of(path):
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m.group()), file.read(),
                      flags=re.S)
    for number, line in enumerate(text.split("\n"), 1):
        word = FOREIGN.search(line)
        if word and not line.startswith("#define"):
            yield number, f"{word.group()}; hide it behind a macro that is empty elsewhere"
    for loop in LOOP.finditer(text):
        yield text.count("\n", 0, loop.start()) + 1, "the index is not declared before the loop"


def compile_all(root, files, shaders, vulkan):
    with tempfile.TemporaryDirectory() as stage:
        for name, text in (("prelude.h", PRELUDE), ("windows.h", WINDOWS),
                           ("crevice_sets.h", "")):
            with open(os.path.join(stage, name), "w", encoding="utf-8") as file:
                file.write(text)
        for name in ("vulkan", "vk_video"):
            if shaders and os.path.isdir(os.path.join(vulkan, name)):
                os.symlink(os.path.join(vulkan, name), os.path.join(stage, name))
        command = ["clang", "--target=x86_64-pc-windows-msvc",
                   "-fms-compatibility-version=19.30", "-std=c11", "-fsyntax-only",
                   "-pedantic-errors", "-Werror=gnu", "-Werror=vla",
                   "-Werror=implicit-function-declaration",
                   "-include", f"{stage}/prelude.h", "-isystem", stage,
                   "-isystem", HEADERS, f"-I{root}/include", f"-I{root}/src",
                   "-DCRV_BUILD", f"-DCRV_HAS_VULKAN={1 if shaders else 0}"]
        if shaders:
            command.append(f"-I{shaders}")
        return subprocess.run(command + files, check=False).returncode == 0


def main(root, shaders, vulkan):
    faults = 0
    for path in sources(root):
        for number, fault in faults_of(path):
            print(f"{path}:{number}: {fault}")
            faults += 1
    if faults:
        return 1
    try:
        subprocess.run(["clang", "--version"], check=True, stdout=subprocess.DEVNULL)
    except (OSError, subprocess.CalledProcessError):
        print("no clang: the sources were only searched")
        return 77
    if not os.path.isdir(HEADERS):
        print(f"no {HEADERS}: the sources were only searched")
        return 77
    stand_in = os.path.join(root, "src/vulkan/absent.c")
    files = [path for path in sources(root) if path.endswith(".c")
             and (path != stand_in if shaders else
                  path == stand_in or "/src/vulkan/" not in path)]
    return 0 if compile_all(root, sorted(files), shaders, vulkan) else 1


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: check_msvc.py ROOT SHADERS VULKAN")
    sys.exit(main(*sys.argv[1:]))
