#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures with `crevice bench` and writes docs/performance.md.

Usage: docs/performance.py CREVICE [-o PAGE.md] [--shared FOLDER] [--keep FOLDER] [--brief]
       docs/performance.py --from FOLDER [-o PAGE.md]

CREVICE is the tool. With --shared (default: the environment variable CREVICE_SHARED) the
views are sponza and dragon of FOLDER/scenes/cameras.json, else those of the built-in
scenes. --keep keeps the numbers as JSON; --from makes the page of kept ones. --brief:
small pictures, one run each, to try this script. The whole takes about a quarter of an
hour; the machine should do nothing else meanwhile."""
import argparse
import json
import os
import subprocess
import sys
import tempfile

# The parts that are measured, each a run of `crevice bench`.
PARTS = ("methods", "threads", "growth", "parts")

# What pipelines are called on the page: method at medium, filter.
SAMPLES = {"hbao": "8x8", "hsao": "7x12 + 1", "alchemy": "12", "vao": "12"}

# An exponent that counts as linear: over a factor of 300 in pixels it is a third more.
LINEAR = 1.05

# The methods that the papers' headlines and the project's aims are about.
MAIN = ["hbao", "alchemy", "vao", "hsao"]


def number(value, digits=1):
    return "-" if value is None else f"{value:,.{digits}f}".replace(",", " ")


def table(headers, rows):
    lines = ["| " + " | ".join(headers) + " |", "|" + "---|" * len(headers)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def in_order(values):
    return list(dict.fromkeys(values))


def select(rows, **wanted):
    return [r for r in rows if all(r[k] == v for k, v in wanted.items())]


def only(rows, key, **wanted):
    """The number of the one row that is wanted; None where there is none."""
    found = select(rows, **wanted)
    return found[0][key] if found else None


# Measuring.

def run_bench(tool, name, folder, arguments):
    path = os.path.join(folder, name + ".json")
    print(f"{name}: crevice bench {' '.join(arguments)}", file=sys.stderr)
    subprocess.run([tool, "bench", "--quiet", "--json", path, *arguments], check=True,
                   stdout=subprocess.DEVNULL)
    with open(path, encoding="utf-8") as stream:
        return json.load(stream)


def views_of(shared):
    if not shared:
        return ["builtin:courtyard"]
    return ["--views", os.path.join(shared, "scenes", "cameras.json"),
            "--view", "sponza", "--view", "dragon"]


def measure(options, folder):
    views = views_of(options.shared)
    size, hd = ("1920x1080", "1280x720") if not options.brief else ("96x54", "64x36")
    speed = [] if not options.brief else ["--seconds", "0", "--repeats", "1"]
    methods = run_bench(options.tool, "methods", folder,
                        views + ["--only", "methods", "--sizes", size, "--isas", "all",
                                 "--structures", "both"] + speed)
    threads = in_order(["1", str(methods["threads"])])
    filters = "none,bilateral13,box4,gauss5"
    run_bench(options.tool, "threads", folder,
              views + ["--only", "methods", "--sizes", f"{size},{hd}", "--methods",
                       ",".join(MAIN), "--filters", filters, "--isa", methods["isas"][-1],
                       "--threads-list", ",".join(threads)] + speed)
    # Large pictures take longer than half of the default second; they are to be repeated.
    full = ["--repeats", "5", "--seconds", "6", "--full", "--presets", "medium",
            "--filters", "none", "--structures", "fast"]
    run_bench(options.tool, "growth", folder,
              views[:4] + ["--only", "growth", "--sizes", size, "--isa",
                           methods["isas"][-1], "--methods",
                           ",".join(MAIN if not options.brief else MAIN[:1])]
              + (full if not options.brief else []) + speed)
    run_bench(options.tool, "parts", folder,
              views + ["--seconds", "2", "--only", "passes,memory,embree,whole", "--sizes",
                       size, "--isas", "all", "--structures", "both", "--threads-list",
                       ",".join(reversed(threads))] + speed)


def load(folder, shared):
    parts = {}
    for name in PARTS:
        with open(os.path.join(folder, name + ".json"), encoding="utf-8") as stream:
            parts[name] = json.load(stream)
        if shared:  # where it lies on this machine is of no interest
            parts[name]["command"] = parts[name]["command"].replace(
                shared.rstrip("/"), "$CREVICE_SHARED")
    return parts


# Tables.

def best_isa(report):
    return report["isas"][-1]


def frame_title(report, frame):
    row = next(r for r in report["methods"] if r["frame"] == frame)
    return f"`{frame}`, {row['width']}x{row['height']}"


def ceilings(report):
    rows = [[f"`{c['isa']}`", str(c["lanes"])]
            + [number(c[k + "_per_s"] / 1e9, 2) for k in (
                "gather_near", "gather_disk", "load_near", "load_disk", "fma")]
            + [number(c[k + "_cycles"], 1) for k in ("gather_disk", "load_disk")]
            for c in report["ceilings"]]
    streams = [[str(s["threads"]), number(s["read_bytes_per_s"] / 1e9),
                number(s["copy_bytes_per_s"] / 1e9)] for s in report["streams"]]
    return table(["one thread", "lanes", "gather, near", "gather, disk", "load, near",
                  "load, disk", "multiply-add", "cycles of a gather, disk",
                  "of a load, disk"], rows) + "\n" + table(
        ["threads", "read, GB/s", "copy, GB/s (read + written)"], streams)


def methods_by_isa(report, frame):
    isas = report["isas"]
    best = best_isa(report)
    rows = []
    for method in in_order(r["method"] for r in report["methods"]):
        mine = select(report["methods"], frame=frame, method=method)
        fast = {r["isa"]: r for r in mine if r["isa"] == "scalar" or r["structure"] == "fast"}
        top = fast[best]
        rows.append([f"`{method}`", str(top["samples"])]
                    + [number(fast[i]["mpixels_per_s"]) for i in isas]
                    + [number(top["speedup_over_scalar"]), number(top["ms"], 2),
                       number(0.5 * (top["ms_q3"] - top["ms_q1"]), 2),
                       number(top["ns_per_pixel_sample"], 3),
                       number(top["cycles_per_pixel_sample"], 2),
                       share(top["share_of_load"]), share(top["share_of_gather"]),
                       number(top["fma_at_ceiling_per_sample"], 0)])
    return table(["method", "samples"] + [f"`{i}`" for i in isas]
                 + ["over scalar", "ms", "+-", "ns/px/sample", "cycles/px/sample",
                    "of loads", "of gathers", "room for multiply-adds"], rows)


def share(value):
    return "-" if value is None else f"{100 * value:.0f} %"


def fast_and_exact(report):
    best = best_isa(report)
    frames = in_order(r["frame"] for r in report["methods"])
    rows = []
    for method in in_order(r["method"] for r in report["methods"]):
        row = [f"`{method}`"]
        for frame in frames:
            pair = [only(report["methods"], "mpixels_per_s", frame=frame, method=method,
                         isa=best, structure=s) for s in ("fast", "exact")]
            row += [number(pair[0]), number(pair[1]),
                    number(pair[0] / pair[1], 2) if all(pair) else "-"]
        rows.append(row)
    headers = ["method"]
    for frame in frames:
        headers += [f"`{frame}` fast", "exact", "ratio"]
    return table(headers, rows)


def thread_scaling(report):
    counts = in_order(r["threads"] for r in report["methods"])
    size = report["methods"][0]["width"]
    rows = []
    for frame in in_order(r["frame"] for r in report["methods"]):
        for method in MAIN:
            for kind in ("none", "bilateral13"):
                rates = [only(report["methods"], "mpixels_per_s", frame=frame, width=size,
                              method=method, filter=kind, threads=t) for t in counts]
                rows.append([f"`{frame}`", f"`{method}` {SAMPLES[method]}", f"`{kind}`"]
                            + [number(r) for r in rates]
                            + [number(rates[-1] / rates[0], 2)])
    return table(["view", "method", "filter"] + [f"{t} thread{'s' * (t > 1)}"
                                                  for t in counts] + ["ratio"], rows)


def growth(report, over, unit, digits=0, scale=1.0):
    rows = []
    for fit in select(report["growth_fits"], over=over):
        points = select(report["growth"], over=over, method=fit["method"])
        per = "ns_per_pixel_sample" if over == "samples" else "ns_per_pixel"
        rows.append([f"`{fit['method']}`",
                     ", ".join(f"{number(p['x'] * scale, digits)}: {number(p[per], 2)}"
                               for p in points),
                     number(fit["exponent"], 2),
                     number(fit["unit_cost_last_over_first"], 2)])
    cost = "ns/px/sample" if over == "samples" else "ns/px"
    last = "cost of one, last over first"
    if over == "radius":
        return table(["method", f"{unit}: {cost}", "exponent"], [r[:3] for r in rows])
    return table(["method", f"{unit}: {cost}", "exponent", last], rows)


def passes(report):
    isas = in_order(r["isa"] for r in report["passes"])
    threads = max(r["threads"] for r in report["passes"])
    best = isas[0]
    rows = []
    for name in in_order(r["pass"] for r in report["passes"]):
        top = select(report["passes"], **{"pass": name}, isa=best, threads=threads)[0]
        rows.append([name, number(top["ms"], 2)]
                    + [number(only(report["passes"], "mpixels_per_s", **{"pass": name},
                                   isa=i, threads=threads), 0) for i in isas]
                    + [number(only(report["passes"], "mpixels_per_s", **{"pass": name},
                                   isa=best, threads=1), 0), share(top["share_of_copy"])])
    return table(["pass", "ms"] + [f"`{i}`, MPix/s" for i in isas]
                 + ["one thread", "of streaming"], rows)


def memory(report):
    rows = [[f"`{r['method']}`", f"`{r['filter']}`", r["structure"],
             number(r["bytes_per_pixel"]), str(int(r["run_allocations"]))]
            for r in report["memory"]]
    return table(["method", "filter", "structure", "bytes/px", "allocations of a run"], rows)


def embree(report):
    rows = [[f"`{r['frame']}`", f"`{r['method']}`", f"`{r['filter']}`", r["target"],
             number(r["ms"], 2), number(r["rmse"], 4), number(r["rays_for_same_rmse"]),
             number(r["exponent"], 2), number(r["ray_tracing_ms"], 0),
             number(r["speedup_over_ray_tracing"])]
            for r in report["embree"]]
    return table(["view", "method", "filter", "integral", "ms", "RMSE", "rays for it",
                  "p", "ray tracing, ms", "times faster"], rows)


def whole(report):
    return table(["", "view", "size", "ms", "+-"],
                 [[r["what"], f"`{r['frame']}`", f"{r['width']}x{r['height']}",
                   number(r["ms"], 0), number(0.5 * (r["ms_q3"] - r["ms_q1"]), 0)]
                  for r in report["whole"]])


# What was wanted and what was reached.

def rates(report, key, frames, **wanted):
    values = [only(report, key, frame=f, **wanted) for f in frames]
    return [v for v in values if v is not None]


def aim_row(what, values, aim, unit, at_least=True):
    """All views must reach it."""
    if not values:
        return [what, "-", f"{aim} {unit}", "-"]
    worst = min(values) if at_least else max(values)
    met = worst >= aim if at_least else worst <= aim
    digits = 2 if aim < 10 else 0
    span = " to ".join(in_order(number(v, digits) for v in (min(values), max(values))))
    limit = "at least" if at_least else "at most"
    return [what, f"{span} {unit}".rstrip(), f"{limit} {aim} {unit}".rstrip(),
            "yes" if met else "no"]


def aims(parts):
    runs = parts["threads"]["methods"]
    frames = in_order(r["frame"] for r in runs)
    wide, narrow = (max(r["width"] for r in runs), min(r["width"] for r in runs))
    most = max(r["threads"] for r in runs)
    main = {"width": wide, "threads": most}

    def speed(method, kind="none"):
        return rates(runs, "mpixels_per_s", frames, method=method, filter=kind, **main)

    def of_pass(name):
        return [r["mpixels_per_s"] for r in select(
            parts["parts"]["passes"], **{"pass": "filter " + name}, threads=most,
            isa=parts["parts"]["isas"][-1])]

    rows = [
        aim_row("`hbao` 8x8", speed("hbao"), 90, "MPix/s"),
        aim_row("`hbao` 8x8 and `bilateral13`", speed("hbao", "bilateral13"), 65, "MPix/s"),
        aim_row("`alchemy` 12", speed("alchemy"), 250, "MPix/s"),
        aim_row("`alchemy` 12 and `bilateral13` at 1280x720",
                rates(runs, "ms", frames, method="alchemy", filter="bilateral13",
                      width=narrow, threads=most), 6.5, "ms", at_least=False),
        aim_row("`vao` 12", speed("vao"), 130, "MPix/s"),
        aim_row("`hsao` 7x12 and one normal ray", speed("hsao"), 12, "MPix/s"),
        aim_row("filter `bilateral13`", of_pass("bilateral13"), 350, "MPix/s"),
        aim_row("filter `box4`", of_pass("box4"), 500, "MPix/s"),
        aim_row("filter `gauss5`", of_pass("gauss5"), 500, "MPix/s"),
    ]
    rows += other_aims(parts, frames, wide, most)
    return table(["", "reached", "aim", "met"], rows)


def other_aims(parts, frames, wide, most):
    runs, methods = parts["threads"]["methods"], parts["methods"]["methods"]
    rows = []
    if {"avx2", "avx512"} <= set(parts["methods"]["isas"]):
        shares = [only(methods, "mpixels_per_s", frame=f, method=m, isa="avx2",
                       structure="fast")
                  / only(methods, "mpixels_per_s", frame=f, method=m, isa="avx512",
                         structure="fast") for f in frames for m in MAIN]
        rows.append(aim_row("AVX2 of AVX-512", shares, 0.55, ""))
    if most == 2:
        pairs = [only(runs, "mpixels_per_s", frame=f, method=m, filter="none", width=wide,
                      threads=2)
                 / only(runs, "mpixels_per_s", frame=f, method=m, filter="none", width=wide,
                        threads=1) for f in frames for m in MAIN]
        rows.append(aim_row("two threads over one", pairs, 1.85, ""))
    for over in ("pixels", "samples"):
        fits = [f["exponent"] for f in select(parts["growth"]["growth_fits"], over=over)
                if f["exponent"] is not None]
        rows.append(aim_row(f"time over {over}, exponent", fits, LINEAR, "",
                            at_least=False))
    rows.append(aim_row("whole run of `crevice ao`",
                        [r["ms"] for r in parts["parts"]["whole"][:1]], 500, "ms",
                        at_least=False))
    rows.append(aim_row("memory beyond input and output",
                        [r["bytes_per_pixel"] for r in parts["parts"]["memory"]], 48,
                        "bytes/px", at_least=False))
    return rows


def headlines(parts):
    runs = parts["threads"]["methods"]
    frames = in_order(r["frame"] for r in runs)
    wide, narrow = (max(r["width"] for r in runs), min(r["width"] for r in runs))
    most = max(r["threads"] for r in runs)

    def span(values, digits, unit):
        return " to ".join(in_order(
            number(v, digits) for v in (min(values), max(values)))) + " " + unit

    return table(["", "then", "here"], [
        ["`hbao` 8x8 (Bavoil, Sainz, Dimitrov 2008)", "67 MPix/s, GeForce 8800 GTX Ultra",
         span(rates(runs, "mpixels_per_s", frames, method="hbao", filter="none",
                    width=wide, threads=most), 0, "MPix/s")],
        ["`alchemy` 12 with its filter, 1280x720 (McGuire et al. 2011)", "3 ms, GTX 580",
         span(rates(runs, "ms", frames, method="alchemy", filter="bilateral13",
                    width=narrow, threads=most), 1, "ms")],
        ["`hsao` 7x12, one normal ray (Dimitrov, Bavoil, Sainz 2008)",
         "26 MPix/s, GeForce 8800 GTX",
         span(rates(runs, "mpixels_per_s", frames, method="hsao", filter="none",
                    width=wide, threads=most), 0, "MPix/s")],
    ])


# The page.

GPU_NOT_MEASURED = """\
Nothing here was measured on a GPU, only what two threads of a processor do; `crevice bench --device vulkan`
gives the steps of every method there, and [gpu.md](gpu.md) the bytes that they move.
`docs/performance_gpu.py` makes a page of a GPU.
"""
GPU_MEASURED = """\
Nothing here was measured on a GPU, only what threads of a processor do;
[performance_gpu.md](performance_gpu.md) says what one does.
"""
PAGE = """# How fast

