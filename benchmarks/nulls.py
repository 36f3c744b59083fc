"""How seldom a name is found where nothing is missing: the page from sweeps over null worlds.

    inca sweep benchmarks/sweeps/null_score.toml --out out/null_score
    python benchmarks/nulls.py --take out/null_score     # a row of its own, then the page
    python benchmarks/nulls.py                           # the page anew

A row has what the records of a sweep say: how many, what was found, times, and which code ran.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from score_tests import RESULT, table

from identification.sweep.statistics import wilson

HERE = Path(__file__).parent
ROWS = HERE / "results" / "nulls.jsonl"
PAGE = HERE.parent / "docs" / "nulls.md"
HEAD = """# Where nothing is missing

A tool that always finds something finds nothing. These are robots of which the nominal model is
exact but for its parameters: the log of an independent simulator, its encoders of 4000 counts with
0.5 mrad of noise. The page is made by `python benchmarks/nulls.py` from the rows in
`benchmarks/results/nulls.jsonl`, which are taken from the records of sweeps.

- *by score*: all candidates are scored on a fitted model, without refits and without the proof on
  unseen samples, which can only lower the rate. A score counts as a false name where it is beyond
  chance for all candidates together, at 1 %.
- *whole searches*: the answer that a user gets.
"""


def main() -> int:
    """Take a sweep, if one is given, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--take", type=Path, help="folder of a sweep over null worlds")
    given = parser.parse_args()
    if given.take is not None:
        with ROWS.open("a", encoding="utf-8") as file:
            file.write(json.dumps(row_of(given.take)) + "\n")
    rows = [json.loads(line) for line in ROWS.read_text(encoding="utf-8").splitlines()]
    PAGE.write_text(page(rows), encoding="utf-8")
    return 0


def row_of(folder: Path) -> dict[str, Any]:
    """What the records of a sweep say."""
    from pyarrow.dataset import dataset

    told = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    records = dataset(folder / "records").to_table().to_pylist()
    done = [r for r in records if r["error"] is None]
    seconds = [r["run.processor_seconds"] for r in done]
    ended = [r["run.ended"] for r in done]
    is_search = "verdict" in done[0]
    named = [bool(r["named"]) if is_search else r["false_name"] for r in done]
    return {
        "about": told["about"], "digest": told["digest"], "is_search": is_search,
        "worlds": len(done), "failed": len(records) - len(done), "false_names": sum(named),
        "silent": sum(r["verdict"] == "nothing missing" for r in done) if is_search else None,
        "below_5_percent":
        None if is_search else float(np.mean([r["below_5_percent"] for r in done])),
        "median_seconds": float(np.median(seconds)), "all_seconds": float(np.sum(seconds)),
        "memory": max(r["run.memory"] for r in done),
        "day": datetime.fromtimestamp(max(ended), UTC).date().isoformat(),
        "code": sorted({r.get("run.code") or "unknown" for r in done}),
    }  # fmt: skip


def page(rows: Sequence[dict[str, Any]]) -> str:
    """The page, from all rows."""
    lines = [
        HEAD,
        "| sweep | worlds | a false name | nothing missing | p below 5 % |"
        " processor time of one, of all | memory | day, code |",
        "|---|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    for row in rows:
        n, below = row["worlds"], row["below_5_percent"]
        lines.append(
            f"| {row['about']} | {n}{', failed ' + str(row['failed']) if row['failed'] else ''}"
            f" | {_rate(row['false_names'], n)}"
            f" | {'-' if row['silent'] is None else _rate(row['silent'], n)}"
            f" | {'-' if below is None else f'{100 * below:.1f} %'}"
            f" | {row['median_seconds']:.2g} s, {row['all_seconds'] / 60:.0f} min"
            f" | {row['memory'] / 2**30:.1f} GB | {row['day']}, {'; '.join(row['code'])} |"
        )
    return "\n".join([*lines, "", *_score_tests(), ""])


def _score_tests() -> list[str]:
    """Returns the part on the test by blocks, where it was measured."""
    if not RESULT.exists():
        return []
    result = json.loads(RESULT.read_text(encoding="utf-8"))
    return [
        "## The test by blocks",
        "",
        "Candidates that act in some of 40 blocks, in noise alone. In brackets: how many"
        " chances were so small. Before, a candidate that acts in one block was beyond chance"
        " nearly always, because a test by blocks alone knows no scatter of that block"
        f" (`python benchmarks/score_tests.py`, {result['commit']}).",
        "",
        *table(result),
    ]


def _rate(hits: int, of: int) -> str:
    """Hits with Wilson's interval."""
    r = wilson(hits, of)
    return f"{hits} [{100 * r['low']:.1f}, {100 * r['high']:.1f} %]"


if __name__ == "__main__":
    raise SystemExit(main())
