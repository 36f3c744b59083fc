"""Geoms of a model that touch where a log says its joints were.

The model is put into states of the log: measured joints at their positions, others as the model
starts. Two bodies that touch in part of these states may be meant to: an end stop, the ground. Two
that touch in all of them most often are not. MuJoCo leaves out the contacts of a body with its
parent only while the parent moves, so that a base which was fixed to the world collides with its
own first link. But a robot that stands on the ground touches it all the time as well. So the log
decides: it is simulated with the model as it is, and without these contacts. The model is refused
where they are what keeps it from explaining the log (ε of `identification.logs.readings`, summed
over outputs and logs), unless numbers of the touching geoms are free: who fits a contact means it.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from identification.effects.joint_plant import JointPlant
from identification.engine import quiet
from identification.logs.log import Log
from identification.logs.readings import NEARER
from identification.model.plant import own_start
from identification.model.predictor import output_columns
from identification.robot.robot import Robot
from identification.robot.unmeasured import felt_trees
from identification.robot.wiring import lengths_of, unexplained

MOST_STATES = 200  # of a log that are looked at, spread over it; contacts last many samples
_OFF = int(mujoco.mjtDisableBit.mjDSBL_CONTACT) | int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)


@dataclass(frozen=True)
class Touch:
    """Two bodies whose geoms touch in some states of the logs.

    Attributes:
        bodies: their indices, the smaller one first.
        geoms: indices of the geoms that touch.
        share: of the states in which they touch, above 0 and at most 1.
        depth: the largest, beyond which MuJoCo pushes them apart [m].
    """

    bodies: tuple[int, int]
    geoms: tuple[int, ...]
    share: float
    depth: float


def find_touches(robot: Robot, logs: Sequence[Log]) -> tuple[Touch, ...]:
    """Returns the pairs of bodies that touch along logs, the most frequent first.

    Pairs of which neither body moves what the logs measure are left out.

    Args:
        robot: the result of `robot_of`.
        logs: all logs of the robot.
    """
    model = robot.plant.model
    if model.opt.disableflags & _OFF or not model.ngeom:
        return ()
    felt, states = felt_trees(model, logs[0]), 0
    found: dict[tuple[int, int], list[tuple[set[int], float]]] = {}
    for log in logs:
        for contacts in _contacts(robot.plant_of(log), log):
            states += 1
            for bodies, each in contacts.items():
                if {int(model.body_treeid[b]) for b in bodies} & felt:
                    found.setdefault(bodies, []).append(each)
    touches = [
        Touch(
            bodies, tuple(sorted(set().union(*(geoms for geoms, _ in each)))), len(each) / states,
            max(depth for _, depth in each),
        )
        for bodies, each in found.items()
    ]  # fmt: skip
    return tuple(sorted(touches, key=lambda t: (-t.share, -t.depth)))


def is_contradicted(robot: Robot, logs: Sequence[Log], touches: Sequence[Touch]) -> bool:
    """Returns whether a model explains logs far better where some of its geoms touch nothing.

    Args:
        robot: the result of `robot_of`.
        logs: all logs of the robot.
        touches: of `find_touches`; without any nothing is simulated.
    """
    if not touches:
        return False
    geoms = sorted({g for touch in touches for g in touch.geoms})
    left, left_without = 0.0, 0.0
    for log in logs:
        plant, length = robot.plant_of(log), lengths_of(robot, log)[0]
        model = copy.copy(plant.bare.model)
        model.geom_contype[geoms] = 0
        model.geom_conaffinity[geoms] = 0
        without = replace(plant, bare=replace(plant.bare, model=model))
        left += _left(plant, length, log)
        left_without += _left(without, length, log)
    return left_without < NEARER * left


@quiet()
def _contacts(plant: JointPlant, log: Log) -> list[dict[tuple[int, int], tuple[set[int], float]]]:
    """Returns, by state, the geoms of each pair of bodies that touch, and their depth."""
    model, start = plant.model, plant.bare.start or own_start(plant.model)
    data, out = mujoco.MjData(model), []
    measured = [(i, k) for k, (field, i) in enumerate(output_columns(model, log.output_names))
                if field == "qpos"]  # fmt: skip
    count = min(len(log), MOST_STATES)
    for k in np.unique(np.linspace(0, len(log) - 1, count).round().astype(int)):
        data.qpos[:] = np.ravel(start.qpos)
        for i, column in measured:
            data.qpos[i] = log.outputs[k, column]
        mujoco.mj_fwdPosition(model, data)
        found: dict[tuple[int, int], tuple[set[int], float]] = {}
        for contact in data.contact:
            depth = float(contact.includemargin - contact.dist)
            if contact.exclude or depth <= 0 or min(contact.geom) < 0:
                continue
            a, b = sorted(int(model.geom_bodyid[g]) for g in contact.geom)
            geoms, deepest = found.get((a, b), (set(), 0.0))
            found[a, b] = geoms | {*map(int, contact.geom)}, max(deepest, depth)
        out.append(found)
    return out


def _left(plant: JointPlant, length: float, log: Log) -> float:
    """Returns what a model leaves unexplained of a log; all where it cannot be simulated."""
    left = unexplained(plant, length, log)
    return np.inf if left is None else float(left.sum())
