# SPDX-License-Identifier: MIT
"""Convergence to the closed forms of a groove of 90 degrees.

The groove is a height field, seen by an orthographic camera along its bisector: frames of it
are written here and given to `crevice ao`. Errors are over a strip of its floor, 0.1 to 1
radius off the wall; its pixels are single estimates."""
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .. import closed_forms, images, plots, stats
from ..measure import Study, side_by_side
from ..options import Options, Target
from . import Step

SIZES_PX = (16, 32, 64, 256)  # pixels a radius
ROWS = 4
DEPTH = 10.0  # of the groove's bottom, in radii
DRAWS = 2

# The horizon is found up to one step late, so the error of jittered equal steps falls like
# 1/Ns; independent samples have 1/sqrt(n). All pixels of a draw share one pattern of samples:
# an error is known to some 20 percent, an order over a factor of 8 to 64 to about 0.1.
ORDER_OF_STEPS, ORDER_OF_SAMPLES, ORDER_MARGIN = 1.0, 0.5, 0.1

# Alchemy is run at this part of its strength, and its error divided by it: near the wall its
# sum passes 1, and a result that is clamped says nothing of the sum.
ALCHEMY_STRENGTH = 0.25

Closed = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Form:
    method: str
    falloff: str
    integral: str
    occlusion: Closed | None  # None: alchemy's own sum, which depends on its options

    @property
    def name(self) -> str:
        return f"{self.method}, {self.integral}"

    @property
    def weighting(self) -> str:
        """Of the hemisphere, for the methods that have both."""
        return self.integral.split(",")[0]


NONE, LINEAR = closed_forms.cosine_none, closed_forms.cosine_linear
FORMS = [Form("hbao", "none", "uniform, none", closed_forms.uniform_none),
         Form("hbao", "linear", "uniform, linear", closed_forms.uniform_linear),
         Form("gtao", "none", "cosine, none", NONE),
         Form("gtao", "linear", "cosine, linear", LINEAR),
         Form("gtao", "none", "uniform, none", closed_forms.uniform_none),
         Form("gtao", "linear", "uniform, linear", closed_forms.uniform_linear),
         Form("bitmask", "none", "cosine, none", NONE),
         Form("bitmask", "linear", "uniform, linear", closed_forms.uniform_linear),
         Form("hsao", "none", "cosine, none", NONE),
         Form("hsao", "linear", "cosine, linear", LINEAR),
         Form("raymarch", "none", "cosine, none", NONE),
         Form("raymarch", "linear", "cosine, linear", LINEAR),
         Form("containment", "none", "cosine, none", NONE),
         Form("containment", "linear", "cosine, linear", LINEAR),
         Form("vao", "linear", "tangent sphere", closed_forms.tangent_sphere),
         Form("ssao", "linear", "ball", closed_forms.ball),
         Form("alchemy", "linear", "its own sum", None),
         Form("vo", "linear", "open half of the ball", closed_forms.half_ball)]

# What the tool traces in `builtin:groove`.
TRACED = {Target("cosine", "none"): NONE, Target("cosine", "linear"): LINEAR,
          Target("uniform", "none"): closed_forms.uniform_none,
          Target("uniform", "linear"): closed_forms.uniform_linear,
          Target(definition="tangent-sphere"): closed_forms.tangent_sphere}


@dataclass
class Sweep:
    """The error of one form over a row of efforts."""
    x: list[float] = field(default_factory=list)
    rms: list[float] = field(default_factory=list)

    def add(self, x: float, rms: float) -> None:
        self.x.append(x)
        self.rms.append(rms)

    @property
    def order(self) -> float:
        return stats.fitted_order(self.x, self.rms)


@dataclass
class Convergence:
    form: Form
    is_directional: bool
    work: Sweep = field(default_factory=Sweep)
    directions: Sweep = field(default_factory=Sweep)
    steps: Sweep = field(default_factory=Sweep)
    reached: dict[int, "Error"] = field(default_factory=dict)  # over pixels a radius

    @property
    def most(self) -> "Error":
        """In the finest picture."""
        return self.reached[max(self.reached)]

    @property
    def judged(self) -> Sweep:
        return self.steps if self.is_directional else self.work

    @property
    def promised(self) -> float:
        return ORDER_OF_STEPS if self.is_directional else ORDER_OF_SAMPLES

    @property
    def is_kept(self) -> bool:
        return self.judged.order > self.promised - ORDER_MARGIN


@dataclass(frozen=True)
class Error:
    rms: float
    mean: float
    largest: float
    lookups: float


@dataclass(frozen=True)
class Groove:
    path: Path
    x: np.ndarray  # of the columns, in radii from the bottom
    height: float  # of the orthographic view

    @property
    def c(self) -> np.ndarray:
        """Distance of the columns from the other wall, in radii."""
        return np.minimum(1.0, self.x * math.sqrt(2))


