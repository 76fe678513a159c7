# SPDX-License-Identifier: MIT
"""What changes from frame to frame when the camera moves, beyond what the truth changes."""
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .. import images, plots, stats
from ..measure import Study
from ..options import Options, Target
from ..page import Bold
from ..views import View
from . import Step

# RMS motion of surface points from frame to frame: slow, and not a whole number, so that
# points do not keep their place in the grid of pixels.
MOTION_PX = 0.75
# A texel shows the same surface if it lies in the point's tangent plane, to within a pixel's
# footprint at its depth, and faces the same way.
COS_NORMALS = 0.9
# Points with less than this of their bilinear weight on their own surface are lost.
LEAST_WEIGHT = 0.999
# Points where the reference changes by less than this are steady.
STEADY = 0.1
RAYS = 64


@dataclass(frozen=True)
class Look:
    """A frame of the motion: what its pixels show, in world space."""
    view: View
    points: np.ndarray  # height x width x 3
    normals: np.ndarray
    is_surface: np.ndarray


@dataclass(frozen=True)
class Taps:
    """Where the points of a frame were in the frame before: up to four texels each."""
    found: np.ndarray  # height x width: of the latter frame
    index: np.ndarray  # 4 x count, into the former frame
    weight: np.ndarray  # 4 x count
    motion_px: float  # RMS

    def change(self, former: np.ndarray, latter: np.ndarray) -> np.ndarray:
        """Of each point that was found."""
        before = np.sum(former.ravel()[self.index] * self.weight, axis=0)
        return latter[self.found].astype(np.float64) - before


def look_at(s: Study, view: View) -> Look:
    frame = s.frame(view)
    depth = frame.channels["Z"].astype(np.float64)
    is_surface = s.mask(view)
    rows, columns = np.mgrid[0:view.height, 0:view.width] + 0.5
    unit = np.where(is_surface, 1.0 if view.is_ortho else depth, 0.0)
    local = np.stack([(columns - view.width / 2) / view.focal_px() * unit,
                      -(rows - view.height / 2) / view.focal_px() * unit,
                      -np.where(is_surface, depth, 0.0)], axis=-1)
    return Look(view, local @ view.axes() + np.array(view.eye), frame.vector("N"), is_surface)


def follow(former: Look, latter: Look) -> Taps:
    """Looks up each point of the latter frame in the former one, bilinearly. Points of which
    not all texels lie on the same surface are left out."""
    view = former.view
    local = (latter.points - np.array(view.eye)) @ view.axes().T
    unit = np.full(local.shape[:2], 1.0) if view.is_ortho else -local[..., 2]
    seen = latter.is_surface & (local[..., 2] < 0)
    unit = np.where(seen, unit, 1.0)
    # In texel centres: whole numbers are centres.
    px = local[..., 0] / unit * view.focal_px() + view.width / 2 - 0.5
    py = -local[..., 1] / unit * view.focal_px() + view.height / 2 - 0.5
    left, top = np.floor(px).astype(int), np.floor(py).astype(int)
    footprint = unit / view.focal_px()
    indices, weights = [], []
    for dy in (0, 1):
        for dx in (0, 1):
            x, y = left + dx, top + dy
            weight = np.abs((1 - dx) - (px - left)) * np.abs((1 - dy) - (py - top))
            inside = seen & (x >= 0) & (y >= 0) & (x < view.width) & (y < view.height)
            index = np.where(inside, y * view.width + x, 0)
            weights.append(np.where(inside & same_surface(former, latter, index, footprint),
                                    weight, 0.0))
            indices.append(index)
    total = np.sum(weights, axis=0)
    found = total >= LEAST_WEIGHT
    rows, columns = np.mgrid[0:view.height, 0:view.width]
    motion = (columns - px)[found]**2 + (rows - py)[found]**2
    return Taps(found, np.stack([i[found] for i in indices]),
                np.stack([w[found] / total[found] for w in weights]),
                float(np.sqrt(motion.mean())) if motion.size else 0.0)


def same_surface(former: Look, latter: Look, index: np.ndarray, footprint: np.ndarray
                 ) -> np.ndarray:
    apart = former.points.reshape(-1, 3)[index] - latter.points
    off_plane = np.abs(np.sum(apart * latter.normals, axis=-1))
    aligned = np.sum(former.normals.reshape(-1, 3)[index] * latter.normals, axis=-1)
    return former.is_surface.ravel()[index] & (off_plane < footprint) & (aligned > COS_NORMALS)


@dataclass
class Truth:
    """The reference of the first two frames, traced twice with other rays each, so that
    products of both changes are free of the noise of the rays."""
    target: Target
    planes: list[list[np.ndarray]]  # of the frame, of the repetition
    steady: np.ndarray  # of the points that were found
    all2: float  # mean squared change
    steady2: float

    @property
    def share(self) -> float:
        return float(self.steady.mean())


