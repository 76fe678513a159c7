#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What clang-format does not see: licence lines, lengths, white space, median sizes.
Usage: check_style.py ROOT; exits 1 and lists what breaks a rule."""
import os
import statistics
import sys

MAX_COLUMNS = 90
MAX_LINES = 800
MEDIAN_LINES = 250
SKIP = {".git", "build", "out", ".cache", ".vscode", ".idea"}
CODE = (".c", ".h", ".comp", ".glsl")
TEXT = CODE + (".py", ".sh", ".cmake", ".in")
NAMES = {"CMakeLists.txt", "demo", "check", "run"}


def files(root):
    for where, folders, names in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in SKIP
                            and not f.startswith("cmake-build"))
        for name in sorted(names):
            if name.endswith(TEXT) or name in NAMES:
                yield os.path.relpath(os.path.join(where, name), root)


def faults_of(path, text):
    lines = text.split("\n")
    code = path.endswith(CODE)
    first = lines[1] if lines[0].startswith("#!") and len(lines) > 1 else lines[0]
    expected = "/* SPDX-License-Identifier: MIT */" if code else "# SPDX-License-Identifier: MIT"
    if first != expected:
        yield 1, f"the first line is not {expected}"
    if len(lines) - 1 > MAX_LINES:
        yield len(lines), f"longer than {MAX_LINES} lines; part it"
    if not text.endswith("\n") or text.endswith("\n\n"):
        yield len(lines), "does not end with exactly one newline"
    for number, line in enumerate(lines, 1):
        if line.rstrip() != line:
            yield number, "white space at the end of the line"
        if "\t" in line:
            yield number, "a tab"
        if code and len(line) > MAX_COLUMNS:
            yield number, f"{len(line)} columns, more than {MAX_COLUMNS}"


def main(root):
    faults = 0
    lengths = []
    for path in files(root):
        with open(os.path.join(root, path), encoding="utf-8", newline="") as file:
            text = file.read()
        if path.endswith(CODE):
            lengths.append(text.count("\n"))
        for number, fault in faults_of(path, text):
            print(f"{path}:{number}: {fault}")
            faults += 1
    if not lengths:
        print(f"{root}: no source file; give the root of the repository")
        return 1
    median = statistics.median(lengths)
    if median > MEDIAN_LINES:
        print(f"half of the sources are longer than {median:.0f} lines; {MEDIAN_LINES} is the limit")
        faults += 1
    print(f"{len(lengths)} sources, median {median:.0f} lines, longest {max(lengths)}; {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: check_style.py ROOT")
    sys.exit(main(sys.argv[1]))
