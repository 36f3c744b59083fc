"""Would a GPU make fits faster: the page from the rows of `benchmarks/gpu_speed.py`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gpu.words import ACCURACY, ANSWER, SHORT, TAKES

HERE = Path(__file__).resolve().parents[1]
ROWS = HERE / "results" / "gpu.jsonl"
PAGE = HERE.parent / "docs" / "gpu.md"

Row = dict[str, Any]
GPU = ("kernel", "mjx", "warp")
LAWS = {  # simulators with the law: words for them, and which rows are theirs
    "MuJoCo, 1 thread": ("processor", 64, 1),
    "MuJoCo, 2 threads": ("processor", 64, 2),
    "MuJoCo, {cores} threads": ("processor", 64, 0),
    "one CUDA kernel, float64": ("kernel", 64, None),
    "MJX, float64": ("mjx", 64, None),
    "MJX, float32": ("mjx", 32, None),
    "MuJoCo Warp, float32": ("warp", 32, None),
}


def page(rows: Sequence[Row]) -> str:
    """The page of the last device and day that has all; of repetitions the least time counts."""
    rows = _complete(rows)
    spreads = [_spread(rows, simulators) for simulators in (("processor",), GPU)]
    rows = sorted(rows, key=lambda row: -row["microseconds_per_step_of_all"])
    rows, cores = list({_key(row): row for row in rows}.values()), max(row["cores"] for row in rows)
    widths = sorted({row["worlds"] for row in rows})
    law, bare = (_times(rows, cores, has_law) for has_law in (True, False))
    watched = [row for row in rows if "free_run_rms_rad" in row]
    last = max(rows, key=lambda row: len(row["versions"]))
    head = ANSWER.format(
        answer=_answer(law, watched, cores), date=last["date"], device=last["device"],
        cores=cores, host=last["host"], spread=spreads[0], spread_gpu=spreads[1],
        mjx=_compiled(rows, "mjx"), kernel=_compiled(rows, "kernel"),
        warp=f"{max(r.get('compile_seconds', 0) for r in rows if r['simulator'] == 'warp'):.0f}",
        versions=", ".join(f"{name} {v}" for name, v in last["versions"].items()),
    )  # fmt: skip
    lines = [
        head, *_table(law, widths), "",
        "The same without the law, currents driving plain motors [µs]:", "",
        *_table(bare, widths), "",
        "From how many worlds on a step is shorter than on the host's cores, between the measured"
        " widths on straight lines of the logarithms:", "",
        f"| | than 2 threads | than {cores} threads | steps a second at {widths[-1]} worlds |",
        "| --- | --- | --- | --- |",
    ]  # fmt: skip
    two, all_ = f"{_words(2)}", _words(cores)
    for name, times in law.items():
        if not name.startswith("MuJoCo,"):
            most = max(times)
            lines.append(
                f"| {name} | {crossing(times, law[two])} | {crossing(times, law[all_])} |"
                f" {most / times[most]:.3g} million |"
            )
    return "\n".join([*lines, *_accuracy(watched)]) + "\n" + TAKES


def _complete(rows: Sequence[Row]) -> list[Row]:
    """The rows of the last device and day on which every simulator was measured."""
    runs: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        runs.setdefault((row["device"], row["host"], row["date"]), []).append(row)
    needed = {(simulator, bits) for simulator, bits, _ in LAWS.values()}
    whole = [r for r in runs.values() if needed <= {(row["simulator"], row["bits"]) for row in r}]
    return whole[-1]


def _spread(rows: Sequence[Row], simulators: Sequence[str]) -> str:
    """By how much repetitions of a time differ at most [%], of 32 worlds and more."""
    times: dict[tuple[Any, ...], list[float]] = {}
    for row in rows:
        if row["simulator"] in simulators and row["worlds"] > 1:
            times.setdefault(_key(row), []).append(row["microseconds_per_step_of_all"])
    return f"{100 * max(max(t) / min(t) - 1 for t in times.values()):.0f}"


def _compiled(rows: Sequence[Row], simulator: str) -> str:
    """Seconds of compiling, the least and the most."""
    found = [f"{row['compile_seconds']:.0f}" for row in rows if row["simulator"] == simulator]
    least, most = min(found, key=int), max(found, key=int)
    return least if least == most else f"{least} to {most}"


def _key(row: Row) -> tuple[Any, ...]:
    return tuple(row.get(k) for k in ("simulator", "bits", "law", "threads", "worlds"))


def _words(threads: int) -> str:
    return f"MuJoCo, {threads} threads"


def _times(rows: Sequence[Row], cores: int, law: bool) -> dict[str, dict[int, float]]:
    """Microseconds of a step of all worlds, by simulator and width."""
    out: dict[str, dict[int, float]] = {}
    for words, (simulator, bits, threads) in LAWS.items():
        of = (simulator, bits, law, cores if threads == 0 else threads)
        found = {
            row["worlds"]: row["microseconds_per_step_of_all"]
            for row in rows
            if _key(row)[:4] == of
        }
        if found:
            out[words.format(cores=cores)] = found
    return out


def _table(times: dict[str, dict[int, float]], widths: Sequence[int]) -> list[str]:
    lines = [
        "| worlds | " + " | ".join(map(str, widths)) + " |",
        "| --- " * (1 + len(widths)) + "|",
    ]
    for name, found in times.items():
        cells = (f"{found[w]:.3g}" if found.get(w, 1e3) < 1e3 else f"{found[w]:.0f}" if w in found
                 else "" for w in widths)  # fmt: skip
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return lines


def crossing(times: dict[int, float], others: dict[int, float]) -> str:
    """The least number of worlds from which on `times` are shorter, to two digits."""
    widths = sorted(set(times) & set(others))
    at = np.unique(np.geomspace(widths[0], widths[-1], 4000).round())
    own, other = (
        np.interp(np.log(at), np.log(widths), np.log([t[w] for w in widths]))
        for t in (times, others)
    )
    longer = np.flatnonzero(own >= other)
    if not len(longer):
        return f"{widths[0]}"
    if longer[-1] == len(at) - 1:
        return "never"
    first = at[longer[-1] + 1]
    return f"about {float(f'{first:.2g}'):.0f}"


def _accuracy(watched: Sequence[Row]) -> list[str]:
    """The table of the accuracy."""
    lines = [
        ACCURACY,
        "| | free run, largest [rad] | rms [rad] | central columns | forward columns |",
        "| --- | --- | --- | --- | --- |",
    ]  # fmt: skip
    for words, (simulator, bits, _) in LAWS.items():
        for row in watched:
            if (row["simulator"], row["bits"]) == (simulator, bits):
                spans = (
                    f"{min(e.values()):.0e} to {max(e.values()):.0e}"
                    for e in (row["central_columns"], row["forward_columns"])
                )
                run = f"{row['free_run_largest_rad']:.1e} | {row['free_run_rms_rad']:.1e}"
                lines.append(f"| {words} | {run} | {' | '.join(spans)} |")
    return lines


def _answer(law: dict[str, dict[int, float]], watched: Sequence[Row], cores: int) -> str:
    """The answer in a paragraph."""
    two, all_ = law[_words(2)], law[_words(cores)]
    mjx, kernel = law["MJX, float64"], law["one CUDA kernel, float64"]
    coarse = next(row for row in watched if row["simulator"] == "warp")
    wrong, widest = coarse["central_columns"].values(), max(kernel)
    return SHORT.format(
        cores=cores, mjx_256=mjx[256], two_256=two[256], all_256=all_[256], mjx_32=mjx[32],
        two_32=two[32], from_two=crossing(mjx, two), from_all=crossing(mjx, all_),
        wrong=100 * min(wrong), kernel_32=kernel[32], kernel_256=kernel[256], widest=widest,
        kernel_widest=kernel[widest], times=all_[widest] / kernel[widest],
    )  # fmt: skip


def write_page() -> None:
    """Write the page of all rows."""
    rows = [json.loads(line) for line in ROWS.read_text(encoding="utf-8").splitlines()]
    PAGE.write_text(page(rows), encoding="utf-8")
