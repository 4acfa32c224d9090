"""`progress=` of the long calls: nothing, a bar on standard error, or a function of the caller's."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Progress = bool | Callable[[float], Any] | None
Report = Callable[[float], Any] | None


def bar(what: str) -> Callable[[float], None]:
    """A function that draws how much is done over itself; 1 ends the line."""

    def draw(fraction: float) -> None:
        filled = int(40 * min(max(fraction, 0.0), 1.0))
        end = "\n" if fraction >= 1 else ""
        sys.stderr.write(f"\r{what} [{'#' * filled}{'-' * (40 - filled)}] {100 * fraction:3.0f} %{end}")
        sys.stderr.flush()

    return draw


@contextmanager
def reported(progress: Progress, what: str) -> Iterator[Report]:
    """What the compiled part is to call; it is called with 1 when all went well."""
    if progress is None or progress is False:
        yield None
        return
    report = bar(what) if progress is True else progress
    if not callable(report):
        raise ValueError(f"progress = {progress!r} is neither True, False, None nor a function")

    latest = 0.0

    def rising(fraction: float) -> Any:
        # A call of several parts starts each at 0; for a person that is standing still.
        nonlocal latest
        latest = max(latest, min(fraction, 1.0))
        return report(latest) if latest < 1 else None

    yield rising
    report(1.0)
