"""The numbers of MuJoCo's `dcmotor` that a model reads: a term that its file omits reads none.

    u = R i + K ω + L di/dt                  te = L/R: without `inductance` the current has no state
    τ = K i - σ₀ z - σ₁ ż                    without `lugre` (σ₀ = 0) z has no state

MuJoCo counts the states of a motor when it compiles the file. A number that would begin a state is
refused by its solver later, and the other numbers of the term then change nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco

from identification.errors import InputError
from identification.model.paths import Slot

_DCMOTOR = int(mujoco.mjtDyn.mjDYN_DCMOTOR) if hasattr(mujoco.mjtDyn, "mjDYN_DCMOTOR") else -1
Entry = tuple[str, int]  # array of the model and its column


@dataclass(frozen=True)
class Term:
    """A term of the motor that a file may leave out.

    Attributes:
        words: what it is.
        attribute: of `dcmotor`, which gives it.
        begins: the number that is zero without it, and that gives the motor a state.
        symbols: its numbers.
    """

    words: str
    attribute: str
    begins: Entry
    symbols: Mapping[Entry, str]


_GAIN, _BIAS, _DYN = "actuator_gainprm", "actuator_biasprm", "actuator_dynprm"
_BASE: Mapping[Entry, str] = {(_GAIN, 0): "resistance R", (_GAIN, 1): "motor constant K"}
_TERMS = (
    Term(
        "LuGre friction", 'lugre="σ₀ σ₁ τ_c τ_s ω_s"', (_DYN, 5),
        {(_DYN, 5): "σ₀", (_DYN, 6): "σ₁", (_BIAS, 3): "τ_c", (_BIAS, 4): "τ_s", (_BIAS, 5): "ω_s"},
    ),
    Term("inductance", 'inductance="L"', (_DYN, 0), {(_DYN, 0): "time constant L/R"}),
)  # fmt: skip


def refuse_unread(model: mujoco.MjModel, name: str, slot: Slot, path: str) -> None:
    """Refuse a parameter of a `dcmotor` that belongs to a term which the model does not have."""
    entry = (slot.field, slot.column if slot.column is not None else -1)
    term = next((t for t in _TERMS if entry in t.symbols), None)
    if term is None:
        return
    field, column = term.begins
    for row in slot.rows:
        if int(model.actuator_dyntype[row]) != _DCMOTOR or getattr(model, field)[row, column] != 0:
            continue
        motor = mujoco.mj_id2name(model, int(mujoco.mjtObj.mjOBJ_ACTUATOR), row) or f"#{row}"
        raise InputError(
            f"{name} ({path}) is {term.symbols[entry]} of the {term.words} of the dcmotor {motor},"
            f" which this model does not have, so that it has no effect: write {term.attribute}"
            f" into the model, or free another of its parameters: {_readable(model, row, motor)}"
        )


def _readable(model: mujoco.MjModel, row: int, motor: str) -> str:
    """Returns the numbers of a motor that can be freed, in words."""
    there = dict(_BASE)
    for term in _TERMS:
        field, column = term.begins
        if getattr(model, field)[row, column] != 0:
            there |= term.symbols
    return ", ".join(
        f"actuator/{motor}.{field.removeprefix('actuator_')}[{column}] ({symbol})"
        for (field, column), symbol in there.items()
    )
