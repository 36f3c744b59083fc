"""Models whose steps leave out what cannot act: sensors, and constraints where there can be none.

MuJoCo looks for contacts, limits and dry friction in every evaluation, also where a model has none
of them. Of a step of a slider that is a quarter, of an arm of two joints a sixth, of one of six an
eighth. Its implicit integrator looks for everything whose force depends on rates; where the damping
of joints alone does, Euler's integrator, which has that implicitly, takes the same step: of an arm
of six joints in half the time. What is predicted stays the same to the bit.

    h |k_v γ| ‖M⁻¹ Jᵀ‖ < 1      of each actuator: a step without its damping implicitly is stable

An actuator at its forcerange has no damping, so that implicit integrators change its step by a jump
where it gets there. A difference of two simulations, over a step of a millionth, is then no slope.
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

# What has forces that depend on rates, beside linear damping of joints.
DAMPING = (
    "dof_dampingpoly", "tendon_damping", "tendon_dampingpoly", "actuator_damping",
    "actuator_dampingpoly", "flex_damping", "flex_edgedamping",
)  # fmt: skip
FIXED = int(mujoco.mjtGain.mjGAIN_FIXED)
BIASES = [int(getattr(mujoco.mjtBias, f"mjBIAS_{kind}")) for kind in ("NONE", "AFFINE", "USER")]
EULER = int(mujoco.mjtIntegrator.mjINT_EULER)
IMPLICIT = int(mujoco.mjtIntegrator.mjINT_IMPLICITFAST)
RK4 = int(mujoco.mjtIntegrator.mjINT_RK4)


def lean(model: mujoco.MjModel, numbers: Sequence[tuple[Slot, Any]] = ()) -> mujoco.MjModel:
    """Returns the model without what cannot act on its states; itself where that is left out."""
    flags = SENSORS
    if model.opt.disableflags & CONSTRAINTS != CONSTRAINTS and not is_constrained(model, numbers):
        flags |= CONSTRAINTS
    if model.opt.disableflags & flags == flags:
        return model
    model = copy.copy(model)
    model.opt.disableflags |= flags
    return model


def is_constrained(model: mujoco.MjModel, numbers: Sequence[tuple[Slot, Any]] = ()) -> bool:
    """Returns whether a limit, dry friction, an equality or a contact may act on a model."""
    if model.neq or model.npair or model.nflex:
        return True
    if any(slot.field in (*ACTIVE, *COLLIDING) for slot, _ in numbers):
        return True
    if any(np.any(getattr(model, field)) for field in ACTIVE):
        return True
    colliding = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    return len(np.unique(model.geom_bodyid[colliding])) > 1


def slope_integrator(model: mujoco.MjModel) -> int:
    """Returns the integrator of simulations for slopes: one evaluation of the dynamics a step.

    It has damping implicitly, but for that of actuators with a forcerange: where these are stable
    without, a step has their damping explicitly, and else the model's own integrator stays.
    """
    own = int(model.opt.integrator)
    rate = np.abs(model.actuator_biasprm[:, 2] * model.actuator_gear[:, 0]) * model.actuator_acc0
    if np.any((model.actuator_forcelimited != 0) & (rate > 0)):
        return EULER if np.all(model.opt.timestep * rate < 1) else own
    if own != RK4:
        return own
    return EULER if is_damped_by_joints_alone(model) else IMPLICIT


def is_damped_by_joints_alone(model: mujoco.MjModel) -> bool:
    """Returns whether MuJoCo derives by rates no force but that of joints' damping."""
    linear = (model.actuator_gaintype == FIXED) & np.isin(model.actuator_biastype, BIASES)
    others = [getattr(model, field) for field in DAMPING if hasattr(model, field)]
    others += [model.actuator_biasprm[:, 2], model.opt.density, model.opt.viscosity]
    is_explicit = model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_EULERDAMP)
    return bool(linear.all()) and not is_explicit and not any(np.any(x) for x in others)
