#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the example renderer under the validation layer and looks at its picture. Exit code
77 where there is no device or no layer, unless CI is set.
Usage: check_vulkan_host.py PROGRAM FOLDER"""
import math
import os
import subprocess
import sys

WIDTH, HEIGHT = 960, 540


def project(point):
    """The pixel that shows a point, by the example's last camera, worked out anew."""
    angle = 0.35 + 0.04 * 4
    eye = (5.2 * math.sin(angle), 2.6, 5.2 * math.cos(angle))
    ahead = [t - e for t, e in zip((0.1, 0.6, -0.4), eye)]
    length = math.hypot(*ahead)
    ahead = [a / length for a in ahead]
    right = (-ahead[2], 0, ahead[0])
    length = math.hypot(*right)
    right = [r / length for r in right]
    up = (right[1] * ahead[2] - right[2] * ahead[1], right[2] * ahead[0] - right[0] * ahead[2],
          right[0] * ahead[1] - right[1] * ahead[0])
    to = [p - e for p, e in zip(point, eye)]
    x, y, d = (sum(a * b for a, b in zip(axis, to)) for axis in (right, up, ahead))
    focal = HEIGHT / 2 / math.tan(0.75 / 2)
    return int(WIDTH / 2 + focal * x / d), int(HEIGHT / 2 - focal * y / d)


def check(pixels):
    def brightness(point):
        x, y = project(point)
        return sum(pixels[3 * (y * WIDTH + x):3 * (y * WIDTH + x) + 3])

    # sRGB of the light's (0.30, 0.42, 0.62).
    sky = tuple(pixels[3 * (20 * WIDTH + 40):3 * (20 * WIDTH + 40) + 3])
    assert max(abs(a - b) for a, b in zip(sky, (149, 173, 206))) <= 1, sky
    # The floor has one normal and is lit evenly: what differs is the occlusion. In front of
    # the ball at (-0.4, 0.6, 0), 0.3 from where it touches, it hides a cone whose sine is
    # 0.6 / hypot(0.3, 0.6) on one side: a fifth of the ambient light at least, which is
    # two thirds of all; a twentieth of an sRGB value is a tenth of the light.
    open_floor = brightness((-1.2, 0, 1.7))
    near_ball = brightness((-0.3, 0, 0.35))
    farther = brightness((-0.2, 0, 0.8))
    assert near_ball < 0.95 * open_floor, (near_ball, open_floor)
    assert near_ball < farther <= open_floor + 3, (near_ball, farther, open_floor)
    # The inner edge of the lowest step and the middle of its tread.
    assert brightness((-2.6, 0.3, -0.22)) < brightness((-2.6, 0.3, 0.15)), "the steps"


def main(program, folder):
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "picture.ppm")
    done = subprocess.run([program, "--validate", path], check=False)
    if done.returncode == 77 and not os.environ.get("CI"):
        sys.exit(77)
    assert done.returncode == 0, done.returncode
    with open(path, "rb") as file:
        magic, size, maximum, pixels = file.read().split(b"\n", 3)
    assert (magic, size, maximum) == (b"P6", b"%d %d" % (WIDTH, HEIGHT), b"255"), size
    assert len(pixels) == WIDTH * HEIGHT * 3, len(pixels)
    check(pixels)
    refused = subprocess.run([program, os.path.join(folder, "gone", "x.ppm")],
                             stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                             check=False)
    assert refused.returncode == 1, "an unwritable file is an error"


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: check_vulkan_host.py PROGRAM FOLDER")
    main(sys.argv[1], sys.argv[2])
