# SPDX-License-Identifier: MIT
"""Arguments, the order of the sections, and the page."""
import argparse
import os
import re
import shlex
import sys
from pathlib import Path

from . import docs
from .images import PictureError
from .measure import Study
from .options import Registry
from .page import Page
from .progress import Progress
from .sections import (Step, alchemy, bent, closed_forms, filters, hbao, hsao, methods, missing,
                       stability, structure, vao, views as view_section)
from .tables import PageError
from .tool import Tool, ToolError, find_tool
from .views import View, ViewError, collect

SECTIONS = {"methods": methods.steps, "missing": missing.steps, "filters": filters.steps,
            "bent": bent.steps,
            "structure": structure.steps,
            "hsao": hsao.steps, "hbao": hbao.steps, "alchemy": alchemy.steps, "vao": vao.steps,
            "closed-forms": closed_forms.steps, "stability": stability.steps}


def size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d+)x(\d+)", text)
    if not found or int(found[1]) < 64 or int(found[2]) < 36:
        raise argparse.ArgumentTypeError(f'"{text}" is no size; give WIDTHxHEIGHT, 64x36 at '
                                         "least")
    return int(found[1]), int(found[2])


def rays(text: str) -> int:
    if not text.isdigit() or not 16 <= int(text) <= 65536:
        raise argparse.ArgumentTypeError(f'"{text}" is no number of 16 to 65536')
    return int(text)


def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(
        prog="study/run", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Measures every method and preset against ray tracing, on your models, and "
                    "writes DIR/index.html.",
        epilog="What was measured is kept in DIR/cache: a run that was interrupted goes on where "
               "it was.\nA list of views is {\"views\": [{\"name\": \"hall\", \"file\": "
               "\"hall.glb\", \"eye\": [-8, 1, 0],\n\"target\": [0, 3, 0], \"up\": [0, 1, 0], "
               "\"vfov_degrees\": 60, \"radius\": 1}, ...]}: the file relative\nto the list, the "
               "radius in scene units; camera, up and radius may be left out.\n\n"
               "  study/run -o out/study --quick\n"
               "  study/run hall.glb engine.glb -o out/study --size 1280x720")
    made.add_argument("models", nargs="*", metavar="MODEL",
                      help="mesh files or builtin:NAME, each framed by itself; without any, "
                           "views of scenes made in code")
    made.add_argument("-o", "--output", type=Path, metavar="DIR", help="folder for the page")
    made.add_argument("--views", action="append", default=[], metavar="FILE.json",
                      help="a list of views of models")
    made.add_argument("--main", metavar="NAME",
                      help="the view that the papers' statements are measured on [the first]")
    made.add_argument("--only", action="append", choices=SECTIONS, metavar="SECTION",
                      help=f"one of {', '.join(SECTIONS)}; may be given again [all]")
    made.add_argument("--size", type=size, metavar="WxH", help="of the pictures [640x360]")
    made.add_argument("--rays", type=rays, metavar="N",
                      help="rays of the references for each pixel, at most [128]")
    made.add_argument("--quick", action="store_true",
                      help="small pictures, few rays and draws, one view: under two minutes")
    made.add_argument("--tool", metavar="FILE", help="the program crevice [the newest build]")
    made.add_argument("--threads", type=int, metavar="N", help="of the tool [all processors]")
    made.add_argument("--device", default="cpu", metavar="NAME", help="what estimates [cpu]")
    made.add_argument("--isa", metavar="NAME", help="instruction set of the CPU's kernels")
    made.add_argument("--quiet", "-q", action="store_true", help="tell nothing but errors")
    docs.add_arguments(made)
    return made


def make_tool(arguments: argparse.Namespace) -> Tool:
    common = ["--threads", str(arguments.threads)] if arguments.threads else []
    timed = ["--device", arguments.device] if arguments.device != "cpu" else []
    timed += ["--isa", arguments.isa] if arguments.isa else []
    return Tool(find_tool(arguments.tool), arguments.output.resolve() / "cache", common, timed)


