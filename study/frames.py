# SPDX-License-Identifier: MIT
"""Frames that a renderer wrote, with its own pass of ambient occlusion: how near `crevice ao`
comes to that pass, with nothing but the field of view and the radius."""
import os
from pathlib import Path
from typing import Any

from .options import Registry
from .tables import markdown, number
from .tool import Tool
from .views import ViewError, read_list

FOLDER = "blender"  # beside a list of views: NAME.exr is the frame of the view NAME


def found(lists: list[str]) -> list[dict[str, Any]]:
    """The views that have a frame, and the frame's path."""
    views = [view | {"frame": Path(path).parent / FOLDER / f"{view['name']}.exr"}
             for path in lists for view in read_list(path)]
    return [view for view in views if os.path.isfile(view["frame"])]


def rmse(tool: Tool, view: dict[str, Any], flags: list[str]) -> float:
    """The distance from the renderer's pass."""
    made = tool.make("ao", [str(view["frame"]), "--vfov", f"{view['vfov_degrees']:.9g}",
                            "--radius", f"{view['radius']:.9g}", "--falloff", "none", *flags])
    distance: float = tool.ask("compare", [str(made), str(view["frame"]), "--json"])["rmse"]
    return distance


def table(tool: Tool, lists: list[str]) -> str:
    views = found(lists)
    if not views:
        raise ViewError(f"no view of --views has a frame {FOLDER}/NAME.exr beside the list")
    methods = list(Registry(tool.ask("methods", ["--json"])).methods)
    return markdown(["frame", "no option", *(f"`{m}`" for m in methods)],
                    [[view["name"], number(rmse(tool, view, []), 4),
                      *(number(rmse(tool, view, ["--method", m]), 4) for m in methods)]
                     for view in views])
