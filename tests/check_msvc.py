#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What MSVC would refuse in library and tool, as far as that can be seen without it: words
of other compilers, OpenMP beyond 2.0, and what clang refuses when it stands in for MSVC, with
MinGW's headers. Of the tool all is compiled but the layer over the operating system and the
viewer. Usage: check_msvc.py ROOT SHADERS VULKAN: the folder of crevice_shaders.h, empty
without Vulkan, and that of Vulkan's headers. Exits 1 and lists faults; 77 if clang or the
headers are missing."""
import glob
import os
import re
import subprocess
import sys
import tempfile

HEADERS = "/usr/x86_64-w64-mingw32/include"
LIBRARY = ("include", "src")
TOOL = ("io", "scene", "tools")
# Kernels are compiled by gcc and clang alone; a port of the tool writes io/system/*.c anew.
APART = ("src/cpu/kernels/", "src/cpu/simd/", "io/system/", "tools/view/")
# Of the tool's libraries: the header that must be there, and what is seen of /usr/include.
NEEDS = {"openexr.h": ("OpenEXR", "Imath"), "png.h": ("png.h", "pngconf.h", "pnglibconf.h"),
         "cjson/cJSON.h": ("cjson",), "assimp/scene.h": ("assimp",),
         "zlib.h": ("zlib.h", "zconf.h"), "rtcore.h": ("embree3", "embree4")}
USR = "/usr/include"
FOREIGN = re.compile(r"\b(__builtin_\w+|__attribute__|__extension__|__typeof__|typeof|__asm\w*)")
LOOP = re.compile(r"#pragma omp[^\n]*\bfor\b[^\n]*\n(?!\s*for \(\w+ = )")

# MinGW's attributes stand where MSVC's may not; its INFINITY is a function's result, where
# MSVC's is a constant; and its windows.h wants the intrinsics of gcc: the library uses a few
# functions of it.
PRELUDE = """#include <_mingw.h>
#undef __MINGW_ATTRIB_NORETURN
#define __MINGW_ATTRIB_NORETURN
#undef __MINGW_ATTRIB_DEPRECATED
#define __MINGW_ATTRIB_DEPRECATED
#include <math.h>
#undef INFINITY
#define INFINITY ((float)(1e300 * 1e300))
"""
WINDOWS = """typedef void *HMODULE, *HANDLE;
typedef long LONG;
typedef struct { unsigned long dwNumberOfProcessors; } SYSTEM_INFO;
typedef int (*FARPROC)(void);
HMODULE LoadLibraryA(const char *name);
FARPROC GetProcAddress(HMODULE from, const char *name);
int FreeLibrary(HMODULE one);
LONG InterlockedIncrement(LONG volatile *counter);
LONG InterlockedCompareExchange(LONG volatile *counter, LONG value, LONG expected);
unsigned long WaitForSingleObject(HANDLE one, unsigned long ms);
int CloseHandle(HANDLE one);
void GetSystemInfo(SYSTEM_INFO *out);
#define INFINITE 0xffffffff
"""


def sources(root, folders):
    for folder in folders:
        for path in glob.glob(f"{root}/{folder}/**/*.[ch]", recursive=True):
            if not os.path.relpath(path, root).startswith(APART):
                yield path


def faults_of(path, loops):
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m.group()), file.read(),
                      flags=re.S)
    for number, line in enumerate(text.split("\n"), 1):
        word = FOREIGN.search(line)
        if word and not line.startswith("#define"):
            yield number, f"{word.group()}; hide it behind a macro that is empty elsewhere"
    for loop in LOOP.finditer(text) if loops else ():
        yield text.count("\n", 0, loop.start()) + 1, "the index is not declared before the loop"


def stage_headers(stage, shaders, vulkan):
    """Fills the folder of system headers that clang sees beside MinGW's; what of the tool's
    libraries is missing."""
    for name, text in (("prelude.h", PRELUDE), ("windows.h", WINDOWS),
                       ("crevice_sets.h", "")):
        with open(os.path.join(stage, name), "w", encoding="utf-8") as file:
            file.write(text)
    for name in ("vulkan", "vk_video"):
        if shaders and os.path.isdir(os.path.join(vulkan, name)):
            os.symlink(os.path.join(vulkan, name), os.path.join(stage, name))
    missing = []
    for header, names in NEEDS.items():
        there = [name for name in names if os.path.exists(os.path.join(USR, name))]
        if not there:
            missing.append(header)
        for name in there:
            os.symlink(os.path.join(USR, name), os.path.join(stage, name))
    return missing


def compile_files(root, stage, files, words):
    command = ["clang", "--target=x86_64-pc-windows-msvc",
               "-fms-compatibility-version=19.30", "-std=c11", "-fsyntax-only",
               "-pedantic-errors", "-Werror=gnu", "-Werror=vla",
               "-Werror=implicit-function-declaration",
               "-include", f"{stage}/prelude.h", "-isystem", stage,
               "-isystem", HEADERS, f"-I{root}/include"]
    return subprocess.run(command + words + sorted(files), check=False).returncode == 0


def compile_library(root, stage, shaders):
    stand_in = os.path.join(root, "src/vulkan/absent.c")
    files = [path for path in sources(root, LIBRARY) if path.endswith(".c")
             and (path != stand_in if shaders else
                  path == stand_in or "/src/vulkan/" not in path)]
    words = [f"-I{root}/src", "-DCRV_BUILD", f"-DCRV_HAS_VULKAN={1 if shaders else 0}"]
    return compile_files(root, stage, files, words + ([f"-I{shaders}"] if shaders else []))


def compile_tool(root, stage):
    files = [path for path in sources(root, TOOL) if path.endswith(".c")]
    embree = 4 if os.path.isdir(os.path.join(USR, "embree4")) else 3
    folders = ("io", "scene", "tools", "tools/crevice")
    return compile_files(root, stage, files, [f"-I{root}/{folder}" for folder in folders]
                         + ["-isystem", f"{stage}/OpenEXR", "-isystem", f"{stage}/Imath",
                            "-isystem", f"{stage}/cjson",
                            f"-DCREVICE_EMBREE_VERSION={embree}"])


def main(root, shaders, vulkan):
    faults = 0
    for folders in (LIBRARY, TOOL): # the tool would do without OpenMP
        for path in sources(root, folders):
            for number, fault in faults_of(path, folders is LIBRARY):
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
    with tempfile.TemporaryDirectory() as stage:
        missing = stage_headers(stage, shaders, vulkan)
        good = compile_library(root, stage, shaders)
        if missing:
            print(f"no {', '.join(missing)}: the tool was only searched")
        else:
            good = compile_tool(root, stage) and good
    return 0 if good else 1


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: check_msvc.py ROOT SHADERS VULKAN")
    sys.exit(main(*sys.argv[1:]))
