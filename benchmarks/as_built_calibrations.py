"""What calibrations of robots as they are built come to: errors, and what was told of them."""

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


def calibration_lines(rows: Sequence[Row]) -> list[str]:
    done = [row for row in rows if "drives" in row]
    lines = [
        "## Calibration", "", "    inca calibrate LOG... [--confirm LOG...]", "",
        "Errors are relative to the truth. *Told* is the mean std that the calibration gives;"
        " *inside* is the share of the errors within 1.96 of their std, which should be 95 %."
        " Without records that confirm, the first half of each record is fitted.", "",
    ]  # fmt: skip
    for key in sorted({records_of(row) for row in done}):
        mine = [row for row in done if records_of(row) == key]
        fitted, confirm = key
        named = f"Fitted: records {fitted}" + (f"; {confirm} confirms" if confirm else ", halves")
        lines += [f"### {named} ({len(mine)} robots, {commits_of(mine)})", ""]
        lines += ["| value | rms error | told | inside |", "|---|---|---|---|"]
        for name in mine[0]["drives"]:
            error, std = _stack(mine, lambda row, n=name: row["drives"][n])
            lines.append(f"| {name} of each drive | {_percent(error)} | {_percent(std)} |"
                         f" {_inside(error, std)} |")  # fmt: skip
        every = [_stack(mine, lambda row, n=name: row["drives"][n]) for name in mine[0]["drives"]]
        error, std = (np.concatenate(part) for part in zip(*every, strict=True))
        lines.append(f"| all values of drives | | | {_inside(error, std)} |")
        for point in ("exit", "connector"):
            error, std = _stack(mine, lambda row, p=point: row["points"][p])
            before = np.concatenate([np.ravel(row["points"][point]["before"]) for row in mine])
            now, drawn, told = (f"{1e3 * _rms(x):.2f} mm" for x in (error, before, std))
            lines.append(
                f"| {point} points, each coordinate | {now} (as drawn {drawn}) | {told} |"
                f" {_inside(error, std)} |"
            )
        for name in ("I_x", "I_y", "I_z", "m"):
            error, std = _stack(mine, lambda row, n=name: row["platform"][n])
            lines.append(
                f"| {name} | {_percent(error)} | {_percent(std)} | {_inside(error, std)} |"
            )
        gaps = [gap for row in mine for gap in row["unseen"]]
        before, after = (1e3 * _rms(np.array([g[w] for g in gaps])) for w in ("before", "after"))
        lines += [
            "",
            f"Free runs over unseen samples are off by {after:.1f} mrad rms; with all drives alike"
            f" and all points as drawn by {before:.0f} mrad. {median_time(mine)}",
            "",
        ]  # fmt: skip
    return lines


def _stack(rows: Sequence[Row], part: Any) -> tuple[np.ndarray, np.ndarray]:
    """Errors and std of all rows, flat."""
    parts = [part(row) for row in rows]
    error, std = (np.concatenate([np.ravel(p[key]) for p in parts]) for key in ("error", "std"))
    return error, std


def _rms(x: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(x))))


def _percent(x: np.ndarray) -> str:
    return f"{100 * _rms(x):.2g} %"


def _inside(error: np.ndarray, std: np.ndarray) -> str:
    return f"{100 * np.mean(np.abs(error) < 1.96 * std):.0f} %"
