# SPDX-License-Identifier: MIT
"""The tables of docs/: every part has its marks, and a small run fills them all."""
import json
import shutil
import subprocess

import pytest
from conftest import ROOT, study

from study import docs, performance, tables

PAGES = ("methods.md", "papers.md", "reference.md", "performance.md", "gpu.md")


def test_number():
    assert tables.number(1234.5, 1) == "1 234.5"
    assert tables.number(0.25, 2, sign=True) == "+0.25"
    assert tables.number(None) == tables.number(float("nan")) == "-"


def test_parts_are_replaced_between_their_marks():
    page = "a\n<!-- x -->\nold\n<!-- end of x -->\nb\n"
    assert tables.with_part(page, "x", "new") == page.replace("old", "new")
    with pytest.raises(tables.PageError, match="no marks of y"):
        tables.with_part(page, "y", "new")


def test_growth_by_hand():
    rows = [{"method": "hbao", "x": x, "ms": 2 * x, "width": 1000, "height": 1000 * x}
            for x in (1, 2, 4)]
    # 2 ms for each million of pixels: 2 ns a pixel, exponent 1.
    assert "| `hbao` | 1: 2.00, 2: 2.00, 4: 2.00 | 1.00 |" in performance.growth_table(
        rows, "MPix", 0)


def test_courtyard_and_reference_tables(report, tmp_path):
    pages = copy_of_pages(tmp_path)
    docs.write(pages, docs.courtyard_parts(report | {"main": report["views"][0]["name"]}))
    docs.write(pages, docs.filters_parts(report))
    docs.write(pages, docs.bent_parts(report))
    methods = (pages / "methods.md").read_text(encoding="utf-8")
    assert "| `hbao` | `bilateral13` |" in methods and "| `bitmask` 4x8 |" in methods
    assert "| `hbao` | uniform, linear | medium | 64 |" in methods
    assert "| corner | 0." in methods
    papers = (pages / "papers.md").read_text(encoding="utf-8")
    assert papers.count("| 2008a, ") == 14


def test_meshes_and_performance_are_written(tool, folder, tmp_path, monkeypatch):
    # The large scenes would come on top of the one that is named, and take minutes.
    monkeypatch.delenv("CREVICE_SHARED", raising=False)
    pages = copy_of_pages(tmp_path)
    done = study(tool, folder / "docs", "builtin:corner", "--quick", "--docs", "meshes", "--docs",
                 "performance", "--pages", str(pages), "--size", "128x72")
    assert done.returncode == 0, done.stderr
    assert "| corner | " in (pages / "methods.md").read_text(encoding="utf-8")
    times = (pages / "performance.md").read_text(encoding="utf-8")
    for words in ("`corner`, 192x108:", "| `corner` | `hbao` 8x8 | `none` |", "| `crevice ao` |"):
        assert words in times


def test_a_frame_beside_the_list_is_measured(tool, folder, tmp_path, monkeypatch):
    monkeypatch.delenv("CREVICE_SHARED", raising=False)
    views = {"views": [{"name": name, "file": "builtin:corner", "eye": [5, 3.5, 1], "radius": 1,
                        "target": [0.8, 0.4, 0], "vfov_degrees": 45}
                       for name in ("framed", "frameless")]}
    (tmp_path / "list.json").write_text(json.dumps(views), encoding="utf-8")
    (tmp_path / "blender").mkdir()
    frame = tmp_path / "frame.exr"
    subprocess.run([tool, "gbuffer", "builtin:corner", "--size", "128x72", "--guard-px", "0",
                    "-o", frame], check=True)
    # Its pass is what the default makes without falloff: 0 in that column alone.
    subprocess.run([tool, "ao", frame, "--vfov", "45", "--radius", "1", "--falloff", "none",
                    "--append", "-o", tmp_path / "blender" / "framed.exr"], check=True)
    pages = copy_of_pages(tmp_path)
    done = study(tool, folder / "docs", "--views", str(tmp_path / "list.json"), "--docs",
                 "frames", "--pages", str(pages))
    assert done.returncode == 0, done.stderr
    page = (pages / "methods.md").read_text(encoding="utf-8")
    part = page.partition("<!-- frames-rmse -->")[2].partition("<!-- end")[0].strip().splitlines()
    heads, row = ([cell.strip() for cell in line.strip("|").split("|")]
                  for line in (part[0], part[2]))
    assert len(part) == 3 and row[0] == "framed"
    assert [h for h, cell in zip(heads, row) if cell == "0.0000"] == ["no option", "`bitmask`"]


def copy_of_pages(folder):
    for name in PAGES:
        shutil.copy(ROOT / "docs" / name, folder / name)
    return folder
