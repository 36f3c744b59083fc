"""Curves: forces on a joint that are drawn from the data, where no listed law fits.

    f(x) = Σ_k c_k Λ_k(x)             Λ_k: 1 at the node x_k, 0 at all others

    of speed        x = sgn(v) √(|v|/v_top),  nodes at ±¼, ±½, ±¾, ±1, and f(0) = 0
    of the load     x = sgn(f_u) √(|f_u|/f_top),   the same nodes, and f(0) = 0
    of position     x = (q - q_mid)/q_far,    nodes evenly from -1 to 1
    of time         x = 2 t/t_end - 1,        the same nodes
    of a neighbour  x of position or of speed, of the joint before or behind it, with its nodes

Between nodes of speed and of the load a curve is straight, because frictions bend sharply there;
between others it is the natural cubic spline, for hoses and springs do not. On it, with h = x_{k+1}
- x_k, u = (x - x_k)/h, w = 1 - u and the second derivatives s_k h²/6 = (G c)_k,

    f = w c_k + u c_{k+1} + (w³ - w) s_k h²/6 + (u³ - u) s_{k+1} h²/6        (de Boor 1978, IV)

A force that depends on a speed or on the drive alone is none at rest or without the drive: what
would be left is a constant force, which is an effect by itself. Nodes of speed and of the load are
dense near zero: there frictions and dead zones bend, and there most of a motion is. Beyond the last
node a curve keeps its value. Each c_k is the force at its node.

A curve has eight sizes, so that a law that explains as much with fewer wins by its criterion. It
acts on one joint, because each joint has a range of its own. What it depends on may be a neighbour:
a hose, a spring or a cable between two bodies pulls at one joint by the position of another, and a
belt or a motor that both joints turn rubs by its speed. It may be as strong as the drives: a soft
stop holds them.
"""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np
from numba import njit

from identification.effects.effect import CURVE, Effect
from identification.effects.laws.joint_group import Group
from identification.native.element import Function

NODES = 8
# How the names of curves end that depend on their own joint.
OF_JOINT = ("_speed", "_load", "_position", "_time")


def _bending() -> tuple[tuple[float, ...], ...]:
    """Returns G, which turns node values into s h²/6 of the natural cubic spline.

    s_{k-1} + 4 s_k + s_{k+1} = (6/h²) (c_{k-1} - 2 c_k + c_{k+1})
    """
    inner = range(1, NODES - 1)
    A, B = np.eye(NODES), np.zeros((NODES, NODES))
    for k in inner:
        A[k, k - 1 : k + 2] = 1.0, 4.0, 1.0
        B[k, k - 1 : k + 2] = 1.0, -2.0, 1.0
    return tuple(map(tuple, np.linalg.solve(A, B).tolist()))


BENDING = _bending()


@njit
def through_zero(x, c):
    """Returns the curve with nodes at -¼, -½, -¾, -1, ¼, ½, ¾, 1, which is zero at zero."""
    z, side = 4.0 * abs(x), 4 if x > 0.0 else 0
    if z >= 4.0:
        return c[side + 3]
    k = int(z)
    before = 0.0 if k == 0 else c[side + k - 1]
    return before + (z - k) * (c[side + k] - before)


@njit
def smooth(x, c):
    """Returns the natural cubic spline with eight nodes evenly from -1 to 1."""
    z = min(7.0, max(0.0, 3.5 * (x + 1.0)))
    k = min(6, int(z))
    u, first, second = z - k, 0.0, 0.0
    w = 1.0 - u
    for j in range(NODES):
        first += BENDING[k][j] * c[j]
        second += BENDING[k + 1][j] * c[j]
    return w * c[k] + u * c[k + 1] + (w**3 - w) * first + (u**3 - u) * second


@njit
def _dense_near_zero(z, c):
    """Returns the curve at a speed or a load in units of the largest one."""
    x = sqrt(abs(z))
    return through_zero(x if z > 0.0 else -x, c)


@njit
def curve_speed(s, p):
    return _dense_near_zero(s.v / s.v_top, p)


@njit
def curve_load(s, p):
    return _dense_near_zero(s.f_u / s.f_top, p)


@njit
def curve_position(s, p):
    return smooth((s.q - s.q_mid) / s.q_far, p)


# A curve over a neighbour is zero where there is no such joint.
@njit
def curve_before(s, p):
    return smooth(s.x_before, p) if s.x_before == s.x_before else 0.0


@njit
def curve_behind(s, p):
    return smooth(s.x_behind, p) if s.x_behind == s.x_behind else 0.0


@njit
def curve_speed_before(s, p):
    return _dense_near_zero(s.v_before, p) if s.v_before == s.v_before else 0.0


@njit
def curve_speed_behind(s, p):
    return _dense_near_zero(s.v_behind, p) if s.v_behind == s.v_behind else 0.0


@njit
def curve_time(s, p):
    return smooth(2.0 * s.time / s.t_end - 1.0, p)


def curve_effects(g: Group) -> list[Effect]:
    """Returns curves of some joints; those without a place are left out by the caller."""
    driven = {where: suffix for where, suffix in g.plain.items() if suffix}
    beside = g.each if g.both or len(g.axes) > 1 else {}
    return [
        _curve(g, curve_speed, "f(v), none at rest", "speed", g.each),
        _curve(g, curve_load, "f(f_u), f_u the drive's force", "the drive's force", driven),
        _curve(g, curve_position, "f(q)", "position", g.each),
        _curve(g, curve_before, "f(q) of the joint before it",
               "the position of the joint before it", beside),
        _curve(g, curve_behind, "f(q) of the joint behind it",
               "the position of the joint behind it", beside),
        _curve(g, curve_speed_before, "f(v) of the joint before it, none at rest",
               "the speed of the joint before it", beside),
        _curve(g, curve_speed_behind, "f(v) of the joint behind it, none at rest",
               "the speed of the joint behind it", beside),
        _curve(g, curve_time, "f(t)", "time", g.each if g.T > 0 else {}),
    ]  # fmt: skip


def _curve(g: Group, law: Function, said: str, what: str, where: dict[str, str]) -> Effect:
    sizes = [g.size(f"c_{k}", g.F, g.f, f"force at node {k}") for k in range(1, NODES + 1)]
    made = g.force(law, said, f"force: some curve of {what}", *sizes, places=where)
    word = law.__name__.removeprefix(CURVE)  # "curve" stands first, so that it is seen to be one
    return replace(made, name=f"{CURVE}_{g.prefix}".rstrip("_") + word)
