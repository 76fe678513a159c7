# SPDX-License-Identifier: MIT
"""What Szirmay-Kalos et al. 2010 state of volumetric ambient occlusion."""
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .. import images, plots, stats
from ..measure import Fit, Study
from ..options import Options, Target
from ..page import Claim, counted, graded
from ..stats import clearly_below
from ..views import View
from . import Step, relief

METHODS = ("ssao", "containment", "vao")
CUBIC = Target("cosine", "cubic")
COUNTS = (4, 8, 16, 32, 64, 128)
EIGHT = COUNTS.index(8)
TILTS = (0, 30, 60)


def steps(s: Study) -> list[Step]:
    json: dict[str, Any] = s.page.results.setdefault("vao", {})
    sweeps = {method: Sweep(method) for method in ("containment", "vao")}
    return [Step("vao: introduction", 0, lambda: introduce(s)),
            Step("vao: against ray tracing", 10, lambda: figure_8(s, json)),
            Step("vao: walls", 1, lambda: walls(s, json)),
            *(Step(f"vao: {m} over samples", 8, lambda w=w: w.measure(s))
              for m, w in sweeps.items()),
            Step("vao: samples and interleaving", 1, lambda: samples(s, sweeps, json)),
            Step("vao: normaliser", 2, lambda: normaliser(s, json)),
            Step("vao: eight samples", 3, lambda: figure_11(s, json)),
            *relief.steps(s, json)]


def introduce(s: Study) -> None:
    s.page.heading(2, "vao", "Szirmay-Kalos et al. 2010: volumetric AO")
    s.page.text(f"Measured on the view {s.main.name} at {s.main.width}x{s.main.height} with R = "
                f"{s.main.radius:.3g}. `containment` has the falloff cubic unless said otherwise: "
                "if a ray meets at most one surface within R, its integral is then that of "
                "`vao`. It is the paper's here, `steps=1 thickness=0`; by default it tests "
                "points on the way as well.")


def cubic(s: Study, method: str, count: int, **settings: Any) -> Options:
    """The paper's way, unfiltered."""
    return s.options(method, filter="none", noise_size=4, samples=count, falloff="cubic",
                     steps=1, thickness=0).set(**settings)


# Figure 8: 32 samples, two neighbourhoods.

@dataclass(frozen=True)
class Neighbourhood:
    view: View
    fit: dict[str, Fit]
    ms: dict[str, float]
    open_mean: dict[str, float]  # of accessibility where the truth is open
    open_pixels: int


def neighbourhood(s: Study, view: View, ms: dict[str, float]) -> Neighbourhood:
    truth = s.reference(view, CUBIC)
    is_open = s.mask(view) & (truth.picture > 0.995)
    options = {m: cubic(s, m, 32, filter="box4") for m in METHODS}
    means = {m: float(s.picture(view, o)[is_open].mean()) if is_open.any() else math.nan
             for m, o in options.items()}
    return Neighbourhood(view, {m: s.fit(view, o, truth) for m, o in options.items()}, ms, means,
                         int(is_open.sum()))


def figure_8(s: Study, json: dict[str, Any]) -> None:
    views = [s.main, s.main.with_radius(3 * s.main.radius)]
    cases = [(view, m) for view in views for m in METHODS]
    times = s.times(s.main, [cubic(s, m, 32, filter="box4", radius=v.radius) for v, m in cases])
    both = [neighbourhood(s, view, {m: t for (v, m), t in zip(cases, times) if v == view})
            for view in views]
    page = s.page
    page.heading(3, "vao-quality", "Against ray tracing")
    page.table("32 samples, interleaved over 4x4 pixels, against the ray-traced truth: cosine "
               "weighting, falloff cubic. Fitted: with the best intensity and contrast.",
               ["R", "method", "RMSE", "fitted", "bias", "SSIM", "time, ms"],
               [[f"{n.view.radius:.3g}", m, f"{n.fit[m].rmse:.4f}", f"{n.fit[m].both_rmse:.4f}",
                 f"{n.fit[m].bias:+.4f}", f"{n.fit[m].ssim or 0:.3f}", f"{n.ms[m]:.2f}"]
                for n in both for m in METHODS])
    figures = []
    for n, size in zip(both, ("small", "large")):
        r = f"R = {n.view.radius:.3g}"
        figures += [page.picture(f"vao-{m}-32-{size}",
                                 s.picture(n.view, cubic(s, m, 32, filter="box4")),
                                 f"{m}, 32 samples, {r}") for m in METHODS]
        figures.append(page.picture(f"vao-truth-{size}", s.truth(n.view, CUBIC),
                                    f"ray-traced, {r}"))
    page.grid(figures)
    page.claim(claim_quality(both))
    page.claim(claim_speed(both[0]))
    page.claim(claim_large(both))
    n = both[0]
    if n.open_pixels:
        page.text(f"On the {n.open_pixels} open pixels (truth above 0.995) of the smaller "
                  "neighbourhood the mean is "
                  + ", ".join(f"{n.open_mean[m]:.3f} for `{m}`" for m in METHODS) + ".")
    for n, size in zip(both, ("small_radius", "large_radius")):
        json[size] = {m: {"rmse": n.fit[m].rmse, "fitted_rmse": n.fit[m].both_rmse,
                          "bias": n.fit[m].bias, "ms": n.ms[m], "mean_of_open": n.open_mean[m]}
                      for m in METHODS}


