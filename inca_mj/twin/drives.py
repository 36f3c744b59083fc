"""A drive and its cable as compiled callbacks see them: fields of MuJoCo, rows of numbers, state.

`M` and `D` hold the word offsets of the fields of mjModel and mjData. They are constants of the
compiled code; the installer checks them against live objects.
"""

from __future__ import annotations

import numpy as np

from identification.native.memory import (
    double,
    inlined,
    integer,
    internal,
    load_byte,
    load_constant,
    load_double,
    offsets,
    store_double,
    word,
)
from inca_mj.effects.hooks import KEY, Drive
from inca_mj.robot import law

M = offsets(
    "mjModel",
    "nactuator nsensor nuser_actuator nuser_tendon nuser_sensor nuser_body"
    " actuator_user actuator_actadr actuator_trnid actuator_ctrladr actuator_ctrllimited"
    " actuator_ctrlrange actuator_gear body_user body_jntadr tendon_user tendon_adr wrap_objid"
    " ten_J_rownnz ten_J_rowadr ten_J_colind jnt_qposadr jnt_dofadr dof_damping site_bodyid"
    " site_pos sensor_type sensor_objtype sensor_objid sensor_adr sensor_user",
)
D = offsets(
    "mjData",
    "time qpos qvel act act_dot ctrl ten_length ten_velocity ten_J qfrc_passive sensordata"
    " site_xpos xpos xmat",
)
FIELDS = frozenset((*M._fields, *D._fields))  # everything the callbacks touch


@internal
def drive(m, i, column):  # type: ignore[no-untyped-def]
    """Returns a number of drive i: row i of `actuator_user`."""
    return double(m, M.actuator_user, word(m, M.nuser_actuator) * i + column)


@internal
def cable(m, k, column):  # type: ignore[no-untyped-def]
    """Returns a number of cable k: row k of `tendon_user`."""
    return double(m, M.tendon_user, word(m, M.nuser_tendon) * k + column)


@internal
def has_drives(m):  # type: ignore[no-untyped-def]
    """Returns whether a model may have drives: whether its rows are wide enough."""
    return (
        word(m, M.nuser_actuator) >= law.ACTUATOR_COLUMNS
        and word(m, M.nuser_tendon) >= law.TENDON_COLUMNS
    )


@internal
def key_of(m, i):  # type: ignore[no-untyped-def]
    """Returns the key of the effects of drive i; zero where it has none, NaN if i is no drive."""
    if drive(m, i, law.ACTUATOR_TAG) != law.TAG:
        return np.nan
    return drive(m, i, KEY) if word(m, M.nuser_actuator) > KEY else 0.0


@internal
def cable_of(m, i):  # type: ignore[no-untyped-def]
    """Returns the index of the cable of drive i."""
    return np.int64(drive(m, i, law.CABLE))


@internal
def motor_dof(m, i):  # type: ignore[no-untyped-def]
    """Returns the degree of freedom of the motor of drive i."""
    return integer(m, M.jnt_dofadr, integer(m, M.actuator_trnid, 2 * i))


@internal
def current_of(m, d, i):  # type: ignore[no-untyped-def]
    """Returns the current of drive i, within its limits [A]."""
    u = integer(m, M.actuator_ctrladr, i)
    current = double(d, D.ctrl, u)
    if load_byte(word(m, M.actuator_ctrllimited) + u):
        current = max(current, double(m, M.actuator_ctrlrange, 2 * u))
        current = min(current, double(m, M.actuator_ctrlrange, 2 * u + 1))
    return current


@internal
def row_of(m, i):  # type: ignore[no-untyped-def]
    """Returns the address of the row of drive i in `actuator_user`."""
    return word(m, M.actuator_user) + 8 * word(m, M.nuser_actuator) * i


@internal
def activations_of(m, d, i):  # type: ignore[no-untyped-def]
    """Returns the address of the activations of drive i: d₀, then the states of its effects."""
    return word(d, D.act) + 8 * integer(m, M.actuator_actadr, i)


@inlined
def restart(m, d, i):  # type: ignore[no-untyped-def]
    """Give the cable of drive i its no-load length after a reset, which left it at zero."""
    act = activations_of(m, d, i)
    if load_double(act) == 0.0:
        k = cable_of(m, i)
        lambda_ = cable(m, k, law.LAMBDA)
        d_0 = lambda_ * double(d, D.ten_length, k) / (lambda_ + drive(m, i, law.T_0))
        store_double(act, d_0)


@inlined
def drive_state(m, d, i, line):  # type: ignore[no-untyped-def]
    """Returns drive i as the hooks before the tension see it."""
    joint, k = integer(m, M.actuator_trnid, 2 * i), line.k
    return Drive(
        time=load_constant(d + 8 * D.time),
        phi=double(d, D.qpos, integer(m, M.jnt_qposadr, joint)),
        omega=double(d, D.qvel, integer(m, M.jnt_dofadr, joint)),
        i=current_of(m, d, i), i_before=np.nan, i_after=np.nan, x=0.0,
        rx=line.x, ry=line.y, rz=line.z, d=line.length,
        d_0=load_double(activations_of(m, d, i)),  # `restart` may write it
        strain=np.nan, strain_rate=np.nan, T=np.nan, F_s=np.nan,
        R=drive(m, i, law.R), R_s=drive(m, i, law.R_S), k_s=drive(m, i, law.K_S),
        b_v=double(m, M.dof_damping, integer(m, M.jnt_dofadr, joint)),
        b_c=drive(m, i, law.B_C), beta=drive(m, i, law.BETA),
        K_t=double(m, M.actuator_gear, 6 * i),
        lambda_=cable(m, k, law.LAMBDA), b=cable(m, k, law.B),
    )  # fmt: skip


@internal
def neighbour_current(m, d, i):  # type: ignore[no-untyped-def]
    """Returns the current of actuator i where that is a drive, else zero [A]."""
    if i < 0 or i >= word(m, M.nactuator) or drive(m, i, law.ACTUATOR_TAG) != law.TAG:
        return 0.0
    return current_of(m, d, i)
