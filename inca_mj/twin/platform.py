"""The platform as compiled callbacks see it: its state, and forces put on it.

A free joint has its velocity in O and its rates in body axes; a force F at a point r of the body
(from its frame) does F on the first three of its forces and Rᵀ (r × F) on the others.
"""

from __future__ import annotations

from identification.native.decorators import internal
from identification.native.memory import load_constant, load_double, store_double
from inca_mj.effects.hooks import Platform
from inca_mj.twin.fields import D, M, double, integer, word


@internal
def connector(m, k):  # type: ignore[no-untyped-def]
    """Site where cable k ends."""
    return integer(m, M.wrap_objid, integer(m, M.tendon_adr, k) + 1)


@internal
def span(m, d, k):  # type: ignore[no-untyped-def]
    """Connector minus exit point of cable k, in O [m]."""
    a, b = integer(m, M.wrap_objid, integer(m, M.tendon_adr, k)), connector(m, k)
    return (
        double(d, D.site_xpos, 3 * b) - double(d, D.site_xpos, 3 * a),
        double(d, D.site_xpos, 3 * b + 1) - double(d, D.site_xpos, 3 * a + 1),
        double(d, D.site_xpos, 3 * b + 2) - double(d, D.site_xpos, 3 * a + 2),
    )


@internal
def dof(m, body):  # type: ignore[no-untyped-def]
    """First degree of freedom of a body's free joint."""
    return integer(m, M.jnt_dofadr, integer(m, M.body_jntadr, body))


@internal
def arm(d, site, body):  # type: ignore[no-untyped-def]
    """From a body's frame to a site of it, in O [m]."""
    return (
        double(d, D.site_xpos, 3 * site) - double(d, D.xpos, 3 * body),
        double(d, D.site_xpos, 3 * site + 1) - double(d, D.xpos, 3 * body + 1),
        double(d, D.site_xpos, 3 * site + 2) - double(d, D.xpos, 3 * body + 2),
    )


@internal
def turned(d, body, x, y, z):  # type: ignore[no-untyped-def]
    """R (x, y, z): from body axes to O."""
    at = word(d, D.xmat) + 72 * body
    return (
        load_constant(at) * x + load_constant(at + 8) * y + load_constant(at + 16) * z,
        load_constant(at + 24) * x + load_constant(at + 32) * y + load_constant(at + 40) * z,
        load_constant(at + 48) * x + load_constant(at + 56) * y + load_constant(at + 64) * z,
    )


@internal
def turned_back(d, body, x, y, z):  # type: ignore[no-untyped-def]
    """Rᵀ (x, y, z): from O to body axes."""
    at = word(d, D.xmat) + 72 * body
    return (
        load_constant(at) * x + load_constant(at + 24) * y + load_constant(at + 48) * z,
        load_constant(at + 8) * x + load_constant(at + 32) * y + load_constant(at + 56) * z,
        load_constant(at + 16) * x + load_constant(at + 40) * y + load_constant(at + 64) * z,
    )


@internal
def cross(a, b):  # type: ignore[no-untyped-def]
    """a × b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@internal
def velocity(m, d, site):  # type: ignore[no-untyped-def]
    """Velocity of a site of the platform, in O [m/s]."""
    body = integer(m, M.site_bodyid, site)
    at = dof(m, body)
    w = turned(
        d, body, double(d, D.qvel, at + 3), double(d, D.qvel, at + 4), double(d, D.qvel, at + 5)
    )  # fmt: skip
    turn = cross(w, arm(d, site, body))
    return (
        double(d, D.qvel, at) + turn[0],
        double(d, D.qvel, at + 1) + turn[1],
        double(d, D.qvel, at + 2) + turn[2],
    )


@internal
def _add(m, d, body, force, torque):  # type: ignore[no-untyped-def]
    """A force and a torque, both in O, on the free joint of a body."""
    at = word(d, D.qfrc_passive) + 8 * dof(m, body)
    own = turned_back(d, body, torque[0], torque[1], torque[2])
    for a in range(3):
        store_double(at + 8 * a, load_double(at + 8 * a) + force[a])
        store_double(at + 24 + 8 * a, load_double(at + 24 + 8 * a) + own[a])


@internal
def push(m, d, site, force):  # type: ignore[no-untyped-def]
    """A force [N], in O, on a site of the platform."""
    body = integer(m, M.site_bodyid, site)
    _add(m, d, body, force, cross(arm(d, site, body), force))


@internal
def wrench(m, d, body, w):  # type: ignore[no-untyped-def]
    """A force [N] at the centre of mass and a torque [N m], both in O, on the platform."""
    _add(m, d, body, (w[0], w[1], w[2]), (w[3], w[4], w[5]))


@internal
def platform(d, at, body):  # type: ignore[no-untyped-def]
    """What effects on the platform see; `at` is its first degree of freedom."""
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
