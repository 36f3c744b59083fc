"""Methods on the logs of any robot: fits and discoveries, and what estimates come to.

    bias = mean(q̂ - q);   std² = Σ (q̂ - q - bias)²/(n - 1);   covered:  |q̂ - q| ≤ z σ̂,  z = 1.96

all relative to |q|, where q is not zero.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np

from identification.quantities import finite_or_none
from identification.report.page.page import Section, Table
from identification.sweep.answers import ANSWER, answer
from identification.sweep.method import Column, Findings, Method, Record, Seed
from identification.sweep.settings import file_setting
from identification.sweep.statistics import said, wilson

# By their names in the TOML of a sweep.
METHODS = {
    "fit-log": "identification.sweep.log_methods:FIT_LOG",
    "discover-log": "identification.sweep.log_methods:DISCOVER_LOG",
}
ESTIMATES = {
    "names": Column(list[str], "parameters"),
    "estimated": Column(list[float], "their estimates [SI]"),
    "std": Column(list[float], "std that the fit gives, inf where it gives none [SI]"),
    "true": Column(list[float], "true values, nan where unknown [SI]"),
}
Z = NormalDist().inv_cdf(0.975)


def estimate_findings(records: Sequence[Record]) -> Findings:
    """Returns bias, std and coverage by parameter."""
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


@dataclass(frozen=True, kw_only=True)
class OnLog:
    """Settings for work on a log; every field says what it is in its metadata."""

    robot: Path = file_setting("robot file (TOML)")
    log: Path = file_setting("log that is fitted")
    confirm: Path | None = file_setting(
        "record that confirms; without it, the rest of the log", None
    )
    spread: str = file_setting(
        "how much the parts of one robot may differ: none, usual, or a TOML file", "usual",
        words=("none", "usual"),
    )  # fmt: skip

    def read(self) -> Any:
        """Reads the robot with its log."""
        from identification.robot.reading import read_robot

        confirm = [] if self.confirm is None else [self.confirm]
        return read_robot(self.robot, [self.log], confirm, [], self.spread)


def fit_log(settings: OnLog, seed: Seed) -> dict[str, Any]:
    """Fit; nothing is left to chance, so the seed is not used."""
    from identification.robot.fitting import fit
    from identification.robot.results.confirmation import confirm

    robot = settings.read()
    found = fit(robot)
    unseen = confirm(robot, found)
    values = found.values
    return {
        "names": [*values], "estimated": [*map(float, values.values())],
        "std": [*found.std.values()], "true": [float("nan")] * len(values),
        "converged": bool(found.converged), "worse": bool(found.is_worse),
        "before": float(unseen[0].before) if unseen else None,
        "after": float(unseen[0].after) if unseen else None,
        "unit": unseen[0].unit if unseen else "",
    }  # fmt: skip


FIT_LOG = Method(
    about="fits the free parameters of a robot to a log",
    settings=OnLog,
    columns={
        **ESTIMATES,
        "converged": Column(bool, "whether the search ended by itself"),
        "worse": Column(bool, "whether unseen data are predicted worse than by the robot's file"),
        "before": Column(
            float, "rms on unseen data with the values of the file [unit of the outputs]"
        ),
        "after": Column(float, "rms on unseen data with the fitted values [unit of the outputs]"),
        "unit": Column(str, "unit of the outputs"),
    },
    run=fit_log,
    summary=estimate_findings,
)


def discover_log(settings: OnLog, seed: Seed) -> dict[str, Any]:
    """Discover; nothing is left to chance, so the seed is not used."""
    from identification.robot.discovery import discover

    return answer(discover(settings.read()))


def named_findings(records: Sequence[Record]) -> Findings:
    """Returns how often each effect is named; the truth is not known."""
    pairs = (pair for r in records for pair in zip(r["named"], r["where"], strict=True))
    counts = Counter(f"{name}, {where}" for name, where in pairs)
    counts.update(r["verdict"] for r in records if not r["named"])
    rows = tuple((name, said(wilson(k, len(records)))) for name, k in counts.most_common())
    section = Section("answers", table=Table(("effect and place, or verdict", "logs"), rows))
    return Findings({"answers": dict(counts.most_common())}, [section])


DISCOVER_LOG = Method(
    about="names what a robot lacks to explain a log",
    settings=OnLog,
    columns=ANSWER,
    run=discover_log,
    summary=named_findings,
)
