# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from study import images


def test_exr_round_trip_with_guard(tmp_path):
    values = np.arange(48, dtype=np.float32).reshape(6, 8)
    images.write_exr(tmp_path / "a.exr", {"Z": values, "N.X": -values}, guard=2)
    frame = images.read(tmp_path / "a.exr")
    assert frame.guard == (2, 2)
    assert np.array_equal(frame.channels["Z"], values[2:-2, 2:-2])
    assert np.array_equal(frame.whole["N.X"], -values)


def test_what_cannot_be_read_is_named(tmp_path):
    with pytest.raises(images.PictureError, match="missing.exr"):
        images.read(tmp_path / "missing.exr")
    (tmp_path / "bad.exr").write_bytes(b"no picture")
    with pytest.raises(images.PictureError, match="bad.exr"):
        images.read(tmp_path / "bad.exr")


def test_error_map_colours():
    truth, mask = np.full((1, 4), 0.5), np.array([[True, True, True, False]])
    colours = images.error_map(np.array([[0.5, 0.0, 0.75, 0.5]]), truth, mask, 0.25)
    # Right, too dark beyond the scale, too bright by all of it, no surface.
    assert np.allclose(colours[0], [images.RIGHT, images.DARK, images.BRIGHT, images.NOTHING])


def test_busiest_window():
    picture = np.zeros((60, 100))
    picture[40:60:2, 80:100] = 1
    rows, columns = images.busiest_window(picture, 20, 20)
    assert (rows.start, columns.start) == (40, 80)
    rows, columns = images.busiest_window(picture, 500, 500)
    assert (rows.stop, columns.stop) == (60, 100)
