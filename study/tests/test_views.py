# SPDX-License-Identifier: MIT
import json

import numpy as np
import pytest

from study import views

GOOD = {"name": "a", "file": "flat.obj", "eye": [0, 1, 3], "target": [0, 0, 0],
        "vfov_degrees": 40}


def write(tmp_path, text):
    path = tmp_path / "views.json"
    path.write_text(text if isinstance(text, str) else json.dumps(text), encoding="utf-8")
    return str(path)


def test_files_are_relative_to_the_list(tmp_path):
    found = views.read_list(write(tmp_path, {"views": [GOOD, {"name": "b",
                                                              "file": "builtin:sphere"}]}))
    assert found[0]["file"] == str(tmp_path / "flat.obj")
    assert found[1]["file"] == "builtin:sphere"


@pytest.mark.parametrize("change, fault", [
    ({"eye": [0, 1]}, "eye"), ({"eye": [0, "1", 2]}, "eye"), ({"eye": [0, float("inf"), 2]}, "eye"),
    ({"target": None}, "target"), ({"up": 3}, "up"), ({"vfov_degrees": None}, "vfov_degrees"),
    ({"radius": -1}, "radius"), ({"radius": True}, "radius"), ({"name": "a b"}, "name"),
    ({"file": 3}, "file")])
def test_faults_of_views_are_told(tmp_path, change, fault):
    with pytest.raises(views.ViewError, match=f'views.json: view 1: "{fault}"'):
        views.read_list(write(tmp_path, {"views": [GOOD | change]}))


@pytest.mark.parametrize("text", ["", "[1]", "{\"views\": []}", "{\"views\": 3}", "{\"views\":\n[}",
                                  "{\"views\": [1]}"])
def test_faults_of_lists_are_told(tmp_path, text):
    with pytest.raises(views.ViewError, match="views.json: "):
        views.read_list(write(tmp_path, text))


def test_a_missing_list_is_told(tmp_path):
    with pytest.raises(views.ViewError, match="none.json: cannot be read"):
        views.read_list(str(tmp_path / "none.json"))


def test_names():
    assert views.unique_name("models/Old hall.glb", set()) == "Old-hall"
    assert views.unique_name("builtin:corner", {"corner"}) == "corner-2"


def test_projection_by_hand():
    """At 90 degrees the picture is twice as high as the distance: 18 px for 2 units at 1."""
    view = views.View("v", "m", (0, 0, 2), (0, 0, 0), (0, 1, 0), 90.0, 0.5, 32, 18)
    assert view.focal_px() == pytest.approx(9)
    assert view.radius_px(np.array(3.0)) == pytest.approx(0.5 * 9 / 3)
    assert np.allclose(view.axes(), np.eye(3))
    moved = view.moved(1.0)
    assert np.linalg.norm(np.subtract(moved.eye, view.eye)) == pytest.approx(1)
