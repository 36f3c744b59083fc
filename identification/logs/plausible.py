"""What no right log holds: numbers that are too large, and sensors that freeze.

Numbers that are too large are most often numbers in another unit. A limit of the size finds
milliamperes that were taken for amperes. A limit of the speed finds degrees that were taken for
radians, even when the angles are small: the speed too is 57 times too large.

A sensor is frozen where an output repeats one value while its joint is still driven. The output of
a joint at rest repeats one value too, but then its inputs have changed. An encoder whose steps are
too coarse for a slow motion also repeats values, but it does not stop suddenly.

A sensor that wakes up again jumps to where its joint has gone meanwhile. A joint that rested, stuck
by friction or at an end stop, or moved by less than a step of its encoder, begins to move from
where it was, and no faster than elsewhere in the log. Only a position that jumps is therefore told
as one that froze. A sensor that froze while its joint left and came back is not found.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from identification.chances import f_above
from identification.errors import InputError
from identification.logs.cures import lines_of
from identification.logs.log import Log
from identification.logs.names import group, lookup
from identification.logs.table import HUGE, Table
from identification.logs.units import to_si, units_that_fit
from identification.storage.files import toml_key

FEWEST = 50  # a frozen output repeats at least so many samples
SHARE = 0.2  # and at least this share of the log
AS_BEFORE = 0.5  # of the std before; a signal that still varies by as much counts as moving
ROUNDED = 1e-6  # of its width, below which a difference is rounding and no step of an encoder
FEW = 0.1  # of the differences may be smaller than a step
SPAN = 2  # samples that a jump takes: one where it is measured, two where it is put on a grid
BEYOND = 2.0  # times the farthest motion in as many samples elsewhere, from which a jump is none
STEPS = 3  # that the encoder crosses in the `FEWEST` samples before it freezes
PAST = 8  # samples back to which an output is compared with itself and with the inputs
LUCK = 1e-3  # chance of noise to look as if its past told of it, below which it is a motion
TURN = 0.1  # of a turn: a jump of a wrapped angle differs from a whole turn by less


def check_possible(table: Table) -> None:
    """Refuse a number that no robot has, in whatever unit it is."""
    for name in (n for n in table.names if n != "time"):
        row = int(np.argmax(np.nan_to_num(np.abs(table[name]))))
        if abs(table[name][row]) > HUGE:
            raise InputError(
                f"{table.place(row)}: {name} is {table[name][row]:.4g}, beyond {HUGE:g}, which no"
                " robot has; repair or cut the log there, or correct the unit of the column"
            )


def check_plausible(
    table: Table,
    factors: Mapping[str, float],
    units: Mapping[str, str],
    limits: Mapping[str, float],
    rates: Mapping[str, float],
    sidecar: Path,
    overrule: str = "",
) -> None:
    """Refuse a column that is too large, or moves too fast, and name the unit that would fit.

    The table is in SI with a time column; the factors are those by which numbers of the file were
    multiplied, by column. The largest plausible sizes [SI] and speeds [SI/s] are given by column or
    group. The sidecar is the TOML that may give the unit, and `overrule` says how a user may
    overrule this.
    """
    for name in table.names:
        size, rate = lookup(limits, name), lookup(rates, name)
        column, unit = table[name], units.get(name, "")
        if size is not None:
            row = int(np.argmax(np.abs(column)))
            if abs(column[row]) > size:
                raise InputError(
                    f"{table.place(row)}: {name} is {column[row]:.4g} {unit}".rstrip()
                    + f", beyond the plausible {size:g} {unit}".rstrip()
                    + _cure(table, name, factors, unit, column[row] / factors[name], size, sidecar)
                    + overrule
                )
        if rate is not None:
            with np.errstate(over="ignore"):
                speed = np.abs(np.diff(column) / np.diff(table["time"]))
            row = int(np.argmax(speed))
            if speed[row] > rate:
                moved = speed[row] / factors[name]
                raise InputError(
                    f"{table.place(row + 1)}: {name} changes by {speed[row]:.4g} {unit}/s, "
                    f"more than the plausible {rate:g} {unit}/s"
                    + (
                        _wrapped(unit, column[row + 1] - column[row])
                        or _cure(table, name, factors, unit, moved, rate, sidecar)
                    )
                    + overrule
                )


def stands_still(y: np.ndarray) -> bool:
    """Returns whether a channel, shape (n,), moves by no more than `STEPS` steps of its encoder."""
    width, steps = np.ptp(y), np.abs(np.diff(y))
    moves = steps[steps > ROUNDED * width]
    if not moves.size:
        return bool(width == 0)
    # A few steps are smaller where a gap was bridged.
    return bool(width <= STEPS * np.quantile(moves, FEW))


def is_noise(y: np.ndarray, inputs: np.ndarray) -> bool:
    """Returns whether neither its own past nor any input (n, nu) tells anything of a channel (n,).

        y_k = c + Σ a_i y_k-i + Σ b_i u_k-i + e_k       i = 1 to `PAST`, with and without a and b

    A joint that moves keeps on moving for a while, and does so after its inputs; white noise of a
    sensor does neither. The F test of the two sums of squares decides.
    """
    if not np.ptp(y) or not _is_untold(y, y[:, None]):  # most channels are told by their own past
        return False
    moving = inputs[:, np.ptp(inputs, axis=0) > 0]
    return _is_untold(y, np.column_stack([y, moving]))


def _is_untold(y: np.ndarray, columns: np.ndarray) -> bool:
    """Returns whether the past of columns, shape (n, m), tells nothing of a channel; see above."""
    numbers = PAST * columns.shape[1]
    free = len(y) - PAST - 1 - numbers
    if free < numbers:
        return False
    past = np.column_stack([columns[PAST - i : len(y) - i] for i in range(1, PAST + 1)])
    now = y[PAST:] - y[PAST:].mean()
    past = past - past.mean(axis=0)
    past /= np.maximum(past.std(axis=0), np.finfo(float).tiny)  # units must not count
    left = float(np.sum((now - past @ np.linalg.lstsq(past, now, rcond=None)[0]) ** 2))
    ratio = (float(now @ now) - left) / numbers / (left / free) if left else np.inf
    return bool(f_above(ratio, numbers, free) > LUCK)


def still_sentence(log: Log) -> str | None:
    """Tells of outputs that stand still in all of a log; None where there is none.

    It is no refusal: a joint may be braked, or its friction may hold it against its drive.
    """
    still = []
    for name, y in zip(log.output_names, log.outputs.T, strict=True):
        if (noise := is_noise(y, log.inputs)) or stands_still(y):
            of = ", all of it noise" * noise
            within = f" (within {width:.2g}{of})" if (width := float(np.ptp(y))) else ""
            still.append(
                f"{name} is {np.median(y):.4g} {log.units.get(name, '')}".rstrip() + within
            )
    if not still:
        return None
    one = len(still) == 1
    return (
        f"In all of log {log.name!r} {' and '.join(still)}: {'a joint' if one else 'joints'} that"
        f" stood still, or {'a dead sensor' if one else 'dead sensors'}. What is dead belongs out"
        " of the outputs of the robot's file."
    )


def refuse_frozen(
    log: Log,
    output: int,
    inputs: np.ndarray,
    others: np.ndarray,
    overrule: str = "",
    is_rate: bool = False,
) -> None:
    """Refuse an output that froze, for a while or to the end.

    Args:
        log: what was measured.
        output: column of the output.
        inputs: what drives its joint, shape (n, k); it counts as driven where all vary as before.
        others: other outputs of its joint, (n, m); it counts as moving where one varies as before.
        overrule: how a user may overrule this, for the message.
        is_rate: whether the output is a rate, which may jump: it is judged at the end only.
    """
    y = log.outputs[:, output]
    if not is_rate:
        _refuse_stuck(log, output, inputs, others, overrule)
    moved = np.flatnonzero(np.diff(y))
    first = int(moved[-1]) + 1 if moved.size else 0
    if first == 0 or len(y) - first < max(FEWEST, SHARE * len(y)):
        return
    step = np.abs(np.diff(y))[moved].min()
    abrupt = np.ptp(y[max(0, first - FEWEST) : first]) > STEPS * step
    behind = np.arange(len(y)) >= first
    driven, seen = _varies(inputs, behind), _varies(others, behind)
    if abrupt and ((driven.size and driven.all()) or seen.any()):
        raise InputError(
            f"{log.output_names[output]} of log {log.name!r} repeats {y[first]:g} from"
            f" {log.time[first]:.6g} s to the end while its joint is driven on: a frozen sensor;"
            f" delete the log's rows from there on, or record again{overrule}"
        )


def _refuse_stuck(
    log: Log, output: int, inputs: np.ndarray, others: np.ndarray, overrule: str
) -> None:
    """Refuse a position that repeats one value for a while and then jumps; see `refuse_frozen`."""
    y = log.outputs[:, output]
    stops = _stops(y)
    if not stops:
        return
    far = np.abs(y[SPAN:] - y[:-SPAN])
    # Spans that hold a part of a wake-up tell nothing of the joint's speed.
    wakes = np.unique([end + k for _, end in stops for k in range(-SPAN, SPAN - 1)])
    moved = float(np.delete(far, wakes).max(initial=0.0))
    steps = np.abs(np.diff(y))
    encoder = float(steps[steps > ROUNDED * np.ptp(y)].min())
    for first, end in stops:
        jump = float(far[end - 1])
        if jump <= max(BEYOND * moved, STEPS * encoder) or moved == 0:
            continue
        part = np.zeros(len(y), dtype=bool)
        part[first:end] = True
        driven, seen = (_varies(signals, part) for signals in (inputs, others))
        if (driven.size and driven.all()) or seen.any():
            raise InputError(
                f"{log.output_names[output]} of log {log.name!r} repeats {y[first]:g} from"
                f" {log.time[first]:.6g} s to {log.time[end - 1]:.6g} s while its joint is driven"
                f" on, and then jumps by {jump:.3g} where it moves by {moved:.2g} at most in as"
                " many samples: a sensor that was stuck; save the rows before it and behind it as"
                f" two logs, or record again{overrule}"
            )


def _stops(y: np.ndarray) -> list[tuple[int, int]]:
    """Returns where a channel repeats a value: the first sample of each stop and the one behind.

    Stops at the beginning and at the end are left out: nothing stands before, or behind, them.
    """
    moves = np.flatnonzero(np.abs(np.diff(y)) > ROUNDED * np.ptp(y)) + 1
    pairs = zip(moves[:-1].tolist(), moves[1:].tolist(), strict=True)
    return [(a, b) for a, b in pairs if b - a >= FEWEST and b + SPAN < len(y)]


def _varies(signals: np.ndarray, part: np.ndarray) -> np.ndarray:
    """Returns which signals vary in a part of the samples as much as in the others, shape (k,)."""
    within, without = signals[part].std(axis=0), signals[~part].std(axis=0)
    return np.asarray((within > 0) & (within >= AS_BEFORE * without))


def _wrapped(unit: str, jump: float) -> str:
    """Returns the advice for an angle that jumps by a whole turn."""
    if unit != "rad" or abs(abs(jump) - 2 * np.pi) > TURN * 2 * np.pi:
        return ""
    return ", a jump of a whole turn: the angle is wrapped; unwrap it (numpy.unwrap)"


def _cure(
    table: Table, name: str, factors: Mapping[str, float], unit: str, raw: float, limit: float,
    sidecar: Path,
) -> str:  # fmt: skip
    """Says which unit to write where numbers are too large: for the column's group, or for some."""
    fitting = units_that_fit(unit, raw, limit)
    if not fitting:
        return "; repair or cut the log there"
    ratio = 1 / to_si(fitting[0])[1]
    like = [n for n in table.names if group(n) == group(name) and factors[n] == factors[name]]
    size = {n: float(np.abs(table[n]).max()) for n in like}
    # Halfway, as factors go, between a column in the same unit and one in the SI unit.
    large = [n for n in like if size[n] * np.sqrt(ratio) > size[name]]
    whole = len(large) == len(like)
    lines = [f'{toml_key(n)} = "{fitting[0]}"' for n in ([group(name)] if whole else large)]
    what = "the file is" if whole else f"{' and '.join(large)} {'are' if large[1:] else 'is'}"
    return (
        f"; if {what} in {' or '.join(fitting)}, write"
        f" {lines_of(lines)} under [units] in {sidecar}, else repair that row"
    )