def make_groove(folder: Path, px: int) -> Groove:
    """The frame at so many pixels a radius. The bottom lies inside a pixel rather than on its
    centre or border; what can occlude lies in the guard band."""
    first = math.ceil(0.1 * math.sqrt(0.5) * px) + 0.25
    columns = int(math.sqrt(0.5) * px - first) + 1
    guard = px + 2
    width, height = columns + 2 * guard, ROWS + 2 * guard
    x = (np.arange(width) - guard + first) / px
    lean = np.full((height, width), math.sqrt(0.5))
    path = folder / f"groove-{px}.exr"
    images.write_exr(path, {"Z": np.tile(DEPTH - np.abs(x), (height, 1)),
                            "N.X": np.where(x > 0, -lean, lean), "N.Y": 0 * lean, "N.Z": lean},
                     guard)
    return Groove(path, x[guard:guard + columns], ROWS / px)


def run_groove(s: Study, groove: Groove, options: Options, seed: int) -> np.ndarray:
    made = s.tool.make("ao", [str(groove.path), "--crop", *options.set(seed=seed).flags(),
                              "--radius", "1", "--ortho", f"{groove.height:.9g}",
                              "--normal-space", "view"])
    return images.read_single(made).astype(np.float64)


def options_of(s: Study, form: Form, **effort: Any) -> Options:
    """Behind the wall all is solid; each pixel has its own rotation and jitter."""
    intensity = {"intensity": ALCHEMY_STRENGTH} if form.occlusion is None else {}
    return s.options(form.method, filter="none", noise_size=64, falloff=form.falloff,
                     weighting=form.weighting, bias_deg=0, thickness=0,
                     thickness_rule="constant", **intensity, **effort)


def exact_of(groove: Groove, form: Form, options: Options) -> np.ndarray:
    if form.occlusion is None:
        return closed_forms.alchemy(groove.c, DEPTH - groove.x, options.number("alchemy_bias"),
                                    options.number("alchemy_eps"))
    return form.occlusion(groove.c)


def measure(s: Study, groove: Groove, form: Form, **effort: Any) -> Error:
    options = options_of(s, form, **effort)
    strength = options.number("intensity")
    exact = 1 - strength * exact_of(groove, form, options)
    key = s.tool.key(["groove", str(groove.path), *options.flags(), form.integral])

    def run() -> list[float]:
        drawn = side_by_side(lambda seed: run_groove(s, groove, options, seed),
                             range(1, DRAWS + 1))
        error = np.concatenate([picture - exact for picture in drawn]) / strength
        return [float(np.sqrt(np.mean(error**2))), float(error.mean()),
                float(np.abs(error).max())]

    return Error(*s.tool.recall(key, run), options.samples)


