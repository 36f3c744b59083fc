"""Estimates against the truth: bias, std, what was claimed of it, and coverage of intervals.

    bias = mean(q̂ - q);   std² = Σ (q̂ - q - bias)²/(n - 1);   covered:  |q̂ - q| ≤ z σ̂,  z = 1.96

all relative to |q|, where q is not zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from statistics import NormalDist

import numpy as np

from identification.quantities import finite_or_none
from identification.report.page import Section, Table
from identification.sweep.method import Column, Findings, Record
from identification.sweep.statistics import said, wilson

ESTIMATES = {
    "names": Column(list[str], "parameters"),
    "estimated": Column(list[float], "their estimates [SI]"),
    "std": Column(list[float], "std that the fit gives, inf where it gives none [SI]"),
    "true": Column(list[float], "true values, nan where unknown [SI]"),
}
Z = NormalDist().inv_cdf(0.975)


def estimate_findings(records: Sequence[Record]) -> Findings:
    """Returns bias, std and coverage by parameter.

    Args:
        records: with the columns `ESTIMATES`.
    """
    by_name: dict[str, list[list[float]]] = {}
    for record in records:
        columns = (record[n] for n in ("names", "estimated", "std", "true"))
        for name, *values in zip(*columns, strict=True):
            by_name.setdefault(name, []).append(values)
    rows, out, inside, of = [], {}, 0, 0
    for name, values in by_name.items():
        estimated, std, true = np.array(values, float).T
        error, known = estimated - true, np.isfinite(true) & np.isfinite(std)
        scale = np.where(true == 0, 1.0, np.abs(true))
        hits = int((np.abs(error) <= Z * std)[known].sum())
        covered = wilson(hits, int(known.sum()))
        inside, of = inside + hits, of + int(known.sum())
        spread = float((error / scale).std(ddof=1)) if len(error) > 1 else float("nan")
        claimed = (std / scale)[np.isfinite(std)]
        numbers = [
            float((error / scale).mean()), spread,
            float(claimed.mean()) if len(claimed) else float("nan"),
        ]  # fmt: skip
        bias, scatter, told = map(finite_or_none, numbers)
        out[name] = {"bias": bias, "std": scatter, "claimed_std": told, "coverage": covered}
        rows.append((name, len(error), bias, scatter, told, said(covered)))
    head = ("parameter", "fits", "bias", "std", "std that fits claim", "inside 95 %")
    text = "Relative to the true value. The last column should be 95 %."
    whole = wilson(inside, of)
    return Findings(
        {"parameters": out, "coverage": whole},
        [Section("estimates against the truth", text, table=Table(head, tuple(rows)))],
        [f"the true value is inside the 95 % interval in {said(whole)}."] if of else [],
    )
