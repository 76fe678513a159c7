# SPDX-License-Identifier: MIT
"""Views: a model, a camera, a radius and a size."""
import dataclasses
import json
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .tool import Tool, ToolError

# Two looks closer at what the courtyard's own view shows small: gears, and grass.
COURTYARD = [
    {"name": "courtyard", "file": "builtin:courtyard"},
    {"name": "courtyard-machine", "file": "builtin:courtyard", "eye": [1.75, 1.35, 3.6],
     "target": [2.68, 0.92, 0.7], "vfov_degrees": 40},
    {"name": "courtyard-grass", "file": "builtin:courtyard", "eye": [-1.75, 0.85, 3.35],
     "target": [-3.7, 0.18, 0.3], "vfov_degrees": 40},
]
# Thin things, whose backs a depth buffer does not hold.
THIN = [{"name": name, "file": f"builtin:{name}"} for name in ("blades", "leaves", "bars")]

CAMERA = re.compile(r"--eye (\S+) --target (\S+) --up (\S+) (--vfov|--ortho) (\S+)")
RADIUS = re.compile(r"--radius (\S+), chosen")
TRIANGLES = re.compile(r": (\d+) triangles")


class ViewError(Exception):
    """A view that cannot be measured; says which and why."""


@dataclass(frozen=True)
class View:
    name: str
    model: str
    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    up: tuple[float, float, float]
    field: float  # degrees; of an orthographic view the height, scene units
    radius: float  # scene units
    width: int
    height: int
    is_ortho: bool = False
    triangles: int = 0

    def camera(self) -> list[str]:
        """The camera as arguments of the tool."""
        vectors = [",".join(f"{x:.9g}" for x in v) for v in (self.eye, self.target, self.up)]
        return ["--eye", vectors[0], "--target", vectors[1], "--up", vectors[2],
                "--ortho" if self.is_ortho else "--vfov", f"{self.field:.9g}"]

    def arguments(self) -> list[str]:
        return [self.model, "--size", f"{self.width}x{self.height}", *self.camera()]

    def resized(self, scale: float) -> "View":
        return dataclasses.replace(self, width=max(1, round(self.width * scale)),
                                   height=max(1, round(self.height * scale)))

    def with_radius(self, radius: float) -> "View":
        return dataclasses.replace(self, radius=radius)

    def axes(self) -> np.ndarray:
        """Rows: right, up and back of the camera, in world space."""
        back = np.subtract(self.eye, self.target)
        back = back / np.linalg.norm(back)
        right = np.cross(self.up, back)
        right = right / np.linalg.norm(right)
        return np.array([right, np.cross(back, right), back])

    def moved(self, distance: float) -> "View":
        """Eye and target go to the right, and half as far up in the picture, so that points
        cross both rows and columns of pixels."""
        right, up, _ = self.axes()
        by = distance * (right + 0.5 * up) / math.sqrt(1.25)
        return dataclasses.replace(self, eye=tuple(map(float, np.add(self.eye, by))),
                                   target=tuple(map(float, np.add(self.target, by))))

    def focal_px(self) -> float:
        """Pixels for each unit at distance 1, or, orthographic, anywhere."""
        half = 0.5 * self.field if self.is_ortho else math.tan(math.radians(self.field) / 2)
        return 0.5 * self.height / half

    def radius_px(self, depth: np.ndarray) -> np.ndarray:
        """The projected radius of each pixel, px."""
        return self.radius * self.focal_px() / (np.ones_like(depth) if self.is_ortho else depth)


def unique_name(model: str, taken: set[str]) -> str:
    """"models/Old hall.glb" is the view "Old-hall"; a second one of that name "Old-hall-2"."""
    base = Path(model.removeprefix("builtin:")).stem
    base = re.sub(r"[^A-Za-z0-9]", "-", base)[:40]
    name, number = base, 2
    while name in taken:
        name, number = f"{base}-{number}", number + 1
    return name


