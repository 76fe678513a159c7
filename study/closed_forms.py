# SPDX-License-Identifier: MIT
"""Occlusion in a groove of 90 degrees, in closed form.

c is the distance of a point of the floor from the other wall, in radii. The point sees its
own wall's plane below its horizon, and the other wall as a plane at the distance c, at right
angles to its own."""
import math

import numpy as np

Form = np.ndarray


def cosine_none(c: Form) -> Form:
    return (np.arccos(c) - c * np.sqrt(1 - c * c)) / math.pi


def cosine_linear(c: Form) -> Form:
    s = np.sqrt(1 - c * c)
    return (np.arccos(c) + c * s - 2 * c * np.log((1 + s) / c)) / math.pi


def uniform_none(c: Form) -> Form:
    return 0.5 * (1 - c)


def uniform_linear(c: Form) -> Form:
    return 0.5 * (1 - c + c * np.log(c))


def tangent_sphere(c: Form) -> Form:
    """The wall cuts a cap of height rho - c off the sphere of radius rho = 1/2."""
    rho = 0.5
    e = np.maximum(0.0, rho - c)
    return e * e * (3 * rho - e) / (4 * rho**3)


def half_ball(c: Form) -> Form:
    """The wall cuts a cap of height h = 1 - c off the ball, pi h^2 (3 - h) / 3. One half of
    the cap is in front of the floor; the open half of the ball is 2 pi / 3."""
    h = 1 - c
    return 0.25 * h * h * (3 - h)


def ball(c: Form) -> Form:
    """Of the whole ball, one half lies behind the floor."""
    return 0.5 + 0.5 * half_ball(c)


def alchemy(c: Form, depth: Form, beta: float, eps: float, parts: int = 2048) -> Form:
    """2 / pi Int max(0, v.n - depth beta) / (v.v + eps) over the disk of radius 1.

    Only the wall's points rise over the floor. At height w along the wall and y along the
    edge, v.n = w and v.v = w^2 + c^2 + y^2; an area dw dy of the wall is seen as
    dw dy / sqrt 2. The integral over y is an arc tangent; the one over w is summed."""
    c, depth = np.atleast_1d(c), np.atleast_1d(depth)
    bias = depth * beta
    top = np.sqrt(np.maximum(0.0, 1 - c * c))
    width = np.maximum(0.0, top - bias) / parts
    # Midpoints, from where a point counts, so that the integrand has no kink inside.
    w = bias[:, None] + width[:, None] * (np.arange(parts) + 0.5)
    squared = w * w + (c * c)[:, None]
    root = np.sqrt(squared + eps)
    along = np.sqrt(np.maximum(0.0, 1 - squared))
    rows = 2 * np.maximum(0.0, w - bias[:, None]) * np.arctan(along / root) / root
    return 2 / math.pi * math.sqrt(0.5) * rows.sum(axis=1) * width
