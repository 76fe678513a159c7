# SPDX-License-Identifier: MIT
import json
import math

import numpy as np
import pytest

from study import page, plots
from study.page import FAILS, HOLDS, NOT_MEASURED, PARTLY, Claim

ABOUT = {"command": "study/run <x>", "version": "1", "processor": "p", "threads": 2,
         "device": "cpu"}


def test_verdicts():
    assert page.graded(True, False) == HOLDS
    assert page.graded(False, False, True) == PARTLY
    assert page.graded(False, False) == FAILS
    assert [page.counted(n, 2) for n in (2, 1, 0)] == [HOLDS, PARTLY, FAILS]


def test_only_what_fails_has_a_reason():
    assert [Claim("", "", v, "", "why").shown_reason
            for v in (HOLDS, NOT_MEASURED, PARTLY, FAILS)] == ["", "", "why", "why"]


def test_text_is_escaped_and_code_marked():
    assert page.prose("a < b, `--x <y>`") == "a &lt; b, <code>--x &lt;y&gt;</code>"


def test_numbers_that_json_has_no_word_for():
    assert page.plain({"a": [math.nan, np.float32(0.5)], "b": np.bool_(True), 3: np.int64(2)}) \
        == {"a": [None, 0.5], "b": True, "3": 2}


def test_page_holds_what_was_given(tmp_path):
    made = page.Page(tmp_path)
    made.heading(2, "one", "One")
    made.table("caption", ["a", "b"], [["<1>", page.Bold("2")]])
    made.claim(Claim("2011", "It fails.", FAILS, "0.3", "Since."))
    made.grid([made.picture("a b", np.zeros((2, 3)), "black")])
    made.results["numbers"] = {"x": math.inf}
    made.write(**ABOUT)
    html = (tmp_path / "index.html").read_text(encoding="utf-8")
    for part in ("does not hold", "&lt;1&gt;", "<strong>2</strong>", "pictures/a-b.png",
                 "Of 1 statements", "study/run &lt;x&gt;"):
        assert part in html
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert report["numbers"] == {"x": None}
    assert report["statements"][0]["verdict"] == FAILS


def test_two_pictures_of_one_name_are_refused(tmp_path):
    made = page.Page(tmp_path)
    made.picture("a", np.zeros((2, 2)), "")
    with pytest.raises(ValueError, match="two pictures"):
        made.picture("a", np.zeros((2, 2)), "")


def test_plots_have_the_page_s_ink_and_names_of_their_own():
    lines = [plots.Line("one", [1, 10], [0.1, 0.01], ["low", "high"])]
    first, second = (plots.draw(lines, "x", "y", log_x=True, log_y=True, front=True)
                     for _ in range(2))
    assert "currentColor" in first and plots.INK not in first
    ids = [set(part.split('"')[0] for part in svg.split(' id="')[1:]) for svg in (first, second)]
    assert ids[0] and not ids[0] & ids[1]
