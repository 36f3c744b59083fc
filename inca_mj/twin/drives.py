"""Drives, cables and the platform as compiled callbacks see them, and forces put on them.

`M` and `D` hold the word offsets of the fields of mjModel and mjData. They are constants of the
compiled code; the installer checks them against live objects. A free joint has its velocity in O
and its rates in body axes; a force F at a point r of the body (from its frame) does F on the first
three of its forces and Rᵀ (r × F) on the others.
"""

from __future__ import annotations

from collections import namedtuple
from typing import Any

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
from inca_mj.effects.hooks import KEY, Drive, Platform
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

# The cable k of a drive.
#   body: on which its connector is; length [m] of its path, rate [m/s] of that
#   x, y, z: connector minus exit point; rx, ry, rz: from the frame of the body to it; in O [m]
Line: Any = namedtuple("Line", "k body length rate x y z rx ry rz")


@internal
def drive(m, i, column):
    """Returns a number of drive i: row i of `actuator_user`."""
    return double(m, M.actuator_user, word(m, M.nuser_actuator) * i + column)


@internal
def cable(m, k, column):
    """Returns a number of cable k: row k of `tendon_user`."""
    return double(m, M.tendon_user, word(m, M.nuser_tendon) * k + column)


@internal
def has_drives(m):
    """Returns whether a model may have drives: whether its rows are wide enough."""
    return (
        word(m, M.nuser_actuator) >= law.ACTUATOR_COLUMNS
        and word(m, M.nuser_tendon) >= law.TENDON_COLUMNS
    )


@internal
def key_of(m, i):
    """Returns the key of the effects of drive i; zero where it has none, NaN if i is no drive."""
    if drive(m, i, law.ACTUATOR_TAG) != law.TAG:
        return np.nan
    return drive(m, i, KEY) if word(m, M.nuser_actuator) > KEY else 0.0


@internal
def row_of(m, i):
    """Returns the address of the row of drive i in `actuator_user`."""
    return word(m, M.actuator_user) + 8 * word(m, M.nuser_actuator) * i


@internal
def activations_of(m, d, i):
    """Returns the address of the activations of drive i: d₀, then the states of its effects."""
    return word(d, D.act) + 8 * integer(m, M.actuator_actadr, i)


@internal
def cable_of(m, i):
    """Returns the index of the cable of drive i."""
    return np.int64(drive(m, i, law.CABLE))


@internal
def motor_dof(m, i):
    """Returns the degree of freedom of the motor of drive i."""
    return integer(m, M.jnt_dofadr, integer(m, M.actuator_trnid, 2 * i))


@internal
def current_of(m, d, i):
    """Returns the current of drive i, within its limits [A]."""
    u = integer(m, M.actuator_ctrladr, i)
    current = double(d, D.ctrl, u)
    if load_byte(word(m, M.actuator_ctrllimited) + u):
        current = max(current, double(m, M.actuator_ctrlrange, 2 * u))
        current = min(current, double(m, M.actuator_ctrlrange, 2 * u + 1))
    return current


@internal
def neighbour_current(m, d, i):
    """Returns the current of actuator i where that is a drive, else zero [A]."""
    if i < 0 or i >= word(m, M.nactuator) or drive(m, i, law.ACTUATOR_TAG) != law.TAG:
        return 0.0
    return current_of(m, d, i)


@inlined
def restart(m, d, i):
    """Give the cable of drive i its no-load length after a reset, which left it at zero."""
    act = activations_of(m, d, i)
    if load_double(act) == 0.0:
        k = cable_of(m, i)
        lambda_ = cable(m, k, law.LAMBDA)
        d_0 = lambda_ * double(d, D.ten_length, k) / (lambda_ + drive(m, i, law.T_0))
        store_double(act, d_0)


@inlined
def drive_state(m, d, i, line):
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
def exit_point(m, k):
    """Returns the site where cable k leaves the frame."""
    return integer(m, M.wrap_objid, integer(m, M.tendon_adr, k))


@internal
def connector(m, k):
    """Returns the site where cable k ends."""
    return integer(m, M.wrap_objid, integer(m, M.tendon_adr, k) + 1)


@inlined
def found_line(m, d, k):
    """Returns cable k as MuJoCo has it."""
    a, b = exit_point(m, k), connector(m, k)
    body = integer(m, M.site_bodyid, b)
    return Line(
        k=k, body=body, length=double(d, D.ten_length, k), rate=double(d, D.ten_velocity, k),
        x=double(d, D.site_xpos, 3 * b) - double(d, D.site_xpos, 3 * a),
        y=double(d, D.site_xpos, 3 * b + 1) - double(d, D.site_xpos, 3 * a + 1),
        z=double(d, D.site_xpos, 3 * b + 2) - double(d, D.site_xpos, 3 * a + 2),
        rx=double(d, D.site_xpos, 3 * b) - double(d, D.xpos, 3 * body),
        ry=double(d, D.site_xpos, 3 * b + 1) - double(d, D.xpos, 3 * body + 1),
        rz=double(d, D.site_xpos, 3 * b + 2) - double(d, D.xpos, 3 * body + 2),
    )  # fmt: skip


