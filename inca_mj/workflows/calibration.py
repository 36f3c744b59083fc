"""Calibration: the values of every drive and the place of every point, from logs of the robot.

A fit by innovations frees the common values, the deviation of each drive, the displacement of each
point, and the inertias. What is usual holds them (`inca_mj.workflows.spread`), and of the drives,
once they are fitted, how much those of this robot scatter. The result is compared with a fit in
which all drives are alike and all points are as drawn.

Physical values are shared by all records. Each record begins at a pose of its own.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from identification import Log
from identification.errors import InputError
from identification.logs.joined import join_logs, rows_of
from identification.model.parameter import (
    RECORD,
    ParameterSet,
    own_name,
    values_of_record,
    with_own,
)
from inca_mj.effects.change import DEVIANTS
from inca_mj.refusals.wiring import refuse_miswired
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import POINT, displaced, with_spread
from inca_mj.twin.logs import POSE
from inca_mj.twin.twin import Twin, build_twin
from inca_mj.workflows.comparison import timestep_for
from inca_mj.workflows.spread import NONE, Spread, spread_of

if TYPE_CHECKING:
    from identification.discovery.nominal_model import NominalModel
    from identification.kalman.refit import Refit

TIMESTEP = 2e-3  # [s]; RK4 errs by 0.03 mrad, 1/20 of an encoder's noise, at half the cost of 1 ms
STEPS = 30  # of a fit, at most
FEWEST = 50  # unseen samples of a record on which a calibration is judged


@dataclass(frozen=True)
class RecordGap:
    """The error of free runs on a record, on samples that no fit of physical values has seen."""

    name: str  # of the record
    role: str  # "fit": its first half was fitted; "confirm": only its start pose was
    before: float  # rms with all drives alike and all points as drawn [rad]
    after: float  # rms of the calibrated robot [rad]


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """A robot calibrated from logs.

    Attributes:
        logs: the records that were fitted.
        spread: what was known of the scatter of drives and points before.
        scatter: the std of each group: of drives as the data show it, of points as it was known.
        alike: the fit with all drives alike and all points as drawn.
        fit: the fit with every drive and point by itself.
        covariance: of the coordinates q of `fit`, shape (p, p).
        robot: the calibrated twin, at the start of the first record.
        unseen: the gap of each record, on unseen samples.
        seconds: wall time [s].
    """

    logs: tuple[Log, ...]
    spread: Spread
    scatter: Mapping[str, float]
    alike: Refit
    fit: Refit
    covariance: np.ndarray
    robot: Twin
    unseen: tuple[RecordGap, ...]
    seconds: float

    @property
    def values(self) -> dict[str, float]:
        """The values of all free parameters by name, in their units."""
        return self.fit.point.values

    @property
    def std(self) -> dict[str, float]:
        """Their std, in their units."""
        point = self.fit.point
        std = self.fit.std * point.space.slope(point.q)
        return dict(zip(point.space.names, std.tolist(), strict=True))


def calibrate(
    logs: Sequence[Log],
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    confirm: Sequence[Log] = (),
    spread: Spread | None = None,
    progress: Callable[[str], None] | None = None,
    timestep: float = TIMESTEP,
    trust: Sequence[str] = (),
) -> Calibration:
    """Calibrate drives, geometry and platform from logs.

    Args:
        logs: records of one robot. Where nothing confirms, the first half of each is fitted (its
            part `estimation`) and the rest is unseen.
        parameters: nominal values, where the search begins; the thesis' Table 3.2 when None.
        geometry: nominal places of exit points and connectors.
        confirm: records of which only the start pose is fitted, on their first half.
        spread: how much drives and points usually differ; `models/inca6d_spread.toml` when None.
        progress: is told one line per step.
        timestep: largest step of the integrator [s].
        trust: checks of the log that you overrule, words of `inca_mj.twin.logs.JUDGED`.

    Raises:
        InputError: there is no log, two logs are no records of one robot, or share samples, a log
            has a part `estimation` that is not its beginning or leaves no samples unseen, it is
            not wired as the robot is, the spread is of nothing, or a start has no pretension.
        DivergenceError: the nominal robot cannot be simulated.
    """
    began, spread = time.perf_counter(), spread or spread_of("usual")
    if not spread.groups:
        raise InputError(
            "a robot whose drives are all alike has nothing to calibrate; inca identify estimates"
            " its common values"
        )
    if not confirm:
        for log in logs:
            _refuse_split(log)
    every = join_logs([*logs, *confirm])
    step = timestep_for(every.sampling_time, timestep)
    fitted = join_logs([*logs] if confirm else [log.part("estimation") for log in logs])
    known = with_own(with_spread(parameters or parameter_set()), POSE, len(logs))
    plant = build_twin(known, geometry, timestep=step, visual=False)
    for log in (*logs, *confirm):
        refuse_miswired(log, plant, trust)

    from identification.discovery.options import DiscoveryOptions
    from identification.innovations.fit import fit_with_effects

    def fit(model: NominalModel, start: Mapping[str, float], near: Refit | None = None) -> Refit:
        return fit_with_effects(
            model, fitted, (), start, DiscoveryOptions(), STEPS, near, progress
        )  # fmt: skip

    say = progress or (lambda line: None)
    say("every drive and every point by itself")
    model = nominal_model(plant, spread, len(logs))
    rough = fit(model, {})
    drives = {group: spread.groups[group] for group in spread.drives}
    scatter = {**spread.points, **rough.problem.scatter(drives)}
    say("the same with the scatter of the drives that the data show")
    end = fit(replace(model, scatter=scatter), rough.point.values, rough)
    say("for comparison, all drives alike and all points as drawn")
    plain = nominal_model(plant, NONE, len(logs))
    alike = fit(plain, {name: end.point.values[name] for name in plain.names})
    robots = [_robot_of(plant, values) for values in (alike.point.values, end.point.values)]
    return Calibration(
        logs=tuple(logs),
        spread=spread,
        scatter=scatter,
        alike=alike,
        fit=end,
        covariance=end.problem.covariance,
        robot=robots[1],
        unseen=(
            *(_gap(log, robots, [alike, end], k) for k, log in enumerate(logs, 1) if not confirm),
            *(_gap(log, robots) for log in confirm),
        ),
        seconds=time.perf_counter() - began,
    )


def _refuse_split(log: Log) -> None:
    """Refuse a record whose fitted part is not its beginning, or leaves nothing to judge it by."""
    seen = rows_of(log, "estimation")
    count = int(seen.sum())
    if not seen[:count].all():
        raise InputError(
            f"log {log.name!r}: its part 'estimation' does not begin where the log begins; a"
            " calibration fits the beginning and is judged on the rest: change the split in the"
            " log's TOML"
        )
    if len(log) - count < FEWEST:
        raise InputError(
            f"log {log.name!r}: its part 'estimation' leaves {len(log) - count} samples unseen, and"
            f" a calibration is judged on {FEWEST} or more: change the split in the log's TOML, or"
            " give --confirm another log"
        )


def nominal_model(plant: Twin, spread: Spread, records: int = 1) -> NominalModel:
    """Returns the nominal model of a search: a robot, its known values, poses of records."""
    from identification.discovery.nominal_model import NominalModel

    known = dict(spread.known)
    for k in range(2, records + 1):
        known |= {own_name(name, k): known[name] for name in POSE}
    return NominalModel(
        plant, tuple(known), np.array([*known.values()]), groups=spread.groups,
        scattering=tuple(spread.drives),
        deviants={name: effect for name, effect in DEVIANTS.items() if name in known},
    )  # fmt: skip


def _robot_of(plant: Twin, values: Mapping[str, float]) -> Twin:
    """Returns the robot at fitted values, its geometry displaced, without the poses of records."""
    source = "calibrated from logs"
    known = plant.parameters.with_values(values, source)
    moved = displaced(plant.geometry, known.values())
    if moved is not plant.geometry:
        moved = replace(moved, assumed=False, source=source)
    kept = tuple(p for p in known if p.where not in (RECORD, POINT))
    return build_twin(
        replace(known, records=kept), moved, timestep=plant.model.opt.timestep, visual=False
    )


def _gap(
    log: Log, robots: Sequence[Twin], fits: Sequence[Refit] = (), number: int = 0
) -> RecordGap:
    """Returns the gap on the second half of a record, of which the first half was fitted.

    The first half of a record without fits tells the start alone.
    """
    from identification.kalman.estimate import estimate_innovations

    values = [values_of_record(fit.point.values, number) for fit in fits] or [
        estimate_innovations(robot, log, POSE).fit.estimate.values for robot in robots
    ]
    starts = ({name: each[name] for name in POSE} for each in values)
    before, after = map(partial(_rms, log), robots, starts)
    return RecordGap(log.name, "fit" if fits else "confirm", before, after)


def _rms(log: Log, robot: Twin, start: Mapping[str, float]) -> float:
    """Returns the rms of a free run over the samples after the part `estimation` [rad]."""
    from identification.model.predictor import Predictor

    predicted = Predictor(robot, log, (), start).predict(np.empty((1, 0)))[0]
    first = len(log.part("estimation"))
    return float(np.sqrt(np.mean((log.outputs - predicted)[first:] ** 2)))
