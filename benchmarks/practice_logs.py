"""Practice logs with labels: what a discovery says of each, beside what is hidden; a page.

    export PRACTICE=FOLDER
    inca sweep benchmarks/sweeps/practice.toml --out OUT          (or practice_spread.toml)
    python benchmarks/practice_logs.py --take OUT                 adds its rows and writes the page
    python benchmarks/practice_logs.py                            writes the page only

FOLDER holds practice_prbs and practice_multisine. A row that is there stays, unless its log was
searched again, and then the newer one counts.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from identification.sweep.statistics import rate
from inca_mj.effects.change import DEVIANTS
from inca_mj.workflows.spread import spread_of

HERE = Path(__file__).parent
ROWS = HERE / "results" / "practice.jsonl"
PAGE = HERE.parent / "docs" / "practice.md"
KEPT = (
    "kind", "ratio", "hidden", "hidden_where", "hidden_size_of", "hidden_sizes", "verdict", "named",
    "where", "confidence", "one_of", "rivals", "size_of", "sizes", "unexplained", "gap_closed",
    "right", "false_name",
)  # fmt: skip
CLOSE, CLOSED = 0.1, 0.9  # of a size, and of the gap on unseen samples
BEYOND = 3.0  # std of the usual spread, from which a drive that differs is to be named
Row = dict[str, Any]

HEAD = """# Practice logs

Logs of a hidden plant that the search does not know, 20 s at 100 Hz, all drives alike, encoders of
4000 counts. `prbs` has the thesis' kind of input and noise of the sensors only; `multisine` has
another input and an unlogged coloured error of the currents of 0.5 mA. The data and their labels
are not part of this project. This page is made by `python benchmarks/practice_logs.py` from the
rows in `benchmarks/results/practice.jsonl`; it is not written by hand.

    inca sweep benchmarks/sweeps/practice.toml              all drives are known to be alike
    inca sweep benchmarks/sweeps/practice_spread.toml       drives may differ, as on robots as built
"""


def rows_of(folder: Path) -> list[Row]:
    """Rows of the records of a sweep."""
    from pyarrow.dataset import dataset

    rows = []
    for record in dataset(folder / "records").to_table().to_pylist():
        if record["error"] is None:
            log = Path(record["set.log"])
            rows.append({
                "log": f"{log.parent.name}/{log.stem}", "spread": record["set.spread"],
                **{name: record[name] for name in KEPT},
                "code": record["run.code"], "seconds": round(record["run.processor_seconds"], 1),
                "ended": record["run.ended"],
            })  # fmt: skip
    return rows


def merged(rows: Sequence[Row]) -> list[Row]:
    """The newest row of each log and spread."""
    newest = {(r["spread"], r["log"]): r for r in sorted(rows, key=lambda r: r["ended"])}
    return [newest[key] for key in sorted(newest)]


def said(rows: Sequence[Row], name: str, hits: Sequence[bool]) -> str:
    """A share with Wilson's interval."""
    r = rate([{"hit": hit} for hit in hits], lambda row: row["hit"])
    return f"{name} {r['hits']} of {r['of']} [{100 * r['low']:.0f}, {100 * r['high']:.0f} %]"


def errors(row: Row) -> list[float]:
    """Relative errors of the sizes of hidden effects that are named, without their signs."""
    found = {
        name.partition("@")[0]: x for name, x in zip(row["size_of"], row["sizes"], strict=True)
    }
    true = zip(row["hidden_size_of"], row["hidden_sizes"], strict=True)
    each = [(found.get(name.partition("@")[0]), x) for name, x in true]
    return [abs(abs(x / y) - 1) for x, y in each if x is not None and y]


def rivals(row: Row) -> list[list[str]]:
    """Names that are not told from each of those that are named."""
    return [[name for name in each.split("|") if name] for each in row["rivals"]]


def in_set(row: Row) -> bool:
    """Whether each hidden effect is named, or a rival of what is named."""
    return {*row["hidden"]} <= {*row["named"]}.union(*rivals(row))


def is_silent(row: Row) -> bool:
    return row["verdict"] == "nothing missing"


def kind_of(row: Row) -> str:
    """The kind of a log; `within` where a drive differs by no more than drives usually do."""
    names = {effect: name.partition("@")[0] for name, (effect, _) in DEVIANTS.items()}
    std = spread_of("usual").drives
    sizes = [
        (names.get(n.partition(".")[0], ""), x)
        for n, x in zip(row["hidden_size_of"], row["hidden_sizes"], strict=True)
    ]
    ours = [name in std and abs(x) <= BEYOND * std[name] for name, x in sizes]
    within = row["spread"] == "usual" and row["kind"] == "single" and any(ours)
    return "within" if within else str(row["kind"])


