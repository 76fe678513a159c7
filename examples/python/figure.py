# SPDX-License-Identifier: MIT
"""Every method on one depth image, as a Matplotlib figure. Usage: figure.py OUT.png"""
import sys

import matplotlib
import numpy as np

import crevice

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def spheres(size=256):
    """Spheres that lie on a plane, orthographic, from above."""
    y, x = np.mgrid[0:size, 0:size] * (8 / size)
    height = np.zeros((size, size))
    for cx, cy, r in np.random.default_rng(2).uniform((0, 0, 0.3), (8, 8, 1.0), (24, 3)):
        inside = r * r - (x - cx) ** 2 - (y - cy) ** 2
        height = np.maximum(height, np.sqrt(np.maximum(inside, 0)))
    return 10 - height


def main(out):
    depth = spheres()
    camera = crevice.Camera.parallel(*depth.shape[::-1], view_height=8)
    names = [method.name for method in crevice.methods()]
    columns = (len(names) + 1) // 2
    figure, axes = plt.subplots(2, columns, figsize=(2.2 * columns, 4.8))
    for axis in axes.flat:
        axis.axis("off")
    for axis, name in zip(axes.flat, names):
        axis.imshow(crevice.ao(depth, camera=camera, radius=1, method=name), cmap="gray",
                    vmin=0, vmax=1)
        axis.set_title(name)
    figure.tight_layout()
    figure.savefig(out)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