Made by `{own_command}`; the numbers are of these runs:

```
{commands}
```

{machine}. crevice {version}, {compiler}.

Frames lie in memory, converted, when the clock starts; a run is `crv_plan_run()`: estimate, filter where
there is one, result. One run warms up, then there are {repeats} or more, for a tenth of a second at
least; the median is given, and behind +- half the distance between the quartiles. A first run that takes
half of `--seconds` is the only one. Samples are the look-ups in the buffers for each pixel. Presets are
`medium`, {threads}. {cycles}

{gpu}
## What was wanted

{aims}
What the papers needed a graphics card for:

{headlines}
## What the machine can do

10^9 floats a second: gathers read every lane from a place of its own, loads read neighbours (unaligned);
near: from 16 KiB, so from the first cache; disk: at 64 places of a disk of 64 px around pixels that follow
each other in a picture of 1920 columns, as estimators read. They are measured in the same run as what is
compared with them, on one thread; shares below take them times the threads. What a kernel that gathers
stays below 100 % of gathers, and one that loads below 100 % of loads, is spent on arithmetic; only where its
samples lie nearer than that disk can it come above. Room for multiply-adds is how many of them the machine could do in the time of one sample.
Streaming is of 128 MiB, which no cache holds.

{ceilings}
## Methods and instruction sets

