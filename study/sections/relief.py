# SPDX-License-Identifier: MIT
"""Height fields (Szirmay-Kalos et al. 2010, Figure 12): relief that the mesh does not have.

The estimate sees a flat floor and a map of heights. The truth is traced in a mesh that has
the same relief. Both are seen from straight above by an orthographic camera, so that a pixel
shows the same point of the relief in both."""
import re
from pathlib import Path
from typing import Any

import numpy as np

from .. import images, stats
from ..measure import Study
from ..options import Options, Target
from ..page import Claim, graded
from . import Step

METHODS = ("vao", "containment")
KINDS = {"field": "height field", "depth": "depth buffer", "product": "both"}
TARGETS = {"vao": Target(definition="tangent-sphere"), "containment": Target("cosine", "cubic")}
TEXELS = 128  # of the map, along each edge
PERIOD = 2.0  # scene units that the map spans on the floor of `builtin:relief`
HEIGHT, RADIUS = 0.1, 0.3
CENTRE = (6.0, 4.2)  # x and z on the floor, far from ball and wall
FIELD = 2.0  # height of the view, scene units
TIME = re.compile(r"filter: ([0-9.]+) s$", re.M)


def cobbles() -> np.ndarray:
    """Rows of stones, every other one shifted by half a stone; 0 to 1."""
    stones = TEXELS // 4
    row, column = np.mgrid[0:TEXELS, 0:TEXELS]
    column = column + row // stones % 2 * stones // 2
    x = 2 * (column % stones + 0.5) / stones - 1
    y = 2 * (row % stones + 0.5) / stones - 1
    return np.maximum(0.0, 1 - x**4 - y**4)


def write_mesh(path: Path, heights: np.ndarray) -> None:
    """The floor with its relief as a PLY file: a vertex at each texel's centre, over more than
    what the view shows and the radius reaches."""
    per_unit = TEXELS / PERIOD
    around = np.array([FIELD, 0.5 * FIELD]) + 2 * RADIUS
    i, j = (np.arange(int((c - a) * per_unit), int((c + a) * per_unit) + 1)
            for c, a in zip(CENTRE, around))
    u, v = np.meshgrid(i, j)
    vertices = np.stack([(u + 0.5) / per_unit, HEIGHT * heights[v % TEXELS, u % TEXELS],
                         (v + 0.5) / per_unit], axis=-1).reshape(-1, 3)
    first = (np.arange(len(j) - 1)[:, None] * len(i) + np.arange(len(i) - 1)).ravel()
    quads = np.stack([first, first + len(i), first + len(i) + 1, first + 1], axis=-1)
    faces = np.empty(len(quads), dtype=[("count", "u1"), ("index", "<i4", 4)])
    faces["count"], faces["index"] = 4, quads
    with path.open("wb") as file:
        file.write(("ply\nformat binary_little_endian 1.0\n"
                    f"element vertex {len(vertices)}\nproperty float x\nproperty float y\n"
                    f"property float z\nelement face {len(faces)}\n"
                    "property list uchar int vertex_indices\nend_header\n").encode())
        vertices.astype("<f4").tofile(file)
        faces.tofile(file)


def time_told(notes: str) -> float:
    """In seconds. What is told as 0.00 took less than half a hundredth."""
    found = TIME.search(notes)
    return max(float(found[1]), 0.005) if found else float("nan")


