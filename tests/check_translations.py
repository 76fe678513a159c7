#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every shader, also those that an algorithm was lifted into, translates to what other
renderers take: HLSL, MSL, ESSL 3.10 and GLSL 4.30. What can be compiled here is.
Usage: check_translations.py ROOT GLSLANG TARGET_ENV; exit code 77 if spirv-cross is missing."""
import os
import shutil
import subprocess
import sys
import tempfile

# Language: options of spirv-cross; options of glslang's front end that compiles it.
LANGUAGES = {
    "hlsl": (["--hlsl", "--shader-model", "60"], ["-D", "-e", "main", "-V"]),
    "msl": (["--msl"], None),
    "essl": (["--version", "310", "--es"], []),
    "glsl": (["--version", "430", "--no-es"], []),
}
# What docs/gpu.md asks of a shader for a method in place of hbao, beside hbao's functions.
LIFTED = {
    "gtao": "",
    "bitmask": "float map_at(ivec2 at) { return INFINITY; } /* no widths */\n",
}


def run(*command):
    return subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          check=False)


def is_compiled(name, language):
    """Half floats are an extension in ESSL and GLSL that glslang does not have."""
    return LANGUAGES[language][1] is not None and not (
        name.endswith("_half") and language in ("essl", "glsl"))


def faults_of(name, module, glslang, folder):
    for language, (options, front_end) in LANGUAGES.items():
        text = os.path.join(folder, f"{name}.in_{language}")  # no name that a shader includes
        made = run("spirv-cross", module, *options, "--output", text)
        if made.returncode:
            yield f"{name} to {language}: {made.stdout}"
        elif is_compiled(name, language):
            built = run(glslang, "-S", "comp", *front_end, text,
                        *(["-o", os.path.join(folder, "again.spv")] if "-V" in front_end else []))
            if built.returncode:
                yield f"{name} in {language}: {built.stdout}"


def lifted(shaders, folder):
    """Paths of lifted_hbao.comp with other methods in hbao's place, and bent normals."""
    with open(os.path.join(shaders, "lifted_hbao.comp"), encoding="utf-8") as file:
        text = file.read()
    for name, functions in LIFTED.items():
        path = os.path.join(folder, f"lifted_{name}.comp")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace('#include "hbao.glsl"', f'{functions}#include "{name}.glsl"')
                       .replace('#include "lifted.glsl"',
                                '#define BENT_NORMAL 1\n#include "lifted.glsl"'))
        yield path


def main(root, glslang, target):
    if not shutil.which("spirv-cross"):
        print("skipped: no spirv-cross; install the package of that name")
        return 77
    shaders = os.path.join(root, "src/vulkan/shaders")
    paths = sorted(os.path.join(shaders, f) for f in os.listdir(shaders) if f.endswith(".comp"))
    faults = [] if len(paths) > 1 else [f"{shaders}: no shader"]
    with tempfile.TemporaryDirectory() as folder:
        paths += lifted(shaders, folder)
        for path in paths:
            name = os.path.basename(path)[:-5]
            module = os.path.join(folder, name + ".spv")
            made = run(glslang, "--quiet", "--target-env", target, "-I" + os.path.join(root, "src"),
                       "-I" + shaders, "-o", module, path)
            if made.returncode or made.stdout.strip():
                faults.append(f"{name}: the compiler says\n{made.stdout}")
            else:
                faults += faults_of(name, module, glslang, folder)
    for fault in faults:
        print(fault)
    print(f"{len(paths)} shaders, {len(LANGUAGES)} languages, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: check_translations.py ROOT GLSLANG TARGET_ENV")
    sys.exit(main(*sys.argv[1:]))
