"""The platform as compiled callbacks see it: its state, and forces put on it.

A free joint has its velocity in O and its rates in body axes; a force F at a point r of the body
(from its frame) does F on the first three of its forces and Rᵀ (r × F) on the others.
"""

from __future__ import annotations

from collections import namedtuple
from typing import Any

import numpy as np

from identification.native.memory import inlined, internal, load_constant, load_double, store_double
from inca_mj.effects.hooks import Platform
from inca_mj.twin.drives import D, M, double, integer, word

# The cable k of a drive.
#   body: on which its connector is; length [m] of its path, rate [m/s] of that
#   x, y, z: connector minus exit point; rx, ry, rz: from the frame of the body to it; in O [m]
Line: Any = namedtuple("Line", "k body length rate x y z rx ry rz")


@internal
def connector(m, k):  # type: ignore[no-untyped-def]
    """Returns the site where cable k ends."""
    return integer(m, M.wrap_objid, integer(m, M.tendon_adr, k) + 1)


@internal
def exit_point(m, k):  # type: ignore[no-untyped-def]
    """Returns the site where cable k leaves the frame."""
    return integer(m, M.wrap_objid, integer(m, M.tendon_adr, k))


@inlined
def found_line(m, d, k):  # type: ignore[no-untyped-def]
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
def drawn_line(m, d, k):  # type: ignore[no-untyped-def]
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
def dof(m, body):  # type: ignore[no-untyped-def]
    """Returns the first degree of freedom of a body's free joint."""
    return integer(m, M.jnt_dofadr, integer(m, M.body_jntadr, body))


@internal
def turned(d, body, x, y, z):  # type: ignore[no-untyped-def]
    """Returns R (x, y, z): from body axes to O."""
    at = word(d, D.xmat) + 72 * body
    return (
        load_constant(at) * x + load_constant(at + 8) * y + load_constant(at + 16) * z,
        load_constant(at + 24) * x + load_constant(at + 32) * y + load_constant(at + 40) * z,
        load_constant(at + 48) * x + load_constant(at + 56) * y + load_constant(at + 64) * z,
    )


@internal
def _arm(m, d, site):  # type: ignore[no-untyped-def]
    """Returns the vector from a body's frame to its site, by the model's numbers, in O [m]."""
    at = word(m, M.site_pos) + 24 * site  # an evaluation may exchange these numbers
    x, y, z = load_double(at), load_double(at + 8), load_double(at + 16)
    return turned(d, integer(m, M.site_bodyid, site), x, y, z)


@internal
def turned_back(d, body, x, y, z):  # type: ignore[no-untyped-def]
    """Returns Rᵀ (x, y, z): from O to body axes."""
    at = word(d, D.xmat) + 72 * body
    return (
        load_constant(at) * x + load_constant(at + 24) * y + load_constant(at + 48) * z,
        load_constant(at + 8) * x + load_constant(at + 32) * y + load_constant(at + 56) * z,
        load_constant(at + 16) * x + load_constant(at + 40) * y + load_constant(at + 64) * z,
    )


@internal
def cross(a, b):  # type: ignore[no-untyped-def]
    """Returns a × b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@internal
def velocity(m, d, body, arm):  # type: ignore[no-untyped-def]
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
def _add(m, d, body, force, torque):  # type: ignore[no-untyped-def]
    """Adds a force and a torque, both in O, to the free joint of a body."""
    at = word(d, D.qfrc_passive) + 8 * dof(m, body)
    own = turned_back(d, body, torque[0], torque[1], torque[2])
    for a in range(3):
        store_double(at + 8 * a, load_double(at + 8 * a) + force[a])
        store_double(at + 24 + 8 * a, load_double(at + 24 + 8 * a) + own[a])


@internal
def push(m, d, line, force):  # type: ignore[no-untyped-def]
    """Puts a force [N], in O, on the platform where a cable pulls at it."""
    _add(m, d, line.body, force, cross((line.rx, line.ry, line.rz), force))


@internal
def wrench(m, d, body, w):  # type: ignore[no-untyped-def]
    """Puts a force [N] at the centre of mass and a torque [N m], both in O, on the platform."""
    _add(m, d, body, (w[0], w[1], w[2]), (w[3], w[4], w[5]))


@internal
def platform(d, at, body):  # type: ignore[no-untyped-def]
    """Returns what effects on the platform see; `at` is its first degree of freedom."""
    v, R = word(d, D.qvel) + 8 * at, word(d, D.xmat) + 72 * body
    return Platform(
        time=load_constant(d + 8 * D.time),
        x=double(d, D.xpos, 3 * body),
        y=double(d, D.xpos, 3 * body + 1),
        z=double(d, D.xpos, 3 * body + 2),
        vx=load_constant(v),
        vy=load_constant(v + 8),
        vz=load_constant(v + 16),
        wx=load_constant(v + 24),
        wy=load_constant(v + 32),
        wz=load_constant(v + 40),
        R11=load_constant(R), R12=load_constant(R + 8), R13=load_constant(R + 16),
        R21=load_constant(R + 24), R22=load_constant(R + 32), R23=load_constant(R + 40),
        R31=load_constant(R + 48), R32=load_constant(R + 56), R33=load_constant(R + 64),
    )  # fmt: skip
