#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the host in C++ on one thread and on three. Usage: check_host.py PROGRAM"""
import re
import subprocess
import sys


def main(program):
    said = [subprocess.run([program, threads], check=True, stdout=subprocess.PIPE,
                           text=True).stdout for threads in ("1", "3")]
    assert said[0] == said[1], "the number of threads changes nothing"
    frames = re.findall(r"wall at \d: ([\d.]+) on it, ([\d.]+) in the corner", said[0])
    assert len(frames) == 4, said[0]
    for wall, corner in frames:
        # More than two radii from the floor nothing occludes. Where wall and floor meet,
        # each hides half of what the other sees; the falloff gives some of that back.
        assert float(wall) == 1, wall
        assert 0.5 < float(corner) < 0.75, corner
    assert "\n0 blocks of memory left\n" in said[0], said[0]


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: check_host.py PROGRAM")
    main(sys.argv[1])
