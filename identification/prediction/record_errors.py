"""Errors of two models by record, over windows of the horizon.

    rms = S √mean (e/s)²,    S = √mean s²     s: scale of each output; S = 1 where units differ

With one output, or with outputs of one scale, this is the rms of e itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.logs.log import Log
from identification.prediction.records import Record
from identification.prediction.unseen import Unseen

Squares = Sequence[np.ndarray]  # mean square of each window (W,) in units of s², one a record


@dataclass(frozen=True, kw_only=True)
class RecordError:
    """Errors on one record, over windows of the horizon.

    Attributes:
        name: of the record.
        role: "fit" or "confirm".
        before: rms of the model before (the nominal one, or the values with which a fit began),
            over all outputs, in the outputs' unit where they have one, else in units of their
            scale.
        after: rms of the model after (the final one, or the fitted one).
    """

    name: str
    role: str
    before: float
    after: float


def error_unit(log: Log, scale: np.ndarray) -> tuple[float, str]:
    """S, and its unit: that of the outputs, or none where they have several.

    Args:
        log: one of the records.
        scale: s of each output, shape (ny,), in its unit.
    """
    unit = log.output_unit
    return (float(np.sqrt(np.mean(scale**2))), unit) if unit else (1.0, "")


def scaled_squares(errors: Sequence[np.ndarray], scale: np.ndarray) -> list[np.ndarray]:
    """Mean squares of windows (W,) in units of s², of errors (W, L, ny), one array a record."""
    return [np.mean((e / scale) ** 2, axis=(1, 2)) for e in errors]


def record_errors(
    records: Sequence[Record],
    scale: float,
    unseen: tuple[Unseen, Unseen],
    fitted: Sequence[Squares],
) -> tuple[RecordError, ...]:
    """Errors of two models on fitted records and on those that confirm.

    Args:
        records: of both roles, in the order of the errors of each.
        scale: S, in the unit of the errors.
        unseen: errors of both models on the records that confirm.
        fitted: squares of both models on the records that were fitted.
    """
    pairs = {
        "fit": zip(*fitted, strict=True),
        "confirm": zip(*(u.at_horizon for u in unseen), strict=True),
    }
    out = []
    for record in records:
        before, after = (scale * float(np.sqrt(x.mean())) for x in next(pairs[record.role]))
        out.append(RecordError(name=record.log.name, role=record.role, before=before, after=after))
    return tuple(out)
