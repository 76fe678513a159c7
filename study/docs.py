# SPDX-License-Identifier: MIT
"""Writes every measured table in docs/, between its marks: study/run --docs PART."""
import argparse
import datetime
import json
import os
import sys
from pathlib import Path
from typing import Any

from . import frames, performance
from .measure import Study
from .options import PRESETS
from .sections import bent, filters
from .tables import markdown, number, rewrite
from .tool import HOME, ToolError

DOCS = HOME / "docs"
PARTS = ("courtyard", "filters", "bent", "meshes", "frames", "performance", "gpu")
SHOWN = ("medium", "high")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--docs", action="append", choices=PARTS, metavar="PART",
                        help=f"measure a part of the tables in docs/ and write them: one of "
                             f"{', '.join(PARTS)}; may be given again. All but courtyard "
                             "take the views of --views, else those of the folder "
                             "CREVICE_SHARED; frames are those in blender/NAME.exr beside "
                             "the list. Let the machine do nothing else meanwhile")
    parser.add_argument("--pages", type=Path, default=DOCS, metavar="DIR",
                        help="the folder of the pages to rewrite [docs]")


def made_by(report: dict[str, Any]) -> str:
    return (f"`{report['command']}`, crevice {report['version']}, {report['processor']}, "
            f"{report['threads']} threads.")


def methods_table(report: dict[str, Any]) -> str:
    """Error, bias and time of the usual presets on the main view; time as a share of hbao's
    at medium in the same run."""
    rows = [r for r in report["methods"] if r["view"] == report["main"]]
    unit = next(r["ms"] for r in rows if (r["method"], r["preset"]) == ("hbao", "medium"))
    return markdown(["method", "integral", "preset", "samples", "RMSE", "bias", "SSIM",
                     "at best power", "time"],
                    [[f"`{r['method']}`", r["target"], r["preset"], f"{r['samples']:.0f}",
                      number(r["rmse"]), number(r["bias"], sign=True), number(r["ssim"]),
                      number(r["fit_power_rmse"]), number(r["ms"] / unit, 2)]
                     for r in rows if r["preset"] in SHOWN and r["preset"] in PRESETS])


def stability_table(report: dict[str, Any]) -> str:
    """What changes when the camera moves, beyond what the truth changes."""
    return markdown(["method", "unfiltered", "filtered"],
                    [[f"`{r['method']}`", *(number(x) for x in r["rms_excess"])]
                     for r in report["stability"]["methods"]])


def statements_table(report: dict[str, Any]) -> str:
    return markdown(["paper", "statement", "here", "measured"],
                    [[s["paper"], s["statement"], s["verdict"], s["measured"]]
                     for s in report["statements"]])


def closed_forms_table(report: dict[str, Any]) -> str:
    return markdown(["method", "closed form", "order", "promised", "RMS error at most work",
                     "mean", "largest"],
                    [[f"`{r['method']}`", r["closed_form"],
                      number(r["steps_order"] or r["work"]["order"], 2),
                      number(r["promised_order"], 1),
                      number(list(r["reached_rmse"].values())[-1], 4),
                      number(r["reached_mean"], 4, sign=True), number(r["reached_largest"], 4)]
                     for r in report["closed_forms"]["methods"]])


def reference_table(report: dict[str, Any]) -> str:
    return markdown(["integral", "rays", "mean error", "RMS error", "claimed"],
                    [[name, f"{rows[-1]['rays']:.0f}", number(rows[-1]["mean"], 4, sign=True),
                      number(rows[-1]["rms"], 4), number(rows[-1]["claimed"], 4)]
                     for name, rows in report["closed_forms"]["reference"].items()])


def layers_table(report: dict[str, Any]) -> str:
    """One layer and two of those methods that take further layers."""
    rows = {(r["view"], r["method"]): r for r in report["missing"]}
    views = list(dict.fromkeys(view for view, _ in rows))
    methods = list(dict.fromkeys(method for _, method in rows))
    return markdown(["view", *(f"`{m}`" for m in methods)],
                    [[view, *(f"{number(rows[view, m]['rmse_one_layer'])}, "
                              f"{number(rows[view, m]['rmse_two_layers'])}" for m in methods)]
                     for view in views])


def parts_table(report: dict[str, Any]) -> str:
    """What the errors of one layer are made of."""
    keys = ("rmse_one_layer", "converged", "missing_data", "estimator", "sampling",
            "sampling_filtered", "blur")
    return markdown(["view", "method", "total", "converged", "missing data", "estimator",
                     "sampling", "left by the filter", "blur"],
                    [[r["view"], f"`{r['method']}`", *(number(r[k]) for k in keys)]
                     for r in report["missing"]
                     if r["missing_data"] is not None
                     and r["method"] in ("bitmask", "gtao", "hsao", "hbao")])


def filters_parts(report: dict[str, Any]) -> dict[str, dict[str, str]]:
    return {"methods.md": {"filters-made-by": made_by(report),
                           "filters-compared": markdown(filters.HEADS,
                                                        report["filters"]["compared"]),
                           "filters-flicker": markdown(filters.VARIANT_HEADS,
                                                       report["filters"]["variants"])}}


