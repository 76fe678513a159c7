#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints the tables of docs/methods.md from what `crevice report` measured.

Usage: docs/tables.py DIR/report.json"""
import json
import sys


def number(value, digits=3, sign=False):
    if value is None:
        return "-"
    return f"{value:+.{digits}f}" if sign else f"{value:.{digits}f}"


def table(headers, rows):
    print("| " + " | ".join(headers) + " |")
    print("|" + "---|" * len(headers))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def in_order(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


def methods(report):
    """Error, bias and time of every preset on the main view; time as a share of hbao's at
    medium in the same run."""
    rows = [r for r in report["methods"] if r["view"] == report["main"]]
    unit = next(r["ms"] for r in rows if r["method"] == "hbao" and r["preset"] == "medium")
    print(f"{report['command']}: {report['main']}\n")
    table(["method", "integral", "preset", "samples", "RMSE", "bias", "SSIM",
           "RMSE at best power", "time, hbao medium = 1"],
          [[f"`{r['method']}`", r["target"], r["preset"], f"{r['samples']:.0f}",
            number(r["rmse"]), number(r["bias"], sign=True), number(r["ssim"]),
            number(r["fit_power_rmse"]), number(r["ms"] / unit, 2)]
           for r in rows if r["preset"] != "paper"])


def views(report, preset):
    """RMSE of one preset on all views."""
    rows = [r for r in report["methods"] if r["preset"] == preset]
    names = in_order(rows, "view")
    found = {(r["view"], r["method"]): r["rmse"] for r in rows}
    print(f"RMSE at {preset}\n")
    table(["method"] + names,
          [[f"`{m}`"] + [number(found.get((v, m))) for v in names]
           for m in in_order(rows, "method")])


def missing(report):
    """Totals of one and two layers, and what the error is made of."""
    rows = report["missing"]
    print("At high, default filter, against the whole scene\n")
    table(["view", "method", "one layer", "two layers", "to beat"],
          [[r["view"], f"`{r['method']}`", number(r["rmse_one_layer"]),
            number(r["rmse_two_layers"]), number(r["to_beat"])] for r in rows])
    table(["view", "method", "total", "converged", "missing data", "estimator", "sampling",
           "left by the filter", "blur"],
          [[r["view"], f"`{r['method']}`"] + [number(r[k]) for k in (
              "rmse_one_layer", "converged", "missing_data", "estimator", "sampling",
              "sampling_filtered", "blur")] for r in rows if r["missing_data"] is not None])


def stability(report):
    """What changes when the camera moves, beyond what the truth changes."""
    s = report["stability"]
    print(f"{s['frames']} frames, {s['motion_px']:.2f} px of motion: {s['pairs']}\n")
    table(["method", "unfiltered", "filtered"],
          [[f"`{r['method']}`"] + [number(x) for x in r["rms_excess"]]
           for r in s["methods"]])


def main(arguments):
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    with open(arguments[0], encoding="utf-8") as stream:
        report = json.load(stream)
    if "methods" in report:
        methods(report)
        views(report, "medium")
        views(report, "high")
    if "missing" in report:
        missing(report)
    if "stability" in report:
        stability(report)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
