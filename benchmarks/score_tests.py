"""How often the test by blocks takes noise for an effect that acts in few blocks or in many.

    python benchmarks/score_tests.py [--draws 40000]        a few minutes of one core

Candidates act in 1 to 40 of 40 blocks of 25 samples, beside eight slow free parameters; nothing is
missing. The noise is white, or a mean of six neighbouring samples. A chance below 1e-2 or 1e-5 is a
false one; "before" is the test of White (1980) with B - 1 degrees of freedom, which forgets that a
candidate in the model leaves nothing of a block in which it acts alone. The result is a part of the
page that `nulls.py` makes.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from identification.chances import f_above
from identification.estimation.block_test import (
    Blocks,
    common_scatter,
    make_blocks,
    p_values,
    scatter_of,
)
from identification.sweep.work import commit

RESULT = Path(__file__).parent / "results" / "score_tests.json"
BLOCKS, LENGTH, FREE, EACH, SETS = 40, 25, 8, 6, 20
ACTIVE = (1, 2, 3, 5, 10, 20, 40)
LEVELS = (1e-2, 1e-5)
MEMORIES = {"white": 1, "memory of 6 samples": 6}


def main() -> int:
    """Draw noise, test candidates that are not there, and keep the rates."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--draws", type=int, default=40000, help="of the noise, for each colour")
    draws = parser.parse_args().draws
    rows = []
    for word, memory in MEMORIES.items():
        found = np.zeros((2, len(LEVELS), len(ACTIVE)))
        for k in range(SETS):
            found += counted(np.random.default_rng(k), draws // SETS, memory)
        of = draws // SETS * SETS * EACH
        rows += [
            {"noise": word, "blocks": n, "tests": of,
             "now": found[0, :, i].tolist(), "before": found[1, :, i].tolist()}
            for i, n in enumerate(ACTIVE)
        ]  # fmt: skip
    RESULT.write_text(json.dumps({"commit": commit(), "levels": LEVELS, "rows": rows}, indent=1))
    print("\n".join(table(json.loads(RESULT.read_text()))))
    return 0


def counted(rng: np.random.Generator, draws: int, memory: int) -> np.ndarray:
    """Returns how many chances are below a level, by test, level and active blocks, (2, 2, 7)."""
    N, active = BLOCKS * LENGTH, np.repeat(ACTIVE, EACH)
    t = np.arange(N)[:, None]
    Q = np.linalg.qr(np.cos(t * rng.uniform(0, 0.05, FREE) + rng.uniform(0, 6, FREE)))[0]
    X = np.cos(t * rng.uniform(0, 0.3, len(active)) + rng.uniform(0, 6, len(active)))
    for j, some in enumerate(active):
        on = np.isin(np.arange(BLOCKS), rng.choice(BLOCKS, some, replace=False))
        X[:, j] *= np.repeat(on, LENGTH)
    X -= Q @ (Q.T @ X)
    own, free = X.reshape(BLOCKS, LENGTH, -1), Q.reshape(BLOCKS, LENGTH, -1)
    G = np.einsum("bnj,bnj->bj", own, own)
    blocks = make_blocks(G[..., None, None], np.einsum("bnp,bnj->bpj", free, own)[..., None])
    out = np.zeros((2, len(LEVELS), len(ACTIVE)))
    for _ in range(draws):
        e = np.convolve(rng.standard_normal(N + memory - 1), np.ones(memory), "valid")
        e -= Q @ (Q.T @ e)
        a = np.einsum("bn,bnj->bj", e.reshape(BLOCKS, LENGTH), own)
        now, before = tested(blocks, G, a, float(e @ e))
        for k, p in enumerate((now, before)):
            for i, level in enumerate(LEVELS):
                out[k, i] += (p < level).reshape(len(ACTIVE), EACH).sum(axis=1)
    return out


def tested(
    blocks: Blocks, G: np.ndarray, a: np.ndarray, squares: float
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the chances of candidates by the test and by that of White, shape (J,) each."""
    H = G.sum(axis=0)
    size = a.sum(axis=0) / H
    variance = (squares - size**2 * H) / (BLOCKS * LENGTH - FREE - 1)
    s = scatter_of(blocks, a[..., None], variance, np.zeros((len(H), 1)))
    g = a - G * size
    W = (H * size) ** 2 / np.maximum(np.sum(g**2, axis=0), 1e-300)
    return p_values(s, common_scatter([s])), f_above(W * (BLOCKS - 1) / BLOCKS, 1, BLOCKS - 1)


def table(result: dict[str, Any]) -> list[str]:
    """Returns the lines of the table."""
    lines = [
        "| noise | blocks in which it acts | tests | below 1e-2, over what it should be |"
        " below 1e-5, likewise | before: below 1e-2 | before: below 1e-5 |",
        "|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    for row in result["rows"]:
        n = row["tests"]
        pairs = zip(row["now"], result["levels"], strict=True)
        now = (f"{k / (n * level):.2g} ({k:.0f})" for k, level in pairs)
        before = (f"{k / n:.2g}" for k in row["before"])
        cells = (row["noise"], row["blocks"], n, *now, *before)
        lines.append(f"| {' | '.join(map(str, cells))} |")
    return lines


if __name__ == "__main__":
    raise SystemExit(main())
