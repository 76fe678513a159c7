# SPDX-License-Identifier: MIT
"""The times of docs/performance.md: what is measured with `crevice bench`, and as tables."""
import dataclasses
import math
import re
import subprocess
import time
from collections.abc import Callable, Sequence
from statistics import median
from typing import Any

from . import stats
from .measure import Study
from .options import Target
from .tables import markdown, number
from .views import View

Row = dict[str, Any]

# The methods that the papers' headlines are about, and what they are called: at `medium`.
MAIN = {"hbao": "8x8", "alchemy": "12", "vao": "12", "hsao": "7x12 + 1"}
FILTERS = ("none", "bilateral13", "box4", "edges15", "gauss5")
HEIGHTS = (180, 360, 720, 1080, 2160)
FACTORS = (0.125, 0.25, 0.5, 1, 2, 4)
WORK = (0.5, 1, 2, 4, 8)  # factors of the samples at `medium`
TRACED = re.compile(r"up to \d+ rays: ([0-9.]+) s")
WIDE, NARROW = 1080, 720


def at_height(view: View, height: int) -> View:
    return view.resized(height / view.height)


class Measured:
    """All that is measured; each part is kept, so that a run can be resumed."""

    def __init__(self, s: Study, views: Sequence[View], wide: int = WIDE):
        self.s = s
        self.views = [at_height(v, wide) for v in views]
        self.small = [at_height(v, wide * NARROW // WIDE) for v in views]
        self.scale = wide / WIDE
        self.about: Row = {}

    def bench(self, view: View, *arguments: str, every_isa: bool = False) -> list[Row]:
        isa = ["--isa", "all"] if every_isa else self.s.isa
        answer = self.s.tool.ask("bench", [
            str(self.s.frame_path(view)), "--set", f"radius={view.radius:.9g}", *isa,
            "--seconds", "0.1" if self.s.is_quick else "1", *arguments, "--json"])
        self.about = {k: answer[k] for k in ("processor", "compiler", "version", "threads")}
        return [row | {"view": view.name} for row in answer["rows"]]

    def methods(self) -> list[Row]:
        return [row for view in self.views
                for row in self.bench(view, "--method", "all", "--structure", "all",
                                      every_isa=True)]

    def threads(self) -> list[Row]:
        counts = f"1,{max(2, self.about['threads'])}"
        return [row for view in self.views
                for row in self.bench(view, "--method", ",".join(MAIN), "--filter",
                                      "none,bilateral13", "--threads", counts)]

    def narrow(self) -> list[Row]:
        return [row for view in self.small
                for row in self.bench(view, "--method", "alchemy", "--filter", "bilateral13")]

    def filters(self) -> list[Row]:
        """Each has every turn once, since machines grow slower and faster within minutes: the
        rows of the median round."""
        names = FILTERS[1:]
        rounds = [self.bench(self.views[0], "--method", "none", "--filter",
                             ",".join(names[k:] + names[:k]), every_isa=True)
                  for k in range(len(names))]
        kinds: dict[tuple[str, str], list[Row]] = {
            (row["filter"], row["isa"]): [] for row in rounds[0]}
        for row in (row for rows in rounds for row in rows):
            kinds[row["filter"], row["isa"]].append(row)
        return [sorted(rows, key=lambda row: row["ms"])[(len(rows) - 1) // 2]
                for rows in kinds.values()]

    def growth(self) -> dict[str, list[Row]]:
        """Rows with x: what grows. The radius is the same part of the picture at every size,
        or the same number of pixels."""
        view, methods = self.views[0], ["--method", ",".join(MAIN)]
        found: dict[str, list[Row]] = {"pixels": [], "pixels alone": [], "radius": [],
                                       "samples": []}
        for height in HEIGHTS:
            sized = at_height(view, max(36, round(height * self.scale)))
            alone = dataclasses.replace(sized, radius=view.radius * NARROW / height)
            for key, v in (("pixels", sized), ("pixels alone", alone)):
                found[key] += [r | {"x": 1e-6 * r["width"] * r["height"]}
                               for r in self.bench(v, *methods)]
        words = ",".join(f"{f:g}" for f in FACTORS)
        found["radius"] = [r | {"x": r["radius_factor"]} for r in self.bench(
            view, *methods, "--radius-factor", words)]
        for method in MAIN:
            found["samples"] += [self.worked(view, method, factor) for factor in WORK]
        return found

    def worked(self, view: View, method: str, factor: float) -> Row:
        options = self.s.options(method)
        key = "directions" if options.reads("directions") else "samples"
        options = options.set(**{key: max(1, round(options.number(key) * factor))})
        row = self.bench(view, "--method", method, "--set", f"{key}={options.get(key)}")[0]
        return row | {"x": options.samples}

    def rays(self) -> list[Row]:
        """The error of `medium` in rays: by how they converge between 16 and 64 of them."""
        found = []
        for view in self.small:
            times = {(r["method"], r["filter"]): r["ms"] for r in self.bench(
                view, "--method", ",".join(MAIN), "--filter", "none,bilateral13")}
            for (method, name), ms in times.items():
                options = self.s.options(method, filter=name)
                truth = self.s.truth(view, options.target)
                rmse = self.s.rmse(view, self.s.picture(view, options), truth)
                found.append({"view": view.name, "method": method, "filter": name,
                              "target": options.target.name, "ms": ms, "rmse": rmse}
                             | self.traced(view, options.target, rmse))
        return found

    def traced(self, view: View, target: Target, rmse: float) -> Row:
        truth, errors, seconds = self.s.truth(view, target), {}, 0.0
        for count in (16, 64):
            made = self.s.trace(view, target, count)
            errors[count] = self.s.rmse(view, made.picture, truth)
            found = TRACED.search(self.s.tool.notes(made.path))
            seconds = float(found[1]) if found else math.nan
        order = math.log(errors[16] / errors[64]) / math.log(4)
        count = max(1.0, 16 * (errors[16] / rmse)**(1 / order)) if order > 0 else math.nan
        return {"order": order, "rays": count, "ray_ms": 1e3 * seconds * count / 64}

    def whole(self) -> list[Row]:
        """Processes of their own, from file to file."""
        view = self.views[0]
        frame, out = str(self.s.frame_path(view)), str(self.s.tool.folder / "whole.exr")
        radius = ["--radius", f"{view.radius:.9g}"]
        commands = {"`crevice ao`": ["ao", frame, *radius, "-o", out],
                    "`crevice ao`, one sample, no filter: reading and writing":
                        ["ao", frame, *radius, "--method", "vo", "--samples", "1", "--filter",
                         "none", "-o", out],
                    "`crevice gbuffer`": ["gbuffer", *view.arguments(), "-o", out]}
        repeats = 2 if self.s.is_quick else 7
        key = self.s.tool.key(["whole", frame, str(repeats)])
        return self.s.tool.recall(key, lambda: [
            {"what": what, "view": view.name, "width": view.width, "height": view.height}
            | spread([self.seconds(c) for _ in range(repeats)]) for what, c in commands.items()])

    def seconds(self, command: list[str]) -> float:
        started = time.monotonic()
        subprocess.run([str(self.s.tool.program), *command, "--quiet"], check=True)
        return time.monotonic() - started


def spread(seconds: Sequence[float]) -> Row:
    ms = sorted(1e3 * v for v in seconds)
    return {"ms": median(ms), "ms_min": ms[0], "ms_max": ms[-1]}


# Tables.

def select(rows: Sequence[Row], **wanted: Any) -> list[Row]:
    return [r for r in rows if all(r[k] == v for k, v in wanted.items())]


def only(rows: Sequence[Row], key: str, **wanted: Any) -> float | None:
    found = select(rows, **wanted)
    return found[0][key] if found else None


def in_order(rows: Sequence[Row], key: str) -> list[Any]:
    return list(dict.fromkeys(r[key] for r in rows))


def ns_per_pixel(row: Row) -> float:
    return 1e6 * row["ms"] / (row["width"] * row["height"])


def of_isa(rows: Sequence[Row], isa: str) -> list[Row]:
    """The default structure of each method there."""
    return [r for r in select(rows, isa=isa)
            if isa == "scalar" or r["structure"] == "deinterleaved"]


def methods_table(s: Study, rows: Sequence[Row], view: str) -> str:
    mine = select(rows, view=view)
    isas = in_order(mine, "isa")
    lines = []
    for method in in_order(mine, "method"):
        best = only_row(of_isa(mine, isas[-1]), method)
        samples = s.options(method).samples
        rates = [only(of_isa(mine, isa), "mpix_per_s", method=method) for isa in isas]
        lines.append([f"`{method}`", f"{samples:.0f}", *(number(r, 1) for r in rates),
                      number(best["mpix_per_s"] / rates[0] if rates[0] else None, 1),
                      number(best["ms"], 2), number((best["ms_q3"] - best["ms_q1"]) / 2, 2),
                      number(ns_per_pixel(best) / samples, 3)])
    return markdown(["method", "samples", *(f"`{i}`" for i in isas), "over scalar", "ms", "+-",
                     "ns/px/sample"], lines)


def only_row(rows: Sequence[Row], method: str) -> Row:
    return select(rows, method=method)[0]


def structures_table(rows: Sequence[Row]) -> str:
    best, views = in_order(rows, "isa")[-1], in_order(rows, "view")
    lines = []
    for method in in_order(rows, "method"):
        line = [f"`{method}`"]
        for view in views:
            both = [only(rows, "mpix_per_s", view=view, method=method, isa=best, structure=k)
                    for k in ("deinterleaved", "exact")]
            ratio = both[0] / both[1] if both[0] and both[1] else None
            line += [number(both[0], 1), number(both[1], 1), number(ratio, 2)]
        lines.append(line)
    return markdown(["method", *(word for view in views
                                 for word in (f"`{view}` deinterleaved", "exact", "ratio"))],
                    lines)


def threads_table(rows: Sequence[Row]) -> str:
    counts = in_order(rows, "threads")
    lines = []
    for row in select(rows, threads=counts[0]):
        same = {k: row[k] for k in ("view", "method", "filter")}
        rates = [only(rows, "mpix_per_s", threads=n, **same) for n in counts]
        ratio = rates[-1] / rates[0] if rates[-1] and rates[0] else None
        lines.append([f"`{row['view']}`", f"`{row['method']}` {MAIN[row['method']]}",
                      f"`{row['filter']}`", *(number(r, 1) for r in rates), number(ratio, 2)])
    return markdown(["view", "method", "filter",
                     *(f"{n} thread{'s' * (n > 1)}" for n in counts), "ratio"], lines)


def growth_table(rows: Sequence[Row], unit: str, digits: int,
                 cost: Callable[[Row], float] = ns_per_pixel) -> str:
    """ns/px of each x, and the exponent p of time ~ x^p, fitted to all points."""
    lines = []
    for method in in_order(rows, "method"):
        mine = select(rows, method=method)
        points = ", ".join(f"{number(r['x'], digits)}: {number(cost(r), 2)}" for r in mine)
        order = stats.slope([r["x"] for r in mine], [r["ms"] for r in mine])
        lines.append([f"`{method}`", points, number(order, 2)])
    return markdown(["method", f"{unit}: ns/px", "exponent"], lines)


def filters_table(rows: Sequence[Row]) -> str:
    isas = in_order(rows, "isa")
    return markdown(["filter", *(f"`{i}`, MPix/s" for i in isas), "ms", "bytes/px"],
                    [[f"`{f}`", *(number(only(rows, "mpix_per_s", filter=f, isa=i), 0)
                                  for i in isas),
                      number(only(rows, "ms", filter=f, isa=isas[-1]), 2),
                      number(only(rows, "bytes_per_pixel", filter=f, isa=isas[-1]), 1)]
                     for f in in_order(rows, "filter")])


def memory_table(rows: Sequence[Row]) -> str:
    best = in_order(rows, "isa")[-1]
    first = in_order(rows, "view")[0]
    return markdown(["method", "structure", "bytes/px", "allocations of a run"],
                    [[f"`{r['method']}`", r["structure"], number(r["bytes_per_pixel"], 1),
                      f"{r['run_allocations']:.0f}"]
                     for r in select(rows, isa=best, view=first)])


def rays_table(rows: Sequence[Row]) -> str:
    return markdown(["view", "method", "filter", "integral", "ms", "RMSE", "rays for it", "p",
                     "ray tracing, ms", "times faster"],
                    [[f"`{r['view']}`", f"`{r['method']}`", f"`{r['filter']}`", r["target"],
                      number(r["ms"], 2), number(r["rmse"], 4), number(r["rays"], 1),
                      number(r["order"], 2), number(r["ray_ms"], 0),
                      number(r["ray_ms"] / r["ms"], 1)] for r in rows])


def whole_table(rows: Sequence[Row]) -> str:
    return markdown(["", "view", "size", "ms", "shortest", "longest"],
                    [[r["what"], f"`{r['view']}`", f"{r['width']}x{r['height']}",
                      number(r["ms"], 0), number(r["ms_min"], 0), number(r["ms_max"], 0)]
                     for r in rows])


def headlines_table(threads: Sequence[Row], narrow: Sequence[Row]) -> str:
    most = max(in_order(threads, "threads"))

    def span(values: list[float], digits: int, unit: str) -> str:
        ends = dict.fromkeys(number(v, digits) for v in (min(values), max(values)))
        return " to ".join(ends) + " " + unit

    def rate(method: str) -> str:
        rows = select(threads, method=method, filter="none", threads=most)
        return span([r["mpix_per_s"] for r in rows], 0, "MPix/s")

    return markdown(["", "then", "here"], [
        ["`hbao` 8x8 (Bavoil, Sainz, Dimitrov 2008)", "67 MPix/s, GeForce 8800 GTX Ultra",
         rate("hbao")],
        ["`alchemy` 12 with its filter, 1280x720 (McGuire et al. 2011)", "3 ms, GTX 580",
         span([r["ms"] for r in narrow], 1, "ms")],
        ["`hsao` 7x12, one normal ray (Dimitrov, Bavoil, Sainz 2008)",
         "26 MPix/s, GeForce 8800 GTX", rate("hsao")]])


def all_parts(m: Measured) -> dict[str, str]:
    """Every part of docs/performance.md."""
    methods = m.methods()
    threads, growth = m.threads(), m.growth()
    views = [f"`{v.name}`, {v.width}x{v.height}:\n\n{methods_table(m.s, methods, v.name)}"
             for v in m.views]
    return {
        "made-by": f"{m.about['processor']}, {m.about['threads']} threads. crevice "
                   f"{m.about['version']}, {m.about['compiler']}. Instruction set "
                   f"`{in_order(methods, 'isa')[-1]}` unless said otherwise.",
        "headlines": headlines_table(threads, m.narrow()), "methods": "\n\n".join(views),
        "structures": structures_table(methods), "threads": threads_table(threads),
        "pixels": growth_table(growth["pixels"], "MPix", 1),
        "pixels-alone": growth_table(growth["pixels alone"], "MPix", 1),
        "samples": growth_table(growth["samples"], "samples", 0),
        "radius": growth_table(growth["radius"], "factor", 3),
        "filters": filters_table(m.filters()), "memory": memory_table(methods),
        "rays": rays_table(m.rays()), "whole": whole_table(m.whole())}
