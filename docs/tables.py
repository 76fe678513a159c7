#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts what `crevice report` measured into the tables of docs/methods.md.

Usage: docs/tables.py TOOL [VIEWS.json]     measure, then rewrite the page
       docs/tables.py --from REPORT.json... rewrite it from reports that are there
       docs/tables.py --print REPORT.json   every number as tables, to look at

TOOL is the program `crevice`. It reports on the built-in views and, where a list of
views is given, on those at 1280x720; both reports are left in out/study and out/meshes.
A part of the page whose numbers no report has stays as it is."""
import json
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
PAGE = os.path.join(HERE, "methods.md")
COSINE = ("hsao", "raymarch", "containment")


def number(value, digits=3, sign=False):
    if value is None:
        return "-"
    return f"{value:+.{digits}f}" if sign else f"{value:.{digits}f}"


def table(headers, rows):
    lines = ["| " + " | ".join(headers) + " |", "|" + "---|" * len(headers)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def in_order(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


def methods(report):
    """Error, bias and time of every preset on the main view; time as a share of hbao's at
    medium in the same run."""
    rows = [r for r in report["methods"] if r["view"] == report["main"]]
    unit = next(r["ms"] for r in rows if r["method"] == "hbao" and r["preset"] == "medium")
    return table(["method", "integral", "preset", "samples", "RMSE", "bias", "SSIM",
                  "at best power", "time"],
                 [[f"`{r['method']}`", r["target"], r["preset"], f"{r['samples']:.0f}",
                   number(r["rmse"]), number(r["bias"], sign=True), number(r["ssim"]),
                   number(r["fit_power_rmse"]), number(r["ms"] / unit, 2)]
                  for r in rows if r["preset"] in ("medium", "high")])


def layers(report):
    """One layer and two of those methods that take further layers, and what to beat."""
    found = {(r["view"], r["method"]): r for r in report["missing"]}

    def pair(view, method):
        row = found[view, method]
        return f"{number(row['rmse_one_layer'])}, {number(row['rmse_two_layers'])}"

    views = [v for v in in_order(report["missing"], "view")
             if found[v, "hbao"]["to_beat"] is not None]
    return table(["view", "`hsao`", "`raymarch`", "`containment`", "to beat", "`hbao`",
                  "to beat"],
                 [[v] + [pair(v, m) for m in COSINE]
                  + [number(found[v, "hsao"]["to_beat"]), pair(v, "hbao"),
                     number(found[v, "hbao"]["to_beat"])] for v in views])


def parts(report):
    """What the errors of one layer are made of."""
    return table(["view", "method", "total", "converged", "missing data", "estimator",
                  "sampling", "left by the filter", "blur"],
                 [[r["view"], f"`{r['method']}`"] + [number(r[k]) for k in (
                     "rmse_one_layer", "converged", "missing_data", "estimator",
                     "sampling", "sampling_filtered", "blur")]
                  for r in report["missing"]
                  if r["missing_data"] is not None and r["method"] in ("hsao", "hbao")])


def stability(report):
    """What changes when the camera moves, beyond what the truth changes."""
    return table(["method", "unfiltered", "filtered"],
                 [[f"`{r['method']}`"] + [number(x) for x in r["rms_excess"]]
                  for r in report["stability"]["methods"]])


def made_by(report):
    """The command, without the folders of this machine, and what it ran on."""
    command = re.sub(r"\S*/", "", report["command"])
    return (f"`{command}`, crevice {report['version']}, {report['compiler']}, "
            f"{report['processor']}, {report['threads']} threads.")


def is_of_meshes(report):
    return any(r["to_beat"] is not None for r in report.get("missing", []))


# Parts of the page, the reports that have them, and what writes them.
PARTS = {
    "courtyard-made-by": (lambda r: "methods" in r and not is_of_meshes(r), made_by),
    "courtyard-methods": (lambda r: "methods" in r and not is_of_meshes(r), methods),
    "courtyard-stability": (lambda r: "stability" in r and not is_of_meshes(r), stability),
    "meshes-made-by": (is_of_meshes, made_by),
    "meshes-layers": (is_of_meshes, layers),
    "meshes-parts": (is_of_meshes, parts),
}


def rewrite(page, reports):
    """The page with every part that a report has written anew, between its marks."""
    for name, (has, write) in PARTS.items():
        report = next(filter(has, reports), None)
        if report is None:
            continue
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
        before, found, rest = page.partition(begin)
        _, closed, after = rest.partition(end)
        if not found or not closed:
            raise ValueError(f"docs/methods.md has no marks of {name}")
        page = before + begin + write(report) + "\n" + end + after
    return page


def read(path):
    with open(path, encoding="utf-8") as stream:
        return json.load(stream)


def measure(tool, views):
    """Runs the reports; their files."""
    out = os.path.join(os.path.dirname(HERE), "out")
    os.makedirs(out, exist_ok=True)
    runs = [["study"]] + ([["meshes", "--views", views, "--size", "1280x720"]] if views
                          else [])
    for folder, *arguments in runs:
        subprocess.run([tool, "report", "-o", os.path.join(out, folder)] + arguments,
                       check=True)
    return [os.path.join(out, run[0], "report.json") for run in runs]


def main(arguments):
    if not arguments or arguments[0] in ("-h", "--help"):
        print(__doc__, file=sys.stderr)
        return 2
    if arguments[0] == "--print":
        report = read(arguments[1])
        for name, (has, write) in PARTS.items():
            if has(report):
                print(f"{name}\n\n{write(report)}\n")
        return 0
    if arguments[0] == "--from":
        files = arguments[1:]
    else:
        files = measure(arguments[0], arguments[1] if len(arguments) > 1 else None)
    with open(PAGE, encoding="utf-8") as stream:
        page = stream.read()
    page = rewrite(page, [read(file) for file in files])
    with open(PAGE, "w", encoding="utf-8") as stream:
        stream.write(page)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
