"""How results present themselves: a line for a terminal, a table for a notebook."""

from __future__ import annotations

import html
from typing import Any

import numpy as np


def count(n: int, one: str, many: str | None = None) -> str:
    return f"{n:,} {one if n == 1 else many or one + 's'}"


def span(values: Any) -> str:
    """'0.1 … 25 (median 3)' of the finite values."""
    finite = np.asarray(values)[np.isfinite(values)]
    if finite.size == 0:
        return "none defined"
    return f"{finite.min():.4g} … {finite.max():.4g} (median {np.median(finite):.4g})"


class Result:
    """Tells about itself what `_facts` lists: (label, text)."""

    def _title(self) -> str:
        return type(self).__name__

    def _facts(self) -> list[tuple[str, str]]:
        raise NotImplementedError

    def __repr__(self) -> str:
        facts = "; ".join(f"{label} {text}" if label else text for label, text in self._facts())
        return f"<{self._title()}: {facts}>"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{html.escape(label)}</th>"
            f"<td style='text-align:left'>{html.escape(text)}</td></tr>"
            for label, text in self._facts()
        )
        return f"<table><caption>{html.escape(self._title())}</caption>{rows}</table>"
