# SPDX-License-Identifier: MIT
"""The filters side by side: error, error at edges, flicker; and what `bitmask` flickers by."""
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import stats
from ..measure import Study
from ..options import Options
from ..views import View
from . import Step, stability

METHODS = ("hbao", "gtao", "bitmask")
EDGE_PX = 2  # so near to an edge is "at edges"

# Docs are measured on these, too: thin things beside each other are what filters disagree on.
THIN = ["builtin:courtyard", "builtin:bars", "builtin:blades", "builtin:leaves"]

# From hbao to bitmask, one change after the other.
VARIANTS: list[tuple[str, str, dict[str, Any]]] = [
    ("`hbao` 8x8", "hbao", {"directions": 8, "steps": 8}),
    ("`gtao` 8x8: another integral", "gtao", {"directions": 8, "steps": 8}),
    ("`gtao` 4x8: half the directions", "gtao", {"directions": 4, "steps": 8}),
    ("`bitmask` 8x8: finite thickness", "bitmask", {"directions": 8, "steps": 8}),
    ("`bitmask` 4x8", "bitmask", {"directions": 4, "steps": 8}),
    ("the same, `--thickness-rule run`", "bitmask",
     {"directions": 4, "steps": 8, "thickness_rule": "run"}),
    ("the same, `--thickness-rule constant --thickness 0.3`", "bitmask",
     {"directions": 4, "steps": 8, "thickness_rule": "constant", "thickness": 0.3}),
    ("`bitmask` 4x8, `--spacing equal`", "bitmask",
     {"directions": 4, "steps": 8, "spacing": "equal"}),
    ("`bitmask` 6x6", "bitmask", {"directions": 6, "steps": 6}),
    ("`bitmask` 6x6, `--spacing equal`", "bitmask",
     {"directions": 6, "steps": 6, "spacing": "equal"}),
    ("`bitmask` 8x4", "bitmask", {"directions": 8, "steps": 4}),
    ("`bitmask` 32x32: no noise", "bitmask", {"directions": 32, "steps": 32}),
    ("`hbao` 32x32: no noise", "hbao", {"directions": 32, "steps": 32})]
VARIANT_HEADS = ["variant", "RMSE", "flicker", "largest flicker over that of `hbao` 8x8"]


@dataclass(frozen=True)
class Row:
    view: str
    method: str
    filter: str
    rmse: float
    at_edges: float
    flicker: float  # RMS change of the error at steady points

    def over(self, other: "Row") -> tuple[float, float, float]:
        return (self.rmse / other.rmse, self.at_edges / other.at_edges,
                self.flicker / other.flicker)


@dataclass(frozen=True)
class Variant:
    view: str
    text: str
    rmse: float
    flicker: float


def steps(s: Study) -> list[Step]:
    rows: list[Row] = []
    variants: list[Variant] = []
    views = [s.main] if s.is_quick else s.views
    return [*(Step(f"filters: {v.name}", 12, lambda v=v: measure(s, v, rows, variants))
              for v in views if not v.is_ortho),
            Step("filters: tables", 0, lambda: write(s, rows, variants))]


def edges(s: Study, view: View) -> np.ndarray:
    """Pixels near one whose right or lower neighbour is not on the same surface."""
    look = stability.look_at(s, view)
    footprint = s.frame(view).channels["Z"].astype(np.float64) / view.focal_px()
    rows, columns = np.mgrid[0:view.height, 0:view.width]
    found = np.zeros((view.height, view.width), dtype=bool)
    for dx, dy in ((1, 0), (0, 1)):
        x, y = np.minimum(columns + dx, view.width - 1), np.minimum(rows + dy, view.height - 1)
        found |= look.is_surface & ~stability.same_surface(look, look, y * view.width + x,
                                                           footprint)
    wide = found.copy()
    for dy in range(-EDGE_PX, EDGE_PX + 1):
        for dx in range(-EDGE_PX, EDGE_PX + 1):
            wide |= np.roll(found, (dy, dx), axis=(0, 1))
    return wide & look.is_surface


