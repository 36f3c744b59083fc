"""Effects of the bodies that a robot moves: ten numbers (m, h, I_O) that each adds to a body's.

    h = m c,    I_O = I_c + m (|c|² 1 - c cᵀ)

    mass mismatch       Δm (1, c, I_O/m)        a heavier body of unchanged shape
    offset of centre    (0, m d, |c+d|² .. )    the same body, displaced by d in its frame
    inertia mismatch    δ (0, 0, I_c)           inertia about the centre of mass
    payload             M (1, p, |p|² 1 - p pᵀ) a point mass at p
    load                the same at p + d       wherever it is: d is found

m: mass [kg]; c: centre of mass in the body's frame [m]; I_c, I_O: inertia about the centre of mass
and about the frame's origin, in the frame's axes [kg m²]. All ten add up over the parts of a body,
so that effects add up too. Each keeps a possible body possible (a positive pseudo-inertia; Wensing,
Kim, Slotine 2018), as long as Δm > -m, δ > -1, M >= 0. Functions take a `Body` s and the sizes p,
and are called before the simulation, as plain Python. What they add is counted from the body as the
robot's own parameters make it, so that a mass may be both free and wrong.
"""

from __future__ import annotations

import math
from collections import namedtuple
from collections.abc import Sequence
from functools import cache
from typing import Any

import mujoco
from numba import njit

from identification.effects.effect import Effect
from identification.effects.moving_bodies import Felt, MovingBody, movable, moving_bodies
from identification.effects.sizes import Shape, Size
from identification.native.element import Element, Hook

# What an effect sees of a body, in the axes of the body's frame.
#   m [kg], cx, cy, cz [m]; Ixx .. Iyz: I_c [kg m²]; px, py, pz: where a payload would sit [m]
Body: Any = namedtuple("Body", "m cx cy cz Ixx Iyy Izz Ixy Ixz Iyz px py pz")

BODY = Element(
    "body",
    Body,
    (
        Hook(
            "inertia",
            (
                "mass [kg]", "h_x [kg m]", "h_y [kg m]", "h_z [kg m]", "I_O,xx [kg m²]",
                "I_O,yy [kg m²]", "I_O,zz [kg m²]", "I_O,xy [kg m²]", "I_O,xz [kg m²]",
                "I_O,yz [kg m²]",
            ),
        ),
    ),
)  # fmt: skip

PROBE = 0.02  # of the largest plausible size
# Of the length of the longest body: how far from a body's end the place of a load is tried, and how
# far it may lie. At the end alone a free mass of the body may do what a load elsewhere does.
TRIED = (-0.5, 0.0, 0.5)
FARTHEST = 2.0
LEAST = 1e-2  # a body that reaches no farther than this is taken to reach so far [m]
WENSING = "Wensing, Kim, Slotine 2018"
HOOK = "inertia"


@njit
def point_inertia(m, x, y, z):
    """Returns m (|c|² 1 - c cᵀ) as (xx, yy, zz, xy, xz, yz)."""
    return (
        m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y),
        -m * x * y, -m * x * z, -m * y * z,
    )  # fmt: skip


@njit
def mass_mismatch(s, p):
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
    def com_offset(s, p):
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
def inertia_mismatch(s, p):
    (k,) = p
    return (
        0.0, 0.0, 0.0, 0.0, k * s.Ixx, k * s.Iyy, k * s.Izz, k * s.Ixy, k * s.Ixz, k * s.Iyz
    )  # fmt: skip


@njit
def payload(s, p):
    (m,) = p
    o = point_inertia(m, s.px, s.py, s.pz)
    return m, m * s.px, m * s.py, m * s.pz, o[0], o[1], o[2], o[3], o[4], o[5]


@cache
def placed(axes: str) -> Any:
    """Returns the law of a point mass that sits some way from where a payload would sit.

    Args:
        axes: of the body's frame along which its place is felt.
    """
    ix, iy, iz = (1 + axes.find(a) for a in "xyz")

    @njit
    def load(s, p):
        m = p[0]
        x = s.px + p[ix] * (ix > 0)
        y = s.py + p[iy] * (iy > 0)
        z = s.pz + p[iz] * (iz > 0)
        o = point_inertia(m, x, y, z)
        return m, m * x, m * y, m * z, o[0], o[1], o[2], o[3], o[4], o[5]

    return load


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
    reach = max(LEAST, *(b.reach for b in bodies))
    way = 0.3 * reach
    axes = "".join(a for a in "xyz" if any(a in felt.axes(b) for b in off))
    length = max([LEAST, *(math.hypot(*b.point) for b in off)])
    of_place = [
        Shape(
            a,
            "m",
            tuple(share * length for share in TRIED),
            -FARTHEST * length,
            FARTHEST * length,
            about=f"its place along {a} of the body, from the point p of the law",
            usual=0.0,
        )
        for a in axes
    ]
    every = (
        _effect(mass_mismatch, "m + Δm, shape unchanged", "body: another mass", bodies,
                _size("dm", "kg", 0.3 * mass, "what its mass has more")),
        _effect(displaced(axes), "c + d, d in the body's frame", "body: centre of mass displaced",
                off, *(_size(a, "m", way, f"displacement along {a} of its frame") for a in axes)),
        _effect(inertia_mismatch, "(1 + δ) I_c", "body: another inertia", turning,
                _size("delta", "", 0.5, "relative, about its centre of mass")),
        _effect(payload, f"a point mass M at the farthest point of its frame ({_ends(last)})",
                "body: a payload at its end", last,
                Size("M", "kg", 2 * mass, 0.01 * mass, 1, "mass of the payload")),
        _effect(placed(axes), f"a point mass M at p + d, d in the body's frame (p of {_ends(off)})",
                "body: a load at any place", off,
                Size("M", "kg", 2 * mass, 0.01 * mass, 1, "mass of the load"), shapes=of_place),
    )  # fmt: skip
    return tuple(e for e in every if e.places)


def _ends(bodies: Sequence[MovingBody]) -> str:
    """Returns where a payload would sit on some bodies, in words."""
    return "; ".join("{}: ({:.3g}, {:.3g}, {:.3g}) m".format(b.label, *b.point) for b in bodies)


def _size(name: str, unit: str, largest: float, about: str) -> Size:
    return Size(name, unit, largest, PROBE * largest, 0, about)


def _effect(
    law: Any, said: str, phrase: str, on: Sequence[MovingBody], *sizes: Size,
    shapes: Sequence[Shape] = (),
) -> Effect:  # fmt: skip
    return Effect(
        law.__name__, said, sizes, tuple(shapes), phrase=phrase, reference=WENSING,
        places={f"body {b.label}": f"@{b.label}" for b in on}, hooks={HOOK: law},
    )  # fmt: skip
