# SPDX-License-Identifier: MIT
import math

import numpy as np
import pytest

from study import stats


def test_rmse_and_bias_by_hand():
    a, b = np.array([[0.5, 0.9, 7.0]]), np.array([[0.4, 0.6, 0.0]])
    mask = np.array([[True, True, False]])
    # Errors 0.1 and 0.3: root of (0.01 + 0.09) / 2, and their mean.
    assert stats.rmse(a, b, mask) == pytest.approx(math.sqrt(0.05))
    assert stats.bias(a, b, mask) == pytest.approx(0.2)
    assert math.isnan(stats.rmse(a, b, np.zeros_like(mask)))


def test_halves_by_hand():
    a, b = np.array([0.2, 0.9]), np.array([0.5, 0.5])
    assert stats.halves(a, b, np.array([True, True])) == pytest.approx((0.15, 0.2))


def test_slope_of_powers():
    x = [1, 2, 4, 8]
    assert stats.slope(x, [3 * v**-0.5 for v in x]) == pytest.approx(-0.5)


def test_crossing():
    x, y = [4, 8, 16], [0.4, 0.2, 0.1]
    # y = 1.6 / x passes 0.16 at 10.
    assert stats.crossing(x, y, 0.16) == pytest.approx(10)
    assert stats.crossing(x, y, 0.4) == 4
    assert stats.crossing(x, y, 0.5) == 0
    assert stats.crossing(x, y, 0.05) == math.inf


def test_order_stops_at_the_floor():
    x = [4 * 2**k for k in range(8)]
    falling = [1 / v for v in x[:4]]
    # From the fourth point on nothing gets better: those after the first are left out.
    assert stats.fitted_order(x, falling + [falling[-1]] * 4) == pytest.approx(1.0)
    assert stats.fitted_order(x, [v**-0.5 for v in x]) == pytest.approx(0.5)


def test_order_of_one_point_is_unknown():
    assert math.isnan(stats.fitted_order([1, 2], [0.1, 0.1]))


@pytest.mark.parametrize("points, front", [
    ([(1, 5), (2, 3), (3, 4), (4, 1)], [0, 1, 3]),
    ([(2, 2), (1, 1)], [1]),
    ([(1, 2), (1, 1)], [1]),  # at the same cost the better one
    ([(1, 1), (2, 1)], [0]),  # no better at a higher cost
    ([], [])])
def test_pareto(points, front):
    assert stats.pareto(points) == front