def group_lines(kind: str, rows: Sequence[Row]) -> list[str]:
    """What the rows of one kind come to."""
    if kind == "null":
        silent = [*map(is_silent, rows)]
        return ["- nothing hidden: " + said(rows, '"nothing missing"', silent) + "."]
    if kind == "within":
        silent = [*map(is_silent, rows)]
        what = f"a drive that differs by less than {BEYOND:g} std of the usual spread"
        return [f"- {what}: " + said(rows, '"nothing missing"', silent) + "."]
    if kind == "unknown":
        unknown = [r["verdict"] == "unknown effect" for r in rows]
        return ["- an effect in no catalogue: " + said(rows, '"unknown effect"', unknown) + "."]
    right = [r for r in rows if r["right"]]
    sizes = [e for r in right for e in errors(r)]
    closed = [(r["gap_closed"] or 0.0) >= CLOSED for r in right]
    parts = [
        said(rows, "the right name first" if kind == "single" else "one of both named",
             [bool(r["right"]) for r in rows]),
        said(rows, "all named, or in a set", [*map(in_set, rows)]),
        said(rows, "a wrong name", [r["false_name"] for r in rows]),
    ]  # fmt: skip
    if right:
        parts += [
            said(right, f"{100 * CLOSED:.0f} % of the gap closed", closed),
            f"sizes within {100 * CLOSE:.0f} % {sum(e <= CLOSE for e in sizes)} of {len(sizes)}"
            f" (median error {100 * np.median(sizes):.2g} %)",
        ]
    times = f"{rows[0]['ratio']:g} times the noise"
    return [
        f"- {'one effect' if kind == 'single' else 'two effects'}, {times}: {'; '.join(parts)}."
    ]


def is_odd(row: Row) -> bool:
    """Whether a row is not what one hopes for."""
    if kind_of(row) in ("null", "within"):
        return not is_silent(row)
    if row["kind"] == "unknown":
        return bool(row["verdict"] != "unknown effect")
    return bool(row["false_name"] or not in_set(row) or row["unexplained"])


def answer(row: Row) -> str:
    """What was said: names with their confidence, and what is not told from each."""
    each = zip(row["named"], row["where"], row["confidence"], rivals(row), strict=True)
    told = [
        f"{name}, {where} ({100 * sure:.0f} %{''.join(f', or {other}' for other in others)})"
        for name, where, sure, others in each
    ]
    left = ", something left" if row["unexplained"] and row["named"] else ""
    return ("; ".join(told) or row["verdict"]) + left


def table(rows: Sequence[Row]) -> list[str]:
    """The rows that are not as hoped."""
    if not rows:
        return ["All others are as hoped.", ""]
    lines = ["", "| log | hidden | times the noise | answer |", "| --- | --- | --- | --- |"]
    for row in rows:
        hidden = " + ".join(row["hidden"]) or "nothing"
        log = row["log"].rpartition("/")[2]
        lines.append(f"| {log} | {hidden} | {row['ratio']:g} | {answer(row)} |")
    return [*lines, ""]


def page(rows: Sequence[Row]) -> str:
    """The page."""
    lines = [HEAD] if rows else [HEAD, "No log has been answered by the present search.\n"]
    for (spread, data), group in groupby(rows, lambda r: (r["spread"], r["log"].split("/")[0])):
        some = list(group)
        codes = ", ".join(sorted({r["code"].split(", ")[-1] for r in some}))
        lines.append(f"## {data}, spread {spread} ({len(some)} logs, {codes})\n")

        def sort(row: Row) -> tuple[str, float]:
            kind = kind_of(row)
            return kind, 0.0 if kind == "within" else row["ratio"]

        for (kind, _), alike in groupby(sorted(some, key=sort), sort):
            lines += group_lines(kind, list(alike))
        seconds = np.median([r["seconds"] for r in some])
        lines += ["", f"Median processor time {seconds:.0f} s.", *table([*filter(is_odd, some)])]
    return "\n".join(lines).rstrip() + "\n"


def main() -> None:
    """Take rows, write the page."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--take", type=Path, nargs="*", default=[], help="folders of sweeps")
    given = parser.parse_args()
    kept = [json.loads(line) for line in ROWS.read_text().splitlines()] if ROWS.exists() else []
    rows = merged([*kept, *(row for folder in given.take for row in rows_of(folder))])
    ROWS.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    PAGE.write_text(page(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
