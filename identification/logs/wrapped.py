"""Angles that jump by a whole turn where their encoder begins anew, put together again.

    Δ_k = y_{k+1} - y_k = w_k + n_k P       |w_k| <= P/2,   P a whole turn,   n_k whole

No joint makes a whole turn from one sample to the next and stands still in all others. So where
some n_k are not zero, the motion was w_k, if it is beyond doubt that it was:

    y stays within one turn        an encoder that begins anew reads nothing else
    |w_k| <= P/4                   no step comes near half a turn, where n_k would be a guess
    |w_k - (w_k-1 + w_k+1)/2| <= P/8                                joints move smoothly
    |w_k - (w_k-1 + w_k+1)/2| <= 3 times the largest one elsewhere    also where n_k is not zero

A column that never jumps by three quarters of a turn, or goes farther than a turn, is not touched.
Where one of the other lines does not hold, it stays as it is too, and a sentence says so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.logs.table import Table
from identification.logs.units import UNITS

WITHIN = 1.02  # of a turn: an encoder's numbers lie in one turn, but for a factor and rounding
SURE = 0.25  # of a turn: largest motion between two samples that leaves no doubt
SMOOTH = 0.125  # of a turn: largest change of this motion from sample to sample
USUAL = 3.0  # times the largest change of the motion elsewhere, for that at a jump
COARSE = 5e-3  # of a turn: such a change is that of a rounded factor, or of an encoder's step
FEWEST = 8  # samples that show how a joint moves
_LEFT = ", and it stays as it is, because "


@dataclass(frozen=True)
class Jumps:
    """The jumps of an angle by about a whole turn."""

    count: int
    values: np.ndarray  # the angle without them, as far as they are beyond doubt, shape (n,)
    doubt: str  # why they may be none, in words; "" where they are beyond doubt


def turn_of(unit: str) -> float:
    """Returns a whole turn in a unit of angles; 0 for any other unit."""
    si, factor = UNITS.get(unit, ("", 1.0))
    return 2 * np.pi / factor if si == "rad" else 0.0


def find_jumps(values: np.ndarray, turn: float) -> Jumps | None:
    """Returns the jumps of an angle by about a whole turn; None where it makes none.

    Args:
        values: of the angle, shape (n,), NaN where nothing stands.
        turn: a whole turn, in the unit of the angle.
    """
    rows = np.flatnonzero(np.isfinite(values))
    y = values[rows]
    steps = np.diff(y)
    jumps = np.abs(steps) >= (1 - SURE) * turn
    if not jumps.any() or len(y) < FEWEST or np.ptp(y) > WITHIN * turn:
        return None
    whole = np.round(steps / turn)
    motion = steps - whole * turn
    bend = np.abs(_bend(motion))
    usual = bend[~_beside(jumps)].max(initial=0.0)
    doubt = ""
    if np.abs(motion).max() > SURE * turn:
        doubt = "it moves by nearly half a turn between other samples"
    elif bend.max() > SMOOTH * turn or bend[jumps].max() > max(USUAL * usual, COARSE * turn):
        doubt = "its motion before a jump does not go on behind it"
    out = np.array(values)
    if not doubt:
        out[rows[1:]] -= turn * np.cumsum(whole)
    return Jumps(int(jumps.sum()), out, doubt)


def without_wraps(table: Table, names: Sequence[str], units: Mapping[str, str]) -> Table:
    """Returns a table whose angles do not jump by whole turns, and tells so.

    Args:
        table: its columns are in SI units; NaN where nothing stands.
        names: columns that measure positions; those that are no angles stay as they are.
        units: their units, by name.
    """
    for name in names:
        turn = turn_of(units.get(name, ""))
        found = find_jumps(table[name], turn) if turn else None
        if found is None:
            continue
        data = np.array(table.data)
        data[:, table.names.index(name)] = found.values
        told = jump_sentence(f"{name} of log {table.path.stem!r}", units[name], found)
        table = replace(table, data=data).told(told)
    return table


def jump_sentence(what: str, unit: str, found: Jumps) -> str:
    """Returns what was made of the jumps of a column, in one sentence that begins with its name."""
    times = "once" if found.count == 1 else f"{found.count} times"
    jumps = f"{what} jumps {times} by about a whole turn ({turn_of(unit):.4g} {unit})"
    if found.doubt:
        return (
            f"{jumps}{_LEFT}{found.doubt}: if its encoder begins anew"
            " after a turn, unwrap it (numpy.unwrap) from samples that are close enough."
        )
    return f"{jumps}, where its encoder begins anew, and is read without these jumps."


def doubted_jumps(remarks: Sequence[str]) -> str:
    """Returns those remarks on a log that tell of jumps that were left in it; "" for none."""
    return " ".join(remark for remark in remarks if _LEFT in remark)


def _bend(motion: np.ndarray) -> np.ndarray:
    """Returns how each step differs from the mean of its neighbours, those at the ends from one."""
    padded = np.concatenate([motion[1:2], motion, motion[-2:-1]])
    return motion - (padded[:-2] + padded[2:]) / 2


def _beside(jumps: np.ndarray) -> np.ndarray:
    """Returns which steps are jumps or have one beside them."""
    beside = np.array(jumps)
    beside[1:] |= jumps[:-1]
    beside[:-1] |= jumps[1:]
    return beside
