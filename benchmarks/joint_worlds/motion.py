"""A robot in motion, M q̈ = r - c - g: Runge-Kutta steps of order 4, a controller, and windows.

An input is held for a sample. On its way to the joint it is clipped, comes late, lags (exactly:
x(t + h) = u + (x - u) exp(-h/τ)), loses α t of its gain, and weakens by c x³. Unlogged torque
is held for a sample too. The controller sees what the encoder says, rounded and noisy,
e(q) = (1 + s) q + a cos q + b sin q + e_0, and its derivative through a first-order filter:

    computed torque   u = M̂(y) (a_d + k_d (v_d - v̂) + k_p (q_d - y)) + ĉ(y, v̂) + ĝ(y)
    PD                u = diag M̂(y) (k_d (v_d - v̂) + k_p (q_d - y)) + ĝ(q_d)

with a model of its own (hats), k_p = w², k_d = 2 w.
"""

from __future__ import annotations

import numpy as np

from joint_worlds import slots as at
from joint_worlds.arm import ARM, arm
from joint_worlds.cart import CART, cart
from joint_worlds.laws import dahl, force, held, largest, stretched, unlisted
from joint_worlds.pendulum import PENDULUM, pendulum
from joint_worlds.robot import JointRobot
from joint_worlds.slots import compiled
from joint_worlds.two_link import TWO_LINK, two_link

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
        a[i] = tau[i] - c[i] - (1.0 - joints[i, at.FLOAT]) * g[i] + force(joints[i], q[i], v[i])
        o = i - 1 if i > 0 else q.size - 1 if q.size < 2 else 1
        a[i] += unlisted(joints[i], q[i], v[i], q[o], v[o])
        if joints[i, at.GIVE] > 0.0:
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
        if joints[i, at.GIVE] > 0.0:
            z[i] = joints[i, at.GIVE] * dahl(joints[i], z[i], q[i] - q0[i], low, high)
        elif low > 0.0 or high > 0.0:
            z[i] = stretched(joints[i], z[i] + q[i] - q0[i], low, high)
        else:
            z[i] = 0.0


@compiled
def encoder(joint, q):  # type: ignore[no-untyped-def]
    """What an encoder without noise shows."""
    turning = joint[at.OFF_COS] * np.cos(q) + joint[at.OFF_SIN] * np.sin(q)
    return (1 + joint[at.SCALE]) * q + turning + joint[at.ZERO]


@compiled
def late(joint, u, i, k, since, period):  # type: ignore[no-untyped-def]
    """Input i as it arrives `since` seconds after sample k began."""
    at_ = max(0, k + int(np.floor((since - joint[at.DELAY]) / period)))
    return min(max(u[at_, i], -joint[at.LIMIT]), joint[at.LIMIT])


