"""Units of the numbers of a robot's model, which are in SI."""

from __future__ import annotations

from collections.abc import Mapping
from fnmatch import fnmatchcase
from typing import Any

import mujoco
import numpy as np

from identification.logs.dimension import refuse_not_si, refuse_other_unit
from identification.model.plant import start_place

UNITS = {  # unit for a slide, unit for a hinge
    "damping": ("N s/m", "N m s/rad"), "armature": ("kg", "kg m^2"),
    "stiffness": ("N/m", "N m/rad"), "frictionloss": ("N", "N m"),
    "qpos": ("m", "rad"), "qvel": ("m/s", "rad/s"),
}  # fmt: skip


GAINS = {"kp": "stiffness", "kv": "damping"}  # a servo is a spring and a damper to its command


def unit_of(model: mujoco.MjModel, path: str) -> str:
    """Returns the unit of a number of a model, "" where none is known.

    Known are those of a body's mass, a joint's number, an entry of the start and a servo's gain.
    """
    place = start_place(path, model)
    thing, _, attribute = path.partition("[")[0].rpartition(".")
    kind, _, name = thing.partition("/")
    joints: list[int] = []
    if place is not None:
        attribute = place[0]
        at = model.jnt_qposadr if attribute == "qpos" else model.jnt_dofadr
        joints = np.flatnonzero(at <= place[1])[-1:].tolist()
    elif kind == "joint":
        joints = [j for j in range(model.njnt) if fnmatchcase(model.joint(j).name, name)]
    elif kind == "actuator" and attribute in GAINS:
        return _unit_of_gain(model, name, GAINS[attribute])
    if not joints or attribute not in UNITS:
        units = {"mass": "kg", "inertia": "kg m^2", "spread": "kg m^2"}
        return units.get(attribute, "") if kind == "body" else ""
    return _by_joint(model, joints[0], attribute)


def _unit_of_gain(model: mujoco.MjModel, name: str, like: str) -> str:
    """Returns the unit of a gain of servos, "" where theirs are not the same or not known."""
    units = {_unit_at(model, i, like) for i in range(model.nu)
             if fnmatchcase(model.actuator(i).name, name)}  # fmt: skip
    return units.pop() if len(units) == 1 else ""


def _unit_at(model: mujoco.MjModel, actuator: int, like: str) -> str:
    """Returns the unit of a spring or damper that acts where an actuator does."""
    # Another gear may turn an angle into a way: it has then a unit that no file tells.
    if abs(model.actuator_gear[actuator, 0]) != 1:
        return ""
    kind, at = int(model.actuator_trntype[actuator]), int(model.actuator_trnid[actuator, 0])
    if kind == int(mujoco.mjtTrn.mjTRN_TENDON):  # of joints, or a way through space
        is_fixed = model.wrap_type[model.tendon_adr[at]] == int(mujoco.mjtWrap.mjWRAP_JOINT)
        return "" if is_fixed else UNITS[like][0]
    if kind not in (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT)):
        return ""
    return _by_joint(model, at, like)


def _by_joint(model: mujoco.MjModel, joint: int, like: str) -> str:
    """Returns the unit of a number of a slide or a hinge, "" of another joint."""
    types = (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE))
    found = int(model.jnt_type[joint])
    return UNITS[like][types.index(found)] if found in types else ""


def refuse_unit(said: Mapping[str, Any], own: str, whose: str) -> None:
    """Refuse a unit in which the model does not read numbers.

    Args:
        said: the table of a parameter.
        own: the unit of the model's numbers; "" where none is known.
        whose: unit it is, for messages.
    """
    unit = said.get("unit", own)
    if own:
        refuse_other_unit(unit, own, whose)
    refuse_not_si(unit, whose)
