"""Scores of all candidates on a fitted nominal model: a search without refits and proof.

It takes less time than a whole search, so that many sizes, lengths and rates can be compared. A
whole search finds more, because it refits rivals, and names less, because it asks for proof.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from identification import Log
from identification.report.page.page import Section, Table
from identification.sweep.answers import TRUTH
from identification.sweep.method import Column, Findings, Method, Record, Seed
from identification.sweep.statistics import rate, said
from inca_mj.studies.hidden_worlds import WORLD, WorldSettings, make_world


@lru_cache(maxsize=2)  # a worker meets few rates
def nominal_plant(sampling_time: float, spread: str, settled: bool) -> Any:
    """Returns the nominal model with every candidate compiled in, once for each worker."""
    from inca_mj.effects.catalogue import CATALOGUE
    from inca_mj.robot.parameters import parameter_set
    from inca_mj.robot.spread import with_spread
    from inca_mj.twin.twin import build_twin
    from inca_mj.workflows.calibration import nominal_model
    from inca_mj.workflows.comparison import timestep_for
    from inca_mj.workflows.discovery import TIMESTEP
    from inca_mj.workflows.spread import spread_of

    known, told = parameter_set(), spread_of(spread)
    plant = build_twin(
        with_spread(known) if told.groups else known, effects=CATALOGUE, settled=settled,
        timestep=timestep_for(sampling_time, TIMESTEP), visual=False,
    )  # fmt: skip
    return nominal_model(plant, told)


def fit_nominal(log: Log, spread: str, *, settled: bool) -> tuple[Any, Any, Sequence[Any]]:
    """Returns the nominal model fitted to a log, the sensitivities of candidates, and their scores.

    The first half of the log is fitted. Candidates of one drive are scored at those places only
    where the effect scores best on all. `settled` says whether the robot stood by itself before.

    Raises:
        InputError: the log is too short.
        DivergenceError: the nominal model cannot be simulated.
    """
    from identification.discovery.candidates import list_common, list_single
    from identification.discovery.options import DiscoveryOptions
    from identification.innovations.fit import fit_with_effects
    from identification.innovations.scoring.scores import score
    from identification.innovations.scoring.sensitivities import compute_sensitivities
    from inca_mj.effects.catalogue import CATALOGUE

    options = DiscoveryOptions()
    model = nominal_plant(log.sampling_time, spread, settled)
    fit = fit_with_effects(model, log.part("estimation"), (), {}, options)
    sensitivities = compute_sensitivities(fit.point, list_common(CATALOGUE))
    best: dict[str, Any] = {}
    for each in score(fit, sensitivities, options):
        best.setdefault(each.candidate.effect.name, each.candidate)
    sensitivities += compute_sensitivities(fit.point, list_single([*best.values()]))
    return fit, sensitivities, score(fit, sensitivities, options)


def named(scores: Sequence[Any]) -> list[str]:
    """Returns the candidates that are beyond chance and plausible, as "effect, place" each."""
    from identification.discovery.options import DiscoveryOptions
    from identification.innovations.scoring.significance import select_significant

    chosen = select_significant(scores, DiscoveryOptions())
    return [f"{s.candidate.effect.name}, {s.candidate.where}" for s in chosen]


FIVE = 5  # candidates that a record keeps


def world_score(settings: WorldSettings, seed: Seed) -> dict[str, Any]:
    """Make a world, fit the nominal model to it, and score all candidates.

    Raises:
        InputError: the world cannot be made.
        DivergenceError: a simulation left the finite numbers.
    """
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
