"""Effects of the bodies that a robot moves: ten numbers (m, h, I_O) that each adds to a body's.

    h = m c,    I_O = I_c + m (|c|² 1 - c cᵀ)

    mass mismatch       Δm (1, c, I_O/m)        a heavier body of unchanged shape
    offset of centre    (0, m d, |c+d|² .. )    the same body, displaced by d in its frame
    inertia mismatch    δ (0, 0, I_c)           inertia about the centre of mass
    payload             M (1, p, |p|² 1 - p pᵀ) a point mass at p

m: mass [kg]; c: centre of mass in the body's frame [m]; I_c, I_O: inertia about the centre of mass
and about the frame's origin, in the frame's axes [kg m²]. All ten add up over the parts of a body,
so that effects add up too. Each keeps a possible body possible (a positive pseudo-inertia; Wensing,
Kim, Slotine 2018), as long as Δm > -m, δ > -1, M >= 0. Functions take a `Body` s and the sizes p,
and are called before the simulation, as plain Python. What they add is counted from the body as the
robot's own parameters make it, so that a mass may be both free and wrong.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence
from functools import cache
from typing import Any

import mujoco
import numpy as np
from numba import njit

from identification.effects.effect import Effect
from identification.effects.moving_bodies import Felt, MovingBody, movable, moving_bodies
from identification.effects.sizes import Size
from identification.effects.values import Values, is_present, table_at
from identification.errors import InputError
from identification.model.paths import Slot
from identification.model.predictor import Numbers
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
LEAST = 1e-2  # a body that reaches no farther than this is taken to reach so far [m]
WENSING = "Wensing, Kim, Slotine 2018"
ROUNDING = 1e-9  # of the trace of an inertia
HOOK = "inertia"
_WIDTHS = {"body_mass": 0, "body_ipos": 3, "body_inertia": 3, "body_iquat": 4}


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


def body_numbers(
    model: mujoco.MjModel, effects: Sequence[Effect], bodies: Sequence[MovingBody],
    names: Sequence[str], values: Values, own: Numbers, n: int,
) -> Numbers:  # fmt: skip
    """Returns the entries of mjModel that effects of bodies change."""
    acting = [e for e in effects if HOOK in e.hooks]
    out: list[tuple[Slot, np.ndarray]] = []
    for body in bodies:
        here = [e for e in acting if e.parameters_at(body.label)]
        touched = {p for e in here for parts in e.parameters_at(body.label) for p in parts}
        if not (touched & {*names} or any(is_present(e, [body.label], values) for e in here)):
            continue
        rows = {field: _rows(model, body.index, field, own, n) for field in _WIDTHS}
        tables = [(e, table_at([e], body.label, values, n)) for e in here]
        for k in range(n):
            _change(body, {field: row[k] for field, row in rows.items()}, tables, k)
        out += _slots(body.index, rows)
    return out


def _rows(model: mujoco.MjModel, b: int, field: str, own: Numbers, n: int) -> np.ndarray:
    """Returns a number of a body in n value sets, shape (n, width)."""
    rows = np.tile(np.atleast_1d(getattr(model, field)[b]), (n, 1))
    for slot, column in own:
        if slot.field == field and b in slot.rows:
            rows[:, slot.column or 0] = column
    return rows


def _change(
    body: MovingBody, row: dict[str, np.ndarray],
    tables: Sequence[tuple[Effect, np.ndarray]], k: int,
) -> None:  # fmt: skip
    """Write what the effects make of a body into its row, in place; nothing where all are zero."""
    present = [(e, t[k]) for e, t in tables if np.any(t[k, : len(e.sizes)])]
    if not present:
        return
    m, c = float(row["body_mass"][0]), np.array(row["body_ipos"])
    I_c = frame_inertia(row["body_inertia"], row["body_iquat"])
    s = seen(m, c, I_c, body.point)
    added = np.sum([e.hooks[HOOK].py_func(s, tuple(p)) for e, p in present], axis=0)  # type: ignore[attr-defined]
    m, c, I_c = changed(body.label, m, c, I_c, added)
    row["body_mass"][0], row["body_ipos"][:] = m, c
    row["body_inertia"][:], row["body_iquat"][:] = principal(I_c)


def _slots(b: int, rows: dict[str, np.ndarray]) -> Numbers:
    """Returns the entries of a body that its rows (n, width) of numbers change."""
    return [
        (Slot(field, (b,), None if not width else k), rows[field][:, k])
        for field, width in _WIDTHS.items()
        for k in range(width or 1)
    ]


def frame_inertia(inertia: np.ndarray, quat: np.ndarray) -> np.ndarray:
    """Returns I_c in the body's axes, shape (3, 3), from principal moments (3,) and axes (4,)."""
    flat = np.empty(9)
    mujoco.mju_quat2Mat(flat, quat)
    R = flat.reshape(3, 3)
    return np.asarray(R @ np.diag(inertia) @ R.T)


def principal(I_c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns principal moments (3,) and the quaternion of their axes (4,) of an inertia (3, 3)."""
    moments, R = np.linalg.eigh(I_c)
    if np.linalg.det(R) < 0:
        R[:, 0] *= -1
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(R).ravel())
    return moments, quat


def about(m: float, c: np.ndarray) -> np.ndarray:
    """Returns m (|c|² 1 - c cᵀ): the inertia of a point mass about the origin, shape (3, 3)."""
    return np.asarray(m * (c @ c * np.eye(3) - np.outer(c, c)))


def seen(m: float, c: np.ndarray, I_c: np.ndarray, point: Sequence[float]) -> Any:
    """Returns the body as an effect sees it."""
    upper = I_c[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    return Body(*map(float, (m, *c, *upper, *point)))


def changed(
    label: str, m: float, c: np.ndarray, I_c: np.ndarray, added: np.ndarray
) -> tuple[float, np.ndarray, np.ndarray]:
    """Returns mass, centre of mass (3,) and I_c (3, 3) after effects have added their ten numbers.

    Args:
        label: of the body, for an error.
        m: mass before [kg].
        c: centre of mass before [m].
        I_c: inertia before [kg m²].
        added: by effects, shape (10,).
    """
    xx, yy, zz, xy, xz, yz = added[4:]
    more = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    mass = m + added[0]
    if not mass > 0:
        raise InputError(f"body {label!r} would have a mass of {mass:.3g} kg; take other sizes")
    centre = (m * c + added[1:4]) / mass
    inertia = I_c + about(m, c) + more - about(mass, centre)
    if not _excess(inertia) <= max(_excess(I_c), 0.0) + ROUNDING * np.trace(I_c):
        raise InputError(f"body {label!r} would have an inertia that no body has; take other sizes")
    return float(mass), centre, inertia


def _excess(I_c: np.ndarray) -> float:
    """Returns the excess of the largest moment over the sum of the others; impossible above 0."""
    low, middle, high = np.linalg.eigvalsh(I_c)
    return float(max(high - middle - low, -low))
