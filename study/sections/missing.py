# SPDX-License-Identifier: MIT
"""What keeps each estimate from the truth. Between the ray-traced truth and the picture
stand, in this order: the data that the buffers do not hold, the estimator with all the
samples that it could want, the samples that it has, and the filter."""
from dataclasses import dataclass
from typing import Any

from .. import images
from ..measure import ONE_LAYER, Buffers, Study
from ..options import Options
from ..views import View
from . import Step

SCALE = 0.25  # the error that gets the darkest colours
TWO_LAYERS = Buffers(2, "surfaces")
FOUR_LAYERS, FOUR_SOLID = Buffers(4, "surfaces"), Buffers(4, "solid")

# What is measured, and with what its method is taken to have converged: more of what its
# error hangs on, without a filter.
SUBJECTS: dict[str, tuple[str, dict[str, int]]] = {
    "gtao": ("none", {"directions": 24, "steps": 48}),
    "bitmask": ("none", {"directions": 24, "steps": 48}),
    "hsao": ("none", {"directions": 16, "steps": 32, "normal_rays": 2}),
    "raymarch": ("none", {"directions": 16, "steps": 32, "normal_rays": 3}),
    "containment": ("none", {"samples": 96, "steps": 24}),
    "hbao": ("linear", {"directions": 24, "steps": 48})}

# Numbers of others, measured elsewhere: mean RMSE over six views at 1280x720, of the best of
# the widely used GPU implementations (32 to 54 samples, denoised).
PUBLISHED = [["cosine, none", "0.104"], ["uniform, linear", "0.088"]]

# Of the method that errs least: what more samples and more layers would gain.
BEST = "bitmask"
BOUNDS = {"some": ("64 samples", ONE_LAYER), "some_two": ("64 samples, two layers", TWO_LAYERS),
          "converged": ("Converged", ONE_LAYER), "converged_two": ("Two layers", TWO_LAYERS),
          "converged_four": ("Four", FOUR_LAYERS),
          "converged_solid": ("Four, fronts and backs", FOUR_SOLID)}

PARTS = {"converged": "Converged, no filter", "missing_data": "Missing data",
         "estimator": "Estimator", "sampling": "Sampling",
         "sampling_filtered": "Sampling left by the filter", "blur": "Blur of the filter"}


@dataclass
class Row:
    view: View
    options: Options
    one: float = 0.0
    two: float = 0.0
    guardless: float = 0.0
    parts: dict[str, float] | None = None


def steps(s: Study) -> list[Step]:
    rows: list[Row] = []
    figures: list[dict[str, Any]] = []
    bounds: dict[str, dict[str, float]] = {}
    found = [Step(f"missing data: {v.name}, {m}", 8 if v == s.main else 2,
                  lambda v=v, m=m: measure(s, v, m, rows, figures))
             for v in s.views for m in SUBJECTS if m in s.registry.methods]
    found += [Step(f"missing data: {v.name}, layers", 4,
                   lambda v=v: bounds.update({v.name: bound(s, v)}))
              for v in (s.views if BEST in s.registry.methods else [])
              if v == s.main or not s.is_quick]
    return found + [Step("missing data: tables", 0, lambda: write(s, rows, figures, bounds))]


def bound(s: Study, view: View) -> dict[str, float]:
    """RMSE of BOUNDS."""
    falloff, much = SUBJECTS[BEST]
    some = s.options(BEST, directions=8, steps=8, falloff=falloff)
    converged = some.set(**much, filter="none")
    truth = s.truth(view, some.target)
    return {key: s.rmse(view, s.picture(view, some if key.startswith("some") else converged,
                                        buffers), truth)
            for key, (_, buffers) in BOUNDS.items()}


def write_bounds(s: Study, bounds: dict[str, dict[str, float]]) -> None:
    means = {key: sum(b[key] for b in bounds.values()) / len(bounds) for key in BOUNDS}
    rows = bounds | {"mean": means}
    s.page.table(f"`{BEST}` without falloff, cosine weighting, RMSE against the whole scene: 8x8 "
                 "with the default filter, then without noise and filter. Backs tell the rule "
                 "what it guesses otherwise, where things have a back.",
                 ["View", *(title for title, _ in BOUNDS.values())],
                 [[name, *(f"{row[key]:.4f}" for key in BOUNDS)] for name, row in rows.items()])
    s.page.results["missing_bounds"] = [{"view": name} | row for name, row in rows.items()]


