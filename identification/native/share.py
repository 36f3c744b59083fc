"""The share of one actuator of a law in the rates, without the rest of the model.

    M q̈ = f + Σ_i f_i(q, v, a_i, p_i),    ȧ_i = g_i(q, v, a_i, p_i)

f_i are the forces of actuator i with all that its law adds, a_i its activations, p_i the numbers
that it alone reads: its share. Another value of p_i or a_i changes nothing but f_i and g_i, so that
the change of the rates is M⁻¹ Δf_i and Δg_i. The same holds of the angle and the rate of a balanced
rotor that turns in the frame (`is_balanced_rotor`). It costs the law of one actuator and no other
law, no actuators and no kinematics. It holds where no constraint acts, which would answer the
force, and where nothing else adds forces to those of the actuator.
"""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np

from identification.native.decorators import internal
from identification.native.memory import load_word
from identification.native.table import SHARE, callback, table
from identification.native.trampolines import SIGNATURES, caller

_BITS = mujoco.mjtDisableBit
_ANSWERED, _LEFT_OUT = (
    int(_BITS.mjDSBL_CONSTRAINT), int(_BITS.mjDSBL_ACTUATION | _BITS.mjDSBL_DAMPER)
)  # fmt: skip

# What limits the force of an actuator, or adds to it what its share does not have.
_OTHER_FORCES = (
    "actuator_forcelimited", "actuator_actlimited", "jnt_actfrclimited", "jnt_actgravcomp",
    "actuator_gainprm", "actuator_damping", "actuator_dampingpoly", "tendon_stiffness",
    "tendon_stiffnesspoly", "tendon_damping", "tendon_dampingpoly", "dof_dampingpoly",
    "jnt_stiffnesspoly",
)  # fmt: skip

# (array of the model, row in it) or (field of the state, index in it) -> actuator
Owners = Mapping[tuple[str, int], int]

_laws_of, _call = table(SHARE), caller(SIGNATURES[SHARE])


def has_shares(model: mujoco.MjModel) -> bool:
    """Returns whether the share of an actuator may be taken alone, where its law gives one."""
    option = model.opt
    is_free = option.disableflags & _ANSWERED and not option.disableflags & _LEFT_OUT
    rest = [np.any(getattr(model, field)) for field in _OTHER_FORCES]
    rest += [option.density, option.viscosity, option.disableactuator]
    return bool(is_free) and not any(rest)


def is_balanced_rotor(model: mujoco.MjModel, joint: int) -> bool:
    """Returns whether a joint turns a body in the frame, and no gravity or spring feels its angle.

    Args:
        model: the model.
        joint: index of the joint.
    """
    body = int(model.jnt_bodyid[joint])
    off = np.cross(model.body_ipos[body] - model.jnt_pos[joint], model.jnt_axis[joint])
    return bool(
        model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE
        and model.body_dofnum[body] == 1
        and not model.body_weldid[model.body_parentid[body]]
        and body not in model.body_parentid[1:]
        and not model.jnt_stiffness[joint]
        and not off.any()
        and not (model.site_bodyid == body).any()
    )


@internal
def add_share(m, d, i):  # type: ignore[no-untyped-def]
    """Add f_i to `qfrc_passive`, and put g_i into `act_dot`."""
    laws = _laws_of()
    for k in range(load_word(laws) - 1, -1, -1):
        if _call(callback(laws, k), (m, d, i)) != 0.0:
            return
