# SPDX-License-Identifier: MIT
"""What is measured on, and with what: views and references."""
import shlex

from ..measure import Study
from ..options import Target
from . import Step

SHOWN = Target("cosine", "linear")


def steps(s: Study) -> list[Step]:
    return [Step(f"views: {v.name}", 5, lambda v=v: s.reference(v, SHOWN) and None)
            for v in s.views] + [Step("views: table", 0, lambda: write(s))]


def write(s: Study) -> None:
    page = s.page
    page.heading(2, "views", "Views")
    rows, results = [], []
    for view in s.views:
        camera, pixels = shlex.join(view.camera()), int(s.mask(view).sum())
        share = 100 * pixels / (view.width * view.height)
        rows.append([view.name + (" (main)" if view == s.main else ""), str(view.triangles),
                     f"{view.radius:.4g}", f"{share:.1f} %", f"`{camera}`"])
        results.append({"name": view.name, "camera": camera, "triangles": view.triangles,
                        "radius": view.radius, "pixels": pixels})
    page.results["views"] = results
    page.table(f"{s.main.width}x{s.main.height} pixels. Radius: of influence, scene units. "
               "Surface: share of the pixels that show one.",
               ["View", "Triangles", "Radius", "Surface", "Camera"], rows)
    page.grid([page.picture(f"view-{v.name}", s.truth(v, SHOWN),
                            f"{v.name}: ray-traced, {SHOWN.name}") for v in s.views])


def references_steps(s: Study) -> list[Step]:
    return [Step("references: table", 0, lambda: write_references(s))]


def write_references(s: Study) -> None:
    page = s.page
    page.heading(2, "references", "References")
    page.text(f"Ray-traced with up to {s.rays} low-discrepancy rays for each pixel; a pixel is "
              f"done earlier when its standard error is below {s.stop:.4f}. The root mean square "
              "standard error below is what the references themselves add to every error on this "
              "page, in squares: an error of 0.05 against a reference of 0.005 is one of 0.0497.")
    rows, results = [], []
    for (view, target, kind, buffers), made in s.references.items():
        scene = "all of it" if kind == "full" else f"what {buffers.layers} layer(s) hold"
        size = f"{view.width}x{view.height}"
        rows.append([view.name, size, f"{view.radius:.3g}", target, scene,
                     f"{made.error:.5f}"])
        results.append({"view": view.name, "size": size, "radius": view.radius,
                        "target": target, "scene": scene, "standard_error": made.error})
    page.results["references"] = results
    page.table("The references that this page compares with.",
               ["View", "Size", "Radius", "Integral", "Scene", "Standard error"], rows)