Millions of pixels a second; the columns after them are of `{best}`.

{methods}
## Fast and exact

By default kernels may move samples by a part of a pixel's footprint, so that neighbouring pixels read side
by side (`hbao`, `alchemy`, `vo`), or round positions otherwise (`hsao`, `raymarch`, `containment`); with
`--exact` they sample where the plain code does. `crevice report --only structure` shows the errors and pictures
of both. Millions of pixels a second, `{best}`. `vao` and `ssao` have one way only: their ratio is 1 but for
the machine's moods.

{exact}
## Threads

Millions of pixels a second, {wide}.

{threads_table}
## Growth

Exponent p of time ~ x^p, fitted to all points: 1 is linear.

Pixels, in millions. The radius is the same part of the picture at every size, so samples lie farther apart
in memory in large ones.

{pixels}
Pixels alone: the radius spans as many of them at every size as it does in 1280x720.

{pixels_alone}
Samples:

{samples}
Radius, as a factor of the view's own; the number of samples is the same.

{radius}
## Before and after the estimate

Each pass by itself, on {first}. Normals are converted when they are first needed, so they are measured
with an estimate of one pixel behind them; filters are what a run with one takes longer than a run
without. Of streaming: bytes that have to be read and written, against the copy rate above.

{passes}
## Memory

