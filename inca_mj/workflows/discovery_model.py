"""The twins of a discovery: the nominal one, fitted, and the one with the named effects."""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace

from identification.discovery.final_values import collect_final_values
from identification.discovery.free_run import FreeRun
from identification.discovery.result import Discovery
from identification.errors import InputError
from identification.kalman.refit import Refit
from identification.logs.joined import records_of
from identification.logs.log import Log
from identification.model.parameter import RECORD
from inca_mj.effects.values import with_effects
from inca_mj.twin.run import Run, simulate
from inca_mj.twin.twin import Twin, build_twin


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
    """Returns the free runs of a discovery.

    Raises:
        InputError: it was made over a horizon, and not with a twin of this robot.
    """
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
    own = known.values()
    at = {name: value for name, value in values.items() if name in own}
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
