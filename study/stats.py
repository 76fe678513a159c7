# SPDX-License-Identifier: MIT
"""Small statistics that the sections share."""
import math
from collections.abc import Sequence

import numpy as np

# Points of a row that its order is fitted through, the last of them.
ORDER_POINTS = 4


def rmse(a: np.ndarray, b: np.ndarray, mask: np.ndarray) -> float:
    """Root mean squared difference over the pixels of the mask."""
    difference = a[mask].astype(np.float64) - b[mask]
    return float(np.sqrt(np.mean(difference * difference))) if difference.size else math.nan


def bias(a: np.ndarray, b: np.ndarray, mask: np.ndarray) -> float:
    """Mean of a - b over the mask."""
    return float(np.mean(a[mask].astype(np.float64) - b[mask])) if mask.any() else math.nan


def halves(a: np.ndarray, b: np.ndarray, mask: np.ndarray) -> tuple[float, float]:
    """The two halves of the mean absolute error: too dark, too bright."""
    error = a[mask].astype(np.float64) - b[mask]
    return float(np.mean(np.maximum(-error, 0))), float(np.mean(np.maximum(error, 0)))


def root_mean_square(values: Sequence[float]) -> float:
    return math.sqrt(sum(v * v for v in values) / len(values))


def slope(x: Sequence[float], y: Sequence[float]) -> float:
    """Exponent p of the fit y ~ x^p, least squares in the logarithms."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def crossing(x: Sequence[float], y: Sequence[float], level: float) -> float:
    """The x at which y, falling, comes down to the level: between two points on the straight
    line of the logarithms. 0 if the first point is below it, infinite if none is."""
    if y[0] <= level:
        return 0.0 if y[0] < level else x[0]
    for i in range(1, len(y)):
        if y[i] <= level:
            t = math.log(y[i - 1] / level) / math.log(y[i - 1] / y[i])
            return x[i - 1] * (x[i] / x[i - 1]) ** t
    return math.inf


def fitted_order(x: Sequence[float], error: Sequence[float]) -> float:
    """How fast the error falls: p of error ~ x^-p through the last points, down to the first
    that is within twice the smallest error. Beyond it something else limits the error."""
    smallest = min(error)
    end = next((i + 1 for i, e in enumerate(error) if e <= 2 * smallest), len(error))
    first = max(0, end - ORDER_POINTS)
    if end - first < 2:
        return math.nan
    return -slope(x[first:end], error[first:end])


def pareto(points: Sequence[tuple[float, float]]) -> list[int]:
    """Indices of the points that no other one beats in both numbers, by the first."""
    front: list[int] = []
    best = math.inf
    for index in sorted(range(len(points)), key=lambda i: points[i]):
        if points[index][1] < best:
            best = points[index][1]
            front.append(index)
    return front


def clearly_below(a: float, b: float) -> bool:
    """Differences under 2 % may come from the noise tile and the rays of the reference."""
    return a < 0.98 * b
