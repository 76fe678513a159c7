# SPDX-License-Identifier: MIT
"""What the sections measure with: frames, references, estimates and times of a view."""
import functools
import hashlib
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any, TypeVar

import numpy as np

from . import images, stats
from .options import Options, Registry, Target
from .page import Page
from .progress import Progress
from .tool import Tool
from .views import View

# The intensity at which no method clamps; results scale with it.
LINEAR = 0.25


T = TypeVar("T")
R = TypeVar("R")


def side_by_side(run: Callable[[T], R], items: Iterable[T]) -> Iterator[R]:
    """Results of several runs of the tool, in their order. A run for each processor: the
    start of a process takes longer than a small picture."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        yield from pool.map(run, items)


@dataclass(frozen=True)
class Buffers:
    """Which buffers an estimate sees."""
    layers: int = 1
    kind: str = "surfaces"
    guard: int | None = None  # px; None: a tenth of the height

    def flags(self) -> list[str]:
        guard = [] if self.guard is None else ["--guard-px", str(self.guard)]
        kind = ["--layer-kind", self.kind] if self.layers > 1 else []
        return ["--layers", str(self.layers), *kind, *guard]


ONE_LAYER = Buffers()


@dataclass(frozen=True)
class Reference:
    path: Path
    picture: np.ndarray
    error: float  # root mean square of the standard errors


@dataclass(frozen=True)
class Fit:
    """How near a picture is to a truth, as it is and at its best strength."""
    rmse: float
    bias: float
    ssim: float
    intensity: float
    intensity_rmse: float
    both_rmse: float


class Study:
    def __init__(self, tool: Tool, registry: Registry, page: Page, progress: Progress,
                 views: list[View], main: View, rays: int, is_quick: bool):
        self.tool, self.registry, self.page, self.progress = tool, registry, page, progress
        self.views, self.main = views, main
        self.rays, self.is_quick = rays, is_quick
        self.references: dict[tuple[View, str, str, Buffers], Reference] = {}

    # Frames.

    @functools.lru_cache(maxsize=64)
    def frame_path(self, view: View, buffers: Buffers = ONE_LAYER) -> Path:
        return self.tool.make("gbuffer", [*view.arguments(), *buffers.flags()])

    @functools.lru_cache(maxsize=8)
    def frame(self, view: View) -> images.Frame:
        return images.read(self.frame_path(view))

    @functools.lru_cache(maxsize=32)
    def mask(self, view: View) -> np.ndarray:
        """Where the view shows a surface."""
        depth = self.frame(view).channels["Z"]
        return np.isfinite(depth) & (depth > 0) & (depth < 1e10)

    # References.

    @property
    def stop(self) -> float:
        """The standard error from which on a pixel gets no more rays: a quarter of what as
        many independent rays would leave at worst. Evenly spread rays do better."""
        return 0.125 / self.rays**0.5

    def reference(self, view: View, target: Target, kind: str = "full",
                  buffers: Buffers = ONE_LAYER) -> Reference:
        key = (view, target.name, kind, buffers)
        if key not in self.references:
            arguments = [*view.arguments(), "--radius", f"{view.radius:.9g}", *target.flags(),
                         "--rays", str(self.rays), "--max-error", f"{self.stop:.6f}"]
            if kind != "full":
                arguments += ["--kind", kind, *buffers.flags()]
            path = self.tool.make("reference", arguments)
            channels = images.read(path).channels
            error = channels["AO.stderr"][self.mask(view)].astype(np.float64)
            self.references[key] = Reference(path, channels["AO"],
                                             stats.root_mean_square(error.tolist()))
        return self.references[key]

    def trace(self, view: View, target: Target, rays: int) -> Reference:
        """A reference of its own, with so many rays in every pixel."""
        path = self.tool.make("reference", [*view.arguments(), "--radius", f"{view.radius:.9g}",
                                            *target.flags(), "--rays", str(rays)])
        channels = images.read(path).channels
        return Reference(path, channels["AO"], float("nan"))

    def truth(self, view: View, target: Target) -> np.ndarray:
        return self.reference(view, target).picture

    # Estimates.

    def options(self, method: str, preset: str = "medium", **settings: Any) -> Options:
        return self.registry.options(method, preset, **settings)

    def estimate_arguments(self, view: View, options: Options, buffers: Buffers) -> list[str]:
        radius = [] if options.has("radius") else ["--radius", f"{view.radius:.9g}"]
        return [str(self.frame_path(view, buffers)), "--crop", *options.flags(), *radius]

    def estimate(self, view: View, options: Options, buffers: Buffers = ONE_LAYER) -> Path:
        """The file with the picture, which is kept."""
        return self.tool.make("ao", self.estimate_arguments(view, options, buffers))

    def prepare(self, pictures: Iterable[tuple[View, Options]]) -> None:
        """Makes the files of estimates side by side."""
        for _ in side_by_side(lambda wanted: self.estimate(*wanted), pictures):
            pass

    def picture(self, view: View, options: Options, buffers: Buffers = ONE_LAYER
                ) -> np.ndarray:
        return images.read_single(self.estimate(view, options, buffers))

    def draws(self, view: View, options: Options, seeds: Sequence[int]
              ) -> Iterator[np.ndarray]:
        """A picture for each seed; they are not kept."""
        def draw(seed: int) -> np.ndarray:
            path = self.tool.make("ao", self.estimate_arguments(
                view, options.set(seed=seed), ONE_LAYER))
            picture = images.read_single(path)
            self.tool.forget(path)
            return picture

        yield from side_by_side(draw, seeds)

    def drawn(self, view: View, options: Options, seeds: Sequence[int], what: str,
              make: Callable[[list[np.ndarray]], Any]) -> Any:
        """A value made of pictures with these seeds; it is kept, the pictures are not."""
        arguments = self.estimate_arguments(view, options, ONE_LAYER)
        key = self.tool.key(["draws", *arguments, *map(str, seeds), what])
        return self.tool.recall(key, lambda: make(list(self.draws(view, options, seeds))))

    def mean(self, view: View, options: Options, seeds: Sequence[int]) -> np.ndarray:
        """The mean picture of these seeds; the picture is kept."""
        arguments = self.estimate_arguments(view, options, ONE_LAYER)
        key = self.tool.key(["mean", *arguments, *map(str, seeds)])
        path = self.tool.folder / f"{key}.npy"
        if not path.exists():
            total = np.zeros((view.height, view.width))
            for picture in self.draws(view, options, seeds):
                total += picture
            part = path.with_suffix(".part.npy")
            np.save(part, (total / len(seeds)).astype(np.float32))
            part.replace(path)
        return np.load(path)

    def errors(self, view: View, options: Options, truths: Sequence[np.ndarray], draws: int
               ) -> list[float]:
        """RMS distances from pictures over draws of the noise."""
        mask = self.mask(view)
        digests = [hashlib.sha256(t.tobytes()).hexdigest()[:16] for t in truths]
        found: list[float] = self.drawn(
            view, options, range(draws), "rmse " + " ".join(digests),
            lambda pictures: [stats.root_mean_square([stats.rmse(p, t, mask) for p in pictures])
                              for t in truths])
        return found

    def error(self, view: View, options: Options, truth: np.ndarray, draws: int) -> float:
        return self.errors(view, options, [truth], draws)[0]

    def rmse(self, view: View, a: np.ndarray, b: np.ndarray) -> float:
        return stats.rmse(a, b, self.mask(view))

    # Comparisons by the tool.

    def compare(self, a: Path, b: Path) -> dict[str, Any]:
        return self.tool.ask("compare", [str(a), str(b), "--json"])

    def fit(self, view: View, options: Options, truth: Reference) -> Fit:
        """The best strengths are those of the result before it is clamped."""
        plain, linear = side_by_side(
            lambda o: self.compare(self.estimate(view, o), truth.path),
            (options, options.set(intensity=LINEAR)))
        return Fit(plain["rmse"], plain["bias"], plain["ssim"],
                   linear["fit_intensity"] * LINEAR, linear["fit_intensity_rmse"],
                   linear["fit_both_rmse"])

    # Times.

    @functools.cached_property
    def isa(self) -> list[str]:
        """The best instruction set, as an argument of the bench."""
        if self.tool.timed:
            return []
        rows = self.tool.ask("bench", ["builtin:corner", "--size", "64x36", "--method", "vo",
                                       "--seconds", "0", "--repeats", "1", "--json"])["rows"]
        return ["--isa", next((r["isa"] for r in rows if r["isa"] != "scalar"), "scalar")]

    def bench(self, views: Sequence[View], arguments: list[str], number: int = 0
              ) -> list[dict[str, Any]]:
        """Rows of `crevice bench` on the views, with the radius of the first. number: of the
        round; each is measured anew."""
        frames = [str(self.frame_path(view)) for view in views]
        if not any(a.startswith("radius=") for a in arguments):
            arguments = [*arguments, "--set", f"radius={views[0].radius:.9g}"]
        seconds = ["--seconds", f"{(0.04 if self.is_quick else 0.4) + 1e-4 * number:.4f}"]
        rows: list[dict[str, Any]] = self.tool.ask(
            "bench", [*frames, *arguments, *self.isa, *seconds, "--json"])["rows"]
        return rows

    def time(self, view: View, options: Options, number: int = 0) -> float:
        """ms of a picture, filter included."""
        arguments = ["--method", options.method, "--preset", options.preset, "--filter",
                     options.get("filter"), "--structure",
                     "exact" if options.has("exact") else "deinterleaved"]
        for key, value in options.settings:
            if key not in ("filter", "exact"):
                arguments += ["--set", f"{key}={value}"]
        return self.bench([view], arguments, number)[0]["ms"]

    def times(self, view: View, options: Sequence[Options]) -> list[float]:
        """ms of each; all take their turn in several rounds, so that whatever else the
        machine does meets them alike. Medians."""
        rounds = range(1 if self.is_quick else 3)
        taken = [[self.time(view, o, number) for o in options] for number in rounds]
        return [median(row) for row in zip(*taken)]