def joint(form: Form, n: int) -> dict[str, int]:
    """Nd = Ns, and for hsao one normal ray; raymarch, which has only its rays, takes Nd / 4 in
    each direction."""
    return {"directions": n, "steps": n,
            "normal_rays": (n + 3) // 4 if form.method == "raymarch" else 1}


def sizes_of(s: Study) -> tuple[int, ...]:
    """Errors over work are measured in the last, which is no larger than the pictures are."""
    return (*SIZES_PX[:-1], min(SIZES_PX[-1], max(96, s.main.height // 16 * 16)))


def points_of(s: Study, form: Form) -> int:
    """raymarch costs Nd^3 / 4: it stops earlier than the others."""
    return (5 if form.method == "raymarch" else 6) - (2 if s.is_quick else 0)


def most(s: Study, form: Form, is_directional: bool) -> dict[str, int]:
    last = points_of(s, form) - 1
    return joint(form, 4 << last) if is_directional else {"samples": 4 << 2 * last}


def measure_form(s: Study, grooves: dict[int, Groove], c: Convergence) -> None:
    fine = grooves[sizes_of(s)[-1]]
    for k in range(points_of(s, c.form)):
        if c.is_directional:
            error = measure(s, fine, c.form, **joint(c.form, 4 << k))
            c.work.add(error.lookups, error.rms)
        else:
            c.work.add(4 << 2 * k, measure(s, fine, c.form, samples=4 << 2 * k).rms)
    if c.is_directional:
        measure_directions_and_steps(s, fine, c)
    for px, groove in grooves.items():
        c.reached[px] = measure(s, groove, c.form, **most(s, c.form, c.is_directional))


def measure_directions_and_steps(s: Study, fine: Groove, c: Convergence) -> None:
    """One of the two is refined while the other is fine."""
    much = fine_steps(s)
    rays = 4 if c.form.method == "raymarch" else 1
    for k in range(points_of(s, c.form)):
        directions = {"directions": 2 << k, "steps": much, "normal_rays": rays}
        c.directions.add(2 << k, measure(s, fine, c.form, **directions).rms)
        stepped = {"directions": 2 * much, "steps": 4 << k, "normal_rays": rays}
        c.steps.add(4 << k, measure(s, fine, c.form, **stepped).rms)


def fine_steps(s: Study) -> int:
    return 32 if s.is_quick else 128


def steps(s: Study) -> list[Step]:
    grooves: dict[int, Groove] = {}
    forms = [f for f in FORMS if f.method in s.registry.methods]
    all_forms = [Convergence(f, s.registry.reads(f.method, "directions")) for f in forms]
    traced: dict[Target, list[dict[str, float]]] = {}

    def open_grooves() -> None:
        grooves.update({px: make_groove(s.tool.folder, px) for px in sizes_of(s)})

    return [Step("closed forms: frames", 1, open_grooves),
            *(Step(f"closed forms: {c.form.name}", 4, lambda c=c: measure_form(s, grooves, c))
              for c in all_forms),
            *(Step(f"closed forms: ray tracing, {t.name}", 2,
                   lambda t=t: traced.update({t: trace(s, t)})) for t in TRACED),
            Step("closed forms: page", 1, lambda: write(s, all_forms, traced))]


def trace(s: Study, target: Target) -> list[dict[str, float]]:
    """What the ray tracing is off by in `builtin:groove`, and what it claims, over its rays."""
    px, width, height = 64, 92, 4
    x = np.abs(np.arange(width) + 0.5 - 0.5 * width) / px
    c = x * math.sqrt(2)
    strip = (c >= 0.1) & (c <= 1)
    found = []
    for rays in [16 << 2 * k for k in range(3 if s.is_quick else 5)]:
        made = images.read(s.tool.make("reference", [
            "builtin:groove", "--size", f"{width}x{height}", "--ortho", f"{height / px}",
            "--radius", "1", *target.flags(), "--rays", str(rays)])).channels
        error = made["AO"].astype(np.float64)[:, strip] - (1 - TRACED[target](c[strip]))
        found.append({"rays": rays, "rms": float(np.sqrt(np.mean(error**2))),
                      "claimed": float(np.sqrt(np.mean(made["AO.stderr"][:, strip]**2.0))),
                      "mean": float(error.mean())})
    return found


def guides(lines: list[plots.Line]) -> list[plots.Line]:
    """Lines of 1/sqrt(x) and 1/x that begin at the largest first error."""
    ends = [min(line.x[0] for line in lines), max(line.x[-1] for line in lines)]
    start = max(line.y[0] for line in lines)
    return [plots.Line(name, ends, [start, start * (ends[1] / ends[0])**-order], is_guide=True)
            for name, order in (("1/sqrt(n)", 0.5), ("1/n", 1.0))]


def plot_work(s: Study, all_forms: list[Convergence], directional: bool) -> None:
    lines = [plots.Line(c.form.name, c.work.x, c.work.rms) for c in all_forms
             if c.is_directional == directional]
    s.page.plot(
        plots.draw(lines + guides(lines), "buffer look-ups for each pixel" if directional
                   else "samples n for each pixel", "RMS error of accessibility", log_x=True,
                   log_y=True),
        "Marching methods, Nd = Ns doubled from point to point (hsao: Nn 1; raymarch: Nn = Nd/4). "
        "RMS error of single pixels, no filter." if directional else
        "Sampling methods, n quadrupled from point to point. RMS error of single pixels, no "
        "filter. alchemy at a quarter of its intensity, its error multiplied by four.")


def write(s: Study, all_forms: list[Convergence],
          traced: dict[Target, list[dict[str, float]]]) -> None:
    s.page.heading(2, "closed-forms", "Convergence to closed forms")
    s.page.text("A 90-degree V groove, seen by an orthographic camera along its bisector, is a "
                "height field whose occlusion is known in closed form. Errors are over a strip "
                "of its floor, 0.1 to 1 radius off the wall; the pixels are single estimates, "
                "each with its own rotation and jitter, no filter, no bias angle, surfaces solid "
                f"without end. R is {sizes_of(s)[-1]} pixels in the plots.")
    plot_work(s, all_forms, True)
    plot_work(s, all_forms, False)
    write_orders(s, all_forms)
    write_reached(s, all_forms)
    write_traced(s, traced)
    s.page.results["closed_forms"] = {
        "methods": [{"method": c.form.method, "closed_form": c.form.integral,
                     "work": {"x": c.work.x, "rmse": c.work.rms, "order": c.work.order},
                     "steps_order": c.steps.order if c.is_directional else None,
                     "promised_order": c.promised, "kept": c.is_kept,
                     "reached_rmse": {px: e.rms for px, e in c.reached.items()},
                     "reached_mean": c.most.mean, "reached_largest": c.most.largest} for c in all_forms],
        "reference": {t.name: rows for t, rows in traced.items()}}


def write_orders(s: Study, all_forms: list[Convergence]) -> None:
    much = fine_steps(s)
    s.page.text(f"Each order is the slope of a straight line through the last "
                f"{stats.ORDER_POINTS} points in the log-log plot, down to the first that is "
                f"within twice the smallest error of its row. Over Nd, Ns is {much}; over Ns, Nd "
                f"is {2 * much}. A horizon is found up to one step late, so that order 1 over Ns "
                "is what jittered equal steps promise, which over look-ups is less, since these "
                "pay for directions, too; independent samples promise 0.5 over n.")
    rows = []
    for c in all_forms:
        sweeps = (c.work, c.directions, c.steps)
        rows.append([c.form.method, c.form.integral,
                     *(f"{w.order:.2f}" if w.x else "–" for w in sweeps),
                     f"{c.promised:.1f} over {'Ns' if c.is_directional else 'n'}",
                     "yes" if c.is_kept else "no"])
    s.page.table("Measured order p: the RMS error falls like work to the power -p.",
                 ["method", "closed form", "over look-ups", "over Nd", "over Ns", "promised",
                  "kept"], rows)
    kept = sum(c.is_kept for c in all_forms)
    s.page.text(f"{kept} of {len(all_forms)} rows keep the promised order, less "
                f"{ORDER_MARGIN:.1f} for the fit.")
    for c in all_forms:
        if not c.is_kept:
            s.page.text(explanation(c))


def explanation(c: Convergence) -> str:
    """What the table says, in words that the numbers choose."""
    w = c.judged
    final = math.log(w.rms[-2] / w.rms[-1]) / math.log(w.x[-1] / w.x[-2])
    if final < c.promised - ORDER_MARGIN and not c.is_directional:
        why = "Its samples are likely worse spread than independent ones."
    elif final > w.order:
        why = ("The order still rises with the work: coarse steps likely pass a near wall "
               "altogether, which costs more than a step found late.")
    else:
        why = "Something other than the steps likely limits it by then."
    return (f"{c.form.name} does not; its order between the last two points is {final:.2f}. "
            f"{why}")


def write_reached(s: Study, all_forms: list[Convergence]) -> None:
    sizes = sizes_of(s)
    s.page.table("How near each method comes to its closed form: RMS error with the most work, "
                 "for several sizes of the radius R in pixels; mean and largest error.",
                 ["method", "closed form", "look-ups", *(f"R = {px} px" for px in sizes),
                  f"mean, {sizes[-1]} px", f"largest, {sizes[-1]} px"],
                 [[c.form.method, c.form.integral, f"{c.most.lookups:.0f}",
                   *(f"{c.reached[px].rms:.5f}" for px in sizes), f"{c.most.mean:+.5f}",
                   f"{c.most.largest:.5f}"] for c in all_forms])
    worst = max(all_forms, key=lambda c: c.most.rms)
    texels = sum(c.reached[sizes[0]].rms > 2 * c.most.rms for c in all_forms)
    s.page.text(f"With the most work and R = {sizes[-1]} pixels every row is within "
                f"{worst.most.rms:.4f} (RMS) of its closed form; {worst.form.name} is the "
                f"farthest. If R is {sizes[0]} pixels only, {texels} of {len(all_forms)} rows "
                "are more than twice as far off: depth is read at texel centres, and there the "
                "size of a texel limits them. In the other rows it is the number of samples in "
                "both.")


def write_traced(s: Study, traced: dict[Target, list[dict[str, float]]]) -> None:
    """The truth that everything is measured against, held to the same forms."""
    lines = [plots.Line(t.name, [r["rays"] for r in rows], [r["rms"] for r in rows])
             for t, rows in traced.items()]
    s.page.heading(3, "closed-forms-reference", "The ray tracing itself")
    s.page.plot(plots.draw(lines + guides(lines), "rays for each pixel",
                           "RMS error of accessibility", log_x=True, log_y=True),
                "`crevice reference` on `builtin:groove`, against the same closed forms.")
    s.page.table("The ray tracing at the most rays: its RMS error, the standard error that it "
                 "claims itself, its mean error, and the order of its convergence.",
                 ["integral", "rays", "RMS error", "claimed", "mean error", "order"],
                 [[t.name, f"{rows[-1]['rays']:.0f}", f"{rows[-1]['rms']:.5f}",
                   f"{rows[-1]['claimed']:.5f}", f"{rows[-1]['mean']:+.5f}",
                   f"{-stats.slope([r['rays'] for r in rows], [r['rms'] for r in rows]):.2f}"]
                  for t, rows in traced.items()])
