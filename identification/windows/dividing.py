"""The records that confirm in two parts, as a search over windows needs them.

The memory of the residual is that of the fitted windows: x_w = mean ‖e_w/s‖² over the samples of
window w (`identification.logs.parts`). A block holds whole windows of the longest length over which
an effect must predict better, so that few windows lie on a border. A block is also as long as
windows are apart where only some of a long record are simulated.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from identification.errors import InputError
from identification.logs.parts import Part, Parts, autocorrelation_time, divide, inside
from identification.model.predictor import Plant
from identification.windows.blocks import count_blocks
from identification.windows.fit import WindowFit
from identification.windows.records import Record
from identification.windows.unseen import LENGTHS, cut_unseen
from identification.windows.windows import Windows

# Of windows that decide, over all records; with fewer no part is kept. At 0.3 % Student's t of 12
# blocks asks for 1.2 times what it asks of many, and that of 8 for 1.4 times, beside the factor
# √1.5 of fewer windows: laws of equal evidence would pass or fail by luck, the likeliest too.
MIN_DECIDING_BLOCKS = 12


def divide_records(
    plant: Plant, records: Sequence[Record], found: WindowFit, horizon: float, scale: np.ndarray
) -> tuple[Record, ...]:
    """Returns the records, those that confirm with their parts.

    Args:
        plant: the model.
        records: to fit and to confirm.
        found: the fit of the model without effects.
        horizon: [s].
        scale: s of each output, shape (ny,), in its unit.

    Raises:
        InputError: no window of the horizon fits a record.
    """
    confirm = [r for r in records if r.role == "confirm"]
    cuts = _cuts(plant, confirm, horizon)
    memory, parted = memory_of(found, scale), []
    for k, record in enumerate(confirm):
        longest = cuts[max(cuts)][k]
        samples = int(np.diff(longest.places[0])[0])
        apart = np.diff(longest.starts)
        unit = samples * max(1, round(float(np.median(apart)) / samples)) if len(apart) else samples
        parts = divide(np.ones(len(record.log), bool), unit, memory / record.log.sampling_time)
        parted.append(replace(record, parts=parts if _is_enough(parts, cuts, k) else None))
    deciding = (
        count_blocks(int(inside(r.parts, "select", cut.places).sum()))
        for r, cut in zip(parted, cuts[1.0], strict=True)
    )
    each = iter(parted if sum(deciding) >= MIN_DECIDING_BLOCKS else confirm)
    return tuple(next(each) if r.role == "confirm" else r for r in records)


def memory_of(found: WindowFit, scale: np.ndarray) -> float:
    """Returns the time τ over which errors of fitted windows repeat one another [s].

    Args:
        found: a fit.
        scale: s of each output, shape (ny,), in its unit.
    """
    squares = [np.mean((e / scale) ** 2, axis=(1, 2)) for e in found.errors]
    apart = [
        float(np.median(np.diff(p.cut.starts))) * p.predictor.log.sampling_time
        for p in found.problem.parts
        if len(p.cut.starts) > 1
    ]
    return autocorrelation_time(squares) * max(apart, default=0.0)


def _cuts(plant: Plant, records: Sequence[Record], horizon: float) -> dict[float, list[Windows]]:
    """Returns the windows of each length, in units of the horizon, that fits the records."""
    cuts = {1.0: cut_unseen(plant, records, horizon, is_horizon=True)}
    for factor in LENGTHS:
        with suppress(InputError):  # it fits no record
            cuts.setdefault(factor, cut_unseen(plant, records, factor * horizon, factor == 1.0))
    return cuts


def _is_enough(parts: Parts, cuts: Mapping[float, Sequence[Windows]], record: int) -> bool:
    """Returns whether each part holds two windows of the horizon, and one of every other length."""
    both: tuple[Part, ...] = "select", "report"
    return parts.is_kept and all(
        inside(parts, part, each[record].places).sum() > (factor == 1.0)
        for factor, each in cuts.items()
        for part in both
    )