def claim_quality(both: list[Neighbourhood]) -> Claim:
    wins = sum(clearly_below(n.fit["vao"].rmse, min(n.fit[m].rmse for m in METHODS[:2]))
               for n in both)
    small, large = (", ".join(f"{n.fit[m].rmse:.4f}" for m in METHODS) for n in both)
    fits = both[1].fit
    return Claim(
        "2010, Figure 8", "Of SSAO, containment tests and volumetric AO at 32 samples the "
        "volumetric is the closest to ray tracing.", counted(wins, 2),
        f"RMSE of ssao, containment and vao at R = {both[0].view.radius:.3g}: {small}; at R = "
        f"{both[1].view.radius:.3g}: {large}.",
        "The depth buffer misses much of what a large neighbourhood holds, so that the others "
        "are too bright; ssao is grey everywhere, and grey is near such a truth by accident."
        if fits["ssao"].rmse < fits["vao"].rmse else
        "Filtered, containment and vao are near their limits, and these differ if a ray meets "
        "more than one surface within R: the tangent sphere then counts other points than the "
        "rays do.")


def claim_speed(n: Neighbourhood) -> Claim:
    wins = sum(n.ms[m] < 0.97 * n.ms["ssao"] for m in ("containment", "vao"))
    return Claim(
        "2010, Figure 8", "Containment tests and volumetric AO are faster than SSAO.",
        counted(wins, 2),
        f"At R = {n.view.radius:.3g} ssao takes {n.ms['ssao']:.2f} ms, containment "
        f"{n.ms['containment']:.2f} ms, vao {n.ms['vao']:.2f} ms.",
        "On a GPU of 2007 the look-up took most of the time. Here arithmetic does, and a pipe, "
        "which is cut with a sphere, costs more of it than a point.")


def claim_large(both: list[Neighbourhood]) -> Claim:
    growth = {m: both[1].ms[m] / both[0].ms[m] for m in METHODS}
    # Less may be the machine's noise.
    slowed = sum(g > 1.1 for g in growth.values())
    return Claim(
        "2010, Figure 8", "The speed of all three suffers from a large neighbourhood, whose "
        "look-ups miss the cache.", counted(slowed, len(METHODS)),
        f"With three times the radius ssao takes {growth['ssao']:.2f} times as long, containment "
        f"{growth['containment']:.2f}, vao {growth['vao']:.2f}.",
        "The caches of a CPU hold many more rows of the depth buffer than those of a GPU of "
        "2007.")


# Figure 8: walls.

def make_wall(folder: Path, tilt: float) -> tuple[Path, float]:
    """A plane turned about the x axis, orthographic, and the height of its view."""
    size, height = 96, 2.0
    y = -((np.arange(size) + 0.5) / size - 0.5) * height
    flat = np.ones((size, size))
    path = folder / f"wall-{tilt}.exr"
    turn = math.radians(tilt)
    images.write_exr(path, {"Z": (10 + y * math.tan(turn))[:, None] * flat, "N.X": 0 * flat,
                            "N.Y": math.sin(turn) * flat, "N.Z": math.cos(turn) * flat})
    return path, height


