# SPDX-License-Identifier: MIT
"""One file a section of the page. Each has steps(study): what is done, in order."""
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Step:
    """weight: about its seconds, against which the time left is told."""
    title: str
    weight: float
    run: Callable[[], None]
