"""Errors of two models by record, over windows of the horizon.

    rms_g = √mean e²            over the outputs of a unit g
    rms   = rms_g               where all outputs have one unit
    rms   = √mean (e/s)²        else; s: scale of each output, in which a search weighs them

The search decides by (e/s)², in which each output counts as much as its error under the nominal
model; what is told in a unit is the error itself.
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


def errors_by_unit(squares: np.ndarray, scale: np.ndarray, log: Log) -> dict[str, float]:
    """Returns rms_g by the outputs' units, each in its unit.

    Args:
        squares: mean squares of outputs in units of s², shape (…, ny).
        scale: s of each output, shape (ny,), in its unit.
        log: which outputs they are.
    """
    return by_unit(scale * np.sqrt(squares.reshape(-1, squares.shape[-1]).mean(axis=0)), log)


def error_of_all(squares: np.ndarray, scale: np.ndarray, log: Log) -> float:
    """Returns the rms over all outputs, in their unit; without a unit where they have several.

    Args:
        squares: mean squares of outputs in units of s², shape (…, ny).
        scale: s of each output, shape (ny,), in its unit.
        log: which outputs they are.
    """
    each = errors_by_unit(squares, scale, log)
    return next(iter(each.values())) if len(each) == 1 else float(np.sqrt(squares.mean()))


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
        pair = next(pairs[record.role])
        before, after = (error_of_all(x, scale, record.log) for x in pair)
        told = [errors_by_unit(x, scale, record.log) for x in pair]
        out.append(RecordError(record.log.name, record.role, before, after, *told))
    return tuple(out)