class Relief:
    def __init__(self, s: Study):
        self.s = s
        self.map, self.mesh = s.tool.folder / "cobbles.exr", s.tool.folder / "cobbles.ply"
        # The map has its own detail; more pixels than these show no more of it.
        self.height = min(270, 3 * s.main.height // 4)
        x, z = CENTRE
        self.camera = ["--eye", f"{x},5,{z}", "--target", f"{x},0,{z}", "--up", "0,0,-1",
                       "--ortho", str(FIELD), "--size", f"{self.height * 16 // 9}x{self.height}"]

    def prepare(self) -> None:
        heights = cobbles()
        images.write_exr(self.map, {"Y": heights})
        write_mesh(self.mesh, heights)

    def options(self, method: str, kind: str, count: int, **settings: Any) -> Options:
        return self.s.options(method, filter="none", noise_size=4, samples=count,
                              falloff="cubic", steps=1, thickness=0,
                              characteristic=kind).set(**settings)

    def render(self, options: Options, camera: list[str]) -> Path:
        return self.s.tool.make("render", [
            "builtin:relief", *camera, "--height-map", str(self.map), "--height-scale",
            str(HEIGHT), *options.flags(), "--radius", str(RADIUS)])

    def picture(self, options: Options) -> np.ndarray:
        return images.read_single(self.render(options, self.camera))

    def truth(self, target: Target) -> np.ndarray:
        return images.read_single(self.s.tool.make("reference", [
            str(self.mesh), *self.camera, "--radius", str(RADIUS), *target.flags(), "--rays",
            str(self.s.rays)]))

    def seconds(self, options: Options) -> float:
        """Of the estimate alone, as the tool tells; a large picture, as it tells hundredths."""
        large = 4 * self.height
        made = self.render(options, self.camera[:-1] + [f"{large * 16 // 9}x{large}"])
        return time_told(self.s.tool.notes(made))


def steps(s: Study, json: dict[str, Any]) -> list[Step]:
    relief = Relief(s)
    return [Step("vao: height fields", 8, lambda: floor(s, relief, json)),
            Step("vao: height fields, pictures", 2, lambda: scene(s, relief))]


def floor(s: Study, relief: Relief, json: dict[str, Any]) -> None:
    relief.prepare()
    truths = {m: relief.truth(t) for m, t in TARGETS.items()}
    everywhere = np.ones(truths["vao"].shape, bool)

    def rmse(method: str, kind: str, count: int, name: str) -> float:
        picture = relief.picture(relief.options(method, kind, count, filter=name))
        return stats.rmse(picture, truths[method], everywhere)

    errors = {m: {k: rmse(m, k, 12, "box4") for k in KINDS} for m in METHODS}
    limits = {m: rmse(m, "product", 256, "none") for m in METHODS}
    ms = {k: 1e3 * relief.seconds(relief.options("vao", k, 12)) for k in KINDS}
    page = s.page
    page.heading(3, "vao-relief", "Height fields")
    page.text(f"A floor without relief of its own (`builtin:relief`) under a height map of "
              f"cobbles, {HEIGHT:g} units high, R = {RADIUS:g}, seen from above. The truth is "
              "ray-traced in a mesh that has the same relief.")
    page.table("The floor under cobbles, 12 samples, interleaved, against ray tracing: vao to "
               "the tangent sphere's visible share, containment to the cosine integral with "
               "falloff cubic. Times are without the filter.",
               ["characteristic function", "vao, RMSE", "containment, RMSE", "vao, time, ms"],
               [[name, f"{errors['vao'][k]:.4f}", f"{errors['containment'][k]:.4f}",
                 f"{ms[k]:.0f}"] for k, name in KINDS.items()])
    page.grid([page.picture("vao-relief-floor", relief.picture(
        relief.options("vao", "product", 12, filter="box4")), "floor: vao, 12 samples, both"),
        page.picture("vao-relief-floor-truth", truths["vao"],
                     "floor: ray-traced, the tangent sphere's visible share")])
    page.claim(claim(errors, limits, ms))
    darkness = float(np.sqrt(np.mean((1 - truths["vao"].astype(np.float64))**2)))
    json["relief"] = {"rmse": errors, "limit_rmse": limits, "vao_ms": ms, "darkness": darkness}


def claim(errors: dict[str, dict[str, float]], limits: dict[str, float], ms: dict[str, float]
          ) -> Claim:
    # Half of the error of doing nothing is a relief that is there; 2 % are noise.
    left = [limits[m] / errors[m]["depth"] for m in METHODS]

    def words(kind: str) -> str:
        return " and ".join(f"{errors[m][kind]:.4f}" for m in METHODS)

    return Claim(
        "2010, Figure 12", "The product of depth buffer and height field gives "
        "displacement-mapped surfaces their own occlusion, although the depth buffer does not "
        "know of it.", graded(max(left) < 0.5, min(left) < 0.98),
        f"RMSE on the relief of vao and containment with the depth buffer alone {words('depth')}, "
        f"with the height field {words('product')}; with 256 samples {limits['vao']:.4f} and "
        f"{limits['containment']:.4f}. vao then takes {ms['product'] / ms['depth']:.2f} times as "
        "long.",
        "A pipe meets the relief to first order from its middle, as if it were a plane there; a "
        "containment test takes points behind a ridge for open. Both err in narrow joints.")


def scene(s: Study, relief: Relief) -> None:
    """As the paper's figure: what each characteristic function sees."""
    figures = []
    for kind, name in KINDS.items():
        options = relief.options("vao", kind, 12, filter="box4")
        picture = images.read_single(relief.render(options, relief.camera[-2:]))
        figures.append(s.page.picture(f"vao-relief-{kind}", picture,
                                      f"ball and wall: vao, 12 samples, {name}"))
    s.page.grid(figures)
