"""Geoms of a model that touch where a log says its joints were.

The model is put into states of the log: measured joints at their positions, others as the model
starts. Two bodies that touch in part of these states may be meant to: an end stop, the ground. Two
that touch in all of them most often are not. MuJoCo leaves out the contacts of a body with its
parent only while the parent moves, so that a base which was fixed to the world collides with its
own first link. But a robot that stands on the ground touches it all the time as well. So the log
decides: it is simulated with the model as it is, and without these contacts. The model is refused
where they are what keeps it from explaining the log (ε of `identification.refusals.readings`,
summed over outputs and logs), unless numbers of the touching geoms are free: who fits a contact
means it.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase

import mujoco
import numpy as np

from identification.effects.plant.joint_plant import JointPlant
from identification.errors import InputError
from identification.logs.log import Log
from identification.model.equalities import put_tied
from identification.model.plant import own_start
from identification.model.predictor import measured_joints, output_columns
from identification.quantities import quantity
from identification.refusals.judge import lengths_of, unexplained
from identification.refusals.readings import NEARER
from identification.refusals.trust import Robot
from identification.refusals.unmeasured import felt_trees
from identification.runtime.engine import quiet
from identification.shares import percent

LISTED = 3  # pairs that a sentence lists
FAR_BETTER = "and without this touch the model explains what was measured far better"
MOST_STATES = 200  # of a log that are looked at, spread over it; contacts last many samples
_OFF = int(mujoco.mjtDisableBit.mjDSBL_CONTACT) | int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)


@dataclass(frozen=True)
class Touch:
    """Two bodies whose geoms touch in some states of the logs."""

    bodies: tuple[int, int]  # their indices, the smaller one first
    geoms: tuple[int, ...]  # indices of the geoms that touch
    share: float  # of the states in which they touch, above 0 and at most 1
    depth: float  # the largest, beyond which MuJoCo pushes them apart [m]


def find_touches(robot: Robot, logs: Sequence[Log]) -> tuple[Touch, ...]:
    """Returns the pairs of bodies that touch along logs, the most frequent first.

    Pairs of which neither body moves what the logs measure are left out.
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
    """Returns whether a model explains logs far better where some of its geoms touch nothing."""
    if not touches:
        return False
    geoms = sorted({g for touch in touches for g in touch.geoms})
    rest, left_without = 0.0, 0.0
    for log in logs:
        plant, length = robot.plant_of(log), lengths_of(robot, log)[0]
        model = copy.copy(plant.bare.model)
        model.geom_contype[geoms] = 0
        model.geom_conaffinity[geoms] = 0
        without = replace(plant, bare=replace(plant.bare, model=model))
        rest += _left(plant, length, log)
        left_without += _left(without, length, log)
    return left_without < NEARER * rest


@quiet()
def _contacts(plant: JointPlant, log: Log) -> list[dict[tuple[int, int], tuple[set[int], float]]]:
    """Returns, by state, the geoms of each pair of bodies that touch, and their depth."""
    model, start = plant.model, plant.bare.start or own_start(plant.model)
    data, out = mujoco.MjData(model), []
    measured = [(i, k) for k, (field, i) in enumerate(output_columns(model, log.output_names))
                if field == "qpos"]  # fmt: skip
    count, known = min(len(log), MOST_STATES), measured_joints(model, log.output_names)
    for k in np.unique(np.linspace(0, len(log) - 1, count).round().astype(int)):
        data.qpos[:] = np.ravel(start.qpos)
        for i, column in measured:
            data.qpos[i] = log.outputs[k, column]
        put_tied(model, known, data.qpos, data.qvel)
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
    rest = unexplained(plant, length, log)
    return np.inf if rest is None else float(rest.sum())


def refuse_touching(robot: Robot, logs: Sequence[Log], touches: Sequence[Touch]) -> None:
    """Refuse a model with bodies that touch in all states of logs which contradict this.

    None of their geoms has a free parameter, and the robot's file does not trust its contacts.
    """
    if "contacts" in robot.file.trust:
        return
    always = [t for t in touches if t.share == 1 and not _is_fitted(robot, t)]
    if is_contradicted(robot, logs, always):
        raise InputError(
            f"{robot.file.model}: {_who(robot, always)} in all states of {_where(logs)} that were"
            f" looked at, {_depth(always)}, {FAR_BETTER}, so that nothing is fitted;"
            f' {_cure(robot, always)}; or write trust = ["contacts"] into {robot.file.path}'
        )


