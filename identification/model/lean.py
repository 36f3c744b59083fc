"""Models whose steps leave out what cannot act: sensors, and constraints where there can be none.

MuJoCo looks for contacts, limits and dry friction in every evaluation, also where a model has none
of them. Of a step of a slider that is a quarter, of an arm of two joints a sixth, of one of six an
eighth. What is predicted stays the same to the bit.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from identification.model.paths import Slot

SENSORS = int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
CONSTRAINTS = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT) | int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
# Entries that make a constraint where they are not zero; a value set may bring them.
ACTIVE = ("jnt_limited", "tendon_limited", "dof_frictionloss", "tendon_frictionloss")
COLLIDING = ("geom_contype", "geom_conaffinity")


def lean(model: mujoco.MjModel, numbers: Sequence[tuple[Slot, Any]] = ()) -> mujoco.MjModel:
    """Returns the model without what cannot act on its states; itself where that is left out.

    Args:
        model: the model.
        numbers: entries that differ in its simulations, and their values.
    """
    flags = SENSORS
    if model.opt.disableflags & CONSTRAINTS != CONSTRAINTS and not is_constrained(model, numbers):
        flags |= CONSTRAINTS
    if model.opt.disableflags & flags == flags:
        return model
    model = copy.copy(model)
    model.opt.disableflags |= flags
    return model


def is_constrained(model: mujoco.MjModel, numbers: Sequence[tuple[Slot, Any]] = ()) -> bool:
    """Whether a limit, dry friction, an equality or a contact may act on a model.

    Args:
        model: the model.
        numbers: entries that differ in its simulations, and their values.
    """
    if model.neq or model.npair or model.nflex:
        return True
    if any(slot.field in (*ACTIVE, *COLLIDING) for slot, _ in numbers):
        return True
    if any(np.any(getattr(model, field)) for field in ACTIVE):
        return True
    colliding = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    return len(np.unique(model.geom_bodyid[colliding])) > 1