def refuse_inputs(arguments: argparse.Namespace) -> None:
    """What is read is not to be written over."""
    written = [(arguments.output / name).resolve() for name in ("report.json", "index.html")]
    for path in arguments.views + arguments.models:
        if Path(path).resolve() in written:
            raise ViewError(f"{path}: is an input; name another folder with -o")


def choose_main(views: list[View], name: str | None) -> View:
    found = [v for v in views if name in (None, v.name)]
    if not found:
        raise ViewError(f"--main: there is no view \"{name}\"; choose one of "
                        f"{', '.join(v.name for v in views)}")
    return found[0]


def make_study(arguments: argparse.Namespace, tool: Tool, page: Page) -> Study:
    is_quick = arguments.quick
    width, height = arguments.size or ((320, 180) if is_quick else (640, 360))
    views = collect(tool, arguments.models, arguments.views, width, height)
    main = choose_main(views, arguments.main)
    if is_quick and not (arguments.models or arguments.views):
        views = [main]
    return Study(tool, Registry(tool.ask("methods", ["--json"])), page,
                 Progress(arguments.quiet), views, main, arguments.rays or (48 if is_quick else 128),
                 is_quick)


def in_folder(arguments: argparse.Namespace, folder: Path) -> argparse.Namespace:
    return argparse.Namespace(**vars(arguments) | {"output": folder})


def docs_study(arguments: argparse.Namespace, folder: Path, lists: list[str]) -> Study:
    """The study that docs/ is measured with: its views are those of the lists."""
    chosen = in_folder(arguments, folder)
    chosen.views = lists
    chosen.size = chosen.size or (1280, 720)
    return make_study(chosen, make_tool(chosen), Page(folder))


def steps_of(study: Study, only: list[str] | None) -> list[Step]:
    steps = view_section.steps(study)
    for name, section in SECTIONS.items():
        if only is None or name in only:
            steps += section(study)
    return steps + view_section.references_steps(study)


def run(study: Study, steps: list[Step]) -> None:
    study.progress.plan([step.weight for step in steps])
    for step in steps:
        runs = study.tool.runs
        if step.weight > 0:
            study.progress.begin(step.title)
        step.run()
        study.progress.end(step.weight, study.tool.runs == runs)


def processor() -> str:
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        text = ""
    found = re.search(r"^model name\s*:\s*(.*)$", text, re.M)
    return found[1].strip() if found else os.uname().machine


def write_page(arguments: argparse.Namespace, study: Study) -> None:
    words = ["study/run", *map(os.path.basename, arguments.models), "-o", "DIR"]
    words += [w for path in arguments.views for w in ("--views", os.path.basename(path))]
    words += ["--size", f"{study.main.width}x{study.main.height}", "--rays", str(study.rays)]
    words += ["--quick"] if study.is_quick else []
    study.page.write(command=shlex.join(words), version=study.registry.version,
                     processor=processor(), threads=arguments.threads or os.cpu_count(),
                     device=arguments.device, main=study.main.name)


def main(words: list[str]) -> int:
    arguments = parser().parse_args(words)
    if not arguments.output:
        parser().error("name the folder for the page with -o DIR")
    try:
        refuse_inputs(arguments)
        if arguments.docs:
            docs.run(arguments, lambda folder, lists: docs_study(arguments, folder, lists),
                     lambda folder: make_tool(in_folder(arguments, folder)))
            return 0
        study = make_study(arguments, make_tool(arguments), Page(arguments.output))
        run(study, steps_of(study, arguments.only))
        write_page(arguments, study)
    except (ToolError, ViewError, PictureError, PageError, OSError) as fault:
        print(f"study: {fault}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("study: stopped; the same command goes on from here", file=sys.stderr)
        return 130
    study.progress.finish(str(arguments.output / "index.html"))
    return 0
