#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""On a machine with a GPU: runs the Vulkan tests and `crevice bench` there, and writes
docs/performance_gpu.md, to which docs/performance.md then refers.

Usage: docs/performance_gpu.py CREVICE [--build FOLDER] [--device vulkan:N] [--size WxH]
                               [--shared FOLDER] [-o PAGE.md] [--json FOLDER] [--brief]

CREVICE is the tool. --build: the build folder, whose tests with the label `vulkan` (conformance,
agreement with the scalar code, validation) are run first, on the first device. With --shared
(default: the environment variable CREVICE_SHARED) the view is sponza of
FOLDER/scenes/cameras.json, else a built-in scene. --json keeps the numbers. --brief: small
pictures, one run each, to try this script; it and devices that are CPUs ask for -o, so that
their numbers never pass for those of a GPU."""
import argparse
import datetime
import json
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
# ms at 3840x2160, estimate and filter together.
AIMS = {"hbao": 1.0, "alchemy": 0.4}
sys.path.insert(0, HERE)
from performance import GPU_MEASURED, GPU_NOT_MEASURED, number, table  # noqa: E402

PAGE = """# How fast on a GPU

Made by `docs/performance_gpu.py CREVICE` on {date}, of `{command}`:

- device: {device}
- crevice {version}, {compiler}
- tests with the label `vulkan`: {tests}

Times are the device's own, of steps of a plan at `medium`, the median of the runs; copies between host and device
are left out. A plan keeps normals and accessibility in 32 bits, where a pass in a host's command buffer has 16
({gpu_md} counts its bytes).

## What was wanted

{aims}
## Estimates and filters

{steps}
"""


def device_of(tool, name):
    """The line of `crevice devices` about the device."""
    wanted = name if ":" in name else name + ":0"
    lines = subprocess.run([tool, "devices"], check=True, text=True,
                           stdout=subprocess.PIPE).stdout.splitlines()
    for line in lines:
        if line.split()[:1] == [wanted]:
            return line.split(None, 1)[1]
    sys.exit(f"{wanted}: there is no such device; see `{tool} devices`")


def run_tests(build):
    """What the tests said, in a line."""
    if not build:
        return "not run"
    made = subprocess.run(["ctest", "-L", "vulkan"], cwd=build, check=False, text=True,
                          stdout=subprocess.PIPE)
    print(made.stdout, file=sys.stderr)
    passed = re.search(r"\d+% tests passed, \d+ tests failed out of \d+", made.stdout)
    skipped = made.stdout.count("Skipped")
    return (passed[0] if passed else "no tests") + (f", {skipped} skipped" if skipped else "")


def measure(options, folder):
    path = os.path.join(folder, "gpu.json")
    views = ["--views", os.path.join(options.shared, "scenes", "cameras.json"), "--view",
             "sponza"] if options.shared else ["builtin:courtyard"]
    speed = ["--repeats", "1", "--seconds", "0"] if options.brief else ["--repeats", "25"]
    arguments = views + ["--device", options.device, "--only", "device", "--sizes",
                         options.size, "--filters", "none,bilateral13,box4,gauss5", "--layouts",
                         "all", "--arithmetic", "both", "--radii", "1,3"] + speed
    if options.brief:
        arguments += ["--methods", "hbao,alchemy"]
    print(f"crevice bench {' '.join(arguments)}", file=sys.stderr)
    subprocess.run([options.tool, "bench", "--quiet", "--json", path, *arguments], check=True,
                   stdout=subprocess.DEVNULL)
    with open(path, encoding="utf-8") as stream:
        return json.load(stream)


def is_step(row):
    return row["step"] not in ("upload", "download")


def case_of(row):
    return tuple(row[k] for k in ("method", "filter", "radius_factor", "layout", "arithmetic"))


def aims_table(report):
    rows = []
    for method, aim in AIMS.items():
        cases = {}
        for row in report["device_steps"]:
            if is_step(row) and case_of(row)[:3] == (method, "bilateral13", 1):
                cases.setdefault(case_of(row), []).append(row)
        case, steps = min(cases.items(), key=lambda c: sum(r["ms"] for r in c[1]))
        ms = sum(r["ms"] for r in steps)
        size = f"{steps[0]['width']}x{steps[0]['height']}"
        rows.append([f"`{method}` and `bilateral13`, {size}, depth {case[3]}, {case[4]}",
                     number(ms, 3), number(aim, 1), "yes" if ms < aim else "no"])
    return table(["the fastest way", "ms", "aim at 3840x2160", "met"], rows)


def steps_table(report):
    rows, first = [], {}
    for row in report["device_steps"]:
        method, name, radius, layout, arithmetic = case_of(row)
        is_filter = row["step"] == name
        # A filter once, whatever was before it; an estimate once, whatever comes after.
        key = ((name, arithmetic, row["step"]) if is_filter
               else (method, radius, layout, row["step"]))
        if row["step"] == "box4" and arithmetic == "half":
            continue  # it has none
        if not is_step(row) or first.setdefault(key, case_of(row)) != case_of(row):
            continue
        rows.append([f"`{row['step']}`" + ("" if is_filter else f" of `{method}`"
                                           if row["step"] != method else ""),
                     "-" if is_filter else number(radius, 0), "-" if is_filter else layout,
                     arithmetic if is_filter else "-", number(row["ms"], 3),
                     number(row["mpixels_per_s"], 0)])
    return table(["step", "radius", "depth", "filter in", "ms", "MPix/s"], rows)


def write_page(report, options, device, tests):
    command = report["command"]
    if options.shared:  # where it lies on this machine is of no interest
        command = command.replace(options.shared.rstrip("/"), "$CREVICE_SHARED")
    return PAGE.format(date=datetime.date.today().isoformat(), command=command, device=device,
                       version=report["version"], compiler=report["compiler"], tests=tests,
                       gpu_md="[gpu.md](gpu.md)",
                       aims=aims_table(report), steps=steps_table(report))


def refer():
    """docs/performance.md tells of the page."""
    path = os.path.join(HERE, "performance.md")
    with open(path, encoding="utf-8") as stream:
        text = stream.read()
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(text.replace(GPU_NOT_MEASURED, GPU_MEASURED))


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("tool", metavar="CREVICE")
    parser.add_argument("--build")
    parser.add_argument("--device", default="vulkan")
    parser.add_argument("--size", default="3840x2160")
    parser.add_argument("--shared", default=os.environ.get("CREVICE_SHARED"))
    parser.add_argument("-o", "--output")
    parser.add_argument("--json")
    parser.add_argument("--brief", action="store_true")
    options = parser.parse_args(arguments)
    device = device_of(options.tool, options.device)
    if (options.brief or "a CPU" in device) and not options.output:
        parser.error(f"{device} is no GPU, or the run a brief one: say with -o where the page "
                     "goes")
    tests = run_tests(options.build)
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.json or temporary
        os.makedirs(folder, exist_ok=True)
        report = measure(options, folder)
    output = options.output or os.path.join(HERE, "performance_gpu.md")
    with open(output, "w", encoding="utf-8") as stream:
        stream.write(write_page(report, options, device, tests))
    if not options.output:
        refer()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