def touch_sentence(
    robot: Robot, logs: Sequence[Log], touches: Sequence[Touch], contradicted: bool
) -> str:
    """Returns a sentence on what touches along logs, "" for nothing, and if they contradict it."""
    if not touches:
        return ""
    shares = " and ".join(dict.fromkeys(percent(touch.share) for touch in touches[:LISTED]))
    more = f", {FAR_BETTER}" if contradicted else ""
    return (
        f"In the model {_who(robot, touches)} in {shares} of the states of {_where(logs)} that were"
        f" looked at, {_depth(touches)}{more}. If this touch is not meant,"
        f" {_cure(robot, touches)}."
    )


@contextmanager
def told_first(*sentences: str) -> Iterator[None]:
    """Adds sentences on what may be the cause, those that are not "", to an error inside."""
    sentence = " ".join(filter(None, sentences))
    try:
        yield
    except InputError as error:
        if not sentence:
            raise
        raise type(error)(f"{error}. But first look at this: {sentence}") from error


def _is_fitted(robot: Robot, touch: Touch) -> bool:
    """Returns whether a number of a geom that touches is free."""
    names = [robot.plant.model.geom(g).name for g in touch.geoms]
    paths = [str(robot.file.records.get(n, {}).get("path", n)) for n in robot.file.free]
    things = [path.removeprefix("geom/").rpartition(".")[0] for path in paths
              if path.startswith("geom/")]  # fmt: skip
    return any(fnmatchcase(name, thing) for name in names for thing in things)


def _who(robot: Robot, touches: Sequence[Touch]) -> str:
    """Returns which bodies touch, in words."""
    model = robot.plant.model
    pairs = [" and ".join(_called(model, b, touch) for b in touch.bodies[::-1])
             for touch in touches[:LISTED]]  # fmt: skip
    more = f" and {len(touches) - LISTED} more pairs" if len(touches) > LISTED else ""
    return f"geoms of {', of '.join(pairs)}{more} touch"


def _called(model: mujoco.MjModel, body: int, touch: Touch) -> str:
    """Returns a body in words; of the world the geom, which may be the ground."""
    if body:
        return model.body(body).name or f"body {body}"
    geom = next(g for g in touch.geoms if not model.geom_bodyid[g])
    kind = mujoco.mjtGeom(int(model.geom_type[geom])).name.removeprefix("mjGEOM_").lower()
    return f"the world ({kind} {model.geom(geom).name}".rstrip() + ")"


def _where(logs: Sequence[Log]) -> str:
    return f"log {logs[0].name!r}" if len(logs) == 1 else f"the {len(logs)} logs"


def _depth(touches: Sequence[Touch]) -> str:
    """Returns how deep geoms lie in each other, in words."""
    return f"up to {quantity(max(touch.depth for touch in touches), unit='m')} deep"


def _cure(robot: Robot, touches: Sequence[Touch]) -> str:
    """Returns the lines that switch touches off."""
    model, name = robot.plant.model, robot.file.model.name
    excludes, others = [], []
    for touch in touches[:LISTED]:
        a, b = (model.body(body).name for body in touch.bodies)
        if pairs := _given_pairs(model, touch):
            others.append(f"delete {pairs}")  # which no <exclude> leaves out
        elif a and b:
            excludes.append(f'<exclude body1="{a}" body2="{b}"/>')
        else:
            geoms = [g for g in touch.geoms if model.geom_bodyid[g] == touch.bodies[1]]
            what = " and ".join(model.geom(g).name or f"number {g}" for g in geoms)
            others.append(f'write contype="0" conaffinity="0" at geom {what}')
    lines = [f"write {' '.join(excludes)} into <contact>"] * bool(excludes) + others
    return (
        f'{" and ".join(lines)} of {name}, or write <flag contact="disable"/> into its <option>'
        " where nothing is to touch"
    )


def _given_pairs(model: mujoco.MjModel, touch: Touch) -> str:
    """Returns the elements <pair> of a model that let geoms touch."""
    each = zip(model.pair_geom1, model.pair_geom2, strict=True)
    names = [[model.geom(g).name for g in pair] for pair in each if {*pair} <= {*touch.geoms}]
    return " and ".join(f'<pair geom1="{a}" geom2="{b}"/>' for a, b in names)
