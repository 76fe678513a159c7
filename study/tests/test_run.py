# SPDX-License-Identifier: MIT
"""One small run of every section: the page is sound, in Chromium too, and its numbers are
those that come from elsewhere."""
import json
import os
import subprocess

import browser
import numpy as np
import page_check
import pytest
from conftest import study

from study import images, main, options, stats
from study.sections import closed_forms, missing, relief


def test_page_is_sound(page):
    assert page_check.faults_of(str(page)) == []


def test_page_in_a_browser(page, folder):
    program = browser.find_browser()
    if program is None and not os.environ.get("CI"):
        pytest.skip("there is no chromium (Debian package chromium)")
    assert program, "there is no chromium (Debian package chromium)"
    assert browser.faults_of_page(program, page / "index.html", folder) == []


def test_every_section_left_its_numbers(report):
    for key in ("views", "references", "methods", "missing", "bent", "structures", "claims_hsao",
                "claims_hbao", "alchemy", "vao", "closed_forms", "stability", "statements"):
        assert report[key], key


def test_every_paper_has_statements(report):
    papers = [s["paper"].split(",")[0] for s in report["statements"]]
    assert {p: papers.count(p) for p in ("2008a", "2008b", "2010", "2011")} == {
        "2008a": 14, "2008b": 6, "2010": 10, "2011": 9}


def test_every_method_and_preset_is_there(tool, report):
    listing = json.loads(subprocess.run([tool, "methods", "--json"], check=True,
                                        capture_output=True).stdout)
    assert {(r["method"], r["preset"]) for r in report["methods"]} == {
        (m["name"], p) for m in listing["methods"] for p in options.PRESETS}
    assert all(r["ms"] > 0 and r["rmse"] > 0 for r in report["methods"])


def test_errors_are_those_of_other_hands(tool, page, report):
    """The tool renders the picture and the truth again, and numpy compares them."""
    view = report["views"][0]
    row = next(r for r in report["methods"]
               if r["method"] == "hbao" and r["preset"] == "medium")
    common = ["builtin:corner", "--size", "96x54", "--radius", f"{view['radius']:.9g}",
              *view["camera"].split()]
    commands = (["render", *common, "-o", "a.exr", "--method", "hbao"],
                ["reference", *common, "-o", "b.exr", "--weighting", "uniform", "--falloff",
                 "linear", "--rays", "16"])
    for command in commands:
        subprocess.run([tool, *command], cwd=page, check=True, capture_output=True)
    picture, truth = images.read_single(page / "a.exr"), images.read(page / "b.exr").channels
    mask = np.isfinite(truth["Z"]) & (truth["Z"] < 1e10)
    assert mask.sum() == view["pixels"]
    # The study's reference stops rays at its error; pixels then differ by less than it.
    assert row["rmse"] == pytest.approx(stats.rmse(picture, truth["AO"], mask), abs=2e-3)


def test_light_by_traced_bent_normals(report):
    """Were a sky's side or a space taken wrongly, it would be worse than by normals."""
    view, normals, traced = report["bent"][0][:3]
    assert view == "corner" and float(normals) > 0.005 and float(traced) < 0.5


def test_comparison_of_made_pictures(tool, folder):
    """`compare`, which the tables come from, on pictures whose numbers are known by hand."""
    shape = (16, 16)
    images.write_exr(folder / "half.exr", {"AO": np.full(shape, 0.5)})
    images.write_exr(folder / "less.exr", {"AO": np.full(shape, 0.75)})
    found = json.loads(subprocess.run(
        [tool, "compare", "half.exr", "less.exr", "--json"], cwd=folder, check=True,
        capture_output=True).stdout)
    assert found["rmse"] == pytest.approx(0.25)
    assert found["bias"] == pytest.approx(-0.25)
    # Half of the occlusion brings 0.5 to 0.75.
    assert found["fit_intensity"] == pytest.approx(0.5, abs=1e-3)


def test_closed_forms_are_reached(report):
    """Errors of the estimates over the work that a quick run spends, from a table of theirs:
    no method is farther off than its sampling explains, and none has a systematic error."""
    rows = report["closed_forms"]["methods"]
    assert [(r["method"], r["closed_form"]) for r in rows] == [
        (f.method, f.integral) for f in closed_forms.FORMS]
    for row in rows:
        assert row["reached_rmse"]["96"] < 0.05, row
        assert abs(row["reached_mean"]) < 0.03, row
    for rows in report["closed_forms"]["reference"].values():
        # 256 rays: a standard error of at most 0.5 / 16 if they were independent.
        assert rows[-1]["rms"] < 0.032 and abs(rows[-1]["mean"]) < 0.01


