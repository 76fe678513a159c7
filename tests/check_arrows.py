#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Who may include whom. Usage: check_arrows.py ROOT; exits 1 and lists what breaks a rule."""
import os
import re
import sys

# Folder: the rooms whose headers its files may include. The first folder that a path
# begins with is its room.
ROOMS = {
    "include/crevice": set(),
    "src/shared": set(),
    "src/base": {"include/crevice"},
    "src/core": {"include/crevice", "src/base", "src/shared"},
    "src/methods": {"include/crevice", "src/base", "src/core", "src/shared"},
    "src/filters": {"include/crevice", "src/base", "src/core", "src/shared"},
    "src/cpu/simd": set(),
    "src/cpu/kernels": {"src/cpu/simd", "src/shared"},  # and what EXTRA lists
    "src/cpu": {"include/crevice", "src/base", "src/core", "src/shared",
                "src/cpu/simd", "src/cpu/kernels"},
    "src/vulkan": {"include/crevice", "src/base", "src/core", "src/shared"},
    "src/backends.c": {"src/core"},
    "io/system": set(),
    "io": {"include/crevice", "io/system"},
    "scene": {"include/crevice", "io/system"},
    "tools/common": {"include/crevice", "io", "io/system", "scene"},
    "tools/crevice": {"include/crevice", "io", "io/system", "scene", "tools/common"},
    "tools/view": {"include/crevice", "io", "io/system", "scene", "tools/common"},
    "python": {"include/crevice"},
    "examples": {"include/crevice"},
}

# A header that a room may include beyond its rooms: the registries are lists that the
# core reads, and nothing else of methods and filters is. Kernels read a frame's planes and
# the values of its options.
EXTRA = {
    "src/cpu/kernels": {"src/core/conversions.h", "src/core/frame.h", "src/core/ids.h",
                        "src/core/image.h",
                        "include/crevice/options.h"},
    "src/core": {"src/methods/list.h", "src/filters/list.h"},
}

STANDARD = set("""assert.h complex.h ctype.h errno.h fenv.h float.h inttypes.h iso646.h
limits.h locale.h math.h setjmp.h signal.h stdalign.h stdarg.h stdatomic.h stdbool.h
stddef.h stdint.h stdio.h stdlib.h stdnoreturn.h string.h tgmath.h threads.h time.h
uchar.h wchar.h wctype.h""".split())

# The headers from outside that a room may include; rooms that are not listed: any that no
# other room owns.
SYSTEM = {
    "include/crevice": {"stdbool.h", "stddef.h", "stdint.h", "vulkan/vulkan.h"},
    "src/shared": {"stddef.h", "stdint.h"},  # offsetof pins layouts
    # The systems' allocators, threads and locales.
    "src/base": STANDARD
    | {"malloc.h", "omp.h", "process.h", "pthread.h", "sys/mman.h", "unistd.h", "windows.h",
       "xlocale.h"},
    "src/core": STANDARD,
    "src/methods": STANDARD,
    "src/filters": STANDARD,
    "src/cpu/kernels": {"stdbool.h", "stdint.h"},
    "src/cpu": STANDARD,
}

# Libraries that belong to some rooms. Vulkan's headers are for the backend, for the public
# header that takes its handles, and for programs that use that.
OWNED = {
    r"(openexr|OpenEXR|zlib)": ("io",),
    r"png": ("io", "scene"),
    r"(embree\d*/|assimp/)": ("scene",),
    r"(cjson/|cJSON)": ("tools/", "scene", "io"),
    r"gtk/": ("tools/view",),
    r"Python\.h": ("python",),
}

# Headers of operating systems, which are for the layers over them alone.
POSIX = re.compile(r"(sys|linux|net|netinet|arpa)/|(dirent|dlfcn|fcntl|fnmatch|ftw|glob|grp"
                   r"|libgen|poll|pthread|pwd|sched|semaphore|signal|spawn|strings|syslog"
                   r"|termios|unistd|wordexp|windows|process|io|direct)\.h$")
LAYERS = ("io/system", "src/base")
LOADER = ("src/vulkan", ("dlfcn.h", "windows.h"))  # opens the system's Vulkan loader

# Headers that the build makes, and their rooms.
GENERATED = {"crevice_shaders.h": "src/vulkan", "crevice_sets.h": "src/cpu",
             "vulkan_host_shaders.h": "examples"}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)', re.M)
COMMENT = re.compile(r"/\*.*?\*/", re.S)


def room_of(path):
    for room in ROOMS:
        if path == room or path.startswith(room + "/"):
            return room
    return None


def resolve(root, includer, name):
    """The project's file that a name means, relative to root, or None."""
    folders = [os.path.dirname(includer), "include", "src", "io", "scene", "tools",
               "tools/crevice"]
    for folder in folders:
        path = os.path.normpath(os.path.join(folder, name))
        if os.path.isfile(os.path.join(root, path)):
            return path
    return None


def fault_of(root, path, name, quoted):
    """What is wrong with `path` including `name`, or None."""
    room = room_of(path)
    target = resolve(root, path, name)
    if target is not None:
        target_room = room_of(target)
        if target_room == room or target in EXTRA.get(room, ()):
            return None
        if target_room in ROOMS[room]:
            if target_room == "include/crevice" and not name.startswith("crevice/"):
                return f'includes a public header as "{name}"; write "crevice/..."'
            return None
        return f"includes {target}, which {room}/ may not"
    if quoted and GENERATED.get(name) == room:
        return None
    if quoted:
        return f'includes "{name}", which is not in the project'
    allowed = SYSTEM.get(room)
    if allowed is not None and name not in allowed:
        return f"includes <{name}>, which {room}/ may not"
    if name.startswith("vulkan/") and room not in ("src/vulkan", "include/crevice", "examples"):
        return f"includes <{name}>, which belongs to src/vulkan/"
    if POSIX.match(name) and room not in LAYERS and not (room == LOADER[0]
                                                         and name in LOADER[1]):
        return f"includes <{name}>, which belongs to io/system/ and src/base/"
    for pattern, owners in OWNED.items():
        if re.match(pattern, name) and not (room + "/").startswith(owners):
            rooms = " and ".join(owner.rstrip("/") + "/" for owner in owners)
            return f"includes <{name}>, which belongs to {rooms}"
    return None


def sources(root):
    for folder in ("include", "src", "io", "scene", "tools", "python", "examples"):
        for where, folders, names in os.walk(os.path.join(root, folder)):
            folders.sort()
            for name in sorted(names):
                if name.endswith((".c", ".h", ".inc", ".glsl", ".comp")):
                    yield os.path.relpath(os.path.join(where, name), root)


def main(root):
    faults = 0
    count = 0
    for path in sources(root):
        count += 1
        if room_of(path) is None:
            print(f"{path}: lies in no room; move it, or add its folder to {__file__}")
            faults += 1
            continue
        with open(os.path.join(root, path), encoding="utf-8") as file:
            text = COMMENT.sub(lambda m: "\n" * m.group().count("\n"), file.read())
        for match in INCLUDE.finditer(text):
            name = match.group(1) or match.group(2)
            fault = fault_of(root, path, name, match.group(1) is not None)
            if fault:
                line = text.count("\n", 0, match.start(match.lastindex)) + 1
                print(f"{path}:{line}: {fault}")
                faults += 1
    if count == 0:
        print(f"{root}: no source file; give the root of the repository")
        faults += 1
    print(f"{count} files, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: check_arrows.py ROOT")
    sys.exit(main(sys.argv[1]))
