"""The scores of all candidates on a fitted nominal model: the search without refits and proof."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from identification import Log


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

    Candidates of one drive are scored at those places only where the effect scores best on all.

    Args:
        log: whole; its first half is fitted.
        spread: as of a discovery.
        settled: whether the robot stood by itself before the log began.

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
