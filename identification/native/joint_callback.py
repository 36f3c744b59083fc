"""The law of `identification.native.joint_law` inside MuJoCo's passive forces.

qfrc_passive[v_j] += f(q_j, v_j, f_u,j; user data of joint j)

A joint has effects when its user data end in a row that begins with `KEY`; every other joint and
model passes through untouched. Sizes of zero add nothing, so that the bare model's trajectory is
kept to the bit. A compiled callback must not raise: numbers that make no sense make NaN, which
MuJoCo reports as a divergence.
"""

from __future__ import annotations

import mujoco
from numba import njit

from identification.native.access import double, integer, offsets, word
from identification.native.joint_law import Numbers, force
from identification.native.memory import load_byte, load_constant, load_double, store_double

KEY = 7351.0609  # first entry of a row of ours
WIDTH = 1 + len(Numbers._fields)  # entries of a row: the key and the numbers

M = offsets(
    "mjModel",
    "njnt nuser_jnt jnt_user jnt_qposadr jnt_dofadr nactuator actuator_trntype actuator_trnid"
    " actuator_gear actuator_gainprm actuator_biasprm actuator_ctrladr actuator_ctrllimited"
    " actuator_ctrlrange actuator_forcelimited actuator_forcerange",
)
D = offsets("mjData", "qpos qvel ctrl qfrc_passive")
FIELDS = {*M._fields, *D._fields}  # everything the callback touches

_JOINT = int(mujoco.mjtTrn.mjTRN_JOINT)
_GAINS, _BIASES, _GEARS = mujoco.mjNGAIN, mujoco.mjNBIAS, 6


@njit
def _clipped(m, limited, range_, i, x):  # type: ignore[no-untyped-def]
    """x within limit i of an array of limits, where there is one."""
    if load_byte(word(m, limited) + i):
        x = max(double(m, range_, 2 * i), min(double(m, range_, 2 * i + 1), x))
    return x


@njit
def drive_force(m, d, j, q, v):  # type: ignore[no-untyped-def]
    """Force of the actuators on joint j, of those that give gain·u + bias [N or N m]."""
    f = 0.0
    for i in range(word(m, M.nactuator)):
        if integer(m, M.actuator_trntype, i) != _JOINT or integer(m, M.actuator_trnid, 2 * i) != j:
            continue
        at = integer(m, M.actuator_ctrladr, i)
        u = _clipped(m, M.actuator_ctrllimited, M.actuator_ctrlrange, at, double(d, D.ctrl, at))
        gear, b = double(m, M.actuator_gear, _GEARS * i), _BIASES * i
        own = double(m, M.actuator_gainprm, _GAINS * i) * u + double(m, M.actuator_biasprm, b)
        own += gear * double(m, M.actuator_biasprm, b + 1) * q
        own += gear * double(m, M.actuator_biasprm, b + 2) * v
        f += gear * _clipped(m, M.actuator_forcelimited, M.actuator_forcerange, i, own)
    return f


@njit
def _numbers(row):  # type: ignore[no-untyped-def]
    """The numbers behind the key of a row at an address."""
    return Numbers(
        load_constant(row + 8), load_constant(row + 16), load_constant(row + 24),
        load_constant(row + 32), load_constant(row + 40), load_constant(row + 48),
        load_constant(row + 56), load_constant(row + 64), load_constant(row + 72),
        load_constant(row + 80), load_constant(row + 88), load_constant(row + 96),
        load_constant(row + 104), load_constant(row + 112), load_constant(row + 120),
        load_constant(row + 128), load_constant(row + 136), load_constant(row + 144),
        load_constant(row + 152),
    )  # fmt: skip


@njit
def add_joint_forces(m, d):  # type: ignore[no-untyped-def]
    """Add the effects of all joints of a model to its passive forces."""
    width = word(m, M.nuser_jnt)
    if width < WIDTH:
        return
    for j in range(word(m, M.njnt)):
        row = word(m, M.jnt_user) + 8 * (width * (j + 1) - WIDTH)
        if load_constant(row) != KEY:
            continue
        p = _numbers(row)
        dof = integer(m, M.jnt_dofadr, j)
        q, v = double(d, D.qpos, integer(m, M.jnt_qposadr, j)), double(d, D.qvel, dof)
        f_u = drive_force(m, d, j, q, v) if p.mu != 0.0 else 0.0
        f = force(q, v, f_u, p)
        if f != 0.0:
            at = word(d, D.qfrc_passive) + 8 * dof
            store_double(at, load_double(at) + f)
