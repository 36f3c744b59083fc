"""The dynamics of the four robots behind one function, and accelerations: M q̈ = r - c - g."""

from __future__ import annotations

import numpy as np

from joint_worlds.arm import ARM, arm
from joint_worlds.cart import CART, cart
from joint_worlds.compiled import compiled
from joint_worlds.laws import GIVE, dahl, force, held, largest, stretched
from joint_worlds.pendulum import PENDULUM, pendulum
from joint_worlds.robot import JointRobot
from joint_worlds.two_link import TWO_LINK, two_link
from joint_worlds.unlisted import unlisted

ROBOTS: dict[str, JointRobot] = {r.name: r for r in (PENDULUM, CART, TWO_LINK, ARM)}


@compiled
def terms(code, q, v, p, M, c, g):  # type: ignore[no-untyped-def]
    """Mass matrix, velocity forces and gravity of a robot, into M, c and g."""
    if code == 0:
        pendulum(q, v, p, M, c, g)
    elif code == 1:
        cart(q, v, p, M, c, g)
    elif code == 2:
        two_link(q, v, p, M, c, g)
    else:
        arm(q, v, p, M, c, g)


@compiled
def accelerations(code, p, joints, q, v, q0, z, tau, M, c, g, a):  # type: ignore[no-untyped-def]
    """q̈ into a: of drives' forces tau, in a step that began at q0 with contacts stretched by z."""
    terms(code, q, v, p, M, c, g)
    for i in range(q.size):
        low = largest(joints[i], q[i], v[i], tau[i], g[i], -1.0)
        high = largest(joints[i], q[i], v[i], tau[i], g[i], 1.0)
        a[i] = tau[i] - c[i] - g[i] + force(joints[i], q[i], v[i])
        o = i - 1 if i > 0 else q.size - 1 if q.size < 2 else 1
        a[i] += unlisted(joints[i], q[i], v[i], q[o], v[o])
        if joints[i, GIVE] > 0.0:
            a[i] -= dahl(joints[i], z[i], q[i] - q0[i], low, high)
        elif low > 0.0 or high > 0.0:
            a[i] -= held(joints[i], z[i] + q[i] - q0[i], v[i], low, high)
    a[:] = np.linalg.solve(M, a)


@compiled
def slip(joints, q, v, q0, z, tau, g):  # type: ignore[no-untyped-def]
    """Move the contacts, in place, at the end of a step."""
    for i in range(q.size):
        low = largest(joints[i], q[i], v[i], tau[i], g[i], -1.0)
        high = largest(joints[i], q[i], v[i], tau[i], g[i], 1.0)
        if joints[i, GIVE] > 0.0:
            z[i] = joints[i, GIVE] * dahl(joints[i], z[i], q[i] - q0[i], low, high)
        elif low > 0.0 or high > 0.0:
            z[i] = stretched(joints[i], z[i] + q[i] - q0[i], low, high)
        else:
            z[i] = 0.0
