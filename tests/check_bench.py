#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether what `crevice bench --json` wrote is whole and agrees with itself. Nothing here
depends on how fast anything is.

Usage: check_bench.py FILE.json ROWS"""
import json
import math
import sys

# What sampling costs at medium, by hand: hbao 8 x 8, alchemy and vao 12 points.
OPTIONS = {"hbao": {"directions": 8, "steps": 8}, "alchemy": {"samples": 12},
           "vao": {"samples": 12}}
# Numbers are written with 15 to 17 digits; quotients of them lose a few.
CLOSE = 1e-9


def close(a, b):
    return math.isclose(a, b, rel_tol=CLOSE)


def check_times(row):
    assert row["runs"] >= 1 and row["runs"] == int(row["runs"]), row
    assert 0 < row["ms_min"] <= row["ms_q1"] <= row["ms"] <= row["ms_q3"] <= row["ms_max"], row
    assert row["cpu_ms"] >= 0, row
    pixels = row["width"] * row["height"]
    assert close(row["mpix_per_s"] * row["ms"], pixels / 1000), row
    # Nothing where the processor's counter cannot be read, as in most virtual machines.
    assert row["cycles_per_pixel"] is None or row["cycles_per_pixel"] > 0, row


def check_steps(row):
    """On a GPU each step has a time; a filter alone is not timed by its clock."""
    if row["device"] == "cpu" or row["method"] == "none":
        assert "steps" not in row, row
        return
    names = [step["name"] for step in row["steps"]]
    assert row["method"] in names, row
    assert row["filter"] == "none" or row["filter"] in names, row
    assert all(step["ms"] >= 0 for step in row["steps"]), row


def check_row(row, report):
    check_times(row)
    check_steps(row)
    assert row["run_allocations"] == 0, row
    # A plane of depth and the result at the least.
    assert row["bytes_per_pixel"] >= 8, row
    if row["device"] == "cpu":
        assert row["structure"] in ("deinterleaved", "exact"), row
        assert row["isa"] != "scalar" or row["structure"] == "exact", row
        assert row["depth_layout"] is None and row["arithmetic"] is None, row
    else:
        assert row["isa"] is None and row["structure"] is None, row
        assert row["depth_layout"] in ("linear", "deinterleaved", "levels"), row
        assert row["arithmetic"] in ("single", "half"), row
    if row["preset"] == "medium" and report["rows"][0]["preset"] == "medium":
        for key, value in OPTIONS.get(row["method"], {}).items():
            assert row["options"][key] == value or "--set" in sys.argv, row


def main(arguments):
    if len(arguments) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    with open(arguments[0], encoding="utf-8") as stream:
        report = json.load(stream, parse_constant=lambda name: 1 / 0)
    assert report["processor"] and report["compiler"] and report["version"], report
    assert report["threads"] >= 1, report
    rows = report["rows"]
    assert len(rows) == int(arguments[1]), len(rows)
    for row in rows:
        check_row(row, report)
    # No combination twice.
    keys = ("scene", "width", "height", "method", "preset", "filter", "device", "isa",
            "structure", "depth_layout", "arithmetic", "threads", "radius_factor")
    assert len({tuple(row[key] for key in keys) for row in rows}) == len(rows), rows
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
