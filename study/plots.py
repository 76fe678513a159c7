# SPDX-License-Identifier: MIT
"""Plots as SVG inside the page: ink in the page's own colour, lines in tones that can be read
on light and dark ground."""
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass, field

import matplotlib
from matplotlib import ticker
from matplotlib.figure import Figure

from . import stats

matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "crevice", "font.size": 10,
    "font.family": "sans-serif", "axes.grid": True, "grid.alpha": 0.25, "axes.spines.top": False,
    "axes.spines.right": False, "lines.linewidth": 1.6, "lines.markersize": 4.5,
    "legend.frameon": False})

COLOURS = ("#2f7ed8", "#d9652b", "#2a9d5c", "#b04fc4", "#c49a12", "#1aa3a8", "#d8476f",
           "#7c7f86", "#8a6a4a", "#6470d8", "#6fa02a", "#a0522d")
MARKERS = "osD^vP*Xhd<>"
# Ink: what becomes the colour of the page's text.
INK = "#010203"


@dataclass
class Line:
    name: str
    x: Sequence[float]
    y: Sequence[float]
    labels: Sequence[str] = field(default_factory=list)
    is_guide: bool = False


def draw(lines: list[Line], x_title: str, y_title: str, log_x: bool = False,
         log_y: bool = False, from_zero: bool = False, front: bool = False) -> str:
    """The plot as an <svg> element. front: joins the points that no other beats in both."""
    figure = Figure(figsize=(9.4, 4.6))
    axes = figure.add_axes((0.08, 0.12, 0.62, 0.85))
    number = 0
    for line in lines:
        if line.is_guide:
            axes.plot(line.x, line.y, "--", color="#888b90", linewidth=1.2, label=line.name)
            continue
        axes.plot(line.x, line.y, color=COLOURS[number % len(COLOURS)],
                  marker=MARKERS[number % len(MARKERS)], label=line.name)
        for x, y, label in zip(line.x, line.y, line.labels):
            axes.annotate(label, (x, y), textcoords="offset points", xytext=(5, 4),
                          fontsize=7.5, color=COLOURS[number % len(COLOURS)])
        number += 1
    if front:
        draw_front(axes, lines)
    axes.set_xlabel(x_title)
    axes.set_ylabel(y_title)
    if log_x:
        axes.set_xscale("log")
        plain_numbers(axes.xaxis)
    if log_y:
        axes.set_yscale("log")
        plain_numbers(axes.yaxis)
    if from_zero:
        axes.set_ylim(bottom=0)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8.5)
    ink(axes)
    return svg_of(figure)


def plain_numbers(axis: matplotlib.axis.Axis) -> None:
    """0.01 rather than a power of ten; 1, 2 and 5 of each decade."""
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5), numticks=14))
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(ticker.NullLocator())


def draw_front(axes: matplotlib.axes.Axes, lines: list[Line]) -> None:
    points = [(x, y) for line in lines if not line.is_guide for x, y in zip(line.x, line.y)]
    best = [points[i] for i in stats.pareto(points)]
    axes.plot([p[0] for p in best], [p[1] for p in best], ":", color=INK, linewidth=2.2,
              label="nothing better", zorder=1)


def ink(axes: matplotlib.axes.Axes) -> None:
    axes.tick_params(which="both", colors=INK)
    axes.grid(color=INK)
    for spine in axes.spines.values():
        spine.set_color(INK)
    for text in (axes.xaxis.label, axes.yaxis.label, *axes.get_legend().get_texts()):
        text.set_color(INK)


def svg_of(figure: Figure) -> str:
    out = io.StringIO()
    figure.savefig(out, format="svg", transparent=True,
                   metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    text = out.getvalue()
    svg = text[text.index("<svg"):]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.S)
    # Inside HTML neither name spaces nor their prefixes are needed.
    svg = re.sub(r'\sxmlns(:\w+)?="[^"]*"', "", svg).replace("xlink:href", "href")
    # Names of one plot must not meet those of another on the same page.
    svg_of.count += 1
    svg = re.sub(r'(id="|href="#|url\(#)', rf"\g<1>p{svg_of.count}-", svg)
    return svg.replace(INK, "currentColor")


svg_of.count = 0