def wall_mean(s: Study, method: str, tilt: float) -> float:
    """Away from the border, beyond which nothing occludes."""
    path, height = make_wall(s.tool.folder, tilt)
    options = cubic(s, method, 64)
    made = s.tool.make("ao", [str(path), *options.flags(), "--radius", "0.2", "--ortho",
                              str(height), "--normal-space", "view"])
    return float(images.read_single(made)[24:-24, 24:-24].mean())


def walls(s: Study, json: dict[str, Any]) -> None:
    mean = {m: [wall_mean(s, m, tilt) for tilt in TILTS] for m in METHODS}
    s.page.claim(claim_walls(mean))
    json["walls"] = mean


def claim_walls(mean: dict[str, list[float]]) -> Claim:
    off = {m: max(abs(v - (0.5 if m == "ssao" else 1.0)) for v in values)
           for m, values in mean.items()}
    words = "; ".join(f"{m} " + ", ".join(f"{v:.4f}" for v in values)
                      for m, values in mean.items())
    # On a slope the depth buffer is a staircase, on which one point in a hundred is on the
    # wrong side.
    return Claim(
        "2010, Figure 8", "SSAO makes a flat open wall middle grey; the other two leave it "
        "white.", graded(max(off.values()) < 0.02, off["ssao"] < 0.05),
        f"A plane turned by 0, 30 and 60 degrees, 64 samples, unfiltered: {words}.",
        "A depth buffer holds a slope as a staircase, on which points near the surface fall on "
        "its wrong side.")


# Figure 9: samples and interleaving.

def draws_of(count: int) -> int:
    """Few samples depend on the draw; many cost more and depend less."""
    return 4 if count <= 16 else 2 if count <= 64 else 1


@dataclass
class Sweep:
    """RMS distance from the method's own limit: one sample set for all pixels, sixteen
    rotations of it in a tile, and these joined by the 4x4 box."""
    method: str
    same: list[float] = field(default_factory=list)
    tile: list[float] = field(default_factory=list)
    joined: list[float] = field(default_factory=list)
    joined_noise: list[float] = field(default_factory=list)  # from the limit in the same box
    truth: list[float] = field(default_factory=list)  # joined, to the ray-traced truth
    blur: float = 0.0  # what the box does to the limit
    ms: list[float] = field(default_factory=list)  # raw and joined, 8 samples

    def measure(self, s: Study) -> None:
        view, much = s.main, cubic(s, self.method, 8).much(512)
        limit, boxed = s.picture(view, much), s.picture(view, much.set(filter="box4"))
        truth = s.truth(view, CUBIC)
        self.blur = s.rmse(view, boxed, limit)
        for count in COUNTS:
            o, draws = cubic(s, self.method, count), draws_of(count)
            box = o.set(filter="box4")
            self.same.append(s.error(view, o.set(noise_size=1), limit, draws))
            self.tile.append(s.error(view, o, limit, draws))
            errors = s.errors(view, box, [limit, boxed, truth], draws)
            for row, error in zip((self.joined, self.joined_noise, self.truth), errors):
                row.append(error)
        eight = cubic(s, self.method, 8)
        self.ms = s.times(view, [eight, eight.set(filter="box4")])

    @property
    def gain(self) -> float:
        """By how much interleaving multiplies 8 samples."""
        return stats.crossing(COUNTS, self.same, self.joined_noise[EIGHT]) / COUNTS[EIGHT]


