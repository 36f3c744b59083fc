"""Even logs whose stamps lost digits keep their rows, with the one step that fits all of them.

    |t_k - t_0 - k T| <= q_k/2    q_k   quantum of stamp k: its last digit, or a clock's tick
                                  T     the sampling time, one for all rows

"%.7g" prints 20000.005 s as 20000 or 20000.01: neighbouring rows get one stamp, others a gap, and
yet every row was sampled in its turn. All T that satisfy this form an interval. It proves an even
log where it is narrow, and where nothing else makes such stamps:

    steps of q and 2 q      dropped rows of an even log too; they do not come as regularly
    rows that share stamps  rows written twice too; within these the outputs do not move on
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.errors import InputError
from identification.logs.sampling import JITTER, MIN_ROWS, FloatArray, float_resolution, grid
from identification.logs.shared_stamps import moves_on, shared
from identification.logs.sidecar import Sidecar
from identification.logs.stamps import WHOLE
from identification.logs.table import Table

COARSE = 0.5  # of a step: from there the rounding of stamps merges rows and makes gaps
EXACT = 1e-3  # relative, to which the step must be known: values follow its square
FEW = 2  # irregular steps, which dropped or repeated rows may well make
MOST = 0.05  # of the rows, that may have come together, such as through a bus
MEANT = 0.5  # of the stamps, that may have such rows where the user says that they are meant
DECIMALS = range(-3, 13)


@dataclass(frozen=True)
class Stamps:
    """Stamps and what is known of their grid.

    Attributes:
        time: the stamps, shape (n,) [s], none smaller than the one before.
        quanta: quantum of each stamp, shape (n,) [s].
        steps: smallest and largest sampling time that fits all rows [s]; None where none does.
    """

    time: FloatArray
    quanta: FloatArray
    steps: tuple[float, float] | None

    @property
    def mean(self) -> float:
        """The mean step [s]."""
        return float(self.time[-1] - self.time[0]) / (len(self.time) - 1)

    @property
    def is_coarse(self) -> bool:
        """Whether rounding alone may merge rows or make gaps."""
        return bool(self.quanta.max() > COARSE * self.mean)

    @property
    def is_exact(self) -> bool:
        """Whether one sampling time fits, and is known well enough."""
        return self.steps is not None and self.steps[1] - self.steps[0] <= EXACT * self.steps[1]


def evened_stamps(
    table: Table, outputs: Sequence[str], sidecar: Sidecar, trusted: bool = False
) -> tuple[Table, str]:
    """Returns a table with even stamps where digits were all that they lost, and a sentence.

    Args:
        table: columns in SI; NaN where nothing stands, and finite stamps.
        outputs: which of them are outputs.
        sidecar: its sampling time wins where it fits the stamps.
        trusted: whether the user says that rows with one stamp are meant.

    Returns:
        The table as it is and "" where its stamps are even already, or uneven for another reason.

    Raises:
        InputError: the stamps are too coarse to say when the rows were sampled.
    """
    time, declared = table["time"], sidecar.sampling_time
    if len(time) < MIN_ROWS or not np.abs(time).max() < WHOLE:  # seconds are not told apart there
        return table, ""
    if np.any(np.diff(time) < 0) or time[0] == time[-1]:
        return table, ""
    stamps = judged(time)
    if declared is not None:
        width = stamps.quanta + JITTER * declared
        if fits(time, width, declared):
            return _with_step(table, stamps, declared)
    elif stamps.is_exact and _is_proven(table, stamps, outputs):
        return _with_step(table, stamps, _roundest(*stamps.steps or (0.0, 0.0)))
    if stamps.is_coarse:
        _refuse_irregular(table, stamps, outputs, sidecar, trusted)
    return table, ""


def judged(time: FloatArray) -> Stamps:
    """Returns stamps with their quanta and the sampling times that fit them.

    Args:
        time: stamps, shape (n,) [s], none smaller than the one before.
    """
    quanta = _quanta(time)
    mean = float(time[-1] - time[0]) / (len(time) - 1)
    return Stamps(time, quanta, _fitting_steps(time, quanta / 2 + JITTER * mean))


def fits(time: FloatArray, width: FloatArray, step: float) -> bool:
    """Returns whether some grid of a step comes as near to all stamps as they allow.

    Args:
        time: stamps, shape (n,) [s].
        width: how far each may be off the grid, shape (n,) [s].
        step: of the grid [s].
    """
    with np.errstate(over="ignore"):  # a step of 1e308 s fits no stamps
        off = time - time[0] - step * np.arange(len(time))
    return bool(np.max(off - width) <= np.min(off + width) + float_resolution(time))


def _fitting_steps(time: FloatArray, width: FloatArray) -> tuple[float, float] | None:
    """Returns the smallest and the largest step of a grid that comes near enough to all stamps.

    Two rows bound the step: each bound is put in the place of the step until no two rows object.
    """
    k, t, least = np.arange(len(time)), time - time[0], float_resolution(time)
    low, high = t - width, t + width

    def bound(step: float, is_lower: bool) -> float | None:
        for _ in range(len(time)):
            i, j = int(np.argmax(low - step * k)), int(np.argmin(high - step * k))
            if low[i] - high[j] - step * (i - j) <= least:
                return step
            if i == j or (i > j) != is_lower:
                return None
            step = float((low[i] - high[j]) / (i - j))
        return None

    first = bound(float((low[-1] - high[0]) / k[-1]), is_lower=True)
    last = bound(float((high[-1] - low[0]) / k[-1]), is_lower=False)
    if first is None or last is None or not 0 < first <= last:
        return None
    return first, last


def _quanta(time: FloatArray) -> FloatArray:
    """Returns the quantum of each stamp, shape (n,) [s].

    "%g" prints larger stamps with fewer decimals, so that each decade has a quantum of its own,
    and none a larger one than the decade above it. Where rows share stamps, a clock ticks slower
    than they come, and all steps are multiples of its tick; without such rows even sampling itself
    makes all steps multiples of one.
    """
    size = np.abs(time)
    decade = np.floor(np.log10(np.where(size > 0, size, np.inf), where=size > 0,
                               out=np.full(len(time), -np.inf)))  # fmt: skip
    quanta, above = np.empty(len(time)), np.inf
    for each in np.unique(decade)[::-1]:
        rows = decade == each
        above = min(above, _decimal(time[rows]))
        quanta[rows] = above
    finest = float(quanta.min())
    if np.any(np.diff(time) == 0) and finest > float_resolution(time):
        ticks = np.rint(np.diff(time) / finest).astype(np.int64)
        quanta = np.maximum(quanta, finest * np.gcd.reduce(ticks))
    return np.maximum(quanta, float_resolution(time))


def _decimal(time: FloatArray) -> float:
    """Returns the largest decimal step [s] of which stamps are multiples; zero where none is."""
    spacing = float_resolution(time)
    for decimals in DECIMALS:
        scaled = time * 10.0**decimals
        tolerance = max(1e-6, spacing * 10.0**decimals)
        if tolerance < 0.1 and np.all(np.abs(scaled - np.rint(scaled)) <= tolerance):
            return float(10.0**-decimals)
    return 0.0


def _is_proven(table: Table, stamps: Stamps, outputs: Sequence[str]) -> bool:
    """Returns whether only an even log has such stamps, of which one step fits all."""
    same = shared(stamps.time)
    if same.any():
        moved = (moves_on(stamps.time, table[name]) for name in outputs)
        return any(is_on for is_on in moved if is_on is not None)
    if not stamps.is_coarse:
        return True
    odd = _odd(stamps.time)
    if odd.any() and np.diff(stamps.time)[odd].min() < np.median(np.diff(stamps.time)):
        return True  # no rows that are missing make steps narrower
    # If more than a few rows are missing by chance, hardly ever does one sampling time fit, but it
    # may where each n-th row is missing. The beat of a sampling time is seldom n to the row.
    apart = np.diff(np.flatnonzero(odd))
    return len(apart) > FEW and bool(np.ptp(apart))


def _odd(time: FloatArray) -> np.ndarray:
    """Returns which steps are neither zero nor the usual one, shape (n - 1,)."""
    steps = np.diff(time)
    usual = np.median(steps[steps > 0])
    return np.asarray((steps > 0) & (np.abs(steps - usual) > 0.25 * usual))


def _with_step(table: Table, stamps: Stamps, step: float) -> tuple[Table, str]:
    data = table.data.copy()
    data[:, table.names.index("time")] = grid(stamps.time[0], step, len(data))
    said = (
        f"Stamps of log {table.path.stem!r} are multiples of {stamps.quanta.max():.6g} s; all its"
        f" rows were kept, and given the sampling time that fits them, {step:.6g} s"
        f" ({1 / step:.4g} Hz)."
    )
    return replace(table, data=data), said


def _roundest(low: float, high: float) -> float:
    """Returns the step in an interval that has, or whose rate has, the fewest digits."""
    middle = (low + high) / 2
    for digits in range(1, 17):
        for step in (float(f"{middle:.{digits}g}"), 1 / float(f"{1 / middle:.{digits}g}")):
            if low <= step <= high:
                return step
    return middle


def _refuse_irregular(
    table: Table, stamps: Stamps, outputs: Sequence[str], sidecar: Sidecar, trusted: bool
) -> None:
    """Refuse coarse stamps that merge rows, or make gaps, as no dropped or repeated rows do."""
    time, declared = stamps.time, sidecar.sampling_time
    same, odd = shared(time), _odd(time)
    lost = np.zeros(len(same), dtype=bool)
    for name in outputs:
        if moves_on(time, table[name]) is not False:
            lost |= same & (np.abs(np.diff(table[name])) > 0)
    n_lost, n_odd = int(lost.sum()), int(odd.sum())
    if n_lost + n_odd <= FEW or (declared and not n_lost):
        return
    if trusted and n_lost <= MEANT * int(np.sum(~same)):
        return
    # Rows that are missing by chance are no matter of digits: no step fits them. A few rows that
    # came together may be lost where the user says what the step is.
    if stamps.steps is None and n_lost <= (MOST * len(time) if declared else FEW):
        return
    row = int(np.flatnonzero(lost if n_lost else odd)[0])
    shown = " and ".join(f"{t:.12g}" for t in time[row : row + 2])
    odd_ones = [
        f"{n_lost} rows have the stamp of the row before them and other values",
        f"{n_odd} steps are not the usual one",
    ]
    told = " and ".join(t for t, n in zip(odd_ones, (n_lost, n_odd), strict=True) if n)
    which = "no sampling time fits all rows"
    cure = "write sampling_time = ... [s] into {file} if the rows are even"
    if declared:
        which = f"sampling_time = {declared:.6g} does not fit all rows"
        cure = "correct sampling_time in {file}"
    elif stamps.steps:
        low, high = stamps.steps
        which = f"each sampling time from {low:.6g} to {high:.6g} s fits all rows"
    raise InputError(
        f"{table.place(row)} and the row after it have the stamps {shown} s: stamps of log"
        f" {table.path.stem!r} are multiples of {stamps.quanta.max():.6g} s, too coarse for rows"
        f" that come every {stamps.mean:.4g} s, where {told}, and {which};"
        f" {cure.format(file=sidecar.file_of('sampling_time'))}, or record stamps with more digits"
    )
