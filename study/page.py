# SPDX-License-Identifier: MIT
"""The page: a list of parts that the sections append to, and templates that draw them."""
import json
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from markupsafe import Markup, escape

from . import images

HOLDS, PARTLY, FAILS = "holds", "holds in part", "does not hold"
NOT_MEASURED = "not measured"
KEYS = {HOLDS: "holds", PARTLY: "partly", FAILS: "fails", NOT_MEASURED: "unknown"}


@dataclass(frozen=True)
class Claim:
    """A statement of a paper, and what it comes to here."""
    paper: str
    statement: str
    verdict: str
    measured: str
    reason: str = ""

    @property
    def key(self) -> str:
        return KEYS[self.verdict]

    @property
    def shown_reason(self) -> str:
        """Why it does not hold; there is none if it does."""
        return self.reason if self.verdict in (PARTLY, FAILS) else ""


@dataclass(frozen=True)
class Bold:
    """A cell of a table that stands out."""
    text: str


def graded(*steps: bool) -> str:
    """The verdict of conditions, the strictest first: all of it, part of it, nothing."""
    return HOLDS if steps[0] else PARTLY if any(steps[1:]) else FAILS


def counted(wins: int, tries: int) -> str:
    return graded(wins == tries, wins > 0)


def prose(text: str) -> Markup:
    """Escaped, with `code` as code."""
    return Markup(re.sub(r"`([^`]*)`", r"<code>\1</code>", str(escape(text))))


def plain(value: Any) -> Any:
    """What JSON can hold; numbers that are not finite become null."""
    if isinstance(value, dict):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    return int(value) if isinstance(value, np.integer) else value


class Page:
    def __init__(self, folder: Path):
        self.folder = folder
        self.parts: list[dict[str, Any]] = []
        self.claims: list[tuple[str, Claim]] = []
        self.results: dict[str, Any] = {}
        self.names: set[str] = set()
        (folder / "pictures").mkdir(parents=True, exist_ok=True)

    def add(self, kind: str, **what: Any) -> None:
        self.parts.append({"kind": kind, **what})

    def heading(self, level: int, anchor: str, text: str) -> None:
        self.add("heading", level=level, id=anchor, text=text)

    def text(self, text: str) -> None:
        self.add("text", text=text)

    def table(self, caption: str, headers: list[str], rows: list[list[Any]]) -> None:
        self.add("table", caption=caption, headers=headers, rows=rows)

    def plot(self, svg: str, caption: str) -> None:
        self.add("plot", svg=Markup(svg), caption=caption)

    def claim(self, claim: Claim) -> None:
        anchor = f"claim-{len(self.claims) + 1}"
        self.claims.append((anchor, claim))
        self.add("claim", id=anchor, claim=claim)

    def details(self, summary: str, is_open: bool = False) -> None:
        self.add("details", summary=summary, is_open=is_open)

    def end_details(self) -> None:
        self.add("end details")

    def grid(self, figures: list[dict[str, Any]], pairs: bool = False) -> None:
        self.add("grid", figures=figures, pairs=pairs)

    def picture(self, name: str, pixels: np.ndarray, caption: str) -> dict[str, Any]:
        """Writes a picture, and gives what grid() takes."""
        name = re.sub(r"[^A-Za-z0-9]+", "-", name)
        if name in self.names:
            raise ValueError(f"two pictures are named {name}")
        self.names.add(name)
        path = f"pictures/{name}.png"
        images.write_png(self.folder / path, pixels)
        return {"src": path, "width": pixels.shape[1], "height": pixels.shape[0],
                "caption": caption}

    def write(self, **about: Any) -> None:
        """index.html, and report.json with all numbers."""
        here = Path(__file__).parent / "templates"
        environment = jinja2.Environment(loader=jinja2.FileSystemLoader(here), autoescape=True,
                                         trim_blocks=True, lstrip_blocks=True,
                                         undefined=jinja2.StrictUndefined)
        environment.filters["prose"] = prose
        environment.tests["bold"] = lambda cell: isinstance(cell, Bold)
        counts = {verdict: sum(c.verdict == verdict for _, c in self.claims) for verdict in KEYS}
        html = environment.get_template("page.html").render(
            parts=self.parts, claims=self.claims, counts=counts, about=about,
            style=Markup((here / "style.css").read_text(encoding="utf-8")),
            contents=[p for p in self.parts if p["kind"] == "heading" and p["level"] == 2])
        results = about | self.results | {"statements": [
            {"paper": c.paper, "statement": c.statement, "verdict": c.verdict,
             "measured": c.measured} for _, c in self.claims]}
        for name, text in (("index.html", html),
                           ("report.json", json.dumps(plain(results), indent=1))):
            part = self.folder / (name + ".part")
            part.write_text(text, encoding="utf-8")
            part.replace(self.folder / name)
