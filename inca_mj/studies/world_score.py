"""Power by score: whether the best candidate of a hidden world is the true one, without refits.

It takes less time than a whole search, so that many sizes, lengths and rates can be compared. A
whole search finds more, because it refits rivals, and names less, because it asks for proof.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from identification.report.page import Section, Table
from identification.sweep.answers import TRUTH
from identification.sweep.method import Column, Findings, Method, Record, Seed
from identification.sweep.statistics import rate, said
from inca_mj.studies.world_settings import WORLD, WorldSettings, make_world

FIVE = 5  # candidates that a record keeps


def world_score(settings: WorldSettings, seed: Seed) -> dict[str, Any]:
    """Make a world, fit the nominal model to it, and score all candidates.

    Raises:
        InputError: the world cannot be made.
        DivergenceError: a simulation left the finite numbers.
    """
    from inca_mj.studies.scoring import fit_nominal, named

    (log, *_), truth = make_world(settings, seed)
    fit, _, scores = fit_nominal(log, settings.spread, settled=True)
    significant = named(scores)
    first = significant[0].partition(",")[0] if significant else ""
    listed = truth["kind"] not in ("null", "unknown")
    return {
        **truth,
        "found": first in truth["hidden"] if listed else None,
        "shown": bool(significant),
        "false_name": bool(significant) and first not in truth["hidden"],
        "scores": [f"{s.candidate.effect.name}, {s.candidate.where}" for s in scores[:FIVE]],
        "gains": [float(s.gain) for s in scores[:FIVE]],
        "significant": significant[:FIVE],
        "sigma": float(fit.level.sigma),
    }  # fmt: skip


def score_findings(records: Sequence[Record]) -> Findings:
    """Returns how often each hidden effect comes first."""
    by_name: dict[str, list[Record]] = {}
    for record in records:
        by_name.setdefault(" + ".join(record["hidden"]) or "nothing", []).append(record)
    found = {
        name: {"found": rate([r for r in mine if r["found"] is not None], lambda r: r["found"]),
               "shown": rate(mine, lambda r: r["shown"])}
        for name, mine in sorted(by_name.items())
    }  # fmt: skip
    rows = tuple((n, said(r["found"]), said(r["shown"])) for n, r in found.items())
    table = Table(("hidden", "comes first", "anything is beyond chance"), rows)
    return Findings({"by_effect": found}, [Section("by effect", table=table)])


WORLD_SCORE = Method(
    about="makes a hidden world and scores all candidates on the fitted nominal model",
    settings=WorldSettings,
    columns={
        **WORLD,
        **TRUTH,
        "found": Column(bool, "the best significant candidate is true; null where none is hidden"),
        "shown": Column(bool, "some candidate is beyond chance"),
        "false_name": Column(bool, "the best significant candidate is not true"),
        "scores": Column(list[str], "the five best candidates, as effect, place"),
        "gains": Column(list[float], "by how much they raise the negative BIC"),
        "significant": Column(list[str], "those that are beyond chance, five at most"),
        "sigma": Column(float, "noise of the sensors by the noise model [rad]"),
    },
    run=world_score,
    success="found",
    against="ratio",
    summary=score_findings,
)
