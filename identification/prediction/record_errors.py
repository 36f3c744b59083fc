"""Errors of two models by record, over windows of the horizon.

    rms = S √mean (e/s)²,        S = √mean s²       over all outputs; S = 1 where units differ
    rms_g = S_g √mean (e/s)²,    S_g = √mean s²     over the outputs of a unit g

s: scale of each output. Of one output, or of outputs of one scale, this is the rms of e itself.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.effect_results import RecordError
from identification.estimation.metrics import by_unit
from identification.logs.log import Log
from identification.windows.records import Record
from identification.windows.unseen import Unseen

Errors = Sequence[np.ndarray]  # y - ŷ of windows (W, L, ny), one array a record


def error_unit(log: Log, scale: np.ndarray) -> tuple[float, str]:
    """Returns S, and its unit: that of the outputs, or none where they have several.

    Args:
        log: one of the records.
        scale: s of each output, shape (ny,), in its unit.
    """
    unit = log.output_unit
    return (float(np.sqrt(np.mean(scale**2))), unit) if unit else (1.0, "")


def scaled_squares(errors: Sequence[np.ndarray], scale: np.ndarray) -> list[np.ndarray]:
    """Returns mean squares (W,) in units of s² of windows' errors (W, L, ny), an array a record."""
    return [np.mean((e / scale) ** 2, axis=(1, 2)) for e in errors]


def errors_by_unit(squares: np.ndarray, scale: np.ndarray, log: Log) -> dict[str, float]:
    """Returns rms_g by the outputs' units, each in its unit.

    Args:
        squares: mean squares of outputs in units of s², shape (…, ny).
        scale: s of each output, shape (ny,), in its unit.
        log: which outputs they are.
    """
    each = np.sqrt(squares.reshape(-1, squares.shape[-1]).mean(axis=0))
    share = by_unit(each, log)
    return {unit: size * share[unit] for unit, size in by_unit(scale, log).items()}


def record_errors(
    records: Sequence[Record],
    scale: np.ndarray,
    unseen: tuple[Unseen, Unseen],
    fitted: tuple[Errors, Errors],
) -> tuple[RecordError, ...]:
    """Returns the errors of two models on fitted records and on those that confirm.

    Args:
        records: of both roles, in the order of the errors of each.
        scale: s of each output, shape (ny,), in its unit.
        unseen: errors of both models on the records that confirm, of which what is kept for the
            report is told.
        fitted: errors of both models on the records that were fitted.
    """
    squares = [[np.mean((e / scale) ** 2, axis=1) for e in each] for each in fitted]
    pairs = {
        "fit": zip(*squares, strict=True),
        "confirm": zip(*(u.report.of_outputs for u in unseen), strict=True),
    }
    out = []
    for record in records:
        whole, _ = error_unit(record.log, scale)
        pair = next(pairs[record.role])
        before, after = (whole * float(np.sqrt(x.mean())) for x in pair)
        told = [errors_by_unit(x, scale, record.log) for x in pair]
        out.append(RecordError(record.log.name, record.role, before, after, *told))
    return tuple(out)
