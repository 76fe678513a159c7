#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether what `crevice bench --json` wrote is whole and agrees with itself. Nothing here
depends on how fast anything is.

Usage: check_bench.py FILE.json [SECTION ROWS]..."""
import json
import math
import sys

# Look-ups for each pixel at medium, by hand: hbao 8 x 8, hsao 7 x 12 (1 + 1 normal ray),
# raymarch 8 x 8 x 4, the others their points.
SAMPLES = {"hbao": 64, "hsao": 168, "raymarch": 256, "alchemy": 12, "vo": 12,
           "containment": 24, "vao": 12, "ssao": 16}
PASSES = ["depth, planar", "depth, radial", "depth, hardware", "depth, reversed",
          "depth, disparity", "normals, view space", "normals, world space",
          "normals from depth", "filter bilateral13", "filter box4", "filter gauss5",
          "picture in and out"]
# Numbers are written with 15 to 17 digits; quotients of them lose a few.
CLOSE = 1e-9


def close(a, b):
    return math.isclose(a, b, rel_tol=CLOSE)


def check_times(row):
    assert row["runs"] >= 1 and row["runs"] == int(row["runs"]), row
    assert row["ms_min"] <= row["ms_q1"] <= row["ms"] <= row["ms_q3"] <= row["ms_max"], row
    assert close(row["ms_spread"] * 2 + 1, row["ms_q3"] - row["ms_q1"] + 1), row
    pixels = row["width"] * row["height"]
    if row.get("pass", "").startswith("filter"):
        return  # a difference of two runs, which may fall below 0
    assert row["ms_min"] > 0 and row["cpu_ms"] >= 0, row
    assert close(row["ns_per_pixel"], 1e6 * row["ms"] / pixels), row
    assert close(row["mpixels_per_s"] * row["ns_per_pixel"], 1000), row


def check_run(row, report):
    """A row of a run of the library: rates and shares by hand from the time."""
    check_times(row)
    assert close(row["ns_per_pixel_sample"] * row["samples"], row["ns_per_pixel"]), row
    if row["cycles_per_pixel"] is not None:
        assert close(row["cycles_per_pixel_sample"] * row["samples"] + 1,
                     row["cycles_per_pixel"] + 1), row
    if report["cycles_from"] == "clock":
        cycles = row["cpu_ms"] * 1e6 * report["clock_ghz"]
        assert close(row["cycles_per_pixel"] * row["width"] * row["height"] + 1, cycles + 1)
    ceiling = [c for c in report["ceilings"] if c["isa"] == row["isa"]]
    assert bool(ceiling) == (row["isa"] in report["isas"] and row["isa"] != "scalar"), row
    rate = row["samples"] * row["mpixels_per_s"] * 1e6 / row["threads"]
    for share, key in (("share_of_load", "load_disk_per_s"),
                       ("share_of_gather", "gather_disk_per_s")):
        if ceiling:
            assert close(row[share], rate / ceiling[0][key]), row
        else:
            assert row[share] is None, row
    stream = next(s for s in report["streams"] if s["threads"] == row["threads"])
    # Depth, three of a normal and the result, 4 bytes each.
    assert close(row["share_of_copy"],
                 20 * row["mpixels_per_s"] * 1e6 / stream["copy_bytes_per_s"]), row
    assert row["run_allocations"] == 0, row
    assert row["structure"] in ("fast", "exact"), row
    assert row["isa"] in report["isas"] or row["isa"].startswith("vulkan"), row
    assert row["bytes_per_pixel"] > 0 and row["radius"] > 0, row
    if row["isa"] == "scalar":
        assert row["structure"] == "exact", row


def check_methods(report):
    rows = report["methods"]
    work = ("frame", "width", "height", "method", "preset", "filter", "threads",
            "radius_factor", "samples")
    scalar = {tuple(r[k] for k in work): r["ms"] for r in rows if r["isa"] == "scalar"}
    seen = set()
    for row in rows:
        check_run(row, report)
        key = tuple(row[k] for k in work)
        assert (key, row["isa"], row["structure"]) not in seen, row
        seen.add((key, row["isa"], row["structure"]))
        if row["preset"] == "medium":
            assert row["samples"] == SAMPLES[row["method"]], row
        if key in scalar:
            assert close(row["speedup_over_scalar"], scalar[key] / row["ms"]), row
        else:
            assert row["speedup_over_scalar"] is None, row


def check_passes(report):
    kinds = {(r["isa"], r["threads"], r["width"], r["height"]) for r in report["passes"]}
    for kind in kinds:
        names = [r["pass"] for r in report["passes"]
                 if (r["isa"], r["threads"], r["width"], r["height"]) == kind]
        assert sorted(names) == sorted(PASSES), names
    for row in report["passes"]:
        check_times(row)
        assert row["streamed_bytes_per_pixel"] in (8, 16, 24), row


def check_memory(report):
    for row in report["memory"]:
        assert close(row["bytes_per_pixel"] * row["width"] * row["height"], row["bytes"]), row
        assert row["run_allocations"] == 0, row
        # A plane of depth and the result at the least.
        assert row["bytes_per_pixel"] >= 8, row


def slope(points):
    """Least squares in the logarithms."""
    xs = [math.log(x) for x, _ in points]
    ys = [math.log(y) for _, y in points]
    mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
    return (sum((x - mx) * (y - my) for x, y in zip(xs, ys))
            / sum((x - mx) ** 2 for x in xs))


def check_growth(report):
    for row in report["growth"]:
        check_run(row, report)
        if row["over"] in ("pixels", "pixels_alone"):
            assert row["x"] == row["width"] * row["height"], row
            factor = 1 if row["over"] == "pixels" else 720 / row["height"]
            assert math.isclose(row["radius_factor"], factor, rel_tol=1e-6), row
        elif row["over"] == "samples":
            assert row["x"] == row["samples"], row
        elif row["over"] == "threads":
            assert row["x"] == row["threads"], row
        else:
            assert row["over"] == "radius", row
            assert math.isclose(row["x"], row["radius_factor"], rel_tol=1e-6), row
    for fit in report["growth_fits"]:
        points = [(r["x"], r["ms"]) for r in report["growth"]
                  if (r["method"], r["over"]) == (fit["method"], fit["over"])]
        assert len(points) == fit["points"], fit
        assert (points[0][0], points[-1][0]) == (fit["from"], fit["to"]), fit
        if len(points) > 1:
            assert math.isclose(fit["exponent"], slope(points), rel_tol=1e-6,
                                abs_tol=1e-9), fit
        else:
            assert fit["exponent"] is None, fit


def check_embree(report):
    for row in report["embree"]:
        check_run(row, report)
        assert row["rmse"] >= 0, row
        if row["rays_for_same_rmse"] is None:
            continue
        assert row["rays_for_same_rmse"] >= 1, row
        # Between the two numbers of rays the law goes through what was measured.
        assert close(row["rmse_of_16_rays"] / row["rmse_of_64_rays"],
                     4 ** row["exponent"]), row
        if row["rays_for_same_rmse"] > 1:
            assert close(row["rmse_of_16_rays"] / row["rmse"],
                         (row["rays_for_same_rmse"] / 16) ** row["exponent"]), row
        assert close(row["speedup_over_ray_tracing"],
                     row["ray_tracing_ms"] / row["ms"]), row


def check_whole(report):
    assert [r["what"] for r in report["whole"]] == [
        "crevice ao", "reading the frame", "writing the result"], report["whole"]
    for row in report["whole"]:
        check_times(row)


def check_machine(report):
    assert report["command"].startswith("crevice bench"), report["command"]
    assert report["processor"] and report["compiler"] and report["version"], report
    assert "scalar" in report["isas"] and report["threads"] >= 1, report
    assert report["cycles_from"] in ("counter", "clock", "none"), report
    assert {c["isa"] for c in report["ceilings"]} == set(report["isas"]) - {"scalar"}
    for ceiling in report["ceilings"]:
        for key in ("gather_near_per_s", "gather_disk_per_s", "load_near_per_s",
                    "load_disk_per_s", "fma_per_s"):
            assert ceiling[key] > 0, ceiling
        if report["clock_ghz"] > 0:
            assert close(ceiling["fma_cycles"] * ceiling["fma_per_s"],
                         ceiling["lanes"] * report["clock_ghz"] * 1e9), ceiling
    for stream in report["streams"]:
        assert stream["read_bytes_per_s"] > 0 and stream["copy_bytes_per_s"] > 0, stream


CHECKS = {"methods": check_methods, "passes": check_passes, "memory": check_memory,
          "growth": check_growth, "embree": check_embree, "whole": check_whole}


def main(arguments):
    if len(arguments) % 2 != 1:
        print(__doc__, file=sys.stderr)
        return 2
    with open(arguments[0], encoding="utf-8") as stream:
        report = json.load(stream, parse_constant=lambda name: 1 / 0)
    check_machine(report)
    expected = dict(zip(arguments[1::2], map(int, arguments[2::2])))
    for section, check in CHECKS.items():
        assert (section in report) == (section in expected), section
        if section in expected:
            assert len(report[section]) == expected[section], (section, len(report[section]))
            check(report)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
