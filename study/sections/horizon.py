# SPDX-License-Identifier: MIT
"""What the two papers on horizons share: the paper's settings, the truth, the shown part of
the picture, and depth layers (both papers) with the growing sphere (2008a, section 5)."""
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import images, stats
from ..measure import ONE_LAYER, Buffers, Study
from ..options import Options
from ..page import Claim, graded

# Shown at most: small enough to see single pixels in a grid of pictures.
SHOWN = (320, 180)
SCALE = 0.5  # the error that gets the darkest colours
LESS = 0.97  # 3 % of an error: what another seed may change


class Horizon:
    """One of the papers on the main view, its settings unfiltered."""

    def __init__(self, s: Study, method: str, results: str):
        self.s, self.view = s, s.main
        self.paper = s.options(method, "paper", filter="none")
        self.results: dict[str, Any] = s.page.results.setdefault(results, {})

    @property
    def truth(self) -> np.ndarray:
        return self.s.truth(self.view, self.paper.target)

    @property
    def window(self) -> tuple[slice, slice]:
        return images.busiest_window(self.truth, *SHOWN)

    def picture(self, options: Options, buffers: Buffers = ONE_LAYER) -> np.ndarray:
        return self.s.picture(self.view, options, buffers)

    def rmse(self, a: np.ndarray, b: np.ndarray | None = None) -> float:
        """Against another picture; without one, the truth."""
        return self.s.rmse(self.view, a, self.truth if b is None else b)

    def bias(self, picture: np.ndarray) -> float:
        return stats.bias(picture, self.truth, self.s.mask(self.view))

    def compare(self, options: Options, buffers: Buffers = ONE_LAYER) -> dict[str, Any]:
        """All that the tool says of a picture against the truth."""
        return self.s.compare(self.s.estimate(self.view, options, buffers),
                              self.s.reference(self.view, self.paper.target).path)

    def show(self, name: str, picture: np.ndarray, caption: str) -> dict[str, Any]:
        return self.s.page.picture(name, picture[self.window], caption)

    def show_error(self, name: str, picture: np.ndarray, caption: str) -> dict[str, Any]:
        at = self.window
        return self.s.page.picture(name, images.error_map(
            picture[at], self.truth[at], self.s.mask(self.view)[at], SCALE), caption)


@dataclass(frozen=True)
class Case:
    key: str
    name: str
    buffers: Buffers = ONE_LAYER
    settings: dict[str, Any] = field(default_factory=dict)


LAYERS = [Case("one_layer", "one layer"),
          Case("two_surfaces", "two layers of surfaces", Buffers(2, "surfaces")),
          Case("front_and_back", "a front and a back layer", Buffers(2, "solid")),
          Case("two_solids", "two pairs of front and back", Buffers(4, "solid"))]
# hbao has no growing sphere.
SPHERES = [Case("growing_sphere", "one layer, growing sphere", ONE_LAYER,
                {"growing_sphere": "on"}),
           Case("horizon_alone", "horizon alone", ONE_LAYER, {"normal_rays": 0}),
           Case("horizon_alone_growing_sphere", "horizon alone, growing sphere", ONE_LAYER,
                {"normal_rays": 0, "growing_sphere": "on"})]


@dataclass(frozen=True)
class Measured:
    rmse: float
    bias: float
    ssim: float
    dark: float
    bright: float


def layers(h: Horizon, options: Options, paper: str, statement: str) -> None:
    found: dict[str, Measured] = {}
    figures = []
    for case in LAYERS + (SPHERES if options.reads("growing_sphere") else []):
        chosen = options.set(**case.settings)
        picture, compared = h.picture(chosen, case.buffers), h.compare(chosen, case.buffers)
        dark, bright = stats.halves(picture, h.truth, h.s.mask(h.view))
        found[case.key] = Measured(compared["rmse"], compared["bias"], compared["ssim"] or 0.0,
                                   dark, bright)
        if case in LAYERS:
            figures.append(h.show_error(f"{options.method}-layers-{case.key}", picture,
                                        f"{options.method}: error, {case.name}"))
    h.s.page.grid(figures)
    write_layers(h, options, found)
    h.results["layers"] = {key: vars(m) for key, m in found.items()}
    h.s.page.claim(claim_layers(found, paper, statement))
    if "growing_sphere" in found:
        h.s.page.claim(claim_growing_sphere(found))


def write_layers(h: Horizon, options: Options, found: dict[str, Measured]) -> None:
    names = {case.key: case.name for case in LAYERS + SPHERES}
    words = " ".join(f"{k}={options.get(k)}" for k in ("directions", "steps", "normal_rays")
                     if options.reads(k))
    h.s.page.table(f"`{options.method}` with `{words}`, unfiltered, against ray tracing of the "
                   "whole scene. Too dark and too bright: the two halves of the mean absolute "
                   "error.",
                   ["buffers", "RMSE", "mean error", "SSIM", "too dark", "too bright"],
                   [[names[key], f"{m.rmse:.4f}", f"{m.bias:+.4f}", f"{m.ssim:.3f}",
                     f"{m.dark:.4f}", f"{m.bright:.4f}"] for key, m in found.items()])


def claim_layers(found: dict[str, Measured], paper: str, statement: str) -> Claim:
    base = found["one_layer"]
    helps = {key: found[key].rmse < LESS * base.rmse
             for key in ("front_and_back", "two_surfaces", "two_solids")}
    return Claim(
        paper, statement, graded(helps["front_and_back"], *helps.values()),
        f"RMSE {base.rmse:.4f} with one layer, {found['front_and_back'].rmse:.4f} with a front "
        f"and a back layer, {found['two_surfaces'].rmse:.4f} with two layers of surfaces, "
        f"{found['two_solids'].rmse:.4f} with two pairs.",
        "A pair of layers lets rays pass behind what has a back, but a solid behind the first "
        "one is still missing, and a mesh that is not closed has no back."
        if base.dark > base.bright else
        "The picture is too bright for the most part: occluders are missing rather than too "
        "thick. Backs add none; they only let rays pass that were blocked before.")


def claim_growing_sphere(found: dict[str, Measured]) -> Claim:
    alone, grown = found["horizon_alone"], found["horizon_alone_growing_sphere"]
    base, sphere = found["one_layer"], found["growing_sphere"]
    less = grown.dark < LESS * alone.dark
    better = grown.rmse < alone.rmse or sphere.rmse < base.rmse
    return Claim(
        "2008a, section 5",
        "Deflecting the horizon only towards occluders within a growing sphere is a remedy for "
        "overestimated occlusion at depth discontinuities.", graded(less and better, less),
        f"Horizon alone: too dark by {alone.dark:.4f} on average without and {grown.dark:.4f} "
        f"with the growing sphere; RMSE {alone.rmse:.4f} and {grown.rmse:.4f}. With normal rays: "
        f"too dark by {base.dark:.4f} and {sphere.dark:.4f}; RMSE {base.rmse:.4f} and "
        f"{sphere.rmse:.4f}.",
        "It does make the picture brighter, but it leaves out real occluders as well, and the "
        "error as a whole grows." if less else
        "Hardly any occluder lies outside the growing sphere here.")
