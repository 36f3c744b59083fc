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


def unit_of(model: mujoco.MjModel, path: str) -> str:
    """Unit of a body's mass, a joint's number or an entry of the start; "" of anything else."""
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
    if not joints or attribute not in UNITS:
        units = {"mass": "kg", "inertia": "kg m^2", "spread": "kg m^2"}
        return units.get(attribute, "") if kind == "body" else ""
    types = (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE))
    found = int(model.jnt_type[joints[0]])
    return UNITS[attribute][types.index(found)] if found in types else ""


def refuse_unit(said: Mapping[str, Any], own: str, whose: str) -> None:
    """Refuse a unit in which the model does not read numbers.

    Args:
        said: the table of a parameter.
        own: the unit of the model's numbers; "" where none is known.
        whose: unit it is, for messages.

    Raises:
        InputError: it is another unit, or none of SI.
    """
    unit = said.get("unit", own)
    if own:
        refuse_other_unit(unit, own, whose)
    refuse_not_si(unit, whose)