def bent_parts(report: dict[str, Any]) -> dict[str, dict[str, str]]:
    return {"methods.md": {"bent-made-by": made_by(report),
                           "bent-light": markdown(bent.HEADS, report["bent"])}}


def courtyard_parts(report: dict[str, Any]) -> dict[str, dict[str, str]]:
    return {"methods.md": {"courtyard-made-by": made_by(report),
                           "courtyard-methods": methods_table(report),
                           "courtyard-stability": stability_table(report)},
            "papers.md": {"statements-made-by": made_by(report),
                          "statements": statements_table(report),
                          "closed-forms": closed_forms_table(report)},
            "reference.md": {"reference-closed-forms": reference_table(report)}}


def meshes_parts(report: dict[str, Any]) -> dict[str, dict[str, str]]:
    return {"methods.md": {"meshes-made-by": made_by(report),
                           "meshes-layers": layers_table(report),
                           "meshes-parts": parts_table(report)}}


def gpu_parts(s: Study, device: str) -> dict[str, dict[str, str]]:
    """Steps of plans by the device's own clock."""
    listing = s.tool.ask("devices", ["--json"])
    answer = s.tool.ask("bench", [
        str(s.frame_path(s.main)), "--set", f"radius={s.main.radius:.9g}", "--device", device,
        "--method", "all", "--filter", "none,preset", "--depth-layout", "all", "--arithmetic",
        "all", "--repeats", "25", "--json"])
    rows = [[f"`{row['method']}`", f"`{row['filter']}`", row["depth_layout"], row["arithmetic"],
             step["name"], number(step["ms"], 3),
             number(1e-3 * row["width"] * row["height"] / step["ms"], 0)]
            for row in answer["rows"] for step in row["steps"] or []
            if step["name"] not in ("upload", "download")]
    name = next((d["name"] for d in listing["vulkan"] if d["device"] in (device, device + ":0")),
                device)
    return {"gpu.md": {
        "gpu-made-by": f"{name}, {s.main.width}x{s.main.height}, crevice {answer['version']}, "
                       f"{answer['compiler']}, {datetime.date.today().isoformat()}.",
        "gpu-steps": markdown(["method", "filter", "depth", "filter in", "step", "ms", "MPix/s"],
                              rows)}}


def shared_list() -> list[str]:
    path = Path(os.environ.get("CREVICE_SHARED", "")) / "scenes" / "cameras.json"
    return [str(path)] if path.is_file() else []


def write(pages: Path, parts: dict[str, dict[str, str]]) -> None:
    for name, texts in parts.items():
        rewrite(pages / name, texts)
        print(f"study: wrote {pages / name}", file=sys.stderr)


def performance_parts(s: Study) -> dict[str, dict[str, str]]:
    chosen = [v for v in s.views if v.name in ("sponza", "dragon")] or s.views[:1]
    wide = 108 if s.is_quick else performance.WIDE
    return {"performance.md": performance.all_parts(performance.Measured(s, chosen, wide))}


def report_of(folder: Path, words: list[str]) -> dict[str, Any]:
    """Runs the study; its numbers."""
    from .main import main  # the pages are a mode of the same program
    if main(words + ["-o", str(folder)]) != 0:
        raise ToolError("the study failed; see above")
    report: dict[str, Any] = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return report


def run(arguments: argparse.Namespace, make_study: Any, make_tool: Any) -> None:
    """make_study(folder, lists) gives the study of the views of the lists, make_tool(folder)
    the tool alone."""
    common = ["--tool", arguments.tool] if arguments.tool else []
    common += ["--quick"] if arguments.quick else []
    lists = arguments.views or shared_list()
    given = [word for path in lists for word in ("--views", path)] + arguments.models
    small = ["--size", "96x54", "--rays", "16"] if arguments.quick else []
    for part in arguments.docs:
        folder = arguments.output / part
        if part == "courtyard":
            write(arguments.pages, courtyard_parts(report_of(folder, common + small)))
        elif part == "filters":
            write(arguments.pages, filters_parts(report_of(
                folder, [*given, *filters.THIN, "--only", "filters", *common, *small])))
        elif part == "bent":
            write(arguments.pages, bent_parts(report_of(
                folder, [*given, "builtin:courtyard", "--only", "bent", *common,
                         *(small or ["--rays", "64"])])))
        elif part == "meshes":
            size = small or ["--size", "1280x720"]
            write(arguments.pages, meshes_parts(report_of(
                folder, [*given, "--only", "missing", *common, *size])))
        elif part == "frames":
            write(arguments.pages, {"methods.md": {
                "frames-rmse": frames.table(make_tool(folder), lists)}})
        else:
            s = make_study(folder, lists)
            write(arguments.pages, performance_parts(s) if part == "performance"
                  else gpu_parts(s, arguments.device if arguments.device != "cpu" else "vulkan"))
