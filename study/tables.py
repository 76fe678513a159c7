# SPDX-License-Identifier: MIT
"""Tables in Markdown, and pages whose measured parts stand between marks."""
import math
from collections.abc import Sequence
from pathlib import Path


class PageError(Exception):
    """A page that lacks the marks of a part; says which."""


def number(value: float | None, digits: int = 3, sign: bool = False) -> str:
    if value is None or not math.isfinite(value):
        return "-"
    return f"{value:+.{digits}f}" if sign else f"{value:,.{digits}f}".replace(",", " ")


def markdown(headers: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = ["| " + " | ".join(headers) + " |", "|" + "---|" * len(headers)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def with_part(page: str, name: str, text: str) -> str:
    """The page with the part of that name between its marks replaced."""
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
    before, found, rest = page.partition(begin)
    _, closed, after = rest.partition(end)
    if not found or not closed:
        raise PageError(f"no marks of {name}; write <!-- {name} --> and <!-- end of {name} -->")
    return before + begin + text + "\n" + end + after


def rewrite(path: Path, parts: dict[str, str]) -> None:
    page = path.read_text(encoding="utf-8")
    for name, text in parts.items():
        try:
            page = with_part(page, name, text)
        except PageError as fault:
            raise PageError(f"{path}: {fault}") from fault
    path.write_text(page, encoding="utf-8")