def samples(s: Study, sweeps: dict[str, Sweep], json: dict[str, Any]) -> None:
    c, w = sweeps["containment"], sweeps["vao"]
    s.page.heading(3, "vao-samples", "Samples and interleaving")
    lines = [plots.Line(sweep.method + words, COUNTS, y) for sweep in (c, w)
             for words, y in (("", sweep.same), (", interleaved", sweep.joined_noise),
                              (", and blur", sweep.joined))]
    bound = plots.Line("independent tests: 1/sqrt(4 n)", COUNTS,
                       [1 / math.sqrt(4 * n) for n in COUNTS], is_guide=True)
    x_title = "samples n for each pixel"
    s.page.plot(plots.draw(lines + [bound], x_title, "RMS error", log_x=True, log_y=True),
                "Noise over samples: RMS distance from each method's own limit at 512 samples. "
                "Interleaved: a 4x4 tile of rotations, then `box4`; otherwise one sample set for "
                "all pixels, and no filter.")
    s.page.plot(plots.draw([plots.Line(f"{x.method}, interleaved", COUNTS, x.truth)
                            for x in (c, w)], x_title, "RMS error", log_x=True, log_y=True),
                "Error over samples against the ray-traced truth, cosine weighting, falloff "
                "cubic. Where a curve is flat, more samples do not help.")
    s.page.grid([s.page.picture(
        f"vao-{m}-{'interleaved' if size == 4 else 'one-set'}",
        s.picture(s.main, cubic(s, m, 4, noise_size=size,
                                filter="box4" if size == 4 else "none")),
        f"{m}, 4 samples, {'interleaved over 4x4 pixels' if size == 4 else 'one set'}")
        for m in ("containment", "vao") for size in (1, 4)])
    for claim in (claim_smooth(c, w), claim_deviation(c, w), claim_interleaved(c, w)):
        s.page.claim(claim)
    for x in (c, w):
        json[x.method] = {"samples": COUNTS, "noise_one_set": x.same, "noise_tile": x.tile,
                          "noise_and_blur_interleaved": x.joined,
                          "noise_interleaved_without_blur": x.joined_noise,
                          "error_interleaved": x.truth, "interleaving_gain": x.gain,
                          "box_blur": x.blur, "ms_raw": x.ms[0], "ms_joined": x.ms[1]}


def claim_smooth(c: Sweep, w: Sweep) -> Claim:
    wins = sum(clearly_below(w.tile[i], c.tile[i]) for i in range(3))
    words = ", ".join(f"at {COUNTS[i]} samples {c.tile[i]:.4f} and {w.tile[i]:.4f}"
                      for i in range(3))
    return Claim(
        "2010, Figure 9", "At few samples volumetric AO is smoother than containment tests, as a "
        "pipe knows how much of it is open.", counted(wins, 3),
        f"RMS noise before the filter, containment against vao, {words}.",
        "Points spread well in three dimensions converge about as fast as pipes in two.")


def needed(sweep: Sweep, level: float) -> str:
    count = stats.crossing(COUNTS, sweep.tile, level)
    return f"more than {COUNTS[-1]}" if math.isinf(count) else f"{math.ceil(count)}"


def claim_deviation(c: Sweep, w: Sweep) -> Claim:
    bounds = [1 / math.sqrt(4 * n) for n in COUNTS]
    within = sum(t < b for t, b in zip(c.tile, bounds))
    chosen = (0, 2, 4)
    return Claim(
        "2010, containment tests", "The standard deviation stays below 1/sqrt(4 n); independent "
        "samples must be 2500 to be surely below 0.01.", counted(within, len(COUNTS)),
        f"RMS noise of containment at {', '.join(str(COUNTS[i]) for i in chosen)} samples: "
        f"{', '.join(f'{c.tile[i]:.4f}' for i in chosen)}; bounds "
        f"{', '.join(f'{bounds[i]:.4f}' for i in chosen)}. It falls as n to the power of "
        f"{stats.slope(COUNTS, c.tile):.2f}. Below 0.01 it comes with {needed(c, 0.01)} samples, "
        f"vao with {needed(w, 0.01)}.", "The sample sets are not independent.")


def name_gain(sweep: Sweep) -> str:
    if math.isinf(sweep.gain):
        return f"more than {COUNTS[-1] // COUNTS[EIGHT]}"
    return f"{sweep.gain:.1f}" if sweep.gain > 0 else f"less than {COUNTS[0] / COUNTS[EIGHT]:.1f}"


def claim_interleaved(c: Sweep, w: Sweep) -> Claim:
    least = min(c.gain, w.gain)
    mild = all(x.joined[EIGHT] < x.same[EIGHT] for x in (c, w))
    # 16 within the quarter by which single draws differ; mild is a blur that leaves a gain.
    return Claim(
        "2010, Figure 9", "Interleaving over 4x4 pixels multiplies the effective number of "
        "samples by 16 for the cost of a box filter, and blurs mildly.",
        graded(least >= 12 and mild, least >= 2),
        "In noise alone (against the limit through the same box) 8 samples, interleaved, are "
        f"worth {name_gain(c)} times as many of one set for containment ({c.same[EIGHT]:.4f} to "
        f"{c.joined_noise[EIGHT]:.4f}) and {name_gain(w)} times for vao ({w.same[EIGHT]:.4f} to "
        f"{w.joined_noise[EIGHT]:.4f}). The box blurs the limit by an RMS error of {c.blur:.4f} "
        f"and {w.blur:.4f}; with that the error is {c.joined[EIGHT]:.4f} and "
        f"{w.joined[EIGHT]:.4f}. Time with the box: {c.ms[1] / c.ms[0]:.2f} and "
        f"{w.ms[1] / w.ms[0]:.2f} of that without.",
        "Sixteen times holds for error that is independent from pixel to pixel. Well-spread sets "
        "converge faster than that by themselves, so that more of them gain more than averages "
        "do. And where the occlusion has detail of a few pixels the box takes more away than the "
        "noise was.")


