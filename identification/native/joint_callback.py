"""The effects of joints inside MuJoCo's passive forces.

    qfrc_passive[v_j] += Σ_e force_e(s_j, p_e,j)          s_j: the `Joint` state of joint j

The numbers stand at the end of a joint's user data, in a row

    (v₀, parameters of the effects, key of the set of effects, TAG)

Every joint without such a row and every other model passes through untouched. Sizes of zero add
nothing, so that the bare model's trajectory is kept to the bit. A compiled callback must not
raise: a row whose set of effects is not compiled in this process makes NaN, which MuJoCo reports
as a divergence.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence
from math import tanh
from typing import Any

import mujoco
import numpy as np

from identification.native.access import double, integer, offsets, word
from identification.native.compose import total
from identification.native.decorators import inlined
from identification.native.element import Element, Function, Hook, Term
from identification.native.memory import load_byte, load_constant, load_double, store_double
from identification.native.table import is_compiled

TAG = 7351.0609  # last entry of a row of ours
SMOOTH, FIRST, LAST = 0, 1, 2  # columns of v₀ and of the first parameter; entries behind the last

# What an effect sees of a hinge or slide joint.
#   time [s]; q, v: position [rad or m] and velocity [rad/s or m/s]
#   v_0 [rad/s or m/s]: below this speed friction creeps, as a fixed step demands
#   sign = tanh(v/v₀): a smooth sign of the velocity
#   f_u [N m or N]: force of the joint's own drives; NaN where it is not gain·u + bias
Joint: Any = namedtuple("Joint", "time q v v_0 sign f_u")

JOINT = Element("joint", Joint, (Hook("force", ("force [N] or torque [N m] on the joint",)),))

M = offsets(
    "mjModel",
    "njnt nuser_jnt jnt_user jnt_qposadr jnt_dofadr nactuator actuator_trntype actuator_trnid"
    " actuator_gear actuator_gainprm actuator_biasprm actuator_dyntype actuator_gaintype"
    " actuator_biastype actuator_ctrladr actuator_ctrllimited actuator_ctrlrange"
    " actuator_forcelimited actuator_forcerange",
)
D = offsets("mjData", "time qpos qvel ctrl qfrc_passive")
FIELDS = frozenset((*M._fields, *D._fields))  # everything the callback touches

_JOINT = int(mujoco.mjtTrn.mjTRN_JOINT)
_NO_DYNAMICS = int(mujoco.mjtDyn.mjDYN_NONE)
_FIXED = int(mujoco.mjtGain.mjGAIN_FIXED)
_NO_BIAS, _AFFINE = int(mujoco.mjtBias.mjBIAS_NONE), int(mujoco.mjtBias.mjBIAS_AFFINE)
_GAINS, _BIASES, _GEARS = mujoco.mjNGAIN, mujoco.mjNBIAS, 6


def width(terms: Sequence[Term]) -> int:
    """Entries of a joint's row with some effects."""
    return FIRST + sum(len(term.names) for term in terms) + LAST


@inlined
def _clipped(m, limited, range_, i, x):  # type: ignore[no-untyped-def]
    """x within limit i of an array of limits, where there is one."""
    if load_byte(word(m, limited) + i):
        x = max(double(m, range_, 2 * i), min(double(m, range_, 2 * i + 1), x))
    return x


@inlined
def _actuator_force(m, d, i, q, v):  # type: ignore[no-untyped-def]
    """Force of actuator i on its joint, gain·u + bias [N or N m]; NaN where it is another law."""
    bias = integer(m, M.actuator_biastype, i)
    if (
        integer(m, M.actuator_dyntype, i) != _NO_DYNAMICS
        or integer(m, M.actuator_gaintype, i) != _FIXED
        or (bias != _NO_BIAS and bias != _AFFINE)
    ):
        return np.nan
    at = integer(m, M.actuator_ctrladr, i)
    u = _clipped(m, M.actuator_ctrllimited, M.actuator_ctrlrange, at, double(d, D.ctrl, at))
    gear = double(m, M.actuator_gear, _GEARS * i)
    own = double(m, M.actuator_gainprm, _GAINS * i) * u
    if bias == _AFFINE:
        b = _BIASES * i
        own += double(m, M.actuator_biasprm, b)
        own += gear * double(m, M.actuator_biasprm, b + 1) * q
        own += gear * double(m, M.actuator_biasprm, b + 2) * v
    return gear * _clipped(m, M.actuator_forcelimited, M.actuator_forcerange, i, own)


@inlined
def drive_force(m, d, j, q, v):  # type: ignore[no-untyped-def]
    """Force of the actuators on joint j [N or N m]."""
    f = 0.0
    for i in range(word(m, M.nactuator)):
        if integer(m, M.actuator_trntype, i) == _JOINT and integer(m, M.actuator_trnid, 2 * i) == j:
            f += _actuator_force(m, d, i, q, v)
    return f


@inlined
def joint(m, d, j, row):  # type: ignore[no-untyped-def]
    """The state of joint j whose row is at an address."""
    q = double(d, D.qpos, integer(m, M.jnt_qposadr, j))
    v = double(d, D.qvel, integer(m, M.jnt_dofadr, j))
    v_0 = load_constant(row + 8 * SMOOTH)
    return Joint(
        time=load_constant(d + 8 * D.time), q=q, v=v, v_0=v_0, sign=tanh(v / v_0),
        f_u=drive_force(m, d, j, q, v),
    )  # fmt: skip


def callbacks(terms: Sequence[Term], key: float) -> dict[str, Function]:
    """The callback of a set of joint effects, to be compiled.

    Args:
        terms: the effects, their columns counted from the first parameter of a row.
        key: of the set.
    """
    force, entries = total(JOINT, terms, "force"), width(terms)

    def passive(m, d):  # type: ignore[no-untyped-def]
        columns = word(m, M.nuser_jnt)
        if columns < LAST:
            return
        for j in range(word(m, M.njnt)):
            end = word(m, M.jnt_user) + 8 * columns * (j + 1)
            if load_constant(end - 8) != TAG:
                continue
            at = word(d, D.qfrc_passive) + 8 * integer(m, M.jnt_dofadr, j)
            own = load_constant(end - 16)
            if own != key:
                if not is_compiled(own):
                    store_double(at, np.nan)
                continue
            row = end - 8 * entries
            f = force(joint(m, d, j, row), row + 8 * FIRST, 0)
            if f != 0.0:
                store_double(at, load_double(at) + f)

    return {"passive": passive}
