"""The effects that a robot lacks to explain one log of a folder."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from identification.report.page import Section, Table
from identification.sweep.answers import ANSWER, answer
from identification.sweep.method import Findings, Method, Record, Seed
from identification.sweep.methods.fit_log import OnLog
from identification.sweep.statistics import said, wilson


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
