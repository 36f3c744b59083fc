"""Rows of studies of many worlds: which search gave them, how they are made, and their page.

A row is a line of a JSONL file. It has a `key`, and the `commit` that last changed the product, so
that rates are of one search: pages count the rows of the search that gave the last row.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import lru_cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
# What decides an answer; the words of a report do not.
PRODUCT = ("identification", "inca_mj", "models", ":(exclude)identification/report")
Row = Mapping[str, Any]


@lru_cache(maxsize=1)
def search_commit() -> str:
    """Returns the last commit that changed the product, "-dirty" where files differ from it."""
    said, changed = (
        subprocess.run(
            ["git", *words, "--", *PRODUCT], cwd=ROOT, capture_output=True, check=True, text=True
        ).stdout.strip()
        for words in (("log", "-1", "--format=%h"), ("status", "--porcelain"))
    )
    return f"{said}-dirty" if changed else said


def rows_of(path: Path) -> list[dict[str, Any]]:
    """Returns the rows of earlier runs, in the order in which they were made."""
    if not path.exists():
        return []
    lines = path.read_text(encoding="utf-8").splitlines()
    return [json.loads(line) for line in lines if line.endswith("}")]  # else it was interrupted


def of_newest(rows: Sequence[Row]) -> list[Row]:
    """Returns the rows of the search that gave the last row, the last of each key."""
    mine = {row["key"]: row for row in rows if row.get("commit") == rows[-1].get("commit")}
    return [*mine.values()]


def answered(
    study: Callable[..., dict[str, Any]], tasks: Mapping[str, tuple[Any, ...]], path: Path,
    told: Callable[[Row], str], processes: int, again: bool = False,
) -> list[dict[str, Any]]:  # fmt: skip
    """Make the rows that this search has not given yet, and return all.

    Args:
        study: returns the row of a task, but for its key and commit.
        tasks: its arguments, by key.
        path: of the rows.
        told: a row in a line.
        processes: how many worlds are answered at once.
        again: whether rows that met an error are made again.
    """
    code, rows = search_commit(), rows_of(path)
    done = {r["key"] for r in rows if r.get("commit") == code and not (again and "error" in r)}
    path.parent.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # of the processes that are started
    with ProcessPoolExecutor(processes, get_context("spawn")) as pool:
        left = {pool.submit(study, *task): k for k, task in tasks.items() if k not in done}
        for future in as_completed(left):
            row = {"key": left[future], "commit": code, **future.result()}
            rows.append(row)
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
            print(told(row), file=sys.stderr, flush=True)
    return rows


def write_part(path: Path, begin: str, end: str, text: str) -> None:
    """Put a part into its page, in place of an earlier one, or at the end of it.

    Args:
        path: of the page.
        begin: the line before the part.
        end: the line behind it.
        text: the part.
    """
    page = path.read_text(encoding="utf-8") if path.exists() else ""
    if begin not in page:
        page = f"{page.rstrip(chr(10))}\n\n{begin}{end}"
    head, _, rest = page.partition(begin)
    path.write_text(f"{head}{begin}{text}{end}{rest.partition(end)[2]}", encoding="utf-8")