@dataclass
class Row:
    options: Options
    truth: Truth | None = None
    # Without and with the filter:
    change: list[float] = field(default_factory=list)  # RMS, all points
    excess: list[float] = field(default_factory=list)  # RMS at steady points, less the truth's
    wobble: list[float] = field(default_factory=list)  # RMS change of the error there
    still: list[float] = field(default_factory=list)  # there, of another draw of the noise
    by_frame: list[float] = field(default_factory=list)  # filtered


@dataclass
class Motion:
    step: float = 0.0
    looks: list[Look] = field(default_factory=list)
    taps: list[Taps] = field(default_factory=list)
    truths: dict[Target, Truth] = field(default_factory=dict)


def steps(s: Study) -> list[Step]:
    motion = Motion()
    rows = [Row(s.options(method)) for method in s.registry.methods]

    def move() -> None:
        made = motion_of(s, s.main, 3 if s.is_quick else 4)
        motion.step, motion.looks, motion.taps = made.step, made.looks, made.taps

    return [Step("stability: frames", 3, move),
            *(Step(f"stability: {r.options.method}", 4, lambda r=r: measure(s, motion, r))
              for r in rows), Step("stability: page", 1, lambda: write(s, motion, rows))]


def motion_of(s: Study, view: View, frames: int) -> Motion:
    """Half the size of the view; the step is one by which points move as wanted."""
    base = view.resized(0.5)
    first = look_at(s, base)
    trial = 0.02 * base.radius
    found = follow(first, look_at(s, base.moved(trial))).motion_px
    step = trial * MOTION_PX / found if found > 0 else trial
    looks = [first] + [look_at(s, base.moved(k * step)) for k in range(1, frames)]
    return Motion(step, looks, [follow(a, b) for a, b in zip(looks, looks[1:])])


def trace(s: Study, view: View, target: Target, seed: int) -> np.ndarray:
    """Other rays for each frame, too: equal ones at one pixel would leave a pattern that is
    fixed to the screen."""
    path: Path = s.tool.make("reference", [
        *view.arguments(), "--radius", f"{view.radius:.9g}", *target.flags(), "--rays",
        str(RAYS), "--seed", str(seed)])
    return images.read_single(path).astype(np.float64)


def truth_of(s: Study, motion: Motion, target: Target) -> Truth:
    if target not in motion.truths:
        planes = [[trace(s, look.view, target, 1 + 2 * n + k) for k in (0, 1)]
                  for n, look in enumerate(motion.looks[:2])]
        a, b = (motion.taps[0].change(planes[0][k], planes[1][k]) for k in (0, 1))
        steady = np.abs(0.5 * (a + b)) < STEADY
        motion.truths[target] = Truth(target, planes, steady, max(0.0, float(np.mean(a * b))),
                                      max(0.0, float(np.mean((a * b)[steady]))))
    return motion.truths[target]


def change_of_error(motion: Motion, truth: Truth, pictures: list[np.ndarray]) -> float:
    """RMS at steady points, from the first frame to the second."""
    a, b = (motion.taps[0].change(pictures[0] - truth.planes[0][k],
                                  pictures[1] - truth.planes[1][k]) for k in (0, 1))
    return max(0.0, float(np.mean((a * b)[truth.steady])))**0.5


def measure(s: Study, motion: Motion, row: Row) -> None:
    truth = row.truth = truth_of(s, motion, row.options.target)
    first = motion.taps[0]
    pair = row.options.set(filter="none"), row.options
    s.prepare((look.view, options) for look in motion.looks for options in pair)
    for options in pair:
        pictures = [s.picture(look.view, options) for look in motion.looks]
        changes = [t.change(a, b) for t, a, b in zip(motion.taps, pictures, pictures[1:])]
        row.change.append(stats.root_mean_square(np.concatenate(changes).tolist()))
        row.by_frame = [float(np.sqrt(np.mean(c**2))) for c in changes]
        steady = changes[0][truth.steady]
        row.excess.append(max(0.0, float(np.mean(steady**2)) - truth.steady2)**0.5)
        row.wobble.append(change_of_error(motion, truth, pictures))
        redrawn = s.picture(motion.looks[1].view, options.set(seed=1))
        still = (redrawn - pictures[1])[first.found][truth.steady]
        row.still.append(float(np.sqrt(np.mean(still.astype(np.float64)**2))))


def write(s: Study, motion: Motion, rows: list[Row]) -> None:
    s.page.heading(2, "stability", "Temporal stability")
    explain(s, motion, rows[0])
    write_tables(s, rows)
    s.page.plot(
        plots.draw([plots.Line(r.options.method, [r.options.samples] * 2, r.wobble,
                               ["no filter", "filter of the preset"]) for r in rows],
                   "buffer look-ups for each pixel",
                   "RMS change of the error from frame to frame", log_x=True, log_y=True),
        "Change of the error over work at steady points, preset medium. Each line joins a method "
        "without and with its filter.")
    sum_up(s, rows)
    base = motion.looks[0].view
    s.page.results["stability"] = {
        "view": s.main.name, "frames": len(motion.looks), "width": base.width,
        "height": base.height, "step": motion.step, "motion_px": motion.taps[0].motion_px,
        "pairs": "without filter, with the preset's filter",
        "methods": [{"method": r.options.method, "filter": r.options.get("filter"),
                     "target": r.truth.target.name, "lookups": r.options.samples,
                     "rms_change": r.change, "reference_rms_change": r.truth.all2**0.5,
                     "steady_share": r.truth.share,
                     "steady_reference_rms_change": r.truth.steady2**0.5,
                     "rms_excess": r.excess, "rms_change_of_error": r.wobble,
                     "rms_still": r.still, "rms_change_by_frame": r.by_frame}
                    for r in rows if r.truth]}


