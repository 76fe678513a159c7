# SPDX-License-Identifier: MIT
"""What Dimitrov, Bavoil, Sainz 2008 state of horizon-split ambient occlusion."""
import math
from dataclasses import dataclass, field
from statistics import median
from typing import Any

import numpy as np

from .. import plots, stats
from ..measure import Study
from ..options import Options
from ..page import FAILS, HOLDS, NOT_MEASURED, Claim, graded
from . import Step
from .horizon import Horizon, layers

RAYS = (2, 4, 8, 16, 32)
LEVEL = 2  # index of the rays at which methods are compared
KINDS = {"alone": "hsao, horizon alone (Nn = 0)", "split": "hsao, Nn = 1",
         "spread": "ray marching, well-spread rays", "random": "ray marching, random rays"}
# Table 1: the paper's sizes as shares of its largest, widths of 640 to 1600.
SCALES = (0.4, 0.5, 0.64, 0.8, 1.0)
NORMAL_RAYS = (0, 1, 2, 4)
FACTORS = (0.25, 0.5, 1, 2, 4)
NUMBERS = {"directions": ("Nd, directions", (2, 4, 7, 14, 28)),
           "steps": ("Ns, steps", (3, 6, 12, 24, 48)),
           "normal_rays": ("Nn, normal rays", (0, 1, 2, 4, 8))}
FIGURE_11 = {"a": (6, 9, 0), "b": (8, 18, 0), "c": (8, 18, 1), "d": (18, 25, 2)}
# An error that the noise of neither picture explains.
OVER = 0.03


def steps(s: Study) -> list[Step]:
    h = Horizon(s, "hsao", "claims_hsao")
    curves = {kind: Curve() for kind in KINDS}
    return [Step("hsao: introduction", 0, lambda: introduce(h)),
            *(Step(f"hsao: {KINDS[k]}", 20 if k == "random" else 3,
                   lambda k=k, c=c: c.measure(h, k)) for k, c in curves.items()),
            Step("hsao: error over rays", 2, lambda: convergence(h, curves)),
            Step("hsao: time of the passes", 8, lambda: cost(h)),
            Step("hsao: radius", 4, lambda: radius(h)),
            Step("hsao: numbers", 5, lambda: numbers(h)),
            Step("hsao: from performance to quality", 3, lambda: sets(h)),
            Step("hsao: blur", 4, lambda: blur(h)),
            Step("hsao: what the horizon leaves out", 3, lambda: contributions(h)),
            Step("hsao: layers", 3, lambda: depth_layers(h))]


def introduce(h: Horizon) -> None:
    h.s.page.heading(2, "claims-hsao", "Horizon-split ambient occlusion, 2008")
    h.s.page.text("Dimitrov, Bavoil, Sainz: Horizon-Split Ambient Occlusion. What the paper "
                  f"states, measured on the view `{h.view.name}`, radius {h.view.radius:.3g}, at "
                  f"{h.view.width}x{h.view.height}; cosine weighting and linear falloff as in "
                  "the paper, one depth layer, unfiltered unless noted. Pictures show the part "
                  "of the view that varies most.")


