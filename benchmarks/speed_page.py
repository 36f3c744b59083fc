"""How near the limit the project runs, as a page.

Its rows are those of `benchmarks/speed.py`, `benchmarks/searches.py` and `benchmarks/cost.py`.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
ROWS = HERE / "results" / "speed.jsonl"
SEARCHES = HERE / "results" / "searches.jsonl"
COSTS = HERE / "results" / "cost.jsonl"
FIGURE = HERE.parent / "docs" / "cost.png"
PAGE = HERE.parent / "docs" / "speed.md"

HEAD = """# How near the limit it runs

Nearly all are ratios of two times that were measured by turns in one run, because seconds tell more
of the machine than of the program. *Bare* is MuJoCo in a loop that does nothing else. This page is
made by `python benchmarks/speed.py --out benchmarks/results/speed.jsonl` from the rows there; it is
not written by hand. Columns are commits; what an older program did not measure is empty.

Steps of commits before 7d711b2 were those of the model that can be drawn, with its sensors and with
MuJoCo's clock; later ones are as fits take them, without the three. They are a quarter shorter, and
so the same law is a larger share of them. Bare steps beside a fit were those from one state up to
8bac341; later ones are those along its log, which take up to 4 % longer.
"""
WORDS = {
    "step_with_law_over_without": "step with the law over one without it",
    "step_with_idle_callbacks_over_without": "the same of callbacks that return at once",
    "step_with_exponentials_over_without": "and with the eight exponentials of the friction",
    "step_with_law_over_without_drawn": "the same of the model with shapes and sensors",
    "step_with_clock_over_without": "step with MuJoCo's clock over one without it",
    "python_callback_over_native": "step with the law in Python over one with the compiled law",
    "batch_on_2_threads_over_loop_on_1": "throughput of two threads over one",
    "reference_adaptive_over_twin": "time of the reference ODE over the twin's",
    "step_microseconds": "step [µs]",
    "evaluation_microseconds": "evaluation of the accelerations [µs]",
    "shared_evaluation_microseconds": "the same where positions are there [µs]",
    "fit_share_of_bare_steps": "bare steps as a share of a fit's processor time",
    "sysid_over_fit": "time of `mujoco.sysid` over that of a fit, same data and optimum",
    "solve_ivp_over_fit": "time of scipy with solve_ivp over that of a fit",
    "fit_processors_used": "processors that a fit uses, of two",
    "discovery_share_of_bare_steps": "bare steps and evaluations as a share of a discovery's time",
    "help_first_seconds": "`--help`, first start [s]",
    "help_second_seconds": "`--help`, second start [s]",
    "simulate_first_seconds": "`simulate`, first start [s]",
    "simulate_second_seconds": "`simulate`, second start [s]",
    "compare_first_seconds": "`compare`, first start [s]",
    "compare_second_seconds": "`compare`, second start [s]",
    "sensitivity_first_seconds": "`sensitivity`, first start [s]",
    "sensitivity_second_seconds": "`sensitivity`, second start [s]",
    "discover_seconds": "`discover` of the shipped log, drives known to be alike [s]",
    "discover_peak_megabytes": "its peak memory [MB]",
    "film_seconds_per_second": "film, seconds for each second",
}
AT_MOST = {"step_with_law_over_without", "help_second_seconds"}  # their goals are upper limits
LAST = 3  # rows that are shown


def page(rows: Sequence[dict[str, Any]]) -> str:
    """The page of the last rows."""
    rows = rows[-LAST:]
    lines = [HEAD, f"| | goal | {' | '.join(row['commit'] for row in rows)} |"]
    lines.append("| --- " * (2 + len(rows)) + "|")
    for name, words in WORDS.items():
        seen = [row.get(name, {}) for row in rows]
        seen = [each if isinstance(each, dict) else {"value": each} for each in seen]
        goal = next((each["goal"] for each in reversed(seen) if each.get("goal") is not None), None)
        side = "≤" if name in AT_MOST else "≥"
        told = "" if goal is None else f"{side} {goal:g}"
        lines.append(f"| {words} | {told} | {' | '.join(_value(e) for e in seen)} |")
    return "\n".join([*lines, *_notes(rows)]) + "\n"


def _value(entry: dict[str, Any]) -> str:
    return "" if entry.get("value") is None else f"{entry['value']:.4g}"


def _notes(rows: Sequence[dict[str, Any]]) -> list[str]:
    """How the values of the newest row came about."""
    notes = [
        f"- {WORDS[name]}: {entry['how']}"
        for name, entry in rows[-1].items()
        if name in WORDS and isinstance(entry, dict) and entry.get("how")
    ]
    return ["", f"Of {rows[-1]['commit']}:", "", *notes] if notes else []


def searches(rows: Sequence[dict[str, Any]]) -> str:
    """The searches of the newest commit beside those of the one that it was compared with."""
    new = rows[-1]["commit"]
    old = next(row["commit"] for row in reversed(rows) if row["commit"] != new)
    by = {(row["case"], row["commit"]): row for row in rows}  # of a case the newest rows
    cases = [case for case, commit in by if commit == new]
    lines = [
        "", "## Searches by two commits in one run", "",
        "Both commits answered each case in one run, each search on processors of its own, with"
        " laws that were compiled already;"
        " `benchmarks/searches.py` takes such rows. A search that did not end within the run has"
        " the seconds at which it was ended. *Same* means the same verdict, names and places; the"
        " last column is the largest difference of a size in its std.", "",
        f"| case | processors | {old} [s] | {new} [s] | processor time [s] | peak memory [MB] |"
        " same | sizes |",
        "| --- " * 8 + "|",
    ]  # fmt: skip
    for case in cases:
        a, b = by.get((case, old), {}), by.get((case, new), {})
        both = a.get("verdict") is not None and b.get("verdict") is not None
        lines.append(
            f"| {case} | {b['processors']} | {_seconds(a)} | {_seconds(b)} |"
            f" {_pair(a, b, 'processor_seconds')} |"
            f" {_pair(a, b, 'megabytes')} | {_same(a, b) if both else ''} |"
            f" {_apart(a, b) if both and _same(a, b) == 'yes' else ''} |"
        )
    return "\n".join(lines) + "\n"


def _seconds(row: dict[str, Any]) -> str:
    if not row:
        return ""
    return f"> {row['limit']:g}" if row["seconds"] is None else f"{row['seconds']:g}"


def _pair(a: dict[str, Any], b: dict[str, Any], key: str) -> str:
    return " -> ".join(f"{row[key]:g}" for row in (a, b) if row.get(key) is not None)


def _same(a: dict[str, Any], b: dict[str, Any]) -> str:
    said = [[row["verdict"], *((e["name"], e["where"]) for e in row["named"])] for row in (a, b)]
    return "yes" if said[0] == said[1] else "no"


def _apart(a: dict[str, Any], b: dict[str, Any]) -> str:
    """The largest difference of a size, in its std."""
    apart = [
        abs(value - other["values"][name][0]) / std
        for one, other in zip(a["named"], b["named"], strict=True)
        for name, (value, std) in one["values"].items()
        if std
    ]
    return f"{max(apart):.2g}" if apart else ""


def costs(rows: Sequence[dict[str, Any]]) -> str:
    """What a search costs against the number of what it has."""
    lines = [
        "", "## Cost against candidates, parameters, records and joints", "",
        f"![Seconds of a search against four numbers]({FIGURE.name})", "",
        "One search after the other, each in a process of its own on two processors;"
        " `benchmarks/cost.py` says what each is. Seconds are those of the search without what is"
        " loaded and compiled before. Dashed lines are proportional to the number. A joint brings"
        " candidates of its own, and more to simulate for each of them.", "",
        "| against | number | seconds | processor time [s] | peak [MB] | verdict | commit |",
        "| --- " * 7 + "|",
    ]  # fmt: skip
    for row in rows:
        seconds = f"> {row['limit']:g}" if row["seconds"] is None else f"{_of_search(row):.1f}"
        lines.append(
            f"| {row['against']} | {row.get('exact', row['of'])} | {seconds} |"
            f" {row.get('processor_seconds', '')} | {row.get('megabytes', '')} |"
            f" {row.get('verdict', '')} | {row['commit']} |"
        )
    return "\n".join(lines) + "\n"


def _of_search(row: dict[str, Any]) -> float:
    """Seconds of all stages of a search."""
    return float(sum(row["stages"].values()))


def draw_costs(rows: Sequence[dict[str, Any]]) -> None:
    """Draw the seconds against each number, beside lines that are proportional to it."""
    import matplotlib as mpl

    mpl.use("agg")
    from matplotlib import pyplot as plt

    kinds = [*dict.fromkeys(row["against"] for row in rows)]
    figure, axes = plt.subplots(1, len(kinds), figsize=(3 * len(kinds), 3), layout="constrained")
    for kind, ax in zip(kinds, axes, strict=True):
        done = [r for r in rows if r["against"] == kind and r["seconds"] is not None]
        count, seconds = [r["exact"] for r in done], [_of_search(r) for r in done]
        ax.loglog(count, seconds, "o-", color="#1f5fa8")
        ax.loglog(count, [seconds[0] * n / count[0] for n in count], "--", color="#888888", lw=1)
        ax.set_xticks(count, [str(n) for n in count])
        ax.minorticks_off()
        ax.set_yticks([s for s in (5, 10, 20, 50, 100, 200, 500, 1000)
                       if min(seconds) / 2 < s < 2 * max(seconds)])  # fmt: skip
        ax.yaxis.set_major_formatter("{x:g}")
        ax.set_xlabel(kind)
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("search [s]")
    figure.savefig(FIGURE, dpi=110)


def write_page() -> None:
    """Write the page of all rows, with its figure."""
    rows, compared, cost = (
        [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
        for path in (ROWS, SEARCHES, COSTS)
    )
    last = {row["against"]: row["commit"] for row in cost}
    newest = [row for row in cost if row["commit"] == last[row["against"]]]
    draw_costs(newest)
    PAGE.write_text(page(rows) + searches(compared) + costs(newest), encoding="utf-8")


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    write_page()
