# SPDX-License-Identifier: MIT
"""Deinterleaved kernels, which may move samples a little, beside those that sample exactly
where the plain code does."""
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..measure import Study
from ..views import View
from . import Step

# How much larger the error may be for the deinterleaved structure to be the default.
MAY_EXCEED = 1.01


@dataclass(frozen=True)
class Row:
    view: str
    method: str
    filter: str
    rmse: tuple[float, float]  # deinterleaved, exact
    apart: float
    ms: tuple[float, float]

    @property
    def ratio(self) -> float:
        deinterleaved, exact = self.rmse
        return deinterleaved / exact if exact > 0 else math.inf if deinterleaved > 0 else 1.0

    @property
    def holds(self) -> bool:
        return self.ratio <= MAY_EXCEED


def steps(s: Study) -> list[Step]:
    rows: list[Row] = []
    figures: list[dict[str, Any]] = []
    views = [s.main] if s.is_quick else s.views
    found = [Step(f"deinterleaved and exact: {v.name}, {m}", 2,
                  lambda v=v, m=m: measure(s, v, m, rows, figures))
             for v in views for m in s.registry.methods]
    return found + [Step("deinterleaved and exact: table", 0, lambda: write(s, rows, figures))]


def measure(s: Study, view: View, method: str, rows: list[Row],
            figures: list[dict[str, Any]]) -> None:
    preset = s.options(method)
    unfiltered = preset.set(filter="none")
    if np.array_equal(s.picture(view, unfiltered), s.picture(view, unfiltered.set(exact=True))):
        return  # it has one structure
    truth = s.truth(view, preset.target)
    for name in ("none", preset.get("filter")):
        options = preset.set(filter=name)
        both = [s.picture(view, options), s.picture(view, options.set(exact=True))]
        errors = [s.rmse(view, picture, truth) for picture in both]
        times = {r["structure"]: r["ms"] for r in s.bench(
            [view], ["--method", method, "--filter", name, "--structure", "all"])}
        ms = (times["deinterleaved"], times["exact"])
        rows.append(Row(view.name, method, name, (errors[0], errors[1]),
                        s.rmse(view, *both), ms))
        if view == s.main and name == "none":
            for label, picture, error, time in zip(("deinterleaved", "exact"), both, errors, ms):
                figures.append(s.page.picture(
                    f"structure-{method}-{label}", picture,
                    f"{view.name}, {method}, no filter, {label}: RMSE {error:.4f}, "
                    f"{time:.2f} ms"))


def write(s: Study, rows: list[Row], figures: list[dict[str, Any]]) -> None:
    page = s.page
    page.heading(2, "structure", "Deinterleaved and exact sampling")
    page.text("By default kernels may move samples by a part of a pixel's footprint, so that "
              "pixels of one phase of the noise tile read side by side; `--exact` samples where "
              "the plain code does. Whether a sample counts is decided by its true distance in "
              "both, so they estimate the same integral. RMSE is against ray tracing of the "
              "whole scene.")
    found = dict.fromkeys(r.method for r in rows)
    rest = ", ".join(f"`{m}`" for m in s.registry.methods if m not in found)
    if rest:
        page.text(f"One structure only, the same picture with `--exact`: {rest}.")
    if not rows:
        return
    page.grid(figures, pairs=True)
    page.table("Preset `medium`, with its filter and without.",
               ["View", "Method", "Filter", "RMSE, deinterleaved", "RMSE, exact",
                "Excess", "Both apart", "Deinterleaved, ms", "Exact, ms", "Within 1 %"],
               [[r.view, r.method, r.filter, f"{r.rmse[0]:.4f}", f"{r.rmse[1]:.4f}",
                 f"{100 * (r.ratio - 1):+.2f} %", f"{r.apart:.4f}", f"{r.ms[0]:.2f}",
                 f"{r.ms[1]:.2f}", "yes" if r.holds else "no"] for r in rows])
    good, worst = sum(r.holds for r in rows), max(r.ratio for r in rows)
    page.text(f"The error of the deinterleaved structure is above that of the exact one by no "
              f"more than {100 * (MAY_EXCEED - 1):.0f} % in {good} of {len(rows)} cases; at worst "
              f"it is {100 * (worst - 1):+.2f} %.")
    page.results["structures"] = [
        {"view": r.view, "method": r.method, "filter": r.filter, "rmse_deinterleaved": r.rmse[0],
         "rmse_exact": r.rmse[1], "ratio": r.ratio, "rmse_apart": r.apart,
         "ms_deinterleaved": r.ms[0], "ms_exact": r.ms[1], "holds": r.holds} for r in rows]
