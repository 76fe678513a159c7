#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the tool over files of other projects and tallies what becomes of them.

    tests/foreign/tally.py TOOL FOLDER... [--seconds 60] [--json FILE]

By hand, for example with Debian's assimp-testmodels and the pictures of OpenEXR:

    tests/foreign/tally.py build/gcc/tools/crevice/crevice /usr/share/assimp/models

A mesh goes through `render`, an EXR file through `ao`; if no channel of it looks like
depth, its first one is taken for it, so that every pixel is read. Outcomes:

    picture   exit code 0, nothing to say
    warning   exit code 0, with a warning
    white     exit code 0, no occlusion anywhere and not a word: a fault, unless looked at
    refusal   exit code 1 and one error line
    unread    exit code 1: no format that assimp knows (pictures, texts)
    silent    another exit code than 0 without an error line, or several: a fault
    crash     ended by a signal: a fault
    hang      took longer than --seconds: a fault

Exits 1 if there was a fault.
"""
import argparse
import array
import collections
import json
import os
import re
import subprocess
import sys
import tempfile

FAULTS = ("white", "silent", "crash", "hang")
# What lies beside models and is none.
BESIDE = {".jpg", ".jpeg", ".png", ".tga", ".bmp", ".dds", ".txt", ".mtl", ".md", ".tif",
          ".tiff", ".gif", ".bin", ".pcx", ".html", ".py", ".license", ".source", ".webp",
          ".ktx2", ".csv"}


def is_open(path):
    """Whether a PFM of one channel is 1 everywhere."""
    with open(path, "rb") as file:
        assert file.readline().strip() == b"Pf"
        file.readline()
        little = float(file.readline()) < 0
        values = array.array("f", file.read())
    if little != (sys.byteorder == "little"):
        values.byteswap()
    return min(values) >= 1.0


def outcome(code, stderr, picture):
    """The word for one run, and the line to show."""
    lines = [line for line in stderr.splitlines() if line.startswith("crevice: ")]
    errors = [line for line in lines if not line.startswith("crevice: warning: ")]
    first = (errors or lines or [""])[0]
    if code < 0 or code > 128:
        return "crash", stderr[-200:]
    if code != 0:
        if len(errors) != 1:
            return "silent", stderr[-200:]
        unread = "No suitable reader" in first or "no triangles" in first
        return ("unread" if unread else "refusal"), first
    if errors or not os.path.exists(picture):
        return "silent", first
    if lines:
        return "warning", first
    return ("white" if is_open(picture) else "picture"), ""


def run_command(command, seconds, picture):
    try:
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        return "hang", ""
    return outcome(done.returncode, done.stderr.decode("utf-8", "replace"), picture)


def run(tool, path, seconds, folder):
    picture = os.path.join(folder, "out.pfm")
    if os.path.exists(picture):
        os.remove(picture)
    if path.lower().endswith(".exr"):
        command = [tool, "ao", path, "-o", picture, "--vfov", "45"]
    else:
        command = [tool, "render", path, "-o", picture, "--size", "96x54",
                   "--import-timeout", str(0.8 * seconds)]
    word, line = run_command(command, seconds, picture)
    channels = re.search(r"no channel looks like depth \(there are: ([^,)]+)", line)
    if word == "refusal" and channels:
        word, line = run_command(command + ["--depth", channels[1], "--normal", "none"],
                                 seconds, picture)
    return word, line


def files_of(folders):
    for folder in folders:
        if os.path.isfile(folder):
            yield folder
        for where, names, files in os.walk(folder):
            names.sort()
            for name in sorted(files):
                if os.path.splitext(name)[1].lower() not in BESIDE:
                    yield os.path.join(where, name)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tool")
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--json", help="write every outcome there")
    arguments = parser.parse_args()
    tool = os.path.abspath(arguments.tool)
    results = []
    counts = collections.Counter()
    with tempfile.TemporaryDirectory() as folder:
        for path in files_of(arguments.folders):
            word, line = run(tool, path, arguments.seconds, folder)
            counts[word] += 1
            results.append({"file": path, "outcome": word, "line": line})
            if word != "picture":
                print(f"{word:8} {path}  {line[:160]}", flush=True)
    print(", ".join(f"{counts[word]} {word}" for word in sorted(counts)))
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(results, file, indent=1)
    return 1 if any(counts[word] for word in FAULTS) else 0


if __name__ == "__main__":
    sys.exit(main())
