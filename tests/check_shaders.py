#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What can be said of the shaders without a device: they compile without a word, their
SPIR-V is valid, also with its constants specialised, and C and GLSL lay out the structs
that they share alike.
Usage: check_shaders.py ROOT GLSLANG TARGET_ENV CC; exit code 77 where spirv-tools are missing."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

# Ids of common.glsl with values that hosts use: all read from the buffer; a usual plan;
# much else, deinterleaved.
SPECIALISED = [
    "0:8 1:8 2:-1 3:-1 4:-1 5:-1 6:-1 7:-1 8:-1 9:-1 10:-1 11:-1 12:-1 13:1 14:-1 15:0 20:0",
    "0:16 1:8 2:1 3:8 4:8 5:1 6:12 7:0 8:1 9:0 10:4 11:1 12:0 13:1 14:1 15:0 20:1",
    "0:64 1:4 2:5 3:7 4:3 5:0 6:1 7:1 8:4 9:1 10:5 11:0 12:1 13:4 14:0 15:1 20:1",
]
SHARED = {  # struct: the header that defines it, an include away from src
    "crv__params": "shared/params.h",
    "crv__noise_texel": "shared/params.h",
    "crv__push": "shared/push.h",
}


def run(*command, **more):
    return subprocess.run(command, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False, **more)


def offsets_in_glsl(disassembly, struct):
    """{member: offset} from the names and decorations of a module that is not stripped."""
    names, offsets = {}, {}
    for match in re.finditer(rf'OpMemberName %{struct}(?:_\d+)? (\d+) "(\w+)"', disassembly):
        names[match[1]] = match[2]
    for match in re.finditer(rf"OpMemberDecorate %{struct}(?:_\d+)? (\d+) Offset (\d+)",
                             disassembly):
        offsets[match[1]] = int(match[2])
    return {names[index]: offset for index, offset in offsets.items()}


def offsets_in_c(root, compiler, folder, struct, members):
    """{member: offset}, and the size under the name ''."""
    lines = "".join(f'    printf("{m} %zu\\n", offsetof({struct}, {m}));\n' for m in members)
    source = os.path.join(folder, "layout.c")
    program = os.path.join(folder, "layout")
    with open(source, "w", encoding="utf-8") as file:
        file.write(f'#include "{SHARED[struct]}"\n#include <stdio.h>\nint main(void)\n{{\n{lines}'
                   f'    printf("%zu\\n", sizeof({struct}));\n    return 0;\n}}\n')
    built = run(compiler, "-std=c11", "-I", os.path.join(root, "src"), "-o", program, source)
    if built.returncode:
        sys.exit(f"{struct}: a member of the shader is not in C:\n{built.stdout}")
    result = {}
    for line in run(program).stdout.splitlines():
        *name, number = line.split()
        result[name[0] if name else ""] = int(number)
    return result


def layout_faults(root, compiler, folder, disassembly):
    for struct in SHARED:
        glsl = offsets_in_glsl(disassembly, struct)
        if not glsl:
            yield f"{struct}: no module has it"
            continue
        c = offsets_in_c(root, compiler, folder, struct, glsl)
        for member, offset in glsl.items():
            if c[member] != offset:
                yield f"{struct}.{member}: at {offset} in GLSL, at {c[member]} in C"
        # Every member is seen: members are of 4 bytes, but for the one array.
        covered = max(glsl.values()) + 4
        if struct != "crv__push" and covered != c[""]:
            yield f"{struct}: {covered} bytes in GLSL, {c['']} in C"


def module_faults(root, glslang, target, folder, name):
    """Faults of one shader; leaves FOLDER/NAME.spv, with its names."""
    path = os.path.join(root, "src/vulkan/shaders", name + ".comp")
    module = os.path.join(folder, name + ".spv")
    made = run(glslang, "--quiet", "--target-env", target, "-I" + os.path.join(root, "src"),
               "-o", module, path)
    if made.returncode or made.stdout.strip():
        yield f"{name}: the compiler says\n{made.stdout}"
    if made.returncode:
        return
    valid = run("spirv-val", "--target-env", "vulkan1.3", module)
    if valid.returncode:
        yield f"{name}: {valid.stdout}"
    for values in SPECIALISED:
        folded = os.path.join(folder, "folded.spv")
        made = run("spirv-opt", "--target-env=vulkan1.3", "--set-spec-const-default-value=" + values,
                   "--freeze-spec-const", "--fold-spec-const-op-composite", module, "-o", folded)
        valid = run("spirv-val", "--target-env", "vulkan1.3", folded)
        if made.returncode or valid.returncode:
            yield f"{name} specialised with {values}: {made.stdout}{valid.stdout}"


def main(root, glslang, target, compiler):
    for tool in ("spirv-val", "spirv-opt", "spirv-dis"):
        if not shutil.which(tool):
            print(f"skipped: no {tool}; install spirv-tools")
            return 77
    shaders = os.path.join(root, "src/vulkan/shaders")
    names = sorted(f[:-5] for f in os.listdir(shaders) if f.endswith(".comp"))
    faults = [] if names else [f"{shaders}: no shader"]
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            faults += module_faults(root, glslang, target, folder, name)
        if not faults:
            text = "".join(run("spirv-dis", os.path.join(folder, name + ".spv")).stdout
                           for name in ("hbao", "bilateral13"))
            faults += layout_faults(root, compiler, folder, text)
    for fault in faults:
        print(fault)
    print(f"{len(names)} shaders, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit("usage: check_shaders.py ROOT GLSLANG TARGET_ENV CC")
    sys.exit(main(*sys.argv[1:]))
