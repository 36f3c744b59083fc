"""What the torques of a robot's logs say: base parameters, friction, and what the model lacks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import mujoco
import numpy as np

from identification.discovery.passes import refuse_unknown
from identification.errors import InputError, refuse_kind
from identification.logs.joined import refuse_different
from identification.logs.log import Log
from identification.model.protocol import with_numbers
from identification.robot.results.results import TorqueFit
from identification.robot.robot import Robot
from identification.robot.turned_drives import bare_models, plain, turned_words
from identification.storage.written import Files
from identification.torques.equations.bodies import read_numbers
from identification.torques.equations.frictions import read_friction
from identification.torques.equations.others import FreeNumber
from identification.torques.evidence import find_evidence

FRICTIONS = (".damping", ".frictionloss")  # endings of paths
STEP = 1e-3  # of a value, or of its scale where it is zero, by which it is moved


def fit_torques(
    robot: Robot, progress: Callable[[str], None] | None = None, without: Sequence[str] = ()
) -> TorqueFit:
    """Compare the drives' forces with those that the measured motion needs.

    All positions must be measured, and the inputs must be what the drives gave. Nothing is
    simulated, so that it takes seconds. Records that confirm judge what is found; where there are
    none, blocks of the logs do that the fits did not see.

    Args:
        robot: the result of `read_robot`; its free masses, inertias and armatures are fitted with
            their priors, and friction always.
        progress: is told one line per step.
        without: names of passes that are left out (docs/discovery.md has them).

    Raises:
        InputError: `without` is no list of names of passes, a joint is neither hinge nor slide or
            is not measured, bodies are tied in a loop, a drive has a state, a log is too short,
            two logs hold the same samples, or the drives' forces have the other sign.
    """
    refuse_kind(robot, Robot, "fit_torques takes a robot (read_robot)")
    refuse_unknown(without)
    logs = (robot.log, *robot.others, *robot.records)
    refuse_different(logs)
    model, own = bare_models(robot, logs)
    evidence = find_evidence(
        model, logs, own=own,
        confirm=len(robot.records), free=free_numbers(robot, logs), effects=robot.candidates,
        bodies=robot.plant.bodies, friction=_friction(robot, model), say=progress,
        without=without,
    )  # fmt: skip
    is_asked = "wiring" not in robot.file.trust
    if is_asked and (turned := turned_words(robot, evidence.base, evidence.whole.fit)):
        raise InputError(turned)
    return TorqueFit(robot, evidence, _files)


def free_numbers(robot: Robot, logs: Sequence[Log]) -> tuple[FreeNumber, ...]:
    """Returns the free parameters of a robot that change the equations of its torques.

    Frictions of joints are left out, because every fit of torques has them, and so are numbers of
    effects, which have no path in the model and are candidates. Where a value holds in
    one log alone, only masses, inertias and armatures are free.
    """
    plant, out = robot.plant, []
    differ = {name for log in logs for name in log.values}
    for name, std in zip(robot.file.free, robot.std, strict=True):
        record = plant.parameters[name]
        if name in differ or name not in robot.mean:
            continue
        mean = robot.mean[name]
        known = float(std) * (mean if record.lower >= 0 and min(record.value, mean) > 0
                              else record.scale)  # fmt: skip
        step = STEP * (abs(record.value) or record.scale)
        values = np.array([[record.value], [record.value + step]])
        if values[1] > record.upper:
            values[1] -= 2 * step
        _, numbers = plant.settings((name,), values)
        before, after = (_numbers(with_numbers(plant.model, numbers, k)) for k in range(2))
        change = (after - before) / float(values[1, 0] - values[0, 0])
        number = FreeNumber(
            name=name, where=record.where, unit=record.unit, value=record.value, mean=mean,
            std=known, change=change,
        )  # fmt: skip
        if np.abs(change).max() > 0:
            out.append(number)
        elif not differ and "/" in record.where and not record.where.endswith(FRICTIONS):
            moved = with_numbers(plant.model, numbers, 1)
            by = float(values[1, 0] - values[0, 0])
            out.append(replace(number, moved=plain(moved), step=by))
    return tuple(out)


def _numbers(model: mujoco.MjModel) -> np.ndarray:
    return np.concatenate([read_numbers(model).ravel(), model.dof_armature])


def _friction(robot: Robot, model: mujoco.MjModel) -> np.ndarray:
    """Returns the frictions of a robot's joints, its effects among them, shape (3 nv,)."""
    values, out = robot.plant.parameters.values(), read_friction(model)
    for k, j in enumerate(model.dof_jntid):
        for i, name in ((1, "coulomb_friction.f_c"), (2, "offset.f_0")):
            places = (name, f"{name}@{model.joint(int(j)).name}")
            out[3 * k + i] += sum(values.get(place, 0.0) for place in places)
    return out


def _files(found: TorqueFit) -> Files:
    from identification.robot.results.fit_files import TorqueFiles  # what draws is slow to import

    return TorqueFiles(found)
