"""The section of docs/benchmarks.md on damaged files, interrupts and forecasts, from its records.

    python benchmarks/robustness.py

Records: results/fuzz.jsonl (`python tests/fuzz --record`), results/interrupts.jsonl
(`interrupts.py`) and results/forecast.jsonl (`forecast.py`).
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any

HERE = Path(__file__).parent
RESULTS = HERE / "results"
PAGE = HERE.parent / "docs" / "benchmarks.md"
BEGIN, END = "<!-- robustness: begin -->\n", "<!-- robustness: end -->\n"
FINDS = ("cryptic", "traceback", "crash", "hang")
Row = dict[str, Any]


def main() -> None:
    """Write the section anew."""
    page = PAGE.read_text(encoding="utf-8")
    if BEGIN not in page:
        page += f"\n{BEGIN}{END}"
    before, behind = page.split(BEGIN)[0], page.split(END)[1]
    text = "\n".join([*fuzzed(rows("fuzz")), "", *stopped(rows("interrupts")), "",
                      *forecast([r for r in rows("forecast") if "memory" in r])])  # fmt: skip
    PAGE.write_text(f"{before}{BEGIN}{text}\n{END}{behind}", encoding="utf-8")


def rows(name: str) -> list[Row]:
    """The rows of a record; none where there is no such file."""
    path = RESULTS / f"{name}.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def fuzzed(record: Sequence[Row]) -> list[str]:
    """Damaged files: counts by reader, for each commit."""
    said = [
        "## Damaged files", "",
        "Right files with one to four changes drawn by chance (`tests/fuzz`). A find is an error "
        "that is no `InputError` of one line,",
        "a death of the process, or no end. A case is made again by its seed and number; what was "
        "found is mended, with a test.", "",
        "    python tests/fuzz --cases 10000 --seed 100 --record benchmarks/results/fuzz.jsonl",
    ]  # fmt: skip
    for commit in dict.fromkeys(row["commit"] for row in record):
        mine = [row for row in record if row["commit"] == commit]
        seeds = sorted({row["seed"] for row in mine})
        said += ["", f"Commit {commit}, seeds {seeds[0]} to {seeds[-1]}:", "",
                 "| reader | cases | read | refused | cryptic | traceback | crash | no end |",
                 "|---|---|---|---|---|---|---|---|"]  # fmt: skip
        every: Counter[str] = Counter()
        for reader in dict.fromkeys(row["reader"] for row in mine):
            counts = sum((Counter(r["counts"]) for r in mine if r["reader"] == reader), Counter())
            every += counts
            said.append(_fuzz_line(reader, counts))
        said.append(_fuzz_line("all", every))
    return said


def _fuzz_line(name: str, counts: Counter[str]) -> str:
    each = (counts[kind] for kind in ("read", "refused", *FINDS))
    return f"| {name} | {counts.total()} | " + " | ".join(map(str, each)) + " |"


def stopped(record: Sequence[Row]) -> list[str]:
    """Interrupts of every command."""
    said = [
        "## Ctrl-C", "",
        "Each command is interrupted at times drawn evenly from its first 20 s. Right is"
        " exit code 130 within four seconds,",
        "with one line that says so and no draft left; or exit code 0, where the command had ended"
        " but for its process.", "",
        "    python benchmarks/interrupts.py --seed 1 --latest 20 --within 4", "",
        "| command | interrupts | right | exit codes | median time to the end | slowest |",
        "|---|---|---|---|---|---|",
    ]  # fmt: skip
    for command in dict.fromkeys(row["command"] for row in record):
        said.append(_stop_line(command, [r for r in record if r["command"] == command]))
    said.append(_stop_line("all", record))
    wrong = [row for row in record if not row["right"]]
    if wrong:
        latest = max(row["after"] for row in wrong)
        said += ["", f"The {len(wrong)} that are not right came within {latest:.2f} s after the"
                 " start of the process, on a busy machine:",
                 "no line of the program had run yet; the answer was Python's own."]  # fmt: skip
    return said


def _stop_line(command: str, mine: Sequence[Row]) -> str:
    codes = Counter(row["code"] for row in mine)
    each = ", ".join(f"{count} × {code}" for code, count in codes.most_common())
    times = [row["seconds"] for row in mine]
    return (
        f"| {command} | {len(mine)} | {sum(row['right'] for row in mine)} | {each} |"
        f" {median(times):.2f} s | {max(times):.2f} s |"
    )


def forecast(record: Sequence[Row]) -> list[str]:
    """What searches said that they would take, and what they took."""
    said = [
        "## Forecast of memory and time", "",
        "What `discover` says before it begins (`identification/innovations/forecast.py`), and what"
        " it then took, on logs of the twin",
        "and of chains of bodies, in which nothing is missing. Memory is beside that of the"
        " program, time is that of the processor.", "",
        "    python benchmarks/forecast.py --samples 500 1000 2000",
        "    python benchmarks/forecast.py --joints 1 5 --samples 2000", "",
        "| robot | samples | spread | verdict | memory: forecast | taken | time: forecast | taken"
        " | commit |",
        "|---|---|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    for row in record:
        memory, seconds = row["memory"], row["seconds"]
        said.append(
            f"| {_robot(row)} | {row['samples']} | {row['spread']} | {row['verdict']} |"
            f" {memory['forecast'] / 1e6:.0f} MB | {memory['measured'] / 1e6:.0f} MB |"
            f" {seconds['forecast']:.0f} s | {seconds['measured']:.0f} s | {row['commit']} |"
        )
    if record:
        memory, seconds = (_ratios(record, key) for key in ("memory", "seconds"))
        said += ["", f"Taken over forecast: memory {memory}, time {seconds}."]
    return said


def _ratios(record: Sequence[Row], key: str) -> str:
    """The smallest and the largest ratio of what was taken to its forecast, in words."""
    each = [row[key]["measured"] / row[key]["forecast"] for row in record]
    return f"{min(each):.2f} to {max(each):.2f}"


def _robot(row: Row) -> str:
    joints = row.get("joints", 0)
    return f"chain, joints: {joints}" if joints else "INCA"


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    main()
