# SPDX-License-Identifier: MIT
"""Says what is being done, and how long the rest may take."""
import sys
import time


def span(seconds: float) -> str:
    """"45 s", "3 min 20 s"."""
    whole = int(round(seconds))
    return f"{whole} s" if whole < 60 else f"{whole // 60} min {whole % 60:02d} s"


class Progress:
    """Steps have weights, about their seconds. What the steps so far took for each of their
    weight says how long the rest may take; steps whose results were kept from a former run
    say nothing."""

    def __init__(self, quiet: bool = False):
        self.quiet = quiet
        self.started = self.step_started = time.monotonic()
        self.left = self.done = self.seconds = 0.0

    def plan(self, weights: list[float]) -> None:
        self.left = sum(weights)

    def begin(self, what: str) -> None:
        self.step_started = time.monotonic()
        now = self.step_started - self.started
        rest = f", about {span(self.remaining())} left" if self.done > 0 else ""
        if not self.quiet:
            print(f"study: {what} ({span(now)}{rest})", file=sys.stderr, flush=True)

    def end(self, weight: float, was_kept: bool) -> None:
        self.left -= weight
        if not was_kept:
            self.done += weight
            self.seconds += time.monotonic() - self.step_started

    def remaining(self) -> float:
        return self.left * self.seconds / self.done

    def finish(self, page: str) -> None:
        if not self.quiet:
            print(f"study: wrote {page} ({span(time.monotonic() - self.started)})",
                  file=sys.stderr)