def read_list(path: str) -> list[dict[str, Any]]:
    """The views of a JSON file, their models' files relative to it."""
    try:
        views = json.loads(Path(path).read_text(encoding="utf-8"))["views"]
    except (OSError, UnicodeDecodeError) as fault:
        raise ViewError(f"{path}: cannot be read ({fault}); name a list of views") from fault
    except (json.JSONDecodeError, TypeError, KeyError) as fault:
        raise ViewError(f"{path}: is no JSON with a list \"views\" ({fault})") from fault
    if not isinstance(views, list) or not views:
        raise ViewError(f"{path}: its list \"views\" is empty; give it views")
    for number, view in enumerate(views, 1):
        fault = fault_of(view)
        if fault:
            raise ViewError(f"{path}: view {number}: {fault}")
        if not view["file"].startswith("builtin:"):
            view["file"] = str(Path(path).parent / view["file"])
    return views


def fault_of(view: Any) -> str | None:
    """What is wrong with a view of a list."""
    if not isinstance(view, dict):
        return "is no object; write {\"name\": ..., \"file\": ...}"
    if not re.fullmatch(r"[A-Za-z0-9_-]{1,40}", str(view.get("name", ""))):
        return "\"name\" is no word of letters, digits, - and _"
    if not isinstance(view.get("file"), str):
        return "\"file\" is no text; name a model"
    for key, needed in (("eye", True), ("target", True), ("up", False)):
        if (needed and "eye" in view or key in view) and not is_vector(view.get(key)):
            return f"\"{key}\" is no list of three numbers"
    if "eye" in view and not is_number(view.get("vfov_degrees")):
        return "\"vfov_degrees\" is no number"
    if "radius" in view and not (is_number(view["radius"]) and view["radius"] > 0):
        return "\"radius\" is no number above 0"
    return None


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) \
        and math.isfinite(value)


def is_vector(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(map(is_number, value))


def framed(tool: Tool, entry: dict[str, Any], width: int, height: int) -> View:
    """The view of an entry of a list. Camera and radius are the tool's own choice if the
    entry has none."""
    arguments = [entry["file"], "--size", f"{width}x{height}"]
    if "eye" in entry:
        vectors = {k: ",".join(f"{x:.9g}" for x in entry.get(k, (0, 1, 0)))
                   for k in ("eye", "target", "up")}
        arguments += [word for k, v in vectors.items() for word in ("--" + k, v)]
        arguments += ["--vfov", f"{entry['vfov_degrees']:.9g}"]
    notes = tool.notes(tool.make("reference", [*arguments, "--rays", "1"]))
    camera, radius = CAMERA.search(notes), RADIUS.search(notes)
    triangles = TRIANGLES.search(notes)
    if not camera or not (radius or "radius" in entry):
        raise ToolError(f"{entry['file']}: the tool told no camera or radius:\n{notes}")
    eye, target, up = (tuple(float(x) for x in camera[i].split(",")) for i in (1, 2, 3))
    return View(entry["name"], entry["file"], eye, target, up, float(camera[5]),
                entry["radius"] if "radius" in entry else float(radius[1]), width, height,
                camera[4] == "--ortho", int(triangles[1]) if triangles else 0)


def collect(tool: Tool, models: list[str], lists: list[str], width: int, height: int
            ) -> list[View]:
    """Views of models and of lists; without any, those of scenes made in code."""
    entries: list[dict[str, Any]] = []
    for model in models:
        name = unique_name(model, {e["name"] for e in entries})
        entries.append({"name": name, "file": model})
    for path in lists:
        entries += read_list(path)
    entries = entries or COURTYARD + THIN
    names = [e["name"] for e in entries]
    for name in names:
        if names.count(name) > 1:
            raise ViewError(f"two views are named \"{name}\"; give each its own name")
    return [framed(tool, entry, width, height) for entry in entries]
