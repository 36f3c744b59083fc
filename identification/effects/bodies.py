"""Effects of the bodies that a robot moves: ten numbers (m, h, I_O) that each adds to a body's.

    mass mismatch       Δm (1, c, I_O/m)        a heavier body of unchanged shape
    offset of centre    (0, m d, |c+d|² .. )    the same body, displaced by d in its frame
    inertia mismatch    δ (0, 0, I_c)           inertia about the centre of mass
    payload             M (1, p, |p|² 1 - p pᵀ) a point mass at p

Each keeps a possible body possible (a positive pseudo-inertia; Wensing, Kim, Slotine 2018), as long
as Δm > -m, δ > -1, M >= 0. s: see `identification.effects.body.Body`; p: the sizes.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import mujoco
from numba import njit

from identification.effects.effect import Effect, Size
from identification.effects.moving_bodies import Felt, MovingBody, movable, moving_bodies

PROBE = 0.02  # of the largest plausible size
LEAST = 1e-2  # a body that reaches no farther than this is taken to reach so far [m]
WENSING = "Wensing, Kim, Slotine 2018"


@njit
def point_inertia(m, x, y, z):  # type: ignore[no-untyped-def]
    """Returns m (|c|² 1 - c cᵀ) as (xx, yy, zz, xy, xz, yz)."""
    return (
        m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y),
        -m * x * y, -m * x * z, -m * y * z,
    )  # fmt: skip


@njit
def mass_mismatch(s, p):  # type: ignore[no-untyped-def]
    (dm,) = p
    k, o = dm / s.m, point_inertia(dm, s.cx, s.cy, s.cz)
    return (
        dm, dm * s.cx, dm * s.cy, dm * s.cz,
        k * s.Ixx + o[0], k * s.Iyy + o[1], k * s.Izz + o[2],
        k * s.Ixy + o[3], k * s.Ixz + o[4], k * s.Iyz + o[5],
    )  # fmt: skip


@cache
def displaced(axes: str) -> Any:
    """Returns the law of a centre of mass that is displaced along some axes of the body's frame."""
    ix, iy, iz = (axes.find(a) for a in "xyz")

    @njit
    def com_offset(s, p):  # type: ignore[no-untyped-def]
        x, y, z = (p[ix] * (ix >= 0), p[iy] * (iy >= 0), p[iz] * (iz >= 0))
        old = point_inertia(s.m, s.cx, s.cy, s.cz)
        new = point_inertia(s.m, s.cx + x, s.cy + y, s.cz + z)
        return (
            0.0, s.m * x, s.m * y, s.m * z,
            new[0] - old[0], new[1] - old[1], new[2] - old[2],
            new[3] - old[3], new[4] - old[4], new[5] - old[5],
        )  # fmt: skip

    return com_offset


@njit
def inertia_mismatch(s, p):  # type: ignore[no-untyped-def]
    (k,) = p
    return (
        0.0, 0.0, 0.0, 0.0, k * s.Ixx, k * s.Iyy, k * s.Izz, k * s.Ixy, k * s.Ixz, k * s.Iyz
    )  # fmt: skip


@njit
def payload(s, p):  # type: ignore[no-untyped-def]
    (m,) = p
    o = point_inertia(m, s.px, s.py, s.pz)
    return m, m * s.px, m * s.py, m * s.pz, o[0], o[1], o[2], o[3], o[4], o[5]


def body_effects(spec: mujoco.MjSpec) -> tuple[Effect, ...]:
    """Returns all candidates of the bodies of a robot: each acts on one body.

    A size of which no body's motion says anything is left out: a displacement of the centre of mass
    along the axis about which the robot turns, an inertia of what only slides.
    """
    model = movable(spec)
    bodies = moving_bodies(model)
    if not bodies:
        return ()
    felt = Felt(model)
    turning = [b for b in bodies if felt.is_turning(b)]
    off = [b for b in bodies if felt.axes(b)]
    last = [b for b in off if b.is_last]
    mass = max(b.mass for b in bodies)
    way = 0.3 * max(LEAST, *(b.reach for b in bodies))
    axes = "".join(a for a in "xyz" if any(a in felt.axes(b) for b in off))
    at = "; ".join("{}: ({:.3g}, {:.3g}, {:.3g}) m".format(b.label, *b.point) for b in last)
    every = (
        _effect(mass_mismatch, "m + Δm, shape unchanged", "body: another mass", bodies,
                _size("dm", "kg", 0.3 * mass, "what its mass has more")),
        _effect(displaced(axes), "c + d, d in the body's frame", "body: centre of mass displaced",
                off, *(_size(a, "m", way, f"displacement along {a} of its frame") for a in axes)),
        _effect(inertia_mismatch, "(1 + δ) I_c", "body: another inertia", turning,
                _size("delta", "", 0.5, "relative, about its centre of mass")),
        _effect(payload, f"a point mass M at the farthest point of its frame ({at})",
                "body: a payload at its end", last,
                Size("M", "kg", 2 * mass, 0.01 * mass, 1, "mass of the payload")),
    )  # fmt: skip
    return tuple(e for e in every if e.places)


def _size(name: str, unit: str, largest: float, about: str) -> Size:
    return Size(name, unit, largest, PROBE * largest, 0, about)


def _effect(law: Any, said: str, phrase: str, on: Sequence[MovingBody], *sizes: Size) -> Effect:
    return Effect(
        law.__name__, said, sizes, places={f"body {b.label}": f"@{b.label}" for b in on},
        phrase=phrase, reference=WENSING, hooks={"inertia": law},
    )  # fmt: skip
