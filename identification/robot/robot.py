"""A robot of a TOML file with its log: plant, free parameters, priors, and candidates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from identification.discovery.nominal_model import NominalModel
from identification.effects.axes import Axis, axes, reach
from identification.effects.catalogue import OF_ANGLE, TURNS, all_effects, turning
from identification.effects.effect import Effect
from identification.effects.named import unknown_effect
from identification.effects.plant.joint_plant import JointPlant, candidates, joint_plant
from identification.errors import InputError, told_of, unknown_name
from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.read import read_log
from identification.logs.stamps.decimation import decimate
from identification.logs.table import MissingColumnsError
from identification.model.plant import start_place
from identification.model.predictor import output_columns
from identification.model.rollout import State
from identification.refusals.limits import refuse_limits
from identification.refusals.unmeasured import refuse_unmeasured
from identification.robot.file.carried import with_carried
from identification.robot.file.checks import (
    outputs_of,
    refuse_columns,
    refuse_every,
    refuse_milliseconds,
    refuse_same_stem,
    refuse_short,
    refuse_unknown_outputs,
    refuse_unnamed,
)
from identification.robot.file.completed import motors_to_add
from identification.robot.file.file import RobotFile
from identification.robot.file.measured_tendons import joint_positions, measured_tendons
from identification.robot.file.model_file import measured_poses, robot_spec, unit_of, with_step
from identification.robot.file.own_values import (
    held_parameters,
    refuse_impossible,
    value_parameters,
    with_fixed,
)
from identification.robot.file.parameters import free_parameter, measured_start
from identification.robot.file.start import refuse_start, start_of
from identification.robot.file.unread_inputs import told_of_inputs


@dataclass(frozen=True)
class Robot:
    """A robot and the log that it is to explain; `read_robot` makes one.

    Attributes:
        file: the content of its TOML.
        log: what was measured; every n-th sample of it, where the file says so.
        plant: its model with the effects.
        std: std of the priors of its free parameters, shape (p,): relative where a parameter must
            be positive, else in units of the parameter's scale.
        records: logs to which nothing is fitted; models are confirmed on them.
        others: further logs that are fitted together with `log`.
        remarks: what was taken for granted when its files were read, a sentence each.
        mean: means of these priors by name, in the parameters' units.
        touches: one sentence on what touches along its logs; "" where nothing does.
        own_effects: candidates of the user's own, beside those of the catalogue.
        read_from: the file of each log that was read, by the place of the log among `log`, `others`
            and `records`; None for one that was given.
    """

    file: RobotFile
    log: Log
    plant: JointPlant
    std: np.ndarray
    records: tuple[Log, ...] = ()
    others: tuple[Log, ...] = ()
    remarks: tuple[str, ...] = ()
    mean: Mapping[str, float] = field(default_factory=dict)
    touches: str = ""
    own_effects: tuple[Effect, ...] = ()
    read_from: tuple[Path | None, ...] = ()

    def __repr__(self) -> str:
        logs = listed(log.name for log in (self.log, *self.others, *self.records))
        return f"Robot of {Path(self.file.path).name}, free: {listed(self.file.free)}; logs: {logs}"

    @property
    def paths(self) -> tuple[Path, ...]:
        """The file of each log, in the order of `read_from`; NAME.csv for one that was given."""
        logs = (self.log, *self.others, *self.records)
        files = self.read_from or (None,) * len(logs)
        return tuple(f or Path(f"{log.name}.csv") for f, log in zip(files, logs, strict=True))

    @property
    def nominal_model(self) -> NominalModel:
        """The nominal model with which a fit or a discovery begins.

        Over a horizon each record brings the values that hold for it alone; a free run has one log.
        """
        file, plant = self.file, self.plant
        if file.horizon is None:
            plant = plant.with_values(self.log.values)
        groups = {a.name: tuple(a.deviations) for a in file.spread if a.deviates}
        return NominalModel(
            plant, file.free, self.std, file.horizon, file.own, self.mean, file.own_values,
            groups=groups, scattering=() if file.horizon else tuple(groups),
        )  # fmt: skip

    @property
    def candidates(self) -> tuple[Effect, ...]:
        """The effects that may be missing."""
        found = candidates(self.plant, self.file.free)
        asked = {*self.file.only, *(e.name for e in self.own_effects)}
        return tuple(e for e in found if not self.file.only or e.name in asked)

    @property
    def starts(self) -> tuple[str, ...]:
        """Free parameters that are entries of the initial state."""
        at = self.plant.parameters
        return tuple(n for n in self.file.free
                     if start_place(at[n].where, self.plant.model) is not None)  # fmt: skip

    def started(self, log: Log) -> dict[str, float]:
        """Returns the start's free parameters with the first measured values of another log."""
        at = self.plant.parameters
        return {
            n: measured_start(self.plant.model, at[n].where, log, at[n].value) for n in self.starts
        }

    def plant_of(self, log: Log, begun: State | None = None) -> JointPlant:
        """Returns the plant as it begins in a log, with the values that hold there.

        Args:
            log: of the robot.
            begun: the initial state where it is known better than the log shows it.
        """
        start = begun or start_of(self.file, self.plant.model, log)
        plant = replace(self.plant, bare=replace(self.plant.bare, start=start))
        return plant.with_values(log.values) if log.values else plant

    def values_of(self, log: Log) -> dict[str, float]:
        """Returns the values that logs give, by name: that of this log, or else the model's."""
        parameters = self.plant.parameters
        logs = (self.log, *self.others, *self.records, log)
        return {n: log.values.get(n, parameters[n].value) for each in logs for n in each.values}