def measure(s: Study, view: View, rows: list[Row], variants: list[Variant]) -> None:
    at_edges = edges(s, view)
    motion = stability.motion_of(s, view, 2)
    for method in METHODS:
        options = s.options(method)
        truth = s.truth(view, options.target)
        filtered = [(name, options.set(filter=name)) for name in ("none", *s.registry.filters)]
        s.prepare((v, chosen) for v in (view, *(look.view for look in motion.looks[:2]))
                  for _, chosen in filtered)
        for name, chosen in filtered:
            picture = s.picture(view, chosen)
            rows.append(Row(view.name, method, name, s.rmse(view, picture, truth),
                            stats.rmse(picture, truth, at_edges), flicker(s, motion, chosen)))
    varied = [(text, s.options(method, **settings)) for text, method, settings in VARIANTS]
    s.prepare((v, options) for v in (view, *(look.view for look in motion.looks[:2]))
              for _, options in varied)
    for text, options in varied:
        error = s.rmse(view, s.picture(view, options), s.truth(view, options.target))
        variants.append(Variant(view.name, text, error, flicker(s, motion, options)))


def flicker(s: Study, motion: stability.Motion, options: Options) -> float:
    truth = stability.truth_of(s, motion, options.target)
    pictures = [s.picture(look.view, options) for look in motion.looks[:2]]
    return stability.change_of_error(motion, truth, pictures)


def mean_of(rows: list[Row], method: str, name: str) -> Row:
    found = [r for r in rows if (r.method, r.filter) == (method, name)]
    return Row("mean", method, name, *(sum(getattr(r, k) for r in found) / len(found)
                                       for k in ("rmse", "at_edges", "flicker")))


def compared(s: Study, rows: list[Row]) -> list[list[str]]:
    """The default filter is the unit. Of each view, then of the means."""
    table = []
    for method in METHODS:
        unit = s.registry.default(method, "filter")
        for name in [n for n in dict.fromkeys(r.filter for r in rows) if n not in ("none", unit)]:
            views = list(dict.fromkeys(r.view for r in rows))
            at = {(r.view, r.filter): r for r in rows if r.method == method}
            ratios = [at[v, name].over(at[v, unit]) for v in views]
            mean = mean_of(rows, method, name).over(mean_of(rows, method, unit))
            worst = [max(range(len(views)), key=lambda i, k=k: ratios[i][k]) for k in range(3)]
            table.append([f"`{method}`", f"`{name}`", *(f"{x:.2f}" for x in mean),
                          *(f"{ratios[i][k]:.2f} ({views[i]})" for k, i in enumerate(worst))])
    return table


HEADS = ["method", "filter", "RMSE", "at edges", "flicker", "worst RMSE", "worst at edges",
         "worst flicker"]


def variant_rows(variants: list[Variant]) -> list[list[str]]:
    """Means over the views, and the view on which a variant flickers most beside the first."""
    unit = {v.view: v.flicker for v in variants if v.text == VARIANTS[0][0]}
    table = []
    for text, _, _ in VARIANTS:
        found = [v for v in variants if v.text == text]
        worst = max(found, key=lambda v: v.flicker / unit[v.view])
        table.append([text, f"{sum(v.rmse for v in found) / len(found):.3f}",
                      f"{sum(v.flicker for v in found) / len(found):.4f}",
                      f"{worst.flicker / unit[worst.view]:.2f} ({worst.view})"])
    return table


def write(s: Study, rows: list[Row], variants: list[Variant]) -> None:
    page = s.page
    page.heading(2, "filters", "Filters")
    if not rows:
        page.text("No view is in perspective; nothing was measured.")
        return
    page.text(f"Preset `medium` with every filter. At edges: pixels within {EDGE_PX} px of a "
              "neighbour on another surface. Flicker: RMS change of the error at steady points "
              "while the camera moves, as in the section on temporal stability, at half the "
              "size.")
    page.table("Each view.", ["View", "Method", "Filter", "RMSE", "RMSE at edges", "Flicker"],
               [[r.view, r.method, r.filter, f"{r.rmse:.4f}", f"{r.at_edges:.4f}",
                 f"{r.flicker:.4f}"] for r in rows])
    table = compared(s, rows)
    page.table("Over the default filter: of the means over the views, and of the worst view.",
               HEADS, table)
    found = variant_rows(variants)
    page.table("With the default filter, mean over the views: from `hbao` to `bitmask`, one "
               "change after the other, and what else was tried.", VARIANT_HEADS, found)
    page.results["filters"] = {
        "compared": table, "variants": found,
        "rows": [{"view": r.view, "method": r.method, "filter": r.filter, "rmse": r.rmse,
                  "rmse_at_edges": r.at_edges, "flicker": r.flicker} for r in rows]}