def explain(s: Study, motion: Motion, row: Row) -> None:
    base, t = motion.looks[0].view, row.truth
    s.page.text(f"The camera of view `{s.main.name}` moves sideways by {motion.step:.3g} scene "
                f"units a frame, over {len(motion.looks)} frames of {base.width} x {base.height} "
                f"pixels; surface points move by {motion.taps[0].motion_px:.2f} pixels (RMS).")
    s.page.text("Each point of a frame is looked up in the frame before, bilinearly between four "
                "texels that all lie in its tangent plane, to within a pixel's footprint, and "
                "face the same way. Points for which they do not are left out: those that were "
                "hidden or outside, and those on silhouettes. On a surface the truth does not "
                "depend on the camera, so an ideal picture would change by the look-up only.")
    outside = 1 - t.share * t.steady2 / t.all2 if t.all2 > 0 else 0.0
    s.page.text("The ray-traced reference of the same integral shows how much that is: the blur "
                "of the look-up where the truth has detail as fine as a pixel. The second table "
                f"leaves out points where the reference changes by {STEADY:g} or more (for "
                f"{t.target.name}: {100 * (1 - t.share):.1f} % of the points, which make "
                f"{100 * outside:.0f} % of its mean square) and takes off the rest, both between "
                "the first two frames.")
    s.page.text("Excess is the root of the mean squared change less that of the reference; 0 if "
                "the reference changes more. The error's change takes the reference's change off "
                "at each point before it is squared: it also counts detail that does not move "
                f"along. The reference is traced twice with {RAYS} other rays for each pixel, "
                "and products of both results are averaged, so that the noise of the rays drops "
                "out.")
    s.page.text("The tile of rotations and jitters is fixed to the screen. A still camera "
                "therefore sees no change at all, whatever the noise, and a moving one sees it "
                "as a pattern that surfaces slide under. The last two columns of the second "
                "table are what a renderer gets that draws another tile for each frame, to "
                "average over time: the camera stands still, and all change is noise. In the "
                "other columns the look-up averages up to four pixels of the frame before, so "
                "that noise counts a little less there.")


def write_tables(s: Study, rows: list[Row]) -> None:
    s.page.table("All points: RMS change of accessibility from frame to frame, preset medium, "
                 "without and with its filter.",
                 ["method", "filter", "look-ups", "change", "change, filter", "reference's"],
                 [[r.options.method, r.options.get("filter"), f"{r.options.samples:.0f}",
                   f"{r.change[0]:.4f}", f"{r.change[1]:.4f}", f"{r.truth.all2**0.5:.4f}"]
                  for r in rows])
    least = (min(r.excess[1] for r in rows), min(r.wobble[1] for r in rows))

    def cell(value: float, smallest: float) -> str | Bold:
        return Bold(f"{value:.4f}") if value <= smallest else f"{value:.4f}"

    s.page.table("Steady points: RMS excess over the reference's change, change of the error, "
                 "and change if the camera stands still and the noise is drawn again.",
                 ["method", "integral", "points", "reference's", "excess", "excess, filter",
                  "error's", "error's, filter", "still", "still, filter"],
                 [[r.options.method, r.truth.target.name, f"{100 * r.truth.share:.1f} %",
                   f"{r.truth.steady2**0.5:.4f}", f"{r.excess[0]:.4f}",
                   cell(r.excess[1], least[0]), f"{r.wobble[0]:.4f}",
                   cell(r.wobble[1], least[1]), f"{r.still[0]:.4f}", f"{r.still[1]:.4f}"]
                  for r in rows])


def sum_up(s: Study, rows: list[Row]) -> None:
    calm = min(rows, key=lambda r: r.wobble[1])
    filtered = [r for r in rows if r.options.get("filter") != "none"]
    gains = sum(r.wobble[1] < r.wobble[0] for r in filtered)
    rest = ("." if gains == len(filtered) else "; for the others, what they average changes by "
            "more from frame to frame than the noise that they remove.")
    s.page.text(f"With its filter, the error of `{calm.options.method}` changes least, by "
                f"{calm.wobble[1]:.4f} (RMS). Filters make the error steadier for {gains} of "
                f"{len(filtered)} methods{rest}")
    smoother = sum(r.excess[1] == 0 for r in rows)
    if smoother:
        s.page.text(f"With their filters, {smoother} methods change less at steady points than "
                    "their reference: their pictures are smoother than the truth.")
