"""What is in a log: its columns with guesses of their units, rates, gaps, ranges, and answers."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from identification.errors import InputError
from identification.inspection.answers import Answer, find_answers
from identification.inspection.guesses import family, is_time, time_unit, unit_of
from identification.logs.formats.formats import log_table, refuse_no_log
from identification.logs.headers.column_words import Role, role_of
from identification.logs.headers.headers import name_and_unit, read_headers
from identification.logs.headers.unknown_units import by_unknown_unit, unknown_sentence
from identification.logs.names import listed, lookup
from identification.logs.repeats import repeat_sentence, repeated_share
from identification.logs.sampling import MIN_ROWS, FloatArray, grid
from identification.logs.sidecar import Sidecar, read_sidecar
from identification.logs.stamps.stamps import seconds_of, with_time
from identification.logs.stamps.standing import columns_of_time, refuse_standing
from identification.logs.stamps.times import TIME, looks_like_time, times_sentence
from identification.logs.table import Table, renamed
from identification.logs.units import to_si
from identification.logs.wrapped import find_jumps, jump_sentence, turn_of
from identification.storage.files import read_bytes

GAP = 1.5  # of the usual interval, from which samples are missing
EVEN = 1e-2  # of the usual interval, by which stamps of an even log differ
SAID = "the TOML of the log"  # why a unit is believed that is no guess
STAMPS = ("time", "%time", "stamp", "timestamp", "t")  # columns whose digits a float may lack
COMPARED = 20  # rows, below which no column is compared with another
LINES = 50  # of a CSV that show which of its columns hold numbers


@dataclass(frozen=True, kw_only=True)
class Column:
    """The content of a column of a log."""

    name: str
    role: Role  # guessed by its name
    unit: str  # guessed, "" where unknown
    why: str  # it is believed
    rate: float  # of its samples [Hz]
    least: float  # of its numbers, in the unit of the file
    most: float
    gaps: int  # intervals longer than usual
    widest: float  # interval between two samples [s]
    empty: int  # rows without a number


@dataclass(frozen=True, kw_only=True)
class Inspection:
    """The content of a log.

    Attributes:
        path: of the log.
        time: stamps from the first one, shape (n,) [s].
        values: numbers by column, shape (n,), NaN where nothing stands, in the unit of the file;
            angles without jumps by whole turns.
        columns: what each holds, in the order of the file.
        time_column: the column of time, "" where the log has none.
        time_unit: its unit; guessed where no TOML says it.
        is_even: whether its stamps are.
        answers: which input each output answers.
        left_out: columns of a CSV that hold no numbers.
        remarks: what was taken for granted when the file was read.
    """

    path: Path
    time: FloatArray
    values: Mapping[str, FloatArray]
    columns: tuple[Column, ...]
    time_column: str
    time_unit: str
    is_even: bool
    answers: tuple[Answer, ...]
    left_out: tuple[str, ...] = ()
    remarks: tuple[str, ...] = field(default=())

    @property
    def step(self) -> float:
        """The usual interval of its rows [s]."""
        return float(np.median(np.diff(np.unique(self.time))))


def inspect_log(path: str | os.PathLike[str]) -> Inspection:
    """Returns what is in a log of any kind that `read_log` reads, with guesses that say they are.

    Args:
        path: of the log; a TOML beside it counts as it does for `read_log`.

    Raises:
        InputError: it cannot be read, or has fewer than three rows of numbers.
    """
    path = Path(path)
    refuse_no_log(path)
    sidecar = read_sidecar(path.with_suffix(".toml"))
    if path.suffix.lower() == ".mat":
        raise InputError(
            f"{path} has no names of columns, but u and y in the order of the model's actuators and"
            " sensors; give it to identification fit as it is"
        )
    texts = () if sidecar.header or path.suffix.lower() != ".csv" else _texts(path)
    table = log_table(
        path, lambda names: [n for n in names if n not in texts], header=sidecar.header,
        stamps=STAMPS,
    )  # fmt: skip
    table = renamed(table, sidecar)
    if len(table.data) < MIN_ROWS:
        raise InputError(f"{path} has fewer than {MIN_ROWS} rows; record the log again")
    of_time = columns_of_time(table, sidecar)
    table, name = _with_time_found(table, sidecar)
    if not name and not sidecar.sampling_time:
        raise InputError(
            f"{path} has no column that looks like time; it has {listed(table.names)}; write the"
            f' one that is as COLUMN = "time" under [columns] in {sidecar.path}, or sampling_time'
            " = 0.01 (in seconds) into it"
        )
    unit = sidecar.units.get(TIME) or name_and_unit(name)[1]
    time: FloatArray = grid(0.0, sidecar.sampling_time or 1.0, len(table.data))
    if name:
        seconds = table[name] * to_si(unit or "s")[1]
        refuse_standing(table, seconds, of_time or (name,), sidecar)
        unit = unit or time_unit(table[name])
        time = (table[name] - table[name][0]) * to_si(unit)[1]
    unit = unit or "s"
    values = {n: table[n] for n in table.names if n != name}
    full = {n: x for n, x in values.items() if np.isfinite(x).sum() >= MIN_ROWS}
    farthest: dict[str, float] = {}  # columns of a family have one unit
    for n, x in full.items():
        farthest[family(n)] = max(farthest.get(family(n), 0.0), float(np.nanmax(np.abs(x))))
    columns = tuple(
        _column(n, time, x, lookup(sidecar.units, n) or "", farthest[family(n)])
        for n, x in full.items()
    )
    if not columns:
        raise InputError(f"{path} has no numbers beside its time; record the log again")
    unsaid = by_unknown_unit(c.name for c in columns if not c.unit)
    remarks = [*table.remarks, *map(unknown_sentence, unsaid, unsaid.values())]
    for column in (c for c in columns if c.role != "input"):
        turn = turn_of(column.unit)
        if turn and (found := find_jumps(full[column.name], turn)):
            full[column.name] = found.values
            remarks.append(jump_sentence(column.name, column.unit, found))
        if share := repeated_share(full[column.name]):
            remarks.append(repeat_sentence(column.name, share))
    steps = np.diff(np.unique(time))
    return Inspection(
        path=path, time=time, values=full, columns=columns,
        time_column=name, time_unit=unit, is_even=bool(np.ptp(steps) <= EVEN * np.median(steps)),
        answers=_answers(time, full, columns), left_out=texts,
        remarks=tuple(remarks),
    )  # fmt: skip


def _with_time_found(table: Table, sidecar: Sidecar) -> tuple[Table, str]:
    """Returns a table and its column of time, "" where it has none; it tells of others."""
    times = [n for n in table.names if is_time(n, table[n])]
    headers = [n for n, (of, _) in read_headers(table.names, {TIME}, sidecar).items() if of == TIME]
    by_header = [n for n in headers if n in times]
    names = table.names
    table = table if by_header else with_time(table, sidecar)
    name = TIME if TIME in table.names else next(iter([*by_header, *times, *headers]), "")
    others = [n for n in names if n != name and looks_like_time(n)]
    if name in names and others and TIME not in sidecar.columns.values():
        table = table.told(times_sentence(table.path, name, others, sidecar.path))
    return table, name


def _column(name: str, time: FloatArray, values: FloatArray, said: str, farthest: float) -> Column:
    """Returns what a column holds, with the unit that a TOML says, or else a guess."""
    rows = np.isfinite(values)
    apart = np.diff(np.unique(time[rows]))
    interval = float(np.median(apart)) if apart.size else np.inf
    unit, why = (said, SAID) if said else unit_of(name, farthest)
    return Column(
        name=name, role=role_of(name), unit=unit, why=why, rate=1 / interval,
        least=float(np.nanmin(values)), most=float(np.nanmax(values)),
        gaps=int(np.sum(apart > GAP * interval)), widest=float(apart.max(initial=0.0)),
        empty=int(np.sum(~rows)),
    )  # fmt: skip


def answers_of(found: Inspection, roles: Mapping[str, Role]) -> tuple[Answer, ...]:
    """Returns what answers what in a log where a model tells the roles of some columns."""
    columns = [replace(c, role=roles.get(c.name, c.role)) for c in found.columns]
    return _answers(found.time, found.values, columns)


def _answers(
    time: FloatArray, values: Mapping[str, FloatArray], columns: Sequence[Column]
) -> tuple[Answer, ...]:
    """Returns what answers what; columns without a role may be either."""
    moving = [c for c in columns if c.most > c.least]
    if not moving:
        return ()
    step = max(1 / c.rate for c in moving)
    t = grid(time[0], step, int((time[-1] - time[0]) / step) + 1)
    even = {}
    for column in moving:
        rows = np.isfinite(values[column.name])
        even[column.name] = np.interp(t, time[rows], values[column.name][rows])
    names = {role: [c.name for c in moving if c.role == role] for role in ("input", "output", "")}
    inputs = names["input"] or names[""]
    outputs = names["output"] or names[""]
    if len(t) < COMPARED:
        return ()
    return find_answers(step, {n: even[n] for n in inputs}, {n: even[n] for n in outputs})


def _texts(path: Path) -> tuple[str, ...]:
    """Returns the columns of a CSV that hold words, as its first lines show."""
    text = read_bytes(path).decode("utf-8-sig", "replace")
    lines = [line for line in text.splitlines() if line.strip() and line[0] != "#"][: LINES + 1]
    names = [name.strip().strip('"').strip() for name in (lines or [""])[0].split(",")]
    cells = [line.split(",") for line in lines[1:]]
    whole = [row for row in cells if len(row) == len(names)]
    return tuple(
        n
        for k, n in enumerate(names)
        if any(not _is_number(row[k]) for row in whole)
        and not (n in STAMPS and whole and seconds_of(whole[0][k]) is not None)
    )


def _is_number(cell: str) -> bool:
    try:
        float(cell or "nan")
    except ValueError:
        return not cell.strip()
    return True
