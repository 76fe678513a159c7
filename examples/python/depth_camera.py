# SPDX-License-Identifier: MIT
"""Depth images of a scanner that stands still: 16-bit millimetres, 0 where it saw nothing.
Usage: depth_camera.py OUT.png [FX FY CX CY DEPTH.png...]

The mean of many images has less noise. Without files a room with a box is made. FX, FY, CX, CY
are the scanner's intrinsics in pixels.
"""
import sys

import matplotlib.image
import numpy as np

import crevice


def room(frames=32, rows=480, columns=640, f=525.0):
    """Walls, a floor and a box, as a scanner would see them: noise, steps, holes."""
    y, x = np.mgrid[0:rows, 0:columns]
    u, v = (x + 0.5 - columns / 2) / f, (y + 0.5 - rows / 2) / f
    planes = [np.full_like(u, 3.0), 1.2 / np.maximum(np.abs(u), 1e-6), 1.0 / np.maximum(v, 1e-6)]
    depth = np.minimum.reduce(planes)
    box = (np.abs(u * 2.2) < 0.4) & (v * 2.2 > 0.3) & (v * 2.2 < 1.0)
    depth[box] = np.minimum(depth, 2.2)[box]
    random = np.random.default_rng(1)
    images = [np.round(1000 * (depth + random.normal(0, 0.0003, depth.shape) * depth ** 2))
              for _ in range(frames)]
    images = np.array(images, np.uint16)
    images[:, :, :12] = 0
    return images, (f, f, columns / 2, rows / 2)


def mean(images):
    """The mean over the images that saw something; NaN where none did."""
    images = np.ma.masked_equal(images, 0)
    return images.mean(axis=0).filled(np.nan)


def main():
    if len(sys.argv) == 2:
        images, intrinsics = room()
    else:
        intrinsics = map(float, sys.argv[2:6])
        images = [np.round(matplotlib.image.imread(name) * 65535) for name in sys.argv[6:]]
    # Millimetres: a radius of 150 is 15 cm. What rises by less than 10 degrees is noise.
    result = crevice.ao(mean(images), camera=crevice.Camera(*intrinsics), radius=150,
                        method="hbao", bias_deg=10)
    matplotlib.image.imsave(sys.argv[1], result, cmap="gray", vmin=0, vmax=1)


if __name__ == "__main__":
    if len(sys.argv) != 2 and len(sys.argv) < 7:
        sys.exit(__doc__)
    main()