def _refuse_lost(file: RobotFile, given: Sequence[Effect]) -> None:
    """Refuse a file with values of a user's own effects without these effects."""
    lost = [name for name in file.own_effects if name not in {e.name for e in given}]
    if lost:
        raise InputError(
            f"{file.path} has values of {listed(lost)}, which its [effects] own says to be your"
            " own: give it again in Python, read_robot(..., own_effects=[...]), because no command"
            f" can; or take {listed(lost)} out of own, free, [parameters] and [fixed] there"
        )


def _said_of_turning(known: Sequence[Axis], only: Sequence[str]) -> tuple[str, ...]:
    """Returns a sentence where laws of the angle are no candidates; none where they are asked."""
    on_and_on = turning(known)
    if not on_and_on or {*OF_ANGLE} & {*only}:
        return ()
    how = listed(f"{a.joint} ({a.travel / (2 * np.pi):.0f} times)" for a in on_and_on)
    return (
        f"Laws that grow with the angle ({listed(OF_ANGLE)}) are no candidates at {how}, which"
        " turns on and on in these logs: there an angle is no place. Name them under effects.only"
        " to try them all the same.",
    )


def read_robot_log(file: RobotFile, path: str | Path) -> Log:
    """Read a log with the columns of a robot."""
    refuse_same_stem(file, Path(path))
    spec = robot_spec(file)[0]
    model, poses = spec.compile(), measured_poses(file)
    refuse_unnamed(model, file)
    inputs = tuple(model.actuator(i).name for i in range(model.nu))
    outputs = outputs_of(model, file)  # without an actuator the log is one of a free swing
    tendons = measured_tendons(model, file)
    told = outputs
    refuse_unknown_outputs(model, file, outputs)
    with told_of(f"outputs in {file.path}") if file.outputs else nullcontext():
        places = output_columns(model, outputs)
    units = {
        n: unit_of(model, f"{field}[{i}]") for n, (field, i) in zip(outputs, places, strict=True)
    }
    refuse_columns(file, (*inputs, *outputs, *tendons.sensors), Path(path))
    if tendons.sensors:  # they stand in the place of the joints that they tell
        outputs = (*tendons.sensors, *(n for n in outputs if n not in tendons.joints))
    column = {name: file.columns.get(name, name) for name in (*inputs, *outputs)}
    of_poses = [name for pose in poses for name in pose.columns]
    made = {name for pose in poses for name in pose.names}
    asked = {column[n]: u for n, u in units.items() if n in outputs and n not in made}
    asked |= {name: "m" for pose in poses for name in pose.columns[:3]}
    try:
        log = read_log(
            path, [column[n] for n in inputs], [column[n] for n in outputs],
            [*motors_to_add(spec).values()], poses=poses, units=asked, named_in=file.path,
            lenient=True, said=file.log, mapped=(*file.columns.values(), *of_poses),
            trust_rows="rows" in file.trust,
        )  # fmt: skip
    except MissingColumnsError as error:
        logged = [f'"{n}"' for n in outputs if column[n] not in error.missing]
        measured = {*error.missing} <= {column[n] for n in outputs}
        if file.outputs or not (logged and measured):
            raise
        raise InputError(
            f"{error}; or, where these are not measured, write outputs = [{', '.join(logged)}] into"
            f" {file.path}"
        ) from error
    refuse_short(log, Path(path))
    refuse_milliseconds(model, file, log, Path(path))
    refuse_every(file, log)
    given = {n: u for n in inputs if (u := log.units.get(column[n]))}
    factors, zeros = (
        {n: of[c] for n, c in column.items() if c in of} for of in (log.factors, log.zeros)
    )
    log = told_of_inputs(file, spec, log, Path(path))
    log = replace(log, input_names=inputs, output_names=outputs, units=given, factors=factors,
                  zeros=zeros, extras={})  # fmt: skip
    if tendons.sensors:
        log = joint_positions(model, tendons, log, told)
    log = replace(log, units={**units, **given})
    return decimate(log, file.every) if file.every > 1 else log


