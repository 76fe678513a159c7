# SPDX-License-Identifier: MIT
"""A depth image of a scanner: 16-bit millimetres, 0 where it saw nothing.
Usage: depth_camera.py OUT.png [DEPTH.png FX FY CX CY]

Without a file a room with a box is made. FX, FY, CX, CY are the scanner's intrinsics in
pixels.
"""
import sys

import matplotlib.image
import numpy as np

import crevice


def room(rows=480, columns=640, f=525.0):
    """Walls, a floor and a box, as a scanner would see them: noise, steps, holes."""
    y, x = np.mgrid[0:rows, 0:columns]
    u, v = (x + 0.5 - columns / 2) / f, (y + 0.5 - rows / 2) / f
    planes = [np.full_like(u, 3.0), 1.2 / np.maximum(np.abs(u), 1e-6), 1.0 / np.maximum(v, 1e-6)]
    depth = np.minimum.reduce(planes)
    box = (np.abs(u * 2.2) < 0.4) & (v * 2.2 > 0.3) & (v * 2.2 < 1.0)
    depth[box] = np.minimum(depth, 2.2)[box]
    depth += np.random.default_rng(1).normal(0, 0.0005, depth.shape) * depth ** 2
    millimetres = np.round(depth * 1000).astype(np.uint16)
    millimetres[:, :12] = 0
    return millimetres, (f, f, columns / 2, rows / 2)


def main():
    if len(sys.argv) == 2:
        millimetres, intrinsics = room()
    else:
        millimetres = (matplotlib.image.imread(sys.argv[2]) * 65535).astype(np.uint16)
        intrinsics = map(float, sys.argv[3:])
    result = crevice.ao(millimetres, camera=crevice.Camera(*intrinsics), radius=150)
    matplotlib.image.imsave(sys.argv[1], result, cmap="gray", vmin=0, vmax=1)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 7):
        sys.exit(__doc__)
    main()