@compiled
def advance(code, p, joints, state, u, k, push, h, m, room):  # type: ignore[no-untyped-def]
    """Go on by one sample of m steps h, in place; rows of state: q, v, z, lagging input."""
    n = u.shape[1]
    q, v, z, x = state[0], state[1], state[2], state[3]
    tau, Q, V, A = room[0:3], room[3:7], room[7:11], room[11:15]
    c, g, M = room[15], room[16], room[17 : 17 + n]
    for s in range(m):
        for i in range(n):
            come = late(joints[i], u, i, k, (s + 0.5) * h, h * m)
            half = np.exp(-0.5 * h / joints[i, at.LAG]) if joints[i, at.LAG] > 0.0 else 0.0
            x1 = come + (x[i] - come) * half
            x2 = come + (x1 - come) * half
            x0 = x[i] if joints[i, at.LAG] > 0.0 else come
            t = k * m * h + s * h
            weak = joints[i, at.WEAK]
            tau[0, i] = (1 - joints[i, at.SAG] * t) * x0 - weak * x0**3 + push[i]
            tau[1, i] = (1 - joints[i, at.SAG] * (t + 0.5 * h)) * x1 - weak * x1**3 + push[i]
            tau[2, i] = (1 - joints[i, at.SAG] * (t + h)) * x2 - weak * x2**3 + push[i]
            x[i] = x2
            Q[0, i], V[0, i] = q[i], v[i]
        accelerations(code, p, joints, Q[0], V[0], Q[0], z, tau[0], M, c, g, A[0])
        for r in range(1, 4):
            w = h if r == 3 else 0.5 * h
            for i in range(n):
                Q[r, i] = q[i] + w * V[r - 1, i]
                V[r, i] = v[i] + w * A[r - 1, i]
            accelerations(code, p, joints, Q[r], V[r], Q[0], z, tau[(r + 1) // 2], M, c, g, A[r])
        for i in range(n):
            q[i] += h / 6 * (V[0, i] + 2 * V[1, i] + 2 * V[2, i] + V[3, i])
            v[i] += h / 6 * (A[0, i] + 2 * A[1, i] + 2 * A[2, i] + A[3, i])
        slip(joints, q, v, Q[0], z, tau[2], g)


@compiled
def closed_loop(  # type: ignore[no-untyped-def]
    code, p, joints, p_hat, computed, w, aim, errors, step, push, h, m
):
    """Follow a reference under control, from rest at zero.

    Args:
        code: of the robot.
        p: numbers of its dynamics, shape (p,).
        joints: numbers of its joints, shape (n, SLOTS).
        p_hat: what the controller takes for them, shape (p,).
        computed: whether it is computed torque, else PD.
        w: the controller's bandwidth [rad/s].
        aim: reference positions, rates and accelerations, shape (3, N, n).
        errors: white noise of the sensors, shape (N, n).
        step: what they round to, shape (n,).
        push: unlogged force, shape (N, n).
        h: step of the integrator [s].
        m: steps in a sample.

    Returns:
        States (N, 4, n), inputs (N, n), measured positions (N, n).
    """
    count, n = errors.shape
    states, u, y = np.zeros((count, 4, n)), np.zeros((count, n)), np.zeros((count, n))
    state, room = np.zeros((4, n)), np.zeros((17 + n, n))
    rate, want, c, g, M = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros((n, n))
    period = h * m
    keep = np.exp(-period * 8 * w)
    for k in range(count):
        for i in range(n):
            seen = encoder(joints[i], state[0, i]) + errors[k, i]
            y[k, i] = step[i] * np.round(seen / step[i]) if step[i] > 0.0 else seen
            if k > 0:
                rate[i] = keep * rate[i] + (1 - keep) * (y[k, i] - y[k - 1, i]) / period
            want[i] = 2 * w * (aim[1, k, i] - rate[i]) + w * w * (aim[0, k, i] - y[k, i])
        terms(code, y[k] if computed else aim[0, k], rate, p_hat, M, c, g)
        for i in range(n):
            u[k, i] = g[i]
            if computed:
                u[k, i] += c[i]
                for j in range(n):
                    u[k, i] += M[i, j] * (aim[2, k, j] + want[j])
            else:
                u[k, i] += M[i, i] * want[i]
        if k == 0:  # what had been there before
            for i in range(n):
                state[3, i] = late(joints[i], u, i, 0, 0.0, period)
        states[k] = state
        advance(code, p, joints, state, u, k, push[k], h, m, room)
    return states, u, y


@compiled
def windows(code, p, joints, begins, starts, u, push, length, h, m):  # type: ignore[no-untyped-def]
    """Positions in windows that begin at given samples and states, under logged inputs.

    Args:
        code: of the robot.
        p: numbers of its dynamics, shape (p,).
        joints: numbers of its joints, shape (n, SLOTS).
        begins: samples, shape (W,).
        starts: states, shape (W, 4, n).
        u: inputs, shape (N, n).
        push: unlogged force, shape (N, n).
        length: samples of a window.
        h: step of the integrator [s].
        m: steps in a sample.

    Returns:
        Encoder positions after 1 to `length` samples, shape (W, length, n).
    """
    n = u.shape[1]
    out, room = np.zeros((begins.size, length, n)), np.zeros((17 + n, n))
    state = np.zeros((4, n))
    for j in range(begins.size):
        state[:] = starts[j]
        for k in range(length):
            advance(code, p, joints, state, u, begins[j] + k, push[begins[j] + k], h, m, room)
            for i in range(n):
                out[j, k, i] = encoder(joints[i], state[0, i])
    return out
