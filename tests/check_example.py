#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the example and looks at its picture: sky and open floor are white, the contact of
sphere and floor is dark. Usage: check_example.py PROGRAM FOLDER"""
import os
import subprocess
import sys


def main(program, folder):
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "ao.pgm")
    subprocess.run([program, path], check=True)
    with open(path, "rb") as file:
        magic, size, maximum, pixels = file.read().split(b"\n", 3)
    assert (magic, size, maximum) == (b"P5", b"640 480", b"255"), (magic, size, maximum)
    assert len(pixels) == 640 * 480, len(pixels)

    def grey(x, y):
        return pixels[y * 640 + x]

    # Pixels worked out by hand from the camera: fy = 240 / tan(0.45) = 497, so that a
    # point (x, y, -d) is seen at (320 + 497 x / d, 240 - 497 y / d).
    assert grey(320, 10) == 255, "the sky is background"
    assert grey(60, 460) > 245, "the floor at the left edge is a sphere's diameter away"
    # (0, -1, -3.5), on the floor half a unit before the contact: the sphere's centre is
    # 1.12 away, so that it spans a cone of 63 degrees about that direction, from a
    # distance of 0.12 on. With what the falloff takes away, a seventh is left with ease.
    assert grey(320, 382) < 255 * 6 / 7, "the floor before the contact is darkened"
    assert grey(320, 364) < grey(320, 382), "and the contact more so"
    assert min(pixels) > 0, "nothing here is closed altogether"
    refused = subprocess.run([program, os.path.join(folder, "gone", "x.pgm")],
                                       stderr=subprocess.DEVNULL, check=False)
    assert refused.returncode == 1, "an unwritable file is an error"


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: check_example.py PROGRAM FOLDER")
    main(sys.argv[1], sys.argv[2])
