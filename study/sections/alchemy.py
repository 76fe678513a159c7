# SPDX-License-Identifier: MIT
"""What McGuire, Osman, Bukowski, Hennessy 2011 state of Alchemy obscurance."""
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import images, plots, stats
from ..measure import LINEAR, Fit, Study
from ..options import Options, Target
from ..page import FAILS, HOLDS, NOT_MEASURED, PARTLY, Claim, graded
from ..stats import clearly_below
from ..views import View
from . import Step

COSINE = Target("cosine", "linear")
OBSCURANCE = Target("cosine", "alchemy")
FACTORS = (0.25, 0.5, 1, 2, 4)
DRAWS = 2
# Table 1: samples in each band and the number of bands on the paper's five machines.
PLATFORMS = ((3, 1), (4, 1), (4, 3), (3, 3), (2, 3))
# Depth samples along each side of a pixel.
SIDE = 2
# Pixels that a statement about a kind of place needs.
ENOUGH = 100


def steps(s: Study) -> list[Step]:
    json: dict[str, Any] = s.page.results.setdefault("alchemy", {})
    return [Step("alchemy: introduction", 0, lambda: introduce(s)),
            Step("alchemy: equal time", 25, lambda: equal_time(s, json)),
            Step("alchemy: cost over radius", 8, lambda: radius(s, json)),
            Step("alchemy: bands", 5, lambda: bands(s, json)),
            Step("alchemy: filter", 3, lambda: filtering(s, json)),
            Step("alchemy: multisampling", 2, lambda: multisample(s, json))]


def introduce(s: Study) -> None:
    s.page.heading(2, "alchemy", "McGuire et al. 2011: Alchemy obscurance")
    s.page.text(f"Measured on the view {s.main.name} at {s.main.width}x{s.main.height} with R = "
                f"{s.main.radius:.3g}. Times are medians of rounds in which all that is compared "
                "takes its turn.")


def twelve(s: Study) -> Options:
    return s.options("alchemy", samples=12, bands=1)


def near_radius_px(s: Study) -> float:
    """The projected radius that a tenth of the view's surfaces exceed: those near by get all
    samples."""
    depth = s.frame(s.main).channels["Z"][s.mask(s.main)]
    return float(np.floor(np.quantile(s.main.radius_px(depth), 0.9)))


# Figures 10 and 11: equal time.

@dataclass
class Rival:
    key: str
    label: str
    options: Options
    own: Fit  # to the truth of its own integral
    cosine: Fit
    obscurance: Fit
    noise: float  # RMS distance from its own limit, unfiltered
    # Darkness beside silhouettes as a share of that in corners, here and in its own truth.
    spill: float
    truth_spill: float
    corners: float  # RMS error there at the best intensity
    ms: float = 0.0


def vo_rung(s: Study, rung: int) -> Options:
    """Settings of rising cost; samples come in pairs."""
    return s.options("vo", samples=2 * (rung + 1))


