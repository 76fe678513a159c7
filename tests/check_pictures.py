#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the examples implicit and multisample and looks at their pictures.
Usage: check_pictures.py IMPLICIT MULTISAMPLE FOLDER"""
import os
import subprocess
import sys


def read(folder, name, width, height):
    with open(os.path.join(folder, name), "rb") as file:
        magic, size, maximum, pixels = file.read().split(b"\n", 3)
    assert (magic, maximum) == (b"P5", b"255"), (name, magic, maximum)
    assert size == b"%d %d" % (width, height), (name, size)
    assert len(pixels) == width * height, (name, len(pixels))
    return pixels


def check_implicit(folder):
    """Depth buffer, field and both, side by side; vao above containment."""
    for shape in ("spheres", "torus", "gyroid"):
        pixels = read(folder, f"implicit_{shape}.pgm", 960, 480)
        dark = 0
        for y in range(480):
            depth, field, both = (pixels[y * 960 + x:y * 960 + x + 320] for x in (0, 320, 640))
            for d, f, b in zip(depth, field, both):
                # What is outside both is outside each. Rounding to greys takes one.
                assert b <= min(d, f) + 1, (shape, y, d, f, b)
                dark += f < 250 and f != 128
        assert dark > 300, f"{shape}: the function occludes nothing"
        assert pixels[0] == 128 and pixels[-1] == 128, f"{shape}: the corners are sky"


def check_multisample(folder):
    plain = read(folder, "multisample_pixel.pgm", 320, 240)
    gathered = read(folder, "multisample_gathered.pgm", 320, 240)
    changed = 0
    for y in range(2, 238):
        for x in range(2, 318):
            at = y * 320 + x
            if abs(plain[at] - gathered[at]) < 20:
                continue
            # A silhouette: a mixture of the surfaces that meet there, both of which are
            # around, two pixels away at most (the cross of a neighbour's sample).
            changed += 1
            around = [plain[at + dy * 320 + dx] for dy in range(-2, 3) for dx in range(-2, 3)]
            assert min(around) - 2 <= gathered[at] <= max(around) + 2, (x, y)
    # The three spheres' outlines are about 2 pi 60, 2 pi 60 and 2 pi 20 px long; some of
    # them are white on both sides.
    assert 50 < changed < 900, changed


def main(implicit, multisample, folder):
    os.makedirs(folder, exist_ok=True)
    for program, check in ((implicit, check_implicit), (multisample, check_multisample)):
        subprocess.run([program, folder], check=True)
        check(folder)
        refused = subprocess.run([program, os.path.join(folder, "gone")],
                                 stderr=subprocess.DEVNULL, check=False)
        assert refused.returncode == 1, "an unwritable file is an error"


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: check_pictures.py IMPLICIT MULTISAMPLE FOLDER")
    main(*sys.argv[1:])
