# SPDX-License-Identifier: MIT
"""Points that are followed between two frames, on a wall whose motion is known."""
import numpy as np
import pytest

from study.sections import stability
from study.views import View

VIEW = View("wall", "none", (0.0, 0.0, 4.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 90.0, 1.0, 32, 18)
# At distance 4 the view of 90 degrees is 8 units high: 18 px.
UNITS_PER_PX = 8 / 18


def wall(view: View, has_step: bool = False) -> stability.Look:
    """A wall in the plane z = 0; with a step, its right half (x > 0) is 1 nearer."""
    rows, columns = np.mgrid[0:view.height, 0:view.width] + 0.5
    x = (columns - view.width / 2) / view.focal_px()
    y = -(rows - view.height / 2) / view.focal_px()
    depth = np.full(x.shape, view.eye[2])
    if has_step:
        depth = np.where(view.eye[0] + x * (depth - 1) > 0, depth - 1, depth)
    points = np.stack([x * depth, y * depth, -depth], -1) + np.array(view.eye)
    normals = np.zeros_like(points)
    normals[..., 2] = 1
    return stability.Look(view, points, normals, np.ones(depth.shape, bool))


def shifted(px: float) -> View:
    eye, target = (px * UNITS_PER_PX, 0.0, 4.0), (px * UNITS_PER_PX, 0.0, 0.0)
    return View(**{**vars(VIEW), "eye": eye, "target": target})


@pytest.mark.parametrize("px", [1.0, 0.5, -2.25])
def test_motion_is_that_of_the_camera(px):
    taps = stability.follow(wall(VIEW), wall(shifted(px)))
    assert taps.motion_px == pytest.approx(abs(px), abs=1e-6)
    # Columns that the former frame does not hold are left out.
    lost = int(np.ceil(abs(px)))
    assert taps.found.sum() == VIEW.height * (VIEW.width - lost)


def test_what_lies_on_the_surface_does_not_change():
    """A ramp over x is looked up exactly by a bilinear look-up."""
    former, latter = wall(VIEW), wall(shifted(0.3))
    taps = stability.follow(former, latter)
    change = taps.change(former.points[..., 0], latter.points[..., 0])
    assert np.abs(change).max() < 1e-9


def test_change_by_hand():
    """What is fixed to the screen moves over the surface by the ramp's slope."""
    former, latter = wall(VIEW), wall(shifted(0.5))
    taps = stability.follow(former, latter)
    ramp = np.tile(np.arange(VIEW.width) * 0.01, (VIEW.height, 1))
    # A point that is at column k now was at k + 0.5 before.
    assert taps.change(ramp, ramp) == pytest.approx(-0.005)


def test_silhouettes_are_left_out():
    taps = stability.follow(wall(VIEW, True), wall(shifted(0.5), True))
    whole = stability.follow(wall(VIEW), wall(shifted(0.5)))
    # At least the pixel between the two halves, whose texels lie on both.
    assert whole.found.sum() - taps.found.sum() >= VIEW.height