@inlined
def drawn_line(m, d, k):
    """Returns cable k from where the numbers of the model put its ends, in a frame that rests."""
    b = connector(m, k)
    body, a = integer(m, M.site_bodyid, b), _arm(m, d, exit_point(m, k))
    r, on = _arm(m, d, b), 3 * integer(m, M.site_bodyid, exit_point(m, k))
    x = double(d, D.xpos, 3 * body) + r[0] - double(d, D.xpos, on) - a[0]
    y = double(d, D.xpos, 3 * body + 1) + r[1] - double(d, D.xpos, on + 1) - a[1]
    z = double(d, D.xpos, 3 * body + 2) + r[2] - double(d, D.xpos, on + 2) - a[2]
    v, length = velocity(m, d, body, r), np.sqrt(x * x + y * y + z * z)
    return Line(
        k=k, body=body, length=length, rate=(x * v[0] + y * v[1] + z * v[2]) / length,
        x=x, y=y, z=z, rx=r[0], ry=r[1], rz=r[2],
    )  # fmt: skip


@internal
def _arm(m, d, site):
    """Returns the vector from a body's frame to its site, by the model's numbers, in O [m]."""
    at = word(m, M.site_pos) + 24 * site  # an evaluation may exchange these numbers
    x, y, z = load_double(at), load_double(at + 8), load_double(at + 16)
    return turned(d, integer(m, M.site_bodyid, site), x, y, z)


@internal
def platform(d, at, body):
    """Returns what effects on the platform see; `at` is its first degree of freedom."""
    v, R = word(d, D.qvel) + 8 * at, word(d, D.xmat) + 72 * body
    return Platform(
        time=load_constant(d + 8 * D.time),
        x=double(d, D.xpos, 3 * body), y=double(d, D.xpos, 3 * body + 1),
        z=double(d, D.xpos, 3 * body + 2),
        vx=load_constant(v), vy=load_constant(v + 8), vz=load_constant(v + 16),
        wx=load_constant(v + 24), wy=load_constant(v + 32), wz=load_constant(v + 40),
        R11=load_constant(R), R12=load_constant(R + 8), R13=load_constant(R + 16),
        R21=load_constant(R + 24), R22=load_constant(R + 32), R23=load_constant(R + 40),
        R31=load_constant(R + 48), R32=load_constant(R + 56), R33=load_constant(R + 64),
    )  # fmt: skip


@internal
def dof(m, body):
    """Returns the first degree of freedom of a body's free joint."""
    return integer(m, M.jnt_dofadr, integer(m, M.body_jntadr, body))


@internal
def velocity(m, d, body, arm):
    """Returns the velocity of a point of the platform in O [m/s]; the arm starts at the body."""
    at = dof(m, body)
    w = turned(
        d, body, double(d, D.qvel, at + 3), double(d, D.qvel, at + 4), double(d, D.qvel, at + 5)
    )  # fmt: skip
    turn = cross(w, arm)
    return (
        double(d, D.qvel, at) + turn[0],
        double(d, D.qvel, at + 1) + turn[1],
        double(d, D.qvel, at + 2) + turn[2],
    )


@internal
def push(m, d, line, force):
    """Puts a force [N], in O, on the platform where a cable pulls at it."""
    _add(m, d, line.body, force, cross((line.rx, line.ry, line.rz), force))


@internal
def wrench(m, d, body, w):
    """Puts a force [N] at the centre of mass and a torque [N m], both in O, on the platform."""
    _add(m, d, body, (w[0], w[1], w[2]), (w[3], w[4], w[5]))


@internal
def _add(m, d, body, force, torque):
    """Adds a force and a torque, both in O, to the free joint of a body."""
    at = word(d, D.qfrc_passive) + 8 * dof(m, body)
    own = turned_back(d, body, torque[0], torque[1], torque[2])
    for a in range(3):
        store_double(at + 8 * a, load_double(at + 8 * a) + force[a])
        store_double(at + 24 + 8 * a, load_double(at + 24 + 8 * a) + own[a])


@internal
def turned(d, body, x, y, z):
    """Returns R (x, y, z): from body axes to O."""
    at = word(d, D.xmat) + 72 * body
    return (
        load_constant(at) * x + load_constant(at + 8) * y + load_constant(at + 16) * z,
        load_constant(at + 24) * x + load_constant(at + 32) * y + load_constant(at + 40) * z,
        load_constant(at + 48) * x + load_constant(at + 56) * y + load_constant(at + 64) * z,
    )


@internal
def turned_back(d, body, x, y, z):
    """Returns Rᵀ (x, y, z): from O to body axes."""
    at = word(d, D.xmat) + 72 * body
    return (
        load_constant(at) * x + load_constant(at + 24) * y + load_constant(at + 48) * z,
        load_constant(at + 8) * x + load_constant(at + 32) * y + load_constant(at + 56) * z,
        load_constant(at + 16) * x + load_constant(at + 40) * y + load_constant(at + 64) * z,
    )


@internal
def cross(a, b):
    """Returns a × b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
