"""The bodies that touch along logs, in sentences, and whether a model is refused for them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from fnmatch import fnmatchcase

import mujoco

from identification.errors import InputError
from identification.logs.log import Log
from identification.quantities import quantity
from identification.robot.robot import Robot
from identification.robot.touching import Touch, is_contradicted

LISTED = 3  # pairs that a sentence lists
FAR_BETTER = "and without this touch the model explains what was measured far better"


def refuse_touching(robot: Robot, logs: Sequence[Log], touches: Sequence[Touch]) -> None:
    """Refuse a model with bodies that touch in all states of logs which contradict this.

    Args:
        robot: the result of `robot_of`.
        logs: all logs of the robot.
        touches: of `find_touches`.

    Raises:
        InputError: without these touches the model explains the logs far better, none of their
            geoms has a free parameter, and the robot's file does not trust its contacts.
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
    """Returns one sentence that says what touches along logs; "" where nothing does.

    Args:
        robot: the result of `robot_of`.
        logs: all logs of the robot.
        touches: of `find_touches`.
        contradicted: whether the logs contradict them (`is_contradicted`).
    """
    if not touches:
        return ""
    shares = " and ".join(dict.fromkeys(_percent(touch.share) for touch in touches[:LISTED]))
    more = f", {FAR_BETTER}" if contradicted else ""
    return (
        f"In the model {_who(robot, touches)} in {shares} of the states of {_where(logs)} that were"
        f" looked at, {_depth(touches)}{more}. If this touch is not meant,"
        f" {_cure(robot, touches)}."
    )


@contextmanager
def told_of_touches(sentence: str) -> Iterator[None]:
    """Raises an error inside anew, together with contacts that the log contradicts.

    Args:
        sentence: of `touch_sentence`; "" where nothing is to be added.

    Raises:
        InputError: of the same kind as inside, with the sentence behind its message.
    """
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


def _percent(share: float) -> str:
    """Returns a share of states in words, which is neither none nor all unless it truly is."""
    if 0.995 <= share < 1:
        return "nearly all"
    return f"{100 * share:.0f} %" if share >= 0.005 else "less than 1 %"


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
    """Returns the logs in words."""
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