def test_layers_change_nothing_where_nothing_is_hidden(report):
    """Behind the two faces of a corner there is nothing, and more samples come nearer."""
    corner, mean = report["missing_bounds"]
    assert corner == mean | {"view": "corner"} and mean["view"] == "mean"
    assert corner["some"] == corner["some_two"] > corner["converged"]
    assert len({v for k, v in corner.items() if k.startswith("converged")}) == 1


def test_parts_of_the_error(report):
    """Whatever the steps are, the triangle of errors cannot be broken: the converged error is
    at most the sum of what the data lack and what the estimator adds."""
    for row in report["missing"]:
        assert row["converged"] <= row["missing_data"] + row["estimator"] + 1e-9
        assert row["estimator"] <= row["missing_data"] + row["converged"] + 1e-9
    assert {r["method"] for r in report["missing"]} == set(missing.SUBJECTS)


def test_filters(report):
    """The default filter's error is what `compare` says of the same picture; in a corner all
    filters err most at the edge."""
    medium = {r["method"]: r for r in report["methods"] if r["preset"] == "medium"}
    for row in report["filters"]["rows"]:
        assert row["rmse_at_edges"] > row["rmse"] > 0, row
        assert row["flicker"] > 0, row
        if row["filter"] == "edges15":
            assert row["rmse"] == pytest.approx(medium[row["method"]]["rmse"], abs=2e-3)


def test_walls(report):
    """A plane: ssao by definition 0.5, the others 1."""
    for method, means in report["vao"]["walls"].items():
        # 0.02: on a slope the depth buffer is a staircase.
        assert means == pytest.approx([0.5 if method == "ssao" else 1.0] * 3, abs=0.02), method


def test_a_time_that_is_too_short_to_tell():
    """A fast machine is told to take 0.00 s for a small picture; ratios of it are numbers."""
    assert relief.time_told("with filter: 0.00 s\n") == 0.005
    assert relief.time_told("without filter: 1.25 s\n") == 1.25


def test_height_field_is_seen(report):
    found = report["vao"]["relief"]
    # The depth buffer knows nothing of the relief: its error is that of a white picture.
    assert found["rmse"]["vao"]["depth"] == pytest.approx(found["darkness"], abs=1e-3)
    assert found["limit_rmse"]["vao"] < 0.5 * found["darkness"]


def test_a_second_run_makes_nothing_anew(tool, page):
    before = {p: p.stat().st_mtime_ns for p in (page / "cache").iterdir()}
    page_before = (page / "index.html").read_text(encoding="utf-8")
    done = study(tool, page, "builtin:corner", "--quick", "--size", "96x54", "--rays", "16")
    assert done.returncode == 0, done.stderr
    rewritten = [p.name for p in (page / "cache").iterdir()
                 if p.stat().st_mtime_ns != before.get(p)]
    # The frames that the study writes itself are written again; nothing is computed anew.
    made_here = ("groove-", "wall-", "cobbles", "views-")
    assert [n for n in rewritten if not n.startswith(made_here)] == []
    assert (page / "index.html").read_text(encoding="utf-8") == page_before


def test_sections_and_main_can_be_chosen(tool, folder):
    out = folder / "two"
    done = study(tool, out, "builtin:corner", "builtin:sphere", "--main", "sphere", "--only",
                 "hbao", "--quick", "--size", "64x36", "--rays", "16", "--threads", "1")
    assert done.returncode == 0, done.stderr
    report = json.loads((out / "report.json").read_text(encoding="utf-8"))
    assert report["main"] == "sphere" and "methods" not in report
    assert page_check.faults_of(str(out)) == []


@pytest.mark.parametrize("arguments, code, words", [
    ((), 2, "name the folder"), (("-o", "out", "--only", "frobnicate"), 2, "frobnicate"),
    (("-o", "out", "--size", "32x18"), 2, "64x36"), (("-o", "out", "--rays", "8"), 2, "16 to"),
    (("-o", "out", "--main", "nave"), 1, "choose one of courtyard"),
    (("-o", "out", "--views", "none.json"), 1, "none.json: cannot be read"),
    (("-o", "out", "--views", "out/report.json"), 1, "is an input"),
    (("-o", "out", "none.glb"), 1, "none.glb"), (("-o", "out", "--tool", "none"), 1, "none:")])
def test_mistakes_are_told(tool, folder, monkeypatch, capsys, arguments, code, words):
    monkeypatch.chdir(folder)
    words_given = list(arguments)
    if "--tool" not in arguments:
        words_given += ["--tool", str(tool)]
    try:
        assert main.main(words_given) == code
    except SystemExit as left:
        assert left.code == code
    assert words in capsys.readouterr().err
