"""The numbers of a body in mjModel, with what effects add to it.

Effects of bodies say what they add to (m, h, I_O) (`identification.effects.laws.bodies`); here it
is written into mass, centre of mass, principal moments and their axes, and what no body can be is
refused. It is plain Python, called before the simulation.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from identification.effects.effect import Effect
from identification.effects.laws.bodies import HOOK, Body
from identification.effects.moving_bodies import MovingBody
from identification.effects.values import Values, is_present, table_at
from identification.errors import InputError
from identification.model.paths import Slot
from identification.model.predictor import Numbers

ROUNDING = 1e-9  # of the trace of an inertia
_WIDTHS = {"body_mass": 0, "body_ipos": 3, "body_inertia": 3, "body_iquat": 4}


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
