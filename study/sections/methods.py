# SPDX-License-Identifier: MIT
"""Every method at every preset, each against the integral that it estimates."""
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import images, plots
from ..measure import Reference, Study
from ..options import PRESETS, Options
from ..page import Bold
from ..views import View
from . import Step

# The error that gets the darkest colours.
SCALE = 0.25

Key = tuple[str, str]  # method, preset


@dataclass(frozen=True)
class Record:
    options: Options
    path: Path
    reference: Reference
    compared: dict[str, Any]
    ms: float


def presets_of(s: Study, view: View) -> tuple[str, ...]:
    """The other views are there to see whether the main one is a special case: two presets
    do."""
    return PRESETS if view == s.main else ("medium", "high")


def steps(s: Study) -> list[Step]:
    views = [s.main] + [v for v in s.views if v != s.main]
    found: list[Step] = [Step("methods: introduction", 0, lambda: introduce(s))]
    for view in views:
        records: dict[Key, Record] = {}
        found += [Step(f"methods: {view.name}, {m}", 2 * len(presets_of(s, view)),
                       lambda v=view, m=m, r=records: measure(s, v, m, r))
                  for m in s.registry.methods]
        found.append(Step(f"methods: {view.name}, pictures", 2,
                          lambda v=view, r=records: write(s, v, r)))
    return found


def measure(s: Study, view: View, method: str, records: dict[Key, Record]) -> None:
    presets = presets_of(s, view)
    rows = s.bench([view], ["--method", method, "--preset", ",".join(presets), "--filter",
                            "preset"])
    times = {row["preset"]: row["ms"] for row in rows}
    for preset in presets:
        options = s.options(method, preset)
        reference = s.reference(view, options.target)
        path = s.estimate(view, options)
        records[method, preset] = Record(options, path, reference,
                                         s.compare(path, reference.path), times[preset])


def introduce(s: Study) -> None:
    s.page.heading(2, "methods", "Methods and presets")
    s.page.text(
        "Every method estimates an integral of its own, by its weighting of the hemisphere and "
        "its falloff, and is held to that: a low error means that the method computes what it "
        "says, not that it looks like the others. `vo` and `ssao` have no integral of this kind; "
        "they are held to the nearest, uniform weighting with cubic and with no falloff.")
    s.page.text(
        "Time is that of a whole picture, filter included, by `crevice bench`: the median of "
        "several runs. Samples are look-ups in the buffers for each pixel, at most. In the error "
        f"maps white is right, blue too dark, orange too bright; the darkest colours stand for "
        f"{SCALE:.2f} and more. On views other than {s.main.name} the presets `low`, `ultra` and "
        "`paper` are left out to save time.")


def write(s: Study, view: View, records: dict[Key, Record]) -> None:
    s.page.heading(3, f"methods-{view.name}", view.name)
    write_plot(s, view, records)
    write_table(s, records)
    write_pictures(s, view, records)
    s.page.results.setdefault("methods", []).extend(
        {"view": view.name, "method": method, "preset": preset, "target": r.options.target.name,
         "samples": r.options.samples, "ms": r.ms}
        | {k: r.compared[k] for k in ("rmse", "mae", "bias", "error_q01", "error_q99", "ssim",
                                      "flip", "fit_power", "fit_power_rmse", "fit_intensity",
                                      "fit_intensity_rmse")}
        for (method, preset), r in records.items())


def write_plot(s: Study, view: View, records: dict[Key, Record]) -> None:
    """Without the paper's numbers, which are no step of the ladder from low to ultra."""
    lines = []
    for method in s.registry.methods:
        row = [(p, records[method, p]) for p in presets_of(s, view) if p != "paper"]
        lines.append(plots.Line(method, [r.ms for _, r in row],
                                [r.compared["rmse"] for _, r in row], [p for p, _ in row]))
    first, last = ("low", "ultra") if view == s.main else ("medium", "high")
    s.page.plot(plots.draw(lines, "time of a picture, ms", "RMSE", log_x=True, log_y=True,
                           front=True),
                f"{view.name}: error over time, from `{first}` to `{last}`, each method against "
                "its own integral: lower left is better, but equal heights are equal errors of "
                "different integrals. Default filter of each preset, one layer. The dotted line "
                "joins what nothing else beats in both.")


def write_table(s: Study, records: dict[Key, Record]) -> None:
    best = {p: min(r.compared["rmse"] for (_, q), r in records.items() if q == p)
            for _, p in records}
    rows: list[list[Any]] = []
    for (method, preset), r in records.items():
        c = r.compared
        rmse = f"{c['rmse']:.4f}"
        ssim = "-" if c["ssim"] is None else f"{c['ssim']:.4f}"
        rows.append([method, preset, r.options.target.name, f"{r.options.samples:.0f}",
                     f"{r.ms:.2f}", Bold(rmse) if c["rmse"] <= best[preset] else rmse,
                     f"{c['mae']:.4f}", f"{c['bias']:+.4f}", ssim, f"{c['flip']:.4f}",
                     f"{c['fit_power_rmse']:.4f} ({c['fit_power']:.2f})",
                     f"{c['fit_intensity_rmse']:.4f} ({c['fit_intensity']:.2f})"])
    s.page.table(
        "Errors against each method's own integral; in bold the lowest RMSE of each preset. Bias: "
        "mean of estimate minus truth. Best power and best intensity: the RMSE that is left when "
        "the result's strength is adjusted by that alone, and in brackets its value.",
        ["Method", "Preset", "Integral", "Samples", "Time, ms", "RMSE", "MAE", "Bias", "SSIM",
         "FLIP", "Best power", "Best intensity"], rows)


def write_pictures(s: Study, view: View, records: dict[Key, Record]) -> None:
    truths = {r.options.target.name: r.reference for r in records.values()}
    s.page.details("Pictures: what is aimed at")
    s.page.grid([s.page.picture(f"{view.name}-truth-{name}", truth.picture,
                                f"Ray-traced: {name}") for name, truth in truths.items()])
    s.page.end_details()
    for preset in presets_of(s, view):
        # One wall of the main view is in plain sight.
        is_open = view == s.main and preset == "high"
        s.page.details(f"Pictures: all methods at `{preset}`", is_open)
        s.page.grid([figure for (method, p), r in records.items() if p == preset
                     for figure in pair(s, view, method, preset, r)], pairs=True)
        s.page.end_details()


def pair(s: Study, view: View, method: str, preset: str, r: Record) -> list[dict[str, Any]]:
    picture = images.read_single(r.path)
    error = images.error_map(picture, r.reference.picture, s.mask(view), SCALE)
    name = f"{view.name}-{method}-{preset}"
    return [s.page.picture(name, picture, f"{method} {preset}: {r.options.samples:.0f} samples, "
                                          f"{r.ms:.1f} ms"),
            s.page.picture(name + "-error", error,
                           f"{method} {preset}: error against {r.options.target.name}, RMSE "
                           f"{r.compared['rmse']:.4f}")]
