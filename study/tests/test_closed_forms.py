# SPDX-License-Identifier: MIT
"""The closed forms against quadrature of the integrals that they are of."""
import math

import numpy as np
import pytest

from study import closed_forms

DISTANCES = [0.15, 0.35, 0.55, 0.75, 0.95]


def hemisphere(c: float, cosine: bool, linear: bool, n: int = 1500) -> float:
    """1 - A by midpoints over directions: the floor's normal is z, the wall stands across x at
    distance c; a ray of x part u > 0 meets it at r = c / u."""
    z = ((np.arange(n) + 0.5) / n)[:, None]
    u = np.sqrt(1 - z * z) * np.cos(2 * np.pi * (np.arange(n) + 0.5) / n)
    with np.errstate(divide="ignore", invalid="ignore"):
        weight = np.where(u > c, 1 - c / u if linear else 1.0, 0.0)
    return float(np.mean(weight * (2 * z if cosine else 1.0)))


@pytest.mark.parametrize("form, cosine, linear", [
    (closed_forms.cosine_none, True, False), (closed_forms.cosine_linear, True, True),
    (closed_forms.uniform_none, False, False), (closed_forms.uniform_linear, False, True)])
@pytest.mark.parametrize("c", DISTANCES)
def test_hemispheres(form, cosine, linear, c):
    # The cells that the edge of what is blocked crosses: 1/n of the range each way.
    assert form(np.array(c)) == pytest.approx(hemisphere(c, cosine, linear), abs=1e-3)


@pytest.mark.parametrize("c", DISTANCES)
def test_volumes(c):
    """Beyond the wall, by slices of the ball parallel to it."""
    n = 10000
    x = c + (1 - c) * (np.arange(n) + 0.5) / n
    width = (1 - c) / n
    ball = np.sum(np.pi * (1 - x * x)) * width
    tangent = np.sum(np.pi * np.maximum(0, 0.25 - x * x)) * width
    # Half of the cap is over the floor; the open half of the ball is 2 pi / 3.
    assert closed_forms.half_ball(np.array(c)) == pytest.approx(ball / 2 / (2 * math.pi / 3),
                                                                abs=1e-6)
    # The floor itself hides half of the ball.
    assert closed_forms.ball(np.array(c)) == pytest.approx(
        (2 * math.pi / 3 + ball / 2) / (4 * math.pi / 3), abs=1e-6)
    assert closed_forms.tangent_sphere(np.array(c)) == pytest.approx(tangent / (math.pi / 6),
                                                                     abs=1e-6)


@pytest.mark.parametrize("c", DISTANCES)
def test_alchemy_sum(c):
    """A plain double sum over the disk as the camera sees it."""
    n, beta, eps, depth = 2000, 1e-3, 1e-3, 5.0
    y = ((np.arange(n) + 0.5) / n * 2 - 1)[:, None]
    w = (np.arange(n) + 0.5) / n
    squared = w * w + c * c + y * y
    terms = np.where(squared <= 1, np.maximum(0, w - depth * beta) / (squared + eps), 0)
    expected = 2 / math.pi * math.sqrt(0.5) * terms.sum() * (1 / n) * (2 / n)
    # The edge of the disk crosses cells of 1/n by 2/n, on which terms are at most 1.
    assert closed_forms.alchemy(np.array(c), np.array(depth), beta, eps)[0] == pytest.approx(
        expected, abs=1e-3)
