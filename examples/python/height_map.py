# SPDX-License-Identifier: MIT
"""Openness of a height map, seen from above. Usage: height_map.py OUT.png [HEIGHTS.npy]

Heights are metres on a grid of one metre; without a file a terrain is made.
"""
import sys

import matplotlib.image
import numpy as np

import crevice


def terrain(size=512, seed=1):
    """Hills upon hills: noise of falling amplitude, smoothed by the Fourier transform."""
    noise = np.random.default_rng(seed).standard_normal((size, size))
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(size), np.fft.fftfreq(size)))
    frequency[0, 0] = 1
    heights = np.fft.ifft2(np.fft.fft2(noise) * frequency ** -2.3).real
    return 160 * (heights - heights.min()) / np.ptp(heights)


def main():
    heights = np.load(sys.argv[2]) if len(sys.argv) > 2 else terrain()
    rows, columns = heights.shape
    depth = heights.max() + 1 - heights  # the camera looks straight down
    camera = crevice.Camera.parallel(columns, rows, view_height=rows)
    openness = crevice.ao(depth, camera=camera, radius=60, preset="high")
    matplotlib.image.imsave(sys.argv[1], openness, cmap="gray", vmin=0, vmax=1)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main()