# Figure 10: the normaliser.

def normaliser(s: Study, json: dict[str, Any]) -> None:
    counts = COUNTS[:4]
    limit = s.picture(s.main, cubic(s, "vao", 4).much(512))
    noise = {kind: [s.error(s.main, cubic(s, "vao", n, normaliser=kind), limit, draws_of(n))
                    for n in counts] for kind in ("analytic", "weighted")}
    s.page.plot(plots.draw([plots.Line(k, counts, v) for k, v in noise.items()],
                           "samples n for each pixel", "RMS error", log_x=True, log_y=True),
                "Noise of vao with both normalisers (`--normaliser`), 4x4 tile, unfiltered: RMS "
                "distance from 512 samples of the weighted one. What the analytic formula keeps "
                "is perspective: seen from the side of the picture a sphere is an ellipse, of "
                "which the pipes cover a circle, and each is shorter along the view axis than "
                "along its ray. The weighted one divides by what it covers.")
    s.page.claim(claim_normaliser(noise["weighted"], noise["analytic"]))
    json["normaliser"] = {"samples": counts} | noise


def claim_normaliser(weighted: list[float], analytic: list[float]) -> Claim:
    return Claim(
        "2010, Figure 10", "With four samples weighted importance sampling is far closer to the "
        "limit than the analytic formula.",
        graded(weighted[0] < 0.75 * analytic[0], clearly_below(weighted[0], analytic[0])),
        f"RMS noise at 4 samples: weighted {weighted[0]:.4f}, analytic {analytic[0]:.4f}; at 8: "
        f"{weighted[1]:.4f}, {analytic[1]:.4f}; at 32: {weighted[3]:.4f}, {analytic[3]:.4f}.",
        "The samples of a disk are spread so well that their chords add up to nearly the volume "
        "already.")


# Figure 11: eight samples; containment with the hard cutoff.

def figure_11(s: Study, json: dict[str, Any]) -> None:
    raw, joined, figures, chosen = {}, {}, [], []
    for method in METHODS:
        falloff = {"falloff": "none"} if method == "containment" else {}
        o = cubic(s, method, 8, filter="box4", **falloff)
        limit = s.picture(s.main, o.much(512))
        raw[method] = s.error(s.main, o.set(filter="none"), limit, 2)
        joined[method] = s.error(s.main, o, limit, 2)
        figures.append(s.page.picture(f"vao-{method}-8", s.picture(s.main, o),
                                      f"{method}, 8 samples, interleaved"))
        chosen.append(o)
    ms = dict(zip(METHODS, s.times(s.main, chosen)))
    s.page.heading(3, "vao-eight", "Eight samples")
    s.page.grid(figures)
    s.page.claim(claim_eight(raw, joined, ms))
    json["eight"] = {"noise": raw, "noise_interleaved": joined, "ms": ms}


def claim_eight(raw: dict[str, float], joined: dict[str, float], ms: dict[str, float]) -> Claim:
    def words(values: dict[str, float], digits: int = 4) -> str:
        return ", ".join(f"{values[m]:.{digits}f}" for m in METHODS)

    others = [raw["ssao"], raw["containment"]]
    return Claim(
        "2010, Figure 11", "At eight samples volumetric AO is smoother than SSAO and containment "
        "tests.", graded(clearly_below(raw["vao"], min(others)),
                         clearly_below(raw["vao"], max(others))),
        f"RMS noise of ssao, containment (falloff none) and vao: {words(raw)}; interleaved "
        f"{words(joined)}. Time {words(ms, 2)} ms.",
        "ssao spans half the range: its noise, like its picture, has half the contrast.")