def robot_of(
    file: RobotFile, log: Log, others: Sequence[Log] = (), records: Sequence[Log] = (),
    own_effects: Sequence[Effect] = (),
) -> Robot:  # fmt: skip
    """Compile a robot for a log, for others that are fitted together with it, and for records."""
    spec, said = robot_spec(file)
    file, carried = with_carried(file, (log, *others))
    said += carried
    said += with_step(spec, [log, *others, *records])
    model = spec.copy().compile()
    refuse_start(file, model)
    refuse_unmeasured(file, model, log)
    for each in (log, *others, *records):
        refuse_limits(file, model, spec.compiler.degree, each)
    _refuse_lost(file, own_effects)
    known = reach([axes(model, each, file.trust) for each in (log, *others)])
    for joint in file.joints:
        if joint not in {a.joint for a in known}:
            where = f"measured joint under effects.joints in {file.path}:"
            raise unknown_name(where, joint, (a.joint for a in known))
    known = tuple(a for a in known if not file.joints or a.joint in file.joints)
    # A free swing that is fitted together with driven logs says nothing of what inputs do.
    driven = next((each for each in (log, *others) if each.inputs.any()), log)
    asked = [*file.only, *(n.partition(".")[0] for n in (*file.fixed, *file.free, *file.held))]
    effects = all_effects(spec, known, driven, file.turns or TURNS, asked)
    said += _said_of_turning(known, file.only)
    for name in file.only:
        if name not in {e.name for e in effects}:
            where = f"effect under effects.only in {file.path}:"
            raise unknown_effect(where, name, effects)
    listed, effects = effects, (*effects, *own_effects)
    try:
        priors = [free_parameter(file, name, model, effects, log) for name in file.free]
    except InputError as wrong:  # a wrong name in free is told first
        if not file.stray:
            raise
        raise InputError(f"{str(wrong).removesuffix('.')}. {file.stray}") from None
    if file.stray:
        raise InputError(file.stray)
    logs = (log, *others, *records)
    valued = value_parameters(file, model, effects, logs)
    valued += held_parameters(file, model, effects, log)
    start = start_of(file, model, log)
    with told_of(f"free in {file.path}"):
        plant = joint_plant(
            spec, [*(p.parameter for p in priors), *valued], log, joints=known, effects=listed,
            own_effects=own_effects, start=start,
        )  # fmt: skip
    fixed = with_fixed(file, plant, effects)
    refuse_impossible(plant, logs)
    std = np.array([p.std for p in priors])
    mean = dict(zip(file.free, (p.mean for p in priors), strict=True))
    return Robot(
        file, log, fixed, std, tuple(records), tuple(others), said, mean,
        own_effects=tuple(own_effects),
    )  # fmt: skip
