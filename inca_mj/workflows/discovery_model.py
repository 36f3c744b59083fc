"""What follows from a discovery: its twins, and the input that would tell two look-alikes apart.

    d(u) = ‖(I - P) ∂ŷ/∂η η‖/σ,    P projects onto the nominal parameters and the rival

d is the distance, in std of the noise, between a record of the effect under the input u and the
nearest one that the rival and the nominal parameters can produce. It is computed for the log's own
input and for standard inputs, over the fitted duration.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace

import numpy as np

from identification.discovery.effect_results import NamedEffect
from identification.discovery.free_run import FreeRun
from identification.discovery.result import Discovery, collect_final_values
from identification.effects.effect import Candidate
from identification.errors import DivergenceError, InputError
from identification.innovations.scoring.sensitivities import compute_sensitivities
from identification.kalman.point import Point, evaluate_point
from identification.kalman.refit import Refit
from identification.logs.joined import records_of
from identification.logs.log import Log
from identification.model.parameter import RECORD
from identification.model.predictor import Predictor
from inca_mj.effects.values import with_effects
from inca_mj.twin.run import Run, simulate
from inca_mj.twin.twin import Twin, build_twin
from inca_mj.workflows.recipes import standard_inputs

TELLS = 5.0  # distance in std of the noise at which a record tells two look-alikes apart


def named_twin(found: Discovery) -> Twin:
    """Returns the robot at the values of the final fit, with the named effects alone.

    Raises:
        InputError: the discovery was not made with a twin of this robot.
    """
    names = {named.candidate.effect.name for named in found.named}
    return _twin(run_of(found).final, names, collect_final_values(found))


def nominal_twin(found: Discovery) -> Twin:
    """Returns the robot at the values of the fit without effects.

    Raises:
        InputError: the discovery was not made with a twin of this robot.
    """
    return _twin(run_of(found).nominal, frozenset(), found.nominal.values)


def run_of(found: Discovery) -> FreeRun:
    """Returns the free runs of a discovery, or refuses one that was made over a horizon."""
    if found.run is None:
        raise InputError("the discovery was made over a horizon; inca_mj.discover needs none")
    return found.run


def _twin(fit: Refit, names: Set[str], values: Mapping[str, float]) -> Twin:
    """Returns the robot of a fit, with the effects of some names at some values."""
    plant = fit.point.predictor.plant
    if not isinstance(plant, Twin):
        raise InputError(
            f"the discovery is of a {type(plant).__name__}, not of a twin;"
            " inca_mj.workflows.discovery makes one of a twin"
        )
    effects = tuple(e for e in plant.effects if e.name in names)
    base = tuple(p for p in plant.parameters if p.where not in ("effect", RECORD))
    known = with_effects(replace(plant.parameters, records=base), effects)
    numbers = known.values()
    at = {name: value for name, value in values.items() if name in numbers}
    free = {name: at[name] for name in fit.point.space.names if name in at}
    return build_twin(
        known.with_values(at).with_values(free, "fitted to the log"),
        plant.geometry,
        timestep=plant.model.opt.timestep,
        effects=effects,
        settled=plant.settled,
    )


def rerun(robot: Twin, log: Log) -> Run:
    """Returns the robot under the currents of a log, or of the first record of a joined one."""
    log = records_of(log)[0][1]
    return simulate(robot, log.inputs, log.sampling_time, hold_kind=log.hold)


def told(found: Discovery) -> Discovery:
    """Returns the discovery, with advice on the input that would tell its look-alikes apart."""
    named = tuple(
        replace(n, advice=_advice(found, n)) if n.one_of and n.rivals else n for n in found.named
    )
    return replace(found, named=named)


def _advice(found: Discovery, named: NamedEffect) -> str:
    """Returns what tells a named effect from its first rival; what it says already if nothing."""
    fit, rival = run_of(found).final, named.rivals[0].candidate
    own = _distance(fit.point, fit.point.log, named.candidate, rival, fit.level.sigma)
    tried = {}
    for name, currents in standard_inputs(len(fit.point.log)):
        log = replace(fit.point.log, inputs=currents, extras={})
        try:
            tried[name] = _distance(fit.point, log, named.candidate, rival, fit.level.sigma)
        except DivergenceError:  # a cable becomes slack under this input
            continue
    if not tried:
        return named.advice
    best = max(tried, key=tried.__getitem__)
    if tried[best] < max(TELLS, 1.5 * own):
        return (
            "No input that was tried would tell them apart better"
            f" ({tried[best]:.1f} std against {own:.1f} here): measure tension or pose too."
        )
    return (
        f"A record under {best} would tell them apart: they would lie"
        f" {tried[best]:.0f} std of the noise from each other, here {own:.1f}."
    )


def _distance(point: Point, log: Log, named: Candidate, rival: Candidate, sigma: float) -> float:
    """Returns d under the inputs of a log, with both effects linearised about their absence."""
    values = point.values
    gone = dict.fromkeys(named.sizes, 0.0)
    keep = [i for i, n in enumerate(point.space.names) if not n.startswith(f"{named.effect.name}.")]
    names, q = tuple(point.space.names[i] for i in keep), point.q[keep]
    fixed = {n: v for n, v in {**values, **gone}.items() if n not in names}
    space = replace(
        point.space, names=names, logarithmic=point.space.logarithmic[keep],
        lower=point.space.lower[keep], upper=point.space.upper[keep],
        scale=point.space.scale[keep],
    )  # fmt: skip
    here = evaluate_point(Predictor(point.predictor.plant, log, names, fixed), space, q)
    first, *theirs = (s.S for s in compute_sensitivities(here, [named, rival]))
    size = np.array([values.get(n, 0.0) or named.whole.get(n, 0.0) for n in named.sizes])
    S = np.concatenate([here.J, *theirs], axis=2).reshape(log.outputs.size, -1)
    Q = np.linalg.qr(S / (np.linalg.norm(S, axis=0) + 1e-300))[0]
    shown = (first @ size).ravel()
    return float(np.linalg.norm(shown - Q @ (Q.T @ shown)) / sigma)