def measure(s: Study, view: View, method: str, rows: list[Row],
            figures: list[dict[str, Any]]) -> None:
    falloff, converged = SUBJECTS[method]
    row = Row(view, s.options(method, "high", falloff=falloff))
    truth = s.truth(view, row.options.target)
    one, two = (s.picture(view, row.options, b) for b in (ONE_LAYER, TWO_LAYERS))
    row.one, row.two = s.rmse(view, one, truth), s.rmse(view, two, truth)
    row.guardless = s.rmse(view, s.picture(view, row.options, Buffers(guard=0)), truth)
    rows.append(row)
    if view != s.main and s.is_quick:
        return
    row.parts = take_apart(s, row, converged)
    for layers, picture, error in ((1, one, row.one), (2, two, row.two)):
        figures.append(s.page.picture(
            f"missing-{view.name}-{method}-{layers}",
            images.error_map(picture, truth, s.mask(view), SCALE),
            f"{view.name}, {method}, {layers} layer{'s' * (layers > 1)}: error, RMSE "
            f"{error:.4f}"))


def take_apart(s: Study, row: Row, converged: dict[str, int]) -> dict[str, float]:
    view, options = row.view, row.options
    truth = s.truth(view, options.target)
    visible = s.reference(view, options.target, "visible").picture
    much = options.set(**converged)
    picture, plain = s.picture(view, options), s.picture(view, options.set(filter="none"))
    limit, filtered = s.picture(view, much.set(filter="none")), s.picture(view, much)
    return {"converged": s.rmse(view, limit, truth),
            "missing_data": s.rmse(view, visible, truth),
            "estimator": s.rmse(view, limit, visible),
            "sampling": s.rmse(view, plain, limit),
            "sampling_filtered": s.rmse(view, picture, filtered),
            "blur": s.rmse(view, filtered, limit)}


def write(s: Study, rows: list[Row], figures: list[dict[str, Any]],
          bounds: dict[str, dict[str, float]]) -> None:
    page = s.page
    page.heading(2, "missing", "What the errors are made of")
    page.text("`gtao`, `bitmask`, `hsao`, `raymarch` and `containment` without falloff (cosine "
              "weighting) and `hbao` with linear falloff (uniform weighting), each at `high` with "
              "the default filter, against ray tracing of the whole scene. Two layers: the next "
              "surface behind the first as well (`--layers 2`). No guard band: nothing beyond the "
              "picture's border occludes (`--guard-px 0`).")
    page.table("RMSE at `high` with the default filter, against ray tracing of the whole scene, "
               "over all pixels with a surface.",
               ["View", "Method", "Integral", "One layer", "Two layers",
                "One layer, no guard band"],
               [[r.view.name, r.options.method, r.options.target.name, f"{r.one:.4f}",
                 f"{r.two:.4f}", f"{r.guardless:.4f}"] for r in rows])
    page.grid(figures, pairs=True)
    page.text("Missing data: ray tracing of what the buffer holds, silhouettes closed half a "
              "radius behind (`crevice reference --kind visible`), against ray tracing of the "
              "whole scene. It is an assumption about what is hidden, like any, and not a bound: "
              "if thin things stand before open space it is too dark, and an estimator that "
              "assumes less may be nearer to the truth. Estimator: the method with many more "
              "samples and no filter, against that. Sampling: the picture before the filter "
              "against the converged one; then what the filter leaves of it; then what the "
              "filter does to a picture that needs none. Errors of the steps may cancel, so that "
              "they do not add up to the total.")
    page.table("What the error is made of, one layer, RMS of each step.",
               ["View", "Method", "Total", *PARTS.values()],
               [[r.view.name, r.options.method, f"{r.one:.4f}",
                 *(f"{r.parts[k]:.4f}" for k in PARTS)] for r in rows if r.parts])
    for row in rows:
        if row.parts and row.view == s.main:
            page.text(sentence(row, row.parts))
    if bounds:
        write_bounds(s, bounds)
    page.table("Published implementations, measured elsewhere: the mean RMSE over six views at "
               "1280x720 of the best of the widely used GPU implementations, with 32 to 54 "
               "samples and their denoiser, against full-scene ray tracing. Not measured here, "
               "and not on the views of this page.", ["Integral", "RMSE"], PUBLISHED)
    page.results["missing"] = [
        {"view": r.view.name, "method": r.options.method, "target": r.options.target.name,
         "rmse_one_layer": r.one, "rmse_two_layers": r.two, "rmse_no_guard_band": r.guardless}
        | (r.parts or {k: None for k in PARTS}) for r in rows]


def sentence(row: Row, parts: dict[str, float]) -> str:
    """Where most of the error is left."""
    largest = max(("missing_data", "estimator", "sampling_filtered", "blur"),
                  key=lambda k: parts[k])
    what = {"missing_data": "what the depth buffer does not hold",
            "estimator": "the estimator itself: more samples do not help",
            "sampling_filtered": "noise that the filter leaves",
            "blur": "the filter's blur"}[largest]
    return (f"`{row.options.method}` on {row.view.name}: the largest step is {what} "
            f"({parts[largest]:.4f} of a total of {row.one:.4f}).")
