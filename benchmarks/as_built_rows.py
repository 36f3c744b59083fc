"""What rows of robots as they are built have in common: their records, commits, times and rates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from identification.sweep.statistics import rate

Row = Mapping[str, Any]


def records_of(row: Row) -> tuple[str, str]:
    _, fitted, confirm, _ = row["key"].split("/")
    return fitted, confirm


def commits_of(rows: Sequence[Row]) -> str:
    return ", ".join(sorted({row["commit"] for row in rows}))


def median_time(rows: Sequence[Row]) -> str:
    seconds = np.median([row["processor_seconds"] for row in rows])
    return f"Median processor time {seconds:.0f} s."


def rate_of(rows: Sequence[Row], test: Any) -> str:
    r = rate(rows, test)
    return f"{r['hits']} of {r['of']} [{100 * r['low']:.0f}, {100 * r['high']:.0f} %]"
