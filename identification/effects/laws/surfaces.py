"""Surfaces: forces on a joint that depend on two things at once, by which names are judged.

    f(x, y) = Σ_j Σ_k c_jk Λ_j(y) Λ_k(x)     Λ: 1 at its node, 0 at all others, straight between

    of speed and position   x = sgn(v) √(|v|/v_top),       y = (q - q_mid)/q_far
    of load and position    x = sgn(f_u) √(|f_u|/f_top),   the same y
    of load and speed       the same x,                    y = v/v_top

Nodes of x lie at ±⅓, ±⅔ and ±1, and f = 0 at x = 0; those of y evenly from -1 to 1. A motor whose
force falls with its speed, a crank between drive and joint, a friction on a part of the way: each
is a force of two variables, which no curve of one can draw, and near which lies some law of the
catalogue. A surface has thirty numbers and is no candidate. What it explains beside a law says
whether the law is what is missing (`identification.prediction.verdict.yardstick`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import sqrt

from numba import njit

from identification.effects.axes import Axis
from identification.effects.effect import Effect
from identification.effects.laws.joint_group import Group, groups
from identification.native.element import Function

X_NODES, Y_NODES = 6, 5
SURFACE = "surface"


@njit
def bilinear(x, y, c):
    """Returns the surface with nodes c[X_NODES j + k]; in x they are those of -⅓, -⅔, -1, ⅓, ⅔, 1.

    Beyond the last nodes it keeps its value.
    """
    half, last = X_NODES // 2, Y_NODES - 1
    z, side = min(1.0 * half, half * abs(x)), half if x > 0.0 else 0
    k = min(half - 1, int(z))
    u = z - k
    t = min(1.0 * last, max(0.0, 0.5 * last * (y + 1.0)))
    j = min(last - 1, int(t))
    w = t - j
    low, high = X_NODES * j + side + k, X_NODES * (j + 1) + side + k
    first = u * c[low] + (0.0 if k == 0 else (1.0 - u) * c[low - 1])
    second = u * c[high] + (0.0 if k == 0 else (1.0 - u) * c[high - 1])
    return (1.0 - w) * first + w * second


@njit
def _root(z):
    return sqrt(z) if z > 0.0 else -sqrt(-z)


@njit
def surface_speed_position(s, p):
    return bilinear(_root(s.v / s.v_top), (s.q - s.q_mid) / s.q_far, p)


@njit
def surface_load_position(s, p):
    return bilinear(_root(s.f_u / s.f_top), (s.q - s.q_mid) / s.q_far, p)


@njit
def surface_load_speed(s, p):
    return bilinear(_root(s.f_u / s.f_top), s.v / s.v_top, p)


def surface_effects(axes: Sequence[Axis]) -> tuple[Effect, ...]:
    """Returns the surfaces of some joints, each at single joints."""
    return tuple(e for g in groups(axes) for e in _of_group(g) if e.places)


def _of_group(g: Group) -> list[Effect]:
    driven = {where: suffix for where, suffix in g.plain.items() if suffix}
    return [
        _surface(g, surface_speed_position, "f(v, q), none at rest", g.each),
        _surface(g, surface_load_position, "f(f_u, q), none without the drive", driven),
        _surface(g, surface_load_speed, "f(f_u, v), none without the drive", driven),
    ]


def _surface(g: Group, law: Function, said: str, where: dict[str, str]) -> Effect:
    nodes = range(1, X_NODES * Y_NODES + 1)
    sizes = [g.size(f"c_{k}", g.F, g.f, f"force at node {k}") for k in nodes]
    made = g.force(law, said, "force: some function of two variables", *sizes, places=where)
    word = law.__name__.removeprefix(SURFACE)
    return replace(made, name=f"{SURFACE}_{g.prefix}".rstrip("_") + word)
