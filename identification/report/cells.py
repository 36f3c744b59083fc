"""Cells of a table on a page: their text, and which columns hold numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?")
_NONE = ("–", "unknown", None)  # in the place of a number


def columns_of(headings: Sequence[str], rows: Sequence[Sequence[object]]) -> list[tuple[str, bool]]:
    """Returns the headings, each with whether numbers stand below it."""
    cells = zip(*rows, strict=True) if rows else ((),) * len(headings)
    return [
        (heading, _holds_numbers(column)) for heading, column in zip(headings, cells, strict=True)
    ]


def _holds_numbers(column: Iterable[object]) -> bool:
    """Returns whether some of the cells are numbers, or all of them are written numbers."""
    cells = list(column)
    written = [isinstance(c, str) and bool(_NUMBER.fullmatch(c)) for c in cells]
    numbers = [isinstance(c, int | float) and not isinstance(c, bool) for c in cells]
    return any(numbers) or (
        any(written) and all(w or c in _NONE for w, c in zip(written, cells, strict=True))
    )


def text_of(cell: object) -> str:
    """Returns a cell as it is read; – where it is empty."""
    if cell is None:
        return "–"
    return f"{cell:z.5g}" if isinstance(cell, float) else str(cell)