def hbao_rung(s: Study, rung: int) -> Options:
    return s.options("hbao", directions=2 + (rung + 1) // 2, steps=2 + rung // 2)


def choose_rung(s: Study, view: View, base: Options, rung: Callable[[Study, int], Options],
                count: int) -> Options:
    """The rung whose time is nearest to that of the base, by bisection."""
    low, high, low_ratio, high_ratio = 0, count - 1, 0.0, math.inf
    while low < high:
        middle = (low + high) // 2
        first, second = s.times(view, [base, rung(s, middle)])
        ratio = second / first
        if ratio < 1:
            low, low_ratio = middle + 1, ratio
        else:
            high, high_ratio = middle, ratio
    # low is the first that takes longer; the one before may be nearer.
    return rung(s, low - 1 if low > 0 and 1 - low_ratio < high_ratio - 1 else low)


def beside_silhouettes(s: Study) -> np.ndarray:
    """Pixels of which one of 32 on four rings within half the radius shows a surface that is
    nearer by more than the radius."""
    view, frame = s.main, s.frame(s.main)
    depth, whole = frame.channels["Z"].astype(np.float64), frame.whole["Z"]
    mask = s.mask(view)
    reach = 0.5 * view.radius_px(np.where(mask, depth, 1.0))
    rows, columns = np.mgrid[0:view.height, 0:view.width] + 0.5
    found = np.zeros(mask.shape, bool)
    for ring in range(1, 5):
        for spoke in range(8):
            angle = math.pi / 4 * spoke
            x = columns + frame.guard[0] + reach * ring / 4 * math.cos(angle)
            y = rows + frame.guard[1] + reach * ring / 4 * math.sin(angle)
            inside = (x >= 0) & (y >= 0) & (x < whole.shape[1]) & (y < whole.shape[0])
            at = whole[np.where(inside, y, 0).astype(int), np.where(inside, x, 0).astype(int)]
            found |= inside & (at < depth - view.radius)
    return found & mask


@dataclass(frozen=True)
class Places:
    beside: np.ndarray  # open pixels beside silhouettes, by the cosine truth
    corners: np.ndarray  # the darkest

    @property
    def are_enough(self) -> bool:
        return min(self.beside.sum(), self.corners.sum()) >= ENOUGH

    def spill(self, picture: np.ndarray) -> float:
        """Darkness beside silhouettes as a share of that in corners."""
        if not self.are_enough:
            return math.nan
        return float((1 - picture[self.beside]).mean() / (1 - picture[self.corners]).mean())


def find_places(s: Study) -> Places:
    cosine = s.truth(s.main, COSINE)
    return Places(beside_silhouettes(s) & (cosine > 0.9), s.mask(s.main) & (cosine < 0.5))


def at_intensity(intensity: float, linear: np.ndarray) -> np.ndarray:
    """A picture that was made at the intensity LINEAR, at another one."""
    return np.maximum(0.0, 1 - intensity * (1 - linear) / LINEAR)


def measure_rival(s: Study, key: str, label: str, options: Options, places: Places) -> Rival:
    view, truth = s.main, s.reference(s.main, options.target)
    linear = s.picture(view, options.set(intensity=LINEAR))
    cosine = s.fit(view, options, s.reference(view, COSINE))
    error = (at_intensity(cosine.intensity, linear) - s.truth(view, COSINE))[places.corners]
    limit = s.picture(view, options.much(512))
    return Rival(key, label, options, s.fit(view, options, truth), cosine,
                 s.fit(view, options, s.reference(view, OBSCURANCE)),
                 s.error(view, options.set(filter="none"), limit, DRAWS),
                 places.spill(linear), places.spill(truth.picture),
                 float(np.sqrt(np.mean(error**2))) if error.size else math.nan)


def equal_time(s: Study, json: dict[str, Any]) -> None:
    """The search is on a quarter of the pixels: ratios are the same."""
    half, base = s.main.resized(0.5), s.options("alchemy", samples=12)
    vo, hbao = choose_rung(s, half, base, vo_rung, 48), choose_rung(s, half, base, hbao_rung, 21)
    chosen = [("alchemy", "alchemy, 12 samples", base),
              ("vo", f"vo, {vo.get('samples')} samples", vo),
              ("hbao", f"hbao, {hbao.get('directions')}x{hbao.get('steps')}", hbao),
              ("hbao-full", "hbao, 8x8", s.options("hbao", directions=8, steps=8))]
    places = find_places(s)
    rivals = {key: measure_rival(s, key, label, o, places) for key, label, o in chosen}
    for rival, ms in zip(rivals.values(), s.times(s.main, [o for _, _, o in chosen])):
        rival.ms = ms
    write_equal_time(s, rivals, places)
    for claim in (claim_error(rivals), claim_silhouettes(rivals, places),
                  claim_cost_of_hbao(rivals), claim_smoothness(rivals)):
        s.page.claim(claim)
    json["equal_time"] = {r.key: {
        "settings": r.label, "ms": r.ms, "rmse": r.own.rmse, "fitted_rmse": r.own.both_rmse,
        "fitted_rmse_cosine_linear": r.cosine.both_rmse,
        "fitted_rmse_cosine_alchemy": r.obscurance.both_rmse, "ssim": r.own.ssim,
        "noise": r.noise, "best_intensity": r.own.intensity,
        "best_intensity_rmse": r.own.intensity_rmse, "spill_beside_silhouettes": r.spill,
        "spill_of_truth": r.truth_spill, "rmse_in_corners": r.corners} for r in rivals.values()}


def write_equal_time(s: Study, rivals: dict[str, Rival], places: Places) -> None:
    page = s.page
    page.heading(3, "alchemy-equal-time", "Alchemy, VO and HBAO at equal time")
    page.text("For `vo` and `hbao` the sample count was searched whose time, filter included, is "
              "nearest to that of `alchemy` with 12 samples. The last row is `hbao` at its usual "
              "settings, which takes longer. RMSE, the same at the best intensity and contrast "
              "(fitted), and SSIM are against its own truth: the ray-traced picture of the "
              "integral that it estimates. The columns linear and alchemy are fitted to a truth "
              "common to all: cosine weighting with these falloffs. Noise: unfiltered RMS "
              "distance from its own limit at many samples.")
    page.table("Alchemy, VO and HBAO, each with its filter.",
               ["method", "ms", "times", "RMSE", "fitted", "linear", "alchemy", "SSIM", "noise"],
               [[r.label, f"{r.ms:.2f}", f"{r.ms / rivals['alchemy'].ms:.2f}",
                 f"{r.own.rmse:.4f}", f"{r.own.both_rmse:.4f}", f"{r.cosine.both_rmse:.4f}",
                 f"{r.obscurance.both_rmse:.4f}", f"{r.own.ssim or 0:.3f}", f"{r.noise:.4f}"]
                for r in rivals.values()])
    if places.corners.any():
        page.text(f"In the darkest corners (the {places.corners.sum()} pixels whose cosine truth "
                  "is under 0.5) the RMS error at the best intensity is " + ", ".join(
                      f"{rivals[k].corners:.4f} for `{k}`" for k in ("alchemy", "vo", "hbao")) + ".")
    figures = []
    cosine, mask = s.truth(s.main, COSINE), s.mask(s.main)
    for key in ("alchemy", "vo", "hbao"):
        r = rivals[key]
        fitted = np.where(mask, at_intensity(r.cosine.intensity, s.picture(
            s.main, r.options.set(intensity=LINEAR))), 1.0)
        figures += [page.picture(f"alchemy-equal-{key}", fitted,
                                 f"{r.label}, at intensity {r.cosine.intensity:.2f}"),
                    page.picture(f"alchemy-equal-{key}-error",
                                 images.error_map(fitted, cosine, mask, 0.3),
                                 f"{r.label}: error; blue is too dark, orange too bright, full "
                                 "colour at 0.3")]
    page.grid(figures + [page.picture("alchemy-equal-truth", cosine,
                                      f"ray-traced, {COSINE.name}")], pairs=True)


def claim_error(rivals: dict[str, Rival]) -> Claim:
    a, b = rivals["alchemy"], rivals["vo"]
    pairs = [(a.own.both_rmse, b.own.both_rmse), (a.cosine.both_rmse, b.cosine.both_rmse),
             (a.obscurance.both_rmse, b.obscurance.both_rmse)]
    wins = [clearly_below(*pair) for pair in pairs]
    words = [f"{x:.4f} against {y:.4f}" for x, y in pairs]
    return Claim(
        "2011, Figure 10", "At equal time Alchemy gives a better picture than volumetric "
        "obscurance.", graded(all(wins), *wins),
        f"At {a.ms:.2f} ms ({a.label}) and {b.ms:.2f} ms ({b.label}) the fitted RMS error is "
        f"{words[0]} to each one's own truth, {words[1]} to the cosine integral with linear "
        f"falloff, {words[2]} with alchemy's falloff.",
        "The paper judges by eye. By RMS error most pixels are open surfaces with little noise, "
        "where a line sample, which has no singular weight, does better.")


def claim_silhouettes(rivals: dict[str, Rival], places: Places) -> Claim:
    a, b = rivals["alchemy"], rivals["vo"]
    of_alchemy, of_vo = a.spill - a.truth_spill, b.spill - b.truth_spill
    # Twice as much is what one sees; 0.05 of a corner's is not.
    verdict = graded(of_alchemy < 0.5 * of_vo and of_vo > 0.05,
                     clearly_below(of_alchemy, of_vo) and of_vo > 0)
    return Claim(
        "2011, Figure 10 a, b", "Alchemy's darkness lies on surfaces; volumetric obscurance also "
        "darkens what is far behind an outline.",
        verdict if places.are_enough else NOT_MEASURED,
        f"On the {places.beside.sum()} open pixels just behind an outline (cosine truth above "
        "0.9) the mean darkness, as a share of that of the darkest corners, is "
        f"{a.spill:.3f} for `alchemy` and {b.spill:.3f} for `vo`; their truths have "
        f"{a.truth_spill:.3f} and {b.truth_spill:.3f}." if places.are_enough else
        "The view has too few such pixels to tell.",
        "What is nearer than the outline by less than the radius darkens in both, and the filter "
        "carries darkness over outlines in both.")


def claim_cost_of_hbao(rivals: dict[str, Rival]) -> Claim:
    a, full = rivals["alchemy"], rivals["hbao-full"]
    ratio = full.ms / a.ms
    return Claim(
        "2011, Figure 11", "HBAO takes about three times as long as Alchemy (8.5 ms against "
        "2.6 ms).", graded(ratio >= 2.5, ratio >= 1.2),
        f"{full.label}: {full.ms:.2f} ms; {a.label}: {a.ms:.2f} ms, both with the filter: "
        f"{ratio:.1f} times as long.", "The times hold the filter, which costs both the same.")


def claim_smoothness(rivals: dict[str, Rival]) -> Claim:
    a, b = rivals["alchemy"], rivals["hbao"]
    smoother, finer = clearly_below(b.noise, a.noise), (a.own.ssim or 0) > (b.own.ssim or 0)
    return Claim(
        "2011, Figure 11", "HBAO is smoother, Alchemy keeps finer detail; here at equal time.",
        graded(smoother and finer, smoother, finer),
        f"At equal time ({b.label}: {b.ms:.2f} ms) the noise before the filter is {b.noise:.4f} "
        f"for hbao and {a.noise:.4f} for alchemy; SSIM to its own truth is {b.own.ssim or 0:.3f} "
        f"for hbao and {a.own.ssim or 0:.3f} for alchemy; the fitted RMS error "
        f"{b.own.both_rmse:.4f} and {a.own.both_rmse:.4f}.",
        "The paper's HBAO runs at half resolution and is scaled up; here both have every pixel, "
        "and the few directions that this time buys.")


# Figures 8 and 9: the radius.

def radius(s: Study, json: dict[str, Any]) -> None:
    view, band = s.main, near_radius_px(s)
    radii = [view.radius * f for f in FACTORS]
    plain = [twelve(s).set(filter="none", radius=r) for r in radii]
    banded = [o.set(bands=3, band_px=band) for o in plain]
    noise = [s.error(view, o, s.picture(view, o.much(384)), DRAWS) for o in plain]
    times = s.times(view, plain + banded)
    ms, banded_ms = times[:len(FACTORS)], times[len(FACTORS):]
    guide = plots.Line("in proportion to R", radii[:2], [ms[0], ms[0] * FACTORS[1] / FACTORS[0]],
                       is_guide=True)
    s.page.heading(3, "alchemy-radius", "Cost and noise over the radius")
    s.page.plot(plots.draw([plots.Line("12 samples", radii, ms),
                            plots.Line("12 samples in 3 bands", radii, banded_ms), guide],
                           "radius R, scene units", "time, ms", log_x=True, from_zero=True),
                "Time of alchemy over the radius, unfiltered. The dashed line grows as the "
                "radius does.")
    s.page.plot(plots.draw([plots.Line("12 samples", radii, noise)], "radius R, scene units",
                           "RMS error", log_x=True, from_zero=True),
                "Noise of alchemy with 12 samples over the radius: RMS distance from 384 "
                "samples.")
    s.page.claim(claim_radius_time(ms))
    s.page.claim(claim_radius_noise(noise))
    json["radius"] = {"factor": FACTORS, "ms": ms, "banded_ms": banded_ms, "noise": noise}


def claim_radius_time(ms: list[float]) -> Claim:
    slope = stats.slope(FACTORS, ms)
    # A slope of 0.1 is what a busy machine does to a median.
    return Claim(
        "2011, Figure 9", "Larger radii read farther apart and miss caches; time grows at most "
        "about linearly, not as the square of the radius.",
        graded(slope <= 1.1, slope <= 1.6),
        f"From a quarter of the view's radius to four times of it, time grows from {ms[0]:.2f} "
        f"ms to {ms[-1]:.2f} ms, {ms[-1] / ms[0]:.2f} times: as R to the power of {slope:.2f}.",
        "The buffers do not fit the caches, so that far samples wait for memory.")


def claim_radius_noise(noise: list[float]) -> Claim:
    middle = FACTORS.index(1)
    return Claim(
        "2011, Figure 8", "At the same number of samples a larger radius costs sharpness: the "
        "variance grows.",
        graded(clearly_below(noise[0], noise[middle]) and clearly_below(noise[middle], noise[-1]),
               clearly_below(noise[0], noise[-1])),
        f"RMS noise of 12 samples at a quarter of the radius {noise[0]:.4f}, at the radius "
        f"{noise[middle]:.4f}, at four times of it {noise[-1]:.4f}.",
        "If most of the view is dark and clamped at 0, there is little left to vary.")


# Figure 5 and Table 1: bands.

def mean_samples(s: Study, options: Options) -> float:
    """What a pixel takes, in the mean: those of a band are told by the projected radius as the
    option's help says."""
    count, band_px = options.number("bands"), options.number("band_px")
    depth = s.frame(s.main).channels["Z"][s.mask(s.main)].astype(np.float64)
    band = np.clip(np.ceil(count * s.main.radius_px(depth) / band_px), 1, count)
    return float((options.number("samples") * band / count).mean())


@dataclass(frozen=True)
class Spending:
    samples: float
    ms: float
    noise: float


def bands(s: Study, json: dict[str, Any]) -> None:
    view, band = s.main, near_radius_px(s)
    plain = twelve(s).set(filter="none")
    limit = s.picture(view, twelve(s).much(512))
    banded = plain.set(bands=3, band_px=band)
    mean = mean_samples(s, banded)
    chosen = {"12 samples everywhere": (plain, 12.0), "3 bands of 4 samples": (banded, mean),
              "the mean of the bands everywhere":
                  (plain.set(samples=max(1, round(mean))), float(max(1, round(mean))))}
    ms = s.times(view, [o for o, _ in chosen.values()])
    spent = {name: Spending(count, t, s.error(view, o, limit, 2 * DRAWS))
             for (name, (o, count)), t in zip(chosen.items(), ms)}
    s.page.heading(3, "alchemy-bands", "Levels of detail and the filter")
    s.page.table("Bands, unfiltered. Noise: RMS distance from 512 samples.",
                 ["samples", "mean for a pixel", "time, ms", "noise"],
                 [[name, f"{p.samples:.1f}", f"{p.ms:.2f}", f"{p.noise:.4f}"]
                  for name, p in spent.items()])
    s.page.claim(claim_bands(band, *spent.values()))
    json["bands"] = {key: vars(p) for key, p in zip(("all", "banded", "equal"), spent.values())}
    platforms(s, band, json["bands"])


def claim_bands(band: float, everywhere: Spending, banded: Spending, equal: Spending) -> Claim:
    # 5 % of time are beyond the noise of medians; 2 % of error beyond that of draws.
    faster, better = banded.ms < 0.95 * everywhere.ms, banded.noise < 1.02 * equal.noise
    return Claim(
        "2011, Figure 5", "Fewer samples where the projected radius is small save time at little "
        "loss.", graded(faster and better, faster, better),
        f"3 bands, all samples from {band:.0f} px of projected radius on: {banded.ms:.2f} ms "
        f"against {everywhere.ms:.2f} ms; noise {banded.noise:.4f} against "
        f"{everywhere.noise:.4f}. The same {banded.samples:.1f} samples in the mean, spread "
        f"evenly: {equal.ms:.2f} ms, noise {equal.noise:.4f}.",
        "In units of the radius there is as much to see far away as near by. And the first "
        "samples of a set, which a band takes, are spread less evenly than a set made for so "
        "few.")


def filtered_limit(s: Study) -> np.ndarray:
    """512 samples through the filter of the preset."""
    return s.picture(s.main, twelve(s).much(512).set(filter=twelve(s).get("filter")))


def platforms(s: Study, band: float, json: dict[str, Any]) -> None:
    filtered = filtered_limit(s)
    options = [twelve(s).set(samples=n * count, bands=count, band_px=band)
               for n, count in PLATFORMS]
    noise = [s.error(s.main, o, filtered, DRAWS) for o in options]
    ms = s.times(s.main, options)
    s.page.table("The five settings of the paper's Table 1 with the filter, all on this machine. "
                 "Noise: RMS distance from 512 samples through the same filter.",
                 ["samples in a band", "bands", "time, ms", "noise, filtered"],
                 [[str(n), str(count), f"{ms[i]:.2f}", f"{noise[i]:.4f}"]
                  for i, (n, count) in enumerate(PLATFORMS)])
    json["table_1_ms"], json["table_1_noise"] = ms, noise


# Figure 6: the filter.

def filtering(s: Study, json: dict[str, Any]) -> None:
    view, soft = s.main, twelve(s).set(filter="bilateral13")
    plain = soft.set(filter="none")
    limit = s.picture(view, soft.much(512))
    filtered = s.picture(view, soft.much(512).set(filter="bilateral13"))
    raw = s.error(view, plain, limit, DRAWS)
    noise, everything = s.errors(view, soft, [filtered, limit], DRAWS)
    blur = s.rmse(view, filtered, limit)
    s.page.claim(claim_filter(raw, noise, blur, everything, s.times(view, [plain, soft])))
    json["filter"] = {"noise_before": raw, "noise_after": noise, "blur": blur,
                      "error": everything}


def claim_filter(raw: float, noise: float, blur: float, everything: float, ms: list[float]
                 ) -> Claim:
    # "Usable" as half of the noise, and blur that leaves a gain.
    half = noise <= 0.5 * raw
    return Claim(
        "2011, Figure 6", "Two passes of a 13-tap cross-bilateral filter make a usable picture of "
        "12 samples.", graded(half and clearly_below(everything, raw), half),
        f"RMS noise of 12 samples {raw:.4f}, filtered {noise:.4f} (against 512 samples through "
        f"the same filter). The filter blurs those by {blur:.4f}; noise and blur together are "
        f"{everything:.4f}. Time {ms[0]:.2f} ms and {ms[1]:.2f} ms.",
        "The noise goes, and detail with it: the filter keeps edges of depth, but not those of "
        "the occlusion itself, where that changes within its 13 taps.")


# Section 2: compositing with subpixel precision.

def gather(coarse: np.ndarray, coarse_depth: np.ndarray, depth: np.ndarray, limit: float
           ) -> np.ndarray:
    """Each sample takes the mean of a cross of pixels, weighted by nearness in depth: 1 at no
    deviation, 0 at the limit. Samples near no pixel of the cross take the nearest one's."""
    values, weights, gaps = [], [], []
    padded = np.pad(coarse, 1, "edge")
    padded_depth = np.pad(coarse_depth, 1, constant_values=np.inf)
    height, width = coarse.shape
    for dy, dx in ((0, 0), (-1, 0), (1, 0), (0, -1), (0, 1)):
        at = np.s_[1 + dy:1 + dy + height, 1 + dx:1 + dx + width]
        value, there = (np.kron(p[at], np.ones((SIDE, SIDE))) for p in (padded, padded_depth))
        gap = np.where(np.isfinite(there) & np.isfinite(depth), np.abs(there - depth), np.inf)
        values.append(value)
        gaps.append(gap)
        weights.append(np.maximum(0.0, 1 - gap / limit))
    total = np.sum(weights, axis=0)
    mean = np.sum(np.multiply(values, weights), axis=0) / np.where(total > 0, total, 1)
    nearest = np.take_along_axis(np.array(values), np.argmin(gaps, axis=0)[None], 0)[0]
    return np.where(total > 0, mean, nearest)


def multisample(s: Study, json: dict[str, Any]) -> None:
    """2x2 depth samples for each pixel: those of a picture of twice the width and height."""
    pixels = s.main.resized(1 / SIDE)
    samples = pixels.resized(SIDE)
    much = s.options("alchemy").much(256)
    coarse, truth = s.picture(pixels, much), s.picture(samples, much)
    with np.errstate(invalid="ignore"):
        depth = s.frame(samples).channels["Z"].astype(np.float64)
        limit = float(s.registry.filter_options["filter_depth"]) * s.main.radius
        gathered = gather(coarse, s.frame(pixels).channels["Z"].astype(np.float64), depth, limit)
        blocks = depth.reshape(pixels.height, SIDE, pixels.width, SIDE)
        edges = blocks.max(axis=(1, 3)) - blocks.min(axis=(1, 3)) > limit
    chosen = np.kron(edges, np.ones((SIDE, SIDE), bool)) & s.mask(samples)
    plain = np.kron(coarse, np.ones((SIDE, SIDE)))
    errors = [stats.rmse(p, truth, chosen) for p in (plain, gathered)]
    s.page.heading(3, "alchemy-multisample", "Compositing with multisampling")
    s.page.claim(claim_multisample(pixels, int(chosen.sum()), *errors))
    json["multisample"] = {"edge_samples": int(chosen.sum()), "rmse_plain": errors[0],
                           "rmse_gathered": errors[1]}


def claim_multisample(pixels: View, count: int, plain: float, gathered: float) -> Claim:
    if count < ENOUGH:
        verdict, measured = NOT_MEASURED, f"The view has {count} such samples, too few."
    else:
        # Two thirds of the error is a visible gain.
        verdict = (HOLDS if gathered <= 0.67 * plain else
                   PARTLY if clearly_below(gathered, plain) else FAILS)
        measured = (f"{pixels.width}x{pixels.height} pixels with 2x2 depth samples each, 256 "
                    f"samples of occlusion: on the {count} samples of pixels that an edge "
                    f"crosses, RMS error with the pixel's own value {plain:.4f}, gathered "
                    f"{gathered:.4f}.")
    return Claim(
        "2011, section 2", "Obscurance of one value for each pixel can be composited with "
        "subpixel precision: each depth sample gathers from a cross of pixels by nearness in "
        "depth.", verdict, measured,
        "If things are thinner than a pixel, no pixel of the cross shows the surface that the "
        "sample is on.")
