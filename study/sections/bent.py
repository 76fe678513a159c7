# SPDX-License-Identifier: MIT
"""Light along bent normals: skies that are ten times as bright on one side, seen through what
is open of each pixel, against rays that see them."""
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import images
from ..measure import Study
from ..tables import number
from ..views import View
from . import Step

METHODS = ("gtao", "bitmask", "hsao", "raymarch")
LIT = "bitmask"  # whose lit pictures are compared as well
MEAN, SLOPE = 0.55, 0.45  # of radiance, over the direction's x, y or z
HEADS = ["view", "normals", "traced", *(f"`{m}`" for m in METHODS), "lit, normals",
         "lit, bent normals"]


@dataclass(frozen=True)
class Truth:
    light: np.ndarray  # irradiance / pi, of each sky
    openness: np.ndarray
    bent: np.ndarray
    normal: np.ndarray


@dataclass
class Row:
    view: View
    normals: float
    shares: dict[str, float]
    lit: tuple[float, float]

    def cells(self) -> list[str]:
        return [self.view.name, number(self.normals, 4),
                *(number(self.shares[k], 2) for k in ("traced", *METHODS)),
                *(number(x, 4) for x in self.lit)]


def steps(s: Study) -> list[Step]:
    rows: list[Row] = []
    views = [s.main] if s.is_quick else s.views
    return [*(Step(f"bent normals: {v.name}", 8, lambda v=v: measure(s, v, rows))
              for v in views), Step("bent normals: table", 0, lambda: write(s, rows))]


def sky_path(s: Study) -> Path:
    """A picture of three skies, one for each colour: brighter towards x, y and z."""
    path = s.tool.folder / "sides.exr"
    height = 128
    azimuth = np.pi * ((np.arange(2 * height) + 0.5) / height - 1)
    polar = (np.pi * (np.arange(height) + 0.5) / height)[:, None]
    towards = (np.sin(polar) * np.sin(azimuth), np.cos(polar) + 0 * azimuth,
               -np.sin(polar) * np.cos(azimuth))
    if not path.exists():
        images.write_exr(path, {c: MEAN + SLOPE * w for c, w in zip("RGB", towards)})
    return path


def picture(s: Study, view: View, sky: str, *words: str) -> np.ndarray:
    """What surfaces send on of the sky's light: height x width x 3."""
    made = s.tool.make("render", [*view.arguments(), "--radius", f"{view.radius:.9g}", "--sky",
                                  sky, "--zenith", "0,1,0", "--key-light", "none", "--method",
                                  LIT, "--falloff", "none", *words])
    channels = images.read(made).channels
    return np.stack([channels[c].astype(np.float64) for c in "RGB"], axis=-1)


def through(openness: np.ndarray, bent: np.ndarray) -> np.ndarray:
    """Irradiance / pi, band 1 of the sky narrowed as scene/sky_opening.c has it."""
    x = 1 - openness
    narrow = 2 / 3 + x * (0.583 - 0.653 * np.sqrt(x) + 0.253 * x)
    return openness[..., None] * (MEAN + SLOPE * narrow[..., None] * bent)


def measure(s: Study, view: View, rows: list[Row]) -> None:
    sky = str(sky_path(s))
    albedo = picture(s, view, "constant:1,1,1", "--shade", "lit-no-ao")
    mask = s.mask(view) & (albedo.min(axis=-1) > 0.01)
    albedo = np.maximum(albedo, 0.01)
    truths = [trace(s, view, sky, albedo, seed) for seed in (0, 1)]

    def error(light: Callable[[Truth], np.ndarray]) -> float:
        """RMS over the skies. The two truths' noise differs, and drops out of the product."""
        first, second = ((light(t) - t.light)[mask] for t in truths)
        square = float(np.mean(first * second))
        return math.sqrt(square) if square > 0 else math.nan

    normals = error(lambda t: t.openness[..., None] * (MEAN + SLOPE * 2 / 3 * t.normal))
    shares = {"traced": error(lambda t: through(t.openness, t.bent)) / normals}
    for method in METHODS:
        bent = estimated(s, view, method)
        shares[method] = error(lambda t, b=bent: through(t.openness, b)) / normals
    lit = [picture(s, view, sky, "--shade", "lit", "--bent-normal", x) / albedo
           for x in ("off", "on")]
    rows.append(Row(view, normals, shares, (error(lambda t: lit[0]), error(lambda t: lit[1]))))


def trace(s: Study, view: View, sky: str, albedo: np.ndarray, seed: int) -> Truth:
    """By the same rays for all of it."""
    rays = str(rays_of(s))
    light = picture(s, view, sky, "--shade", "lit", "--sky-rays", rays, "--seed", str(seed))
    made = images.read(s.tool.make("reference", [
        *view.arguments(), "--radius", f"{view.radius:.9g}", "--rays", rays, "--seed",
        str(seed)]))
    return Truth(light / albedo, made.channels["AO"].astype(np.float64), made.vector("bent"),
                 made.vector("N"))


def rays_of(s: Study) -> int:
    """Of each truth: half of the study's. Fewer leave the product to chance."""
    return max(32, s.rays // 2)


def estimated(s: Study, view: View, method: str) -> np.ndarray:
    return images.read(s.tool.make("render", [
        *view.arguments(), "--radius", f"{view.radius:.9g}", "--method", method, "--falloff",
        "none", "--bent-normal", "on"])).vector("bent")


def write(s: Study, rows: list[Row]) -> None:
    page = s.page
    page.heading(2, "bent", "Light along bent normals")
    page.text("Three skies, each ten times as bright on one side (towards +x, +y and +z) as on "
              "the other, and no other light. The truth is their radiance along twice "
              f"{rays_of(s)} rays for each pixel (`crevice render --sky-rays`), as far as the "
              "radius; the noise of the two drops out. Normals: RMSE of irradiance / pi over the "
              "three, if accessibility is multiplied by the irradiance that the normal would get "
              "from the whole sky. The next columns are shares of that, for light through the "
              "opening around the bent normal: the ray-traced one, and that of each method at "
              "`medium` with its filter. All of these take the ray-traced accessibility, whose "
              "error would hide that of the light. Lit: RMSE of `crevice render --lit` with "
              f"`{LIT}`, accessibility and all, by normals and by bent normals.")
    page.table("Error of the light of a sky with a bright side.", HEADS,
               [r.cells() for r in rows])
    page.results["bent"] = [r.cells() for r in rows]