What a G-buffer and a plan take through the allocator hook, beyond the host's input and output, and how
often a run calls it.

{memory}
## Ray tracing to the same error

How long Embree would take for the same picture with the same error, on the same threads. The error is
RMSE against 512 rays a pixel, over the surface in blocks of 8x8 px that are spread over the picture. Ray
tracing is not run to that error but extrapolated: its error is taken to fall as n^-p with the number n of
rays, p measured between 16 and 64 rays. Where the estimate's error is mostly a bias, few rays reach it;
their picture is noisy where the estimate's is smooth.

{embree}
## The whole tool

`crevice ao` as a process of its own, from an EXR file with depth and normals to an EXR file with the
result, and what reading and writing take of it.

{whole}
## To measure this yourself

`crevice bench` prints such tables for your machine, scenes and frames in a minute; `crevice help bench`
tells how to choose. `docs/performance.py build/gcc/tools/crevice/crevice` makes this page; with
`CREVICE_SHARED` set, of the scenes that lie there. Let the machine do nothing else meanwhile.
"""


def gpu_text():
    """Whether docs/performance_gpu.py has been at work."""
    there = os.path.exists(os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                        "performance_gpu.md"))
    return GPU_MEASURED if there else GPU_NOT_MEASURED


def cycles_text(report):
    return {
        "counter": "Cycles are those of the processor's counter, of all threads, waiting included.",
        "clock": "The processor's cycle counter cannot be read on this machine; cycles are "
                 f"processor time at {report['clock_ghz']:.2f} GHz, the clock of a chain of "
                 "additions, waiting threads included.",
        "none": "Cycles are not known on this machine.",
    }[report["cycles_from"]]


def write_page(parts, own_command):
    first = parts["methods"]
    frames = in_order(r["frame"] for r in first["methods"])
    wide = next(r for r in first["methods"])
    per_view = "".join(f"{frame_title(first, f)}:\n\n{methods_by_isa(first, f)}\n"
                       for f in frames)
    threads = first["threads"]
    return PAGE.format(
        own_command=own_command,
        commands="\n".join(parts[p]["command"] for p in PARTS),
        machine=f"{first['processor']}, {threads} thread{'s' * (threads > 1)}",
        version=first["version"], compiler=first["compiler"],
        repeats=first["repeats"], cycles=cycles_text(first), gpu=gpu_text(),
        threads=f"and threads {threads}, where nothing else is said",
        aims=aims(parts), headlines=headlines(parts), ceilings=ceilings(first),
        best=best_isa(first), methods=per_view.rstrip("\n") + "\n",
        exact=fast_and_exact(first), wide=f"{wide['width']}x{wide['height']}",
        threads_table=thread_scaling(parts["threads"]),
        pixels=growth(parts["growth"], "pixels", "MPix", 1, 1e-6),
        pixels_alone=growth(parts["growth"], "pixels_alone", "MPix", 1, 1e-6),
        samples=growth(parts["growth"], "samples", "samples"),
        radius=growth(parts["growth"], "radius", "factor", 3),
        first=frame_title(first, parts["parts"]["passes"][0]["frame"]),
        passes=passes(parts["parts"]), memory=memory(parts["parts"]),
        embree=embree(parts["parts"]), whole=whole(parts["parts"]))


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawTextHelpFormatter)
    here = os.path.dirname(os.path.abspath(__file__))
    parser.add_argument("tool", nargs="?", metavar="CREVICE")
    parser.add_argument("-o", "--output", default=os.path.join(here, "performance.md"))
    parser.add_argument("--shared", default=os.environ.get("CREVICE_SHARED"))
    parser.add_argument("--keep")
    parser.add_argument("--from", dest="kept")
    parser.add_argument("--brief", action="store_true")
    options = parser.parse_args(arguments)
    if (options.tool is None) == (options.kept is None):
        parser.error("give the tool, or --from FOLDER")
    return options


def main(arguments):
    options = parse(arguments)
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.kept or options.keep or temporary
        os.makedirs(folder, exist_ok=True)
        if not options.kept:
            measure(options, folder)
        parts = load(folder, options.shared)
    shown = "docs/performance.py" + (" --brief" if options.brief else "")
    with open(options.output, "w", encoding="utf-8") as stream:
        stream.write(write_page(parts, shown + " CREVICE"))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