def options_of(h: Horizon, kind: str, rays: int) -> Options:
    if kind in ("spread", "random"):
        settings = {"steps": h.paper.get("steps"), "thickness": h.paper.get("thickness"),
                    "falloff": h.paper.get("falloff")}
        return h.s.options("raymarch", "paper", filter="none", normal_rays=1, directions=rays,
                           **settings)
    return h.paper.set(normal_rays=0 if kind == "alone" else 1,
                       directions=rays // 2 if kind == "split" else rays)


@dataclass
class Curve:
    """Figure 12: errors of one kind over the rays."""
    truth: list[float] = field(default_factory=list)  # RMSE to ray tracing
    own: list[float] = field(default_factory=list)  # to what the kind itself converges to
    limit: float = 0.0  # RMSE of that to ray tracing
    shown: list[np.ndarray] = field(default_factory=list)
    greys: int = 0  # of 256 in use without a falloff

    def measure(self, h: Horizon, kind: str) -> None:
        limit = random_limit(h) if kind == "random" else h.picture(limit_of(h, kind))
        self.limit = h.rmse(limit)
        for rays in RAYS:
            self.shown.append(random_mean(h, rays) if kind == "random"
                              else h.picture(options_of(h, kind, rays)))
        self.truth = [h.rmse(p) for p in self.shown]
        self.own = [h.rmse(p, limit) for p in self.shown]
        if kind != "random":
            picture = h.picture(options_of(h, kind, RAYS[LEVEL]).set(falloff="none"))
            levels = (picture[h.s.mask(h.view)] * 255 + 0.5).astype(int)
            self.greys = len(np.unique(levels))

    @property
    def slope(self) -> float:
        return stats.slope(RAYS, self.own)

    def needs(self, level: float) -> float:
        """Rays for a distance from the own limit."""
        return stats.crossing(RAYS, self.own, level)


def limit_of(h: Horizon, kind: str) -> Options:
    """About eight times the most rays, over the same jitter of the steps, which is part of the
    method and which more rays do not average out."""
    o = options_of(h, kind, RAYS[-1])
    return o.set(directions=(4 if kind == "alone" else 1) * RAYS[-1],
                 normal_rays=0 if kind == "alone" else 8)


def one_random_ray(h: Horizon) -> Options:
    """Each ray's direction and jitter drawn anew: another seed for each ray. A tile whose edge
    is no power of two is shuffled anew by each seed."""
    return options_of(h, "random", 1).set(noise_size=63)


def random_mean(h: Horizon, rays: int) -> np.ndarray:
    return h.s.mean(h.view, one_random_ray(h), range(1, 1 + rays))


def random_limit(h: Horizon) -> np.ndarray:
    """Seeds other than those of the curve. Three times the most rays add a seventh to the last
    error, and hardly anything to the first ones."""
    many = (1 if h.s.is_quick else 3) * RAYS[-1]
    return h.s.mean(h.view, one_random_ray(h), range(1000, 1000 + many))


def convergence(h: Horizon, curves: dict[str, Curve]) -> None:
    page = h.s.page
    page.heading(3, "hsao-convergence", "Error over rays")
    page.text("A horizon ray and a marched ray take `steps=12` look-ups each, so rays stand for "
              "cost. Random rays are the mean of runs with one ray and another seed each; "
              "well-spread rays are those of `raymarch` as it is, with `normal_rays=1` and one "
              "direction for each ray.")
    x_title = "rays for each pixel: Nd (1 + Nn), of ray marching Nd Nn"
    first = curves["random"].own[0]
    guide = plots.Line("1/sqrt(rays)", RAYS, [first * math.sqrt(RAYS[0] / r) for r in RAYS],
                       is_guide=True)
    page.plot(plots.draw([plots.Line(KINDS[k], RAYS, c.own) for k, c in curves.items()] + [guide],
                         x_title, "RMS distance from own limit", log_x=True, log_y=True),
              "Figure 12 of 2008a as numbers: RMS distance from what the same method gives with "
              "several times as many rays as the last point. How well it is on the way to its "
              "own limit, whatever that limit is worth. Unfiltered, `steps=12`, linear falloff.")
    page.plot(plots.draw([plots.Line(KINDS[k], RAYS, c.truth) for k, c in curves.items()],
                         x_title, "RMSE to ray tracing", log_x=True),
              "The same runs against the ray-traced picture. If a line turns level, the rest is "
              "no longer a matter of rays: depth buffer, steps, and for the horizon alone what "
              "it leaves out.")
    page.claim(claim_fewer_rays(curves))
    page.claim(claim_horizon_rate(curves))
    page.claim(claim_greys({k: c.greys for k, c in curves.items()}))
    page.details("Pictures: 2, 8 and 32 rays, unfiltered")
    for kind in ("random", "spread", "split", "alone"):
        c = curves[kind]
        page.grid([h.show(f"hsao-rays-{kind}-{RAYS[i]}", c.shown[i],
                          f"{KINDS[kind]}: {RAYS[i]} rays, RMSE {c.truth[i]:.4f}")
                   for i in (0, 2, 4)])
    page.end_details()
    h.results["convergence"] = {"rays": RAYS} | {
        k: {"rmse_to_ray_traced": c.truth, "rmse_to_own_limit": c.own, "slope": c.slope,
            "limit_rmse_to_ray_traced": c.limit, "grey_levels": c.greys or None,
            "rays_for_equal_error": c.needs(curves["split"].own[LEVEL])}
        for k, c in curves.items()}


def count_of_rays(rays: float) -> str:
    if rays > RAYS[-1]:
        return f"more than {RAYS[-1]}"
    return f"{rays:.1f}" if rays > 0 else f"less than {RAYS[0]}"


def claim_fewer_rays(curves: dict[str, Curve]) -> Claim:
    level = curves["split"].own[LEVEL]
    needs = {k: curves[k].needs(level) for k in ("spread", "random")}
    # Errors over many thousand pixels repeat to a few percent; over the slopes here that is
    # 15 % in rays at most. Less than a quarter more is no difference.
    beats = {k: n > 1.25 * RAYS[LEVEL] for k, n in needs.items()}
    return Claim(
        "2008a, Figure 12", "Ray marching converges to a similar picture as horizon-split "
        "ambient occlusion, but needs more rays.",
        graded(all(beats.values()), beats["random"]),
        f"For the distance from its own limit that `hsao` has with {RAYS[LEVEL]} rays "
        f"({level:.4f}), ray marching needs {count_of_rays(needs['random'])} random rays, or "
        f"{count_of_rays(needs['spread'])} well-spread ones. Limits: RMSE "
        f"{curves['split'].limit:.4f} to ray tracing for hsao, {curves['spread'].limit:.4f} for "
        "ray marching.",
        "The paper compares with Monte Carlo rays, and against these it holds. `raymarch` "
        "spreads its rays evenly in azimuth and height, which helps it in both dimensions at "
        "once; `hsao` spends half of its rays on the horizon, and what is above the horizon "
        "hangs on a single ray for each direction." if beats["random"] else
        "What the normal rays find above the horizon varies as much here as what ray marching "
        "finds in the whole hemisphere, at twice the rays for each direction.")


def claim_horizon_rate(curves: dict[str, Curve]) -> Claim:
    slopes = {k: c.slope for k, c in curves.items()}
    # Over a factor of 16 in rays, 0.1 in the exponent is a third in error.
    holds = slopes["alone"] < min(slopes["spread"], slopes["random"]) - 0.1
    return Claim(
        "2008a, sections 1 and 5", "Horizon occlusion converges faster than marched rays, "
        "because what is below the horizon is integrated in closed form.",
        graded(holds, slopes["alone"] < slopes["random"] - 0.1),
        f"Distance from the own limit falls with rays^{slopes['alone']:.2f} for the horizon "
        f"alone, rays^{slopes['split']:.2f} for hsao with one normal ray, "
        f"rays^{slopes['spread']:.2f} for well-spread and rays^{slopes['random']:.2f} for random "
        f"marched rays. The horizon alone has its limit at an RMSE of "
        f"{curves['alone'].limit:.4f} to ray tracing, hsao with normal rays at "
        f"{curves['split'].limit:.4f}.",
        "Well-spread rays come near the rate that one dimension of closed form gains over "
        "random ones.")


def claim_greys(greys: dict[str, int]) -> Claim:
    return Claim(
        "2008a, section 6", "Fewer steps in the shades of grey than ray marching at a low number "
        "of rays.",
        # Twice the greys is an edge that can be seen.
        HOLDS if greys["split"] > 2 * greys["spread"] else FAILS,
        f"With {RAYS[LEVEL]} rays and falloff `none`, the unfiltered 8-bit picture has "
        f"{greys['alone']} greys for the horizon alone, {greys['split']} for hsao with Nn = 1 "
        f"and {greys['spread']} for ray marching.",
        "The horizon is cut off at so few heights here that it takes few values, too.")


@dataclass(frozen=True)
class Cost:
    """Table 1: ms of the passes at five sizes."""
    sizes: list[tuple[int, int]]
    horizon: list[float]
    normal: list[float]
    blur: list[float]
    over_rays: list[float]  # unfiltered, over NORMAL_RAYS
    spread: float  # of the rounds of a run: longest over shortest, less 1

    @property
    def megapixels(self) -> list[float]:
        return [1e-6 * w * h for w, h in self.sizes]

    @property
    def whole(self) -> list[float]:
        return [sum(parts) for parts in zip(self.horizon, self.normal, self.blur)]

    @property
    def growth(self) -> float:
        """Exponent of the whole time over the pixels."""
        return stats.slope(self.megapixels, self.whole) if min(self.whole) > 0 else math.nan

    @property
    def ratios(self) -> list[float]:
        return [a / b if b else math.inf for a, b in zip(self.horizon, self.normal)]

    @property
    def line(self) -> float:
        """Time that normal rays 3 and 4 add over that of 1 and 2."""
        zero, _, two, four = self.over_rays
        return (four - two) / (two - zero) if two != zero else math.inf

    @property
    def is_busy(self) -> bool:
        """If two runs of the same differ by half, differences of times mean nothing."""
        return self.spread > 0.5 or min(self.ratios) <= 0 or not 0 < self.line < math.inf


def measure_cost(h: Horizon) -> Cost:
    views = [h.view.resized(k) for k in SCALES]
    taken: dict[tuple[str, int], list[list[float]]] = {}
    for number in range(2 if h.s.is_quick else 4):
        for name, rays in (("none", 0), ("none", 1), ("gauss5", 0)):
            rows = h.s.bench(views, ["--method", "hsao", "--preset", "paper", "--filter", name,
                                     "--set", f"normal_rays={rays}", "--structure",
                                     "deinterleaved"], number)
            taken.setdefault((name, rays), []).append([row["ms"] for row in rows])
    medians = {key: [median(size) for size in zip(*rows)] for key, rows in taken.items()}
    horizon = medians["none", 0]
    return Cost([(v.width, v.height) for v in views], horizon, [b - a for a, b in zip(horizon, medians["none", 1])],
                [b - a for a, b in zip(horizon, medians["gauss5", 0])],
                h.s.times(h.view, [h.paper.set(normal_rays=n) for n in NORMAL_RAYS]),
                median(max(size) / min(size) - 1 for size in zip(*taken["none", 0])))


def cost(h: Horizon) -> None:
    c, page = measure_cost(h), h.s.page
    page.heading(3, "hsao-cost", "Time of the passes")
    page.table("Table 1 of 2008a, measured here: `directions=7 steps=12 normal_rays=1 "
               "filter=gauss5`. Horizon: the time with Nn = 0, unfiltered. Normal: what one "
               "normal ray adds. Blur: what the filter adds. Medians of runs taken in turns.",
               ["size", "pixels, 10^6", "horizon, ms", "normal, ms", "blur, ms", "all, ms",
                "horizon / normal"],
               [[f"{w}x{height}", f"{1e-6 * w * height:.3f}", f"{c.horizon[i]:.2f}",
                 f"{c.normal[i]:.2f}", f"{c.blur[i]:.2f}", f"{c.whole[i]:.2f}",
                 f"{c.ratios[i]:.2f}"] for i, (w, height) in enumerate(c.sizes)])
    # What the machine's moods make negative has no place on a logarithmic axis.
    lines = [plots.Line(name, c.megapixels, [max(v, math.nan) if v > 0 else math.nan for v in y])
             for name, y in (("horizon", c.horizon), ("normal rays, Nn = 1", c.normal),
                             ("blur", c.blur))]
    guide = [c.horizon[-1] * p / c.megapixels[-1] for p in c.megapixels]
    page.plot(plots.draw(lines + [plots.Line("proportional to pixels", c.megapixels, guide,
                                             is_guide=True)],
                         "pixels, millions", "time, ms", log_x=True, log_y=True),
              "Time of each pass over the pixels of the picture. The dashed line is proportional "
              "to the pixels.")
    for claim in (claim_one_ray(c), claim_growth(c), claim_rays(c)):
        page.claim(claim)
    h.results["cost"] = {"megapixels": c.megapixels, "horizon_ms": c.horizon,
                         "normal_ms": c.normal, "blur_ms": c.blur, "whole_ms": c.whole,
                         "normal_rays": NORMAL_RAYS, "normal_rays_ms": c.over_rays,
                         "horizon_over_normal": median(c.ratios), "rays_3_4_over_1_2": c.line,
                         "growth_exponent": c.growth,
                         "spread": c.spread}


def number(value: float) -> str:
    return f"{value:.2f}" if math.isfinite(value) else "(unknown)"


def timed(c: Cost, what: str) -> str:
    """What was measured, and whether it can be relied on."""
    busy = ": something else kept the machine busy, nothing is concluded" if c.is_busy else ""
    return f"{what} Runs of the same differed by {100 * c.spread:.0f} % between rounds{busy}."


def claim_one_ray(c: Cost) -> Claim:
    ratio = median(c.ratios)
    # The paper calls up to 1.53 almost the same; so do we, both ways.
    verdict = graded(1 / 1.53 < ratio < 1.53, 0.4 < ratio < 2.5)
    return Claim(
        "2008a, Table 1", "The horizon costs about as much as one normal ray for each direction.",
        NOT_MEASURED if c.is_busy else verdict,
        timed(c, f"Horizon over one normal ray: {ratio:.2f}, the median of five sizes "
                 f"({min(c.ratios):.2f} to {max(c.ratios):.2f}). In the paper's table: 1.06 to "
                 "1.53."),
        "A marched ray ends at the first thing that it hits, the horizon takes all its steps, "
        "and each step that deflects it takes two square roots." if ratio > 1 else
        "A normal ray costs a direction of its own here.")


def claim_growth(c: Cost) -> Claim:
    growth = c.growth
    # 0.15 is a factor of 1.3 over the table's span of 6.25 in pixels: noise of timings on a
    # busy machine.
    off = abs(growth - 1)
    return Claim(
        "2008a, Table 1", "The time grows in proportion to the pixels.",
        NOT_MEASURED if c.is_busy else graded(off < 0.15, off < 0.3),
        timed(c, f"Time of all passes grows with pixels^{number(growth)} from "
                 f"{c.sizes[0][0]}x{c.sizes[0][1]} to {c.sizes[-1][0]}x{c.sizes[-1][1]}. The "
                 "paper's own table: pixels^1.05 for horizon and normal rays together, from the "
                 "smallest to the largest size."),
        "At larger sizes the same radius spans more pixels, and the look-ups miss the caches."
        if growth > 1 else
        "Runs of a few milliseconds also pay for starting the threads and waiting for the last "
        "one, at small sizes more than for pixels.")


def claim_rays(c: Cost) -> Claim:
    # A third either way: differences of two times carry the noise of both.
    verdict = graded(0.75 < c.line < 1.33, 0.5 < c.line < 2)
    times = ", ".join(f"{t:.2f}" for t in c.over_rays)
    return Claim(
        "2008a, section 5", "Normal occlusion costs in proportion to the normal rays.",
        NOT_MEASURED if c.is_busy else verdict,
        timed(c, f"With 0, 1, 2 and 4 normal rays: {times} ms. The third and fourth add "
                 f"{number(c.line)} times what the first two add."),
        "Steep rays leave the scene at once or end at once; their share changes with the number "
        "of rays.")


def radius(h: Horizon) -> None:
    """Figure 6, at half the size: the many directions and steps are slow."""
    s, view = h.s, h.view.resized(0.5)
    mean, noise = [], []
    for factor in FACTORS:
        o = h.paper.set(radius=view.radius * factor)
        limit = s.picture(view, o.set(directions=32, steps=48, normal_rays=2))
        mean.append(float(limit[s.mask(view)].mean()))
        noise.append(s.rmse(view, s.picture(view, o), limit))
    radii = [view.radius * f for f in FACTORS]
    s.page.heading(3, "hsao-radius", "Effect of the radius")
    s.page.plot(plots.draw([plots.Line("mean occlusion, converged", radii, [1 - m for m in mean]),
                            plots.Line("noise of 7 directions, 12 steps, 1 normal ray", radii,
                                       noise)],
                           "radius, scene units", "occlusion; RMS distance", log_x=True,
                           from_zero=True),
                "Figure 6 of 2008a as numbers. Mean occlusion 1 - A of the view, and the RMS "
                "distance of `directions=7 steps=12 normal_rays=1` from `directions=32 steps=48 "
                "normal_rays=2`, unfiltered, at half the size.")
    s.page.claim(claim_radius(mean, noise))
    s.page.grid([h.show(f"hsao-radius-{i}", h.picture(
        h.paper.set(radius=r, filter="gauss5")),
        f"radius {r:.3g} ({FACTORS[i]:g} times the view's), gauss5")
        for i, r in enumerate(radii)])
    h.results["radius"] = {"factors": FACTORS, "mean_accessibility": mean, "noise": noise}


def claim_radius(mean: list[float], noise: list[float]) -> Claim:
    darker = all(b < a for a, b in zip(mean, mean[1:]))
    # A quarter more noise is about half as many rays again at the rates of Figure 12.
    grows = noise[-1] > 1.25 * noise[0]
    return Claim(
        "2008a, Figure 6 and section 3.6", "A larger radius gives stronger occlusion, and needs "
        "more rays for the same quality.", graded(darker and grows, darker, grows),
        f"From a quarter of the radius to four times: mean occlusion from {1 - mean[0]:.3f} to "
        f"{1 - mean[-1]:.3f}, distance from many directions and steps from {noise[0]:.4f} to "
        f"{noise[-1]:.4f} at the same number of samples.",
        "The occluders of this view are large against the steps at every radius." if darker else
        "At the largest radius occluders lie beyond the guard band, where nothing is known.")


def numbers(h: Horizon) -> None:
    """Figure 7: what the numbers of directions, steps and normal rays do."""
    rmse: dict[str, list[float]] = {}
    bias: dict[str, list[float]] = {}
    samples: dict[str, list[float]] = {}
    for key, (_, values) in NUMBERS.items():
        options = [h.paper.set(**{key: value}) for value in values]
        pictures = [h.picture(o) for o in options]
        rmse[key] = [h.rmse(p) for p in pictures]
        bias[key] = [h.bias(p) for p in pictures]
        samples[key] = [o.samples for o in options]
    page, x_title = h.s.page, "look-ups in the buffers for each pixel"
    page.heading(3, "hsao-numbers", "Effect of Nd, Ns and Nn")
    for y, y_title, caption in (
            (rmse, "RMSE to ray tracing",
             "Each of the three numbers varied alone about `directions=7 steps=12 "
             "normal_rays=1` (Figures 7 and 11 of 2008a), over the look-ups it costs. "
             "Unfiltered, against ray tracing."),
            (bias, "mean error",
             "The same runs: mean signed error. Above 0 the picture is too bright.")):
        page.plot(plots.draw([plots.Line(NUMBERS[k][0], samples[k], y[k]) for k in NUMBERS],
                             x_title, y_title, log_x=True), caption)
    page.claim(claim_numbers(rmse))
    h.results["numbers"] = {k: {"values": NUMBERS[k][1], "rmse": rmse[k], "bias": bias[k]}
                            for k in NUMBERS}


def claim_numbers(rmse: dict[str, list[float]]) -> Claim:
    # 3 % is what another seed changes at most.
    helps = {k: v[-1] < 0.97 * v[0] for k, v in rmse.items()}
    ends = {k: f"from {v[0]:.4f} to {v[-1]:.4f}" for k, v in rmse.items()}
    return Claim(
        "2008a, Figure 7 and section 3.6", "More directions, more steps and more normal rays "
        "each give a better picture.", graded(all(helps.values()), *helps.values()),
        f"RMSE {ends['directions']} with 2 to 28 directions, {ends['steps']} with 3 to 48 steps, "
        f"{ends['normal_rays']} with 0 to 8 normal rays.",
        "What is left is not a matter of sampling: the depth buffer holds only the first "
        "surface." if helps["steps"] else
        "More steps also find more of the thin occluders, and take each of them for a wall "
        "without a back: the picture gets too dark faster than it gets finer.")


def set_of(h: Horizon, name: str, **settings: Any) -> Options:
    directions, steps_, rays = FIGURE_11[name]
    return h.paper.set(directions=directions, steps=steps_, normal_rays=rays, **settings)


def sets(h: Horizon) -> None:
    rows, figures = [], []
    found: dict[str, list[float]] = {"rmse": [], "rmse_gauss5": [], "bias": []}
    for name, counts in FIGURE_11.items():
        o = set_of(h, name)
        raw, blurred = h.picture(o), h.compare(o.set(filter="gauss5"))
        for key, value in (("rmse", h.rmse(raw)), ("rmse_gauss5", blurred["rmse"]),
                           ("bias", h.bias(raw))):
            found[key].append(value)
        rows.append([f"({name})", *map(str, counts), f"{o.samples:.0f}",
                     f"{found['rmse'][-1]:.4f}", f"{found['bias'][-1]:+.4f}",
                     f"{blurred['rmse']:.4f}", f"{blurred['ssim'] or 0:.3f}"])
        figures.append(h.show(f"hsao-figure-11{name}", h.picture(o.set(filter="gauss5")),
                              f"({name}) Nd {counts[0]}, Ns {counts[1]}, Nn {counts[2]}, gauss5: "
                              f"RMSE {blurred['rmse']:.4f}"))
    page = h.s.page
    page.heading(3, "hsao-sets", "From performance to quality")
    page.grid(figures + [h.show("hsao-figure-11e", h.truth, "(e) ray traced")])
    page.table("The sets of Figure 11 against ray tracing, linear falloff.",
               ["set", "Nd", "Ns", "Nn", "look-ups", "RMSE", "bias", "RMSE, gauss5",
                "SSIM, gauss5"], rows)
    page.claim(claim_sets(found["rmse_gauss5"]))
    h.results["figure_11"] = dict(found)


def claim_sets(blurred: list[float]) -> Claim:
    # 3 %: what another seed may change.
    normal, whole = blurred[2] < 0.97 * blurred[1], blurred[3] < 0.97 * blurred[0]
    return Claim(
        "2008a, Figure 11", "Normal occlusion improves the occlusion of near things, and the set "
        "for quality is nearer to ray tracing than the one for performance.",
        graded(normal and whole, normal, whole),
        f"A normal ray takes the RMSE from {blurred[1]:.4f} (b) to {blurred[2]:.4f} (c); from "
        f"performance (a) to quality (d) it goes from {blurred[0]:.4f} to {blurred[3]:.4f}.",
        "What the depth buffer does not hold outweighs what the further samples find.")


def blur(h: Horizon) -> None:
    """The blur's weights do not depend on the picture: the mean of blurred draws is the blurred
    mean."""
    draws = range(1, (7 if h.s.is_quick else 13))
    plain, soft = set_of(h, "c"), set_of(h, "c", filter="gauss5")
    mean, blurred_mean = (h.s.mean(h.view, o, draws) for o in (plain, soft))
    picture, blurred = h.picture(plain), h.picture(soft)
    noise, left = h.rmse(picture, mean), h.rmse(blurred, blurred_mean)
    detail = h.rmse(blurred_mean, mean)
    h.s.page.claim(claim_blur(noise, left, detail, h.rmse(picture), h.rmse(blurred), len(draws)))
    h.results["blur"] = {"noise": noise, "noise_gauss5": left, "detail_gauss5": detail}


def claim_blur(noise: float, left: float, detail: float, raw: float, blurred: float, draws: int
               ) -> Claim:
    # A third less noise can be seen; 3 % of error is what another seed may change.
    quieter, better = left < 0.67 * noise, blurred < 0.97 * raw
    return Claim(
        "2008a, section 4.1.3", "A 5x5 Gaussian weighted by depth reduces the noise and preserves "
        "what is sharp.", graded(quieter and better, quieter, better),
        f"Set (c): noise of {noise:.4f} without and {left:.4f} with `gauss5`, RMS distance from "
        f"the mean over {draws} draws. The blur changes the picture without noise by "
        f"{detail:.4f}. RMSE to ray tracing: {raw:.4f} without, {blurred:.4f} with it.",
        "The blur also spreads contact shadows a few pixels wide, where depth does not tell the "
        "surfaces apart: in creases. That takes back what less noise gains.")


def contributions(h: Horizon) -> None:
    """Figures 1 and 10: what the horizon leaves to the normal rays."""
    many = h.paper.set(directions=24, steps=24)
    whole, alone = h.picture(many.set(normal_rays=2)), h.picture(many.set(normal_rays=0))
    mask = h.s.mask(h.view)
    share = float((1 - alone[mask]).mean() / (1 - whole[mask]).mean())
    by = (h.truth - alone)[mask]
    over = by[by > OVER]
    page = h.s.page
    page.heading(3, "hsao-limits", "What the horizon leaves out")
    page.text("Figure 10 of 2008a on this view: `directions=24 steps=24`, with `normal_rays=0` "
              "and `normal_rays=2`.")
    page.grid([h.show("hsao-part-horizon", alone, "horizon occlusion"),
               h.show("hsao-part-normal", np.clip(1 - (alone - whole), 0, 1), "normal occlusion"),
               h.show("hsao-part-both", whole, "both"),
               h.show("hsao-part-truth", h.truth, "ray traced")])
    page.claim(claim_parts(share, (h.rmse(alone), h.bias(alone)), (h.rmse(whole), h.bias(whole))))
    page.claim(claim_bound(over.size / by.size, float(over.mean()) if over.size else 0.0))
    h.results.update(horizon_share=share, horizon_rmse=h.rmse(alone),
                     with_normal_rays_rmse=h.rmse(whole),
                     horizon_too_dark_share=over.size / by.size)


def claim_parts(share: float, alone: tuple[float, float], whole: tuple[float, float]) -> Claim:
    # Dominates: more than half. Can be left out: a tenth more error at most.
    dominates, spare = share > 0.5, alone[0] < 1.1 * whole[0]
    return Claim(
        "2008a, Figures 1 and 10", "The horizon term dominates, so that the normal rays can be "
        "left out.", graded(dominates and spare, dominates, spare),
        f"The horizon finds {100 * share:.0f} % of the occlusion that hsao finds with normal "
        f"rays on this view. Alone it has an RMSE of {alone[0]:.4f} and a mean error of "
        f"{alone[1]:+.4f}; with normal rays {whole[0]:.4f} and {whole[1]:+.4f}.",
        "The paper says it of single objects with relief. Here things stand on and over others, "
        "and reach into the hemisphere from above the horizon.")


def claim_bound(over: float, over_by: float) -> Claim:
    return Claim(
        "2008a, section 1", "Horizon occlusion is a lower bound of the occlusion.",
        # A percent of pixels lies on edges, where a pixel is two surfaces at once.
        graded(over < 0.01, over < 0.1),
        f"The horizon alone is darker than ray tracing by more than {OVER:.2f} at "
        f"{100 * over:.1f} % of the pixels, there by {over_by:.3f} on average.",
        "It is a bound for a height field without gaps. At depth discontinuities, which section "
        "5 of the paper concedes, everything below the horizon counts as blocked although there "
        "may be nothing behind a thin occluder.")


def depth_layers(h: Horizon) -> None:
    h.s.page.heading(3, "hsao-layers", "Depth discontinuities")
    layers(h, h.paper.set(directions=12), "2008a, section 5",
           "Two depth layers, fronts and backs, improve the accuracy.")
