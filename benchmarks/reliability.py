"""How often a name of a given confidence is right: a figure, and one JSON object.

    python benchmarks/reliability.py out/*.jsonl --figure reliability.png

Reads what `benchmarks/discovery.py --out` wrote. Every named effect counts, not only the first.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from discovery_statistics import calibration, wilson
from matplotlib.figure import Figure

from identification.report.style import GREY, INK, MEASURED, save_png

EDGES = (0.0, 0.3, 0.5, 0.7, 0.9, 1.0)


def names_of(row: dict[str, Any]) -> list[tuple[float, bool]]:
    """Confidence of every named effect of a log, and whether the log has it."""
    true = {e["name"] for e in row["truth"]["effects"]}
    return [(n["confidence"], n["name"] in true) for n in row["answer"]["named"]]


def reliability_figure(pairs: list[tuple[float, bool]]) -> Figure:
    """Share of right names over confidence, with Wilson's 95 % intervals."""
    figure = Figure((4.8, 4.2), layout="constrained")
    ax = figure.subplots()
    ax.plot([0, 1], [0, 1], color=GREY, lw=1, ls="--", label="calibrated")
    claimed, hit = np.array([p for p, _ in pairs]), np.array([r for _, r in pairs], bool)
    at = np.clip(np.digitize(claimed, EDGES) - 1, 0, len(EDGES) - 2)
    for k in np.unique(at):
        mine = at == k
        seen = wilson(int(hit[mine].sum()), int(mine.sum()))
        x, share = claimed[mine].mean(), hit[mine].mean()
        ax.plot([x, x], [seen["low"], seen["high"]], color=MEASURED, lw=2)
        ax.plot(x, share, "o", color=MEASURED)
        ax.annotate(f"{mine.sum()}", (x, share), (5, -12), textcoords="offset points", color=INK)
    ax.set(xlim=(0, 1.02), ylim=(0, 1.02), xlabel="confidence", ylabel="share that is right")
    ax.legend(loc="upper left", frameon=False)
    return figure


def main() -> None:
    """Read, draw, print."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("files", type=Path, nargs="+")
    parser.add_argument("--figure", type=Path)
    options = parser.parse_args()
    rows = [json.loads(line) for f in options.files for line in f.read_text().splitlines()]
    rows = [row for row in rows if "error" not in row]
    pairs = [pair for row in rows for pair in names_of(row)]
    if not pairs:
        raise SystemExit("no effect was named in these files; there is nothing to calibrate")
    if options.figure:
        save_png(reliability_figure(pairs), options.figure)
    hits = sum(right for _, right in pairs)
    print(json.dumps({
        "logs": len(rows), "names": len(pairs), "right": wilson(hits, len(pairs)),
        "brier": float(np.mean([(c - r) ** 2 for c, r in pairs])),
        "first_names": calibration(rows),
    }))  # fmt: skip


if __name__ == "__main__":
    main()
