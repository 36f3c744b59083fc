"""The numbers of MuJoCo's bodies after the effects that act on them, for n value sets.

What an effect adds is counted from the body as the robot's own parameters make it, so that a mass
may be both free and wrong.
"""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from identification.effects import values as effect_values
from identification.effects.body import changed, frame_inertia, principal, seen
from identification.effects.effect import Effect
from identification.effects.moving_bodies import MovingBody
from identification.effects.values import Values
from identification.model.paths import Slot
from identification.model.predictor import Numbers

HOOK = "inertia"
_WIDTHS = {"body_mass": 0, "body_ipos": 3, "body_inertia": 3, "body_iquat": 4}


def body_numbers(
    model: mujoco.MjModel, effects: Sequence[Effect], bodies: Sequence[MovingBody],
    names: Sequence[str], values: Values, own: Numbers, n: int,
) -> Numbers:  # fmt: skip
    """Returns the entries of mjModel that effects of bodies change.

    Args:
        model: without these effects.
        effects: a set; those that act on other things are passed over.
        bodies: that may have effects.
        names: the parameters that differ from the plant's own.
        values: of all parameters, one or n of each.
        own: entries that the robot's own parameters change.
        n: how many value sets.

    Raises:
        InputError: no such body is possible.
    """
    acting = [e for e in effects if HOOK in e.hooks]
    out: list[tuple[Slot, np.ndarray]] = []
    for body in bodies:
        here = [e for e in acting if e.parameters_at(body.label)]
        touched = {p for e in here for parts in e.parameters_at(body.label) for p in parts}
        if not (touched & {*names} or _is_present(here, body, values)):
            continue
        rows = {field: _rows(model, body.index, field, own, n) for field in _WIDTHS}
        tables = [(e, effect_values.table_at([e], body.label, values, n)) for e in here]
        for k in range(n):
            _change(body, {field: row[k] for field, row in rows.items()}, tables, k)
        out += _slots(body.index, rows)
    return out


def _is_present(effects: Sequence[Effect], body: MovingBody, values: Values) -> bool:
    return any(effect_values.is_present(e, [body.label], values) for e in effects)


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
    return [
        (Slot(field, (b,), None if not width else k), rows[field][:, k])
        for field, width in _WIDTHS.items()
        for k in range(width or 1)
    ]
