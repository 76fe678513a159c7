#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Proves that check_arrows.py and check_style.py can fail: small trees, each with one fault."""
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SPDX = "/* SPDX-License-Identifier: MIT */\n"

GOOD = {
    "include/crevice/base.h": "#include <stdint.h>\n",
    "include/crevice/image.h": '#include "base.h"\n',
    "src/shared/params.h": "#include <stdint.h>\n",
    "src/base/log.h": '#include "crevice/base.h"\n',
    "src/core/image.c": '#include "base/log.h"\n#include "shared/params.h"\n#include <math.h>\n',
    "src/core/frame.h": "",
    "src/methods/hbao.c": '#include "core/frame.h"\n/* #include "cpu/cpu.h" */\n',
    "src/cpu/cpu.h": '#include "core/frame.h"\n',
    "io/io.h": '#include "crevice/base.h"\n',
    "io/png.c": '#include "io.h"\n#include <png.h>\n',
    "scene/scene.h": '#include "crevice/base.h"\n',
    "tools/crevice/main.c": '#include "io.h"\n#include "scene.h"\n#include <cjson/cJSON.h>\n',
    "examples/minimal.c": '#include "crevice/image.h"\n#include <stdio.h>\n',
}

# (script, file that is added or replaced, its text, a part of the line that must appear)
FAULTS = [
    ("arrows", "include/crevice/image.h", '#include "../../src/base/log.h"\n', "src/base/log.h"),
    ("arrows", "include/crevice/image.h", "#include <stdio.h>\n", "<stdio.h>"),
    ("arrows", "src/shared/params.h", '#include "crevice/base.h"\n', "src/shared/ may not"),
    ("arrows", "src/shared/params.h", "#include <math.h>\n", "<math.h>"),
    ("arrows", "src/base/log.c", '#include "core/frame.h"\n', "src/base/ may not"),
    ("arrows", "src/core/x.c", '#include "cpu/cpu.h"\n', "src/core/ may not"),
    ("arrows", "src/core/x.c", "#include <png.h>\n", "<png.h>"),
    ("arrows", "src/methods/x.c", '\n#  include "cpu/cpu.h"\n', "x.c:3: includes src/cpu"),
    ("arrows", "src/methods/x.c", '#include "../cpu/cpu.h"\n', "src/cpu/cpu.h"),
    ("arrows", "src/cpu/x.c", '#include "io.h"\n', "io/io.h"),
    ("arrows", "io/x.c", '#include "scene.h"\n', "scene/scene.h"),
    ("arrows", "io/x.c", '#include "core/frame.h"\n', "src/core/frame.h"),
    ("arrows", "io/x.c", "#include <assimp/scene.h>\n", "belongs to scene/"),
    ("arrows", "io/x.c", "#include <unistd.h>\n", "belongs to io/system/"),
    ("arrows", "scene/x.c", "#include <sys/stat.h>\n", "belongs to io/system/"),
    ("arrows", "tools/crevice/x.c", "#include <signal.h>\n", "belongs to io/system/"),
    ("arrows", "io/system/x.c", '#include "io.h"\n', "io/io.h"),
    ("arrows", "scene/x.c", '#include "gone.h"\n', "not in the project"),
    ("arrows", "scene/x.c", '#include "../include/crevice/base.h"\n', 'write "crevice/..."'),
    ("arrows", "tools/crevice/x.c", '#include "base/log.h"\n', "src/base/log.h"),
    ("arrows", "tools/crevice/x.c", "#include <core/frame.h>\n", "src/core/frame.h"),
    ("arrows", "examples/x.c", '#include "io.h"\n', "io/io.h"),
    ("arrows", "src/loose.c", "", "lies in no room"),
    ("style", "src/core/x.c", "int x; \n", "white space"),
    ("style", "src/core/x.c", "\tint x;\n", "a tab"),
    ("style", "src/core/x.c", "/* " + "x" * 90 + " */\n", "columns"),
    ("style", "src/core/x.c", "int x;\n" * 800, "longer than 800"),
    ("style", "src/core/x.c", "int x;", "newline"),
    ("style", "tools/x.sh", "", "SPDX"),
]


def run(script, tree):
    with tempfile.TemporaryDirectory() as root:
        for path, text in tree.items():
            path = os.path.join(root, path)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as file:
                file.write(SPDX + text)
        return subprocess.run([sys.executable, os.path.join(HERE, f"check_{script}.py"), root],
                              capture_output=True, text=True, check=False)


def main():
    bad = 0
    for script in ("arrows", "style"):
        result = run(script, GOOD)
        if result.returncode != 0:
            print(f"check_{script}.py refuses a good tree:\n{result.stdout}{result.stderr}")
            bad += 1
    for script, path, text, expected in FAULTS:
        result = run(script, {**GOOD, path: text})
        if result.returncode != 1 or expected not in result.stdout:
            print(f"check_{script}.py misses {path} with {text[:60]!r}: "
                  f"exit {result.returncode}\n{result.stdout}{result.stderr}")
            bad += 1
    print(f"{len(FAULTS) + 2 - bad} passed, {bad} failed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
