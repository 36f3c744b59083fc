"""A log to a `Log`: one reader for files of every kind, with an optional TOML beside it."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from identification.errors import InputError
from identification.logs.formats.formats import log_table, refuse_no_log
from identification.logs.headers.headers import with_headers
from identification.logs.headers.unknown_units import told_of_unknown_units
from identification.logs.log import Log
from identification.logs.names import check_column_names, check_keys, lookup
from identification.logs.plausible import check_plausible, check_possible
from identification.logs.poses import Pose, measured_columns, with_angles
from identification.logs.repeats import told_of_repeats
from identification.logs.sampling import FloatArray, check_time, grid
from identification.logs.sidecar import Sidecar, read_sidecar
from identification.logs.stamps.coarse import evened_stamps, refuse_contradicted
from identification.logs.stamps.publishers import (
    refuse_interleaved,
    refuse_second_publisher,
    refuse_two_inputs,
)
from identification.logs.stamps.resampling import even_out
from identification.logs.stamps.stamps import wanted_columns, with_time, without_repeated
from identification.logs.stamps.standing import columns_of_time, refuse_standing
from identification.logs.stamps.times import told_of_times
from identification.logs.table import (
    Table,
    check_columns,
    check_finite,
    check_stamps,
    conversions,
    converted,
    renamed,
)
from identification.logs.units import check_si
from identification.logs.wrapped import without_wraps
from identification.storage.files import readable

# Columns of time whose stamps may need more digits than a float has.
STAMPS = ("time", "time [ns]", "time (ns)", "time [us]", "time (us)")


def read_log(
    path: str | os.PathLike[str],
    inputs: Sequence[str],
    outputs: Sequence[str],
    optional: Sequence[str] = (),
    *,
    units: Mapping[str, str] | None = None,
    limits: Mapping[str, float] | None = None,
    rates: Mapping[str, float] | None = None,
    named_in: Path | None = None,
    lenient: bool = False,
    said: Mapping[str, Any] | None = None,
    mapped: Collection[str] = (),
    overrule: str = "",
    trust_rows: bool = False,
    poses: Sequence[Pose] = (),
) -> Log:
    """Read a log; columns may stand in any order, and a file that cannot be right is refused.

    The keys of `units`, `limits` and `rates` are columns or groups: "angle" is all of angle_1,
    angle_2, and so on.

    Args:
        path: `.csv` with the header `time,<inputs>,<outputs>[,<optional>]`, `.mat` with `u`, `y`,
            `Ts`, or a path of another kind (see `identification.logs.formats.formats`); a `.toml`
            of the same stem may say more (see `docs/robot/keys.md`).
        inputs: names of the actuators (nu).
        outputs: names of the sensors (ny).
        optional: columns that may be there; they become `Log.extras`.
        units: SI unit of each column; the sidecar may then give another unit of that quantity.
        limits: largest plausible size [SI].
        rates: largest plausible speed of change [SI/s]; this finds degrees taken for radians.
        named_in: the file that names `inputs` and `outputs`, for messages; the sidecar when None.
        lenient: columns that are not asked for are left out, uneven time stamps and missing cells
            are put on an even grid (`identification.logs.stamps.resampling`), and angles lose
            their jumps by whole turns (`identification.logs.wrapped`); the log's remarks say so.
        mapped: columns that a user has written for others, so that their headers say their unit.
        said: keys of the sidecar that hold where it does not say otherwise.
        overrule: how a user may overrule `limits` and `rates`, for their messages.
        trust_rows: whether rows that look like those of a second publisher are read; else they are
            refused where `lenient`, and in any case where most stamps have such rows.
        poses: outputs that are made of the columns of a pose; these are read in their place.

    Returns:
        The log in SI units, named after the file.

    Raises:
        InputError: the file cannot be read, or cannot be such a log; one sentence says why and what
            to do.
    """
    path, units, limits, rates = Path(path), units or {}, limits or {}, rates or {}
    measured = measured_columns(outputs, poses)
    columns = (*inputs, *measured, *optional)
    check_column_names(columns)
    for what, keys in (("unit", units), ("limit", limits), ("rate", rates)):
        check_keys(f"{what} for column", keys, columns)
    for unit in units.values():
        check_si(unit)

    refuse_no_log(path)
    sidecar = read_sidecar(path.with_suffix(".toml"), said, named_in)
    if sidecar.values and not lenient:
        raise InputError(
            f"{sidecar.file_of('values')} gives values of a robot under [values], which only the"
            " robots of read_robot have; leave them out"
        )
    olds = {new: old for old, new in sidecar.columns.items()}
    table = log_table(
        path,
        wanted_columns({"time", *columns}, sidecar) if lenient else None,
        header=sidecar.header,
        stamps={*STAMPS, *(old for old, new in sidecar.columns.items() if new == "time")},
        asked=[olds.get(name, name) for name in (*inputs, *measured)],
        of_matlab=(inputs, measured, optional),
    )
    if lenient:
        table, found = with_headers(table, {"time", *columns}, sidecar, mapped)
        table = told_of_times(table, found, is_said="time" in sidecar.columns.values())
        sidecar = found
        table = told_of_unknown_units(table, sidecar, {**units, "time": "s"}, mapped)
    for key in ("units", "factors", "zeros"):
        check_keys(
            f"column under {key!r} in {sidecar.file_of(key)}:",
            getattr(sidecar, key),
            ("time", *columns),
        )
    if sidecar.factors.get("time", 1.0) < 0:
        raise InputError(
            f"the factor of time under 'factors' in {sidecar.file_of('factors')} is negative, and"
            " time goes on; write a positive one, such as 1e-9 for ns"
        )
    if "time" in sidecar.zeros:
        raise InputError(
            f"'zeros' in {sidecar.file_of('zeros')} has one for time, whose first stamp may be any;"
            " leave it out"
        )
    of_time = columns_of_time(table, sidecar)
    table = with_time(renamed(table, sidecar), sidecar)
    if "time" not in table.names and sidecar.sampling_time:
        time = grid(0.0, sidecar.sampling_time, len(table.data))
        data = np.column_stack([time, table.data])
        table = replace(table, names=("time", *table.names), data=data)
    check_columns(table, ("time", *inputs, *measured), optional, sidecar, named_in)

    si, factors = conversions(table, sidecar, {**units, "time": "s"})
    table = with_angles(converted(table, sidecar, factors), poses)
    gaps: tuple[tuple[float, float], ...] = ()
    refuse_standing(table, table["time"], of_time, sidecar)
    if lenient:
        check_stamps(table)
        check_possible(table)  # a log of a robot; others may hold any number
        table = without_wraps(table, outputs, si)
        cure = f', or write trust = ["rows"] into {named_in}' if named_in else ""
        refuse_second_publisher(table, inputs, outputs, si, cure, trust_rows)
        if not trust_rows:
            refuse_interleaved(table, inputs, outputs, cure)
    if not _is_even(table, sidecar):
        if lenient:
            table = without_repeated(table)
        if not _is_even(table, sidecar):
            table = evened_stamps(table, outputs, sidecar, trust_rows)
    if lenient:
        table = told_of_repeats(table, outputs)
    if lenient and not _is_even(table, sidecar):
        refuse_contradicted(table, outputs, sidecar, trust_rows)
        refuse_two_inputs(table, inputs, cure, trust_rows)
        table, gaps = even_out(table, inputs, sidecar.hold, sidecar.sampling_time)
    check_finite(table)
    time = table["time"]
    check_time(time, table.place, sidecar.sampling_time)
    if sidecar.sampling_time:  # the grid is better than coarse stamps
        time = grid(time[0], sidecar.sampling_time, len(time))
    check_plausible(table, factors, si, limits, rates, sidecar.file_of("units"), overrule)
    return Log(
        time=time,
        inputs=_stacked(table, inputs),
        outputs=_stacked(table, outputs),
        input_names=tuple(inputs),
        output_names=tuple(outputs),
        extras={name: table[name] for name in optional if name in table.names},
        units={n: u for n, u in si.items() if n in table.names and n != "time"},
        name=readable(path.stem),
        notes=sidecar.notes,
        hold=sidecar.hold,
        splits=sidecar.splits,
        values=sidecar.values,
        remarks=table.remarks,
        unread=tuple(n for n in table.unread if n not in sidecar.ignore),
        gaps=gaps,
        said_units={n: u for n in table.names if (u := lookup(sidecar.units, n)) is not None},
        factors=_given(sidecar.factors, table),
        zeros={n: zero * factors[n] for n, zero in _given(sidecar.zeros, table).items()},
    )


def _given(by_name: Mapping[str, float], table: Table) -> dict[str, float]:
    """Returns what is given for a column or its group, by column."""
    found = {n: lookup(by_name, n) for n in table.names if n != "time"}
    return {n: given for n, given in found.items() if given is not None}


def _is_even(table: Table, sidecar: Sidecar) -> bool:
    try:
        check_finite(table)
        check_time(table["time"], table.place, sidecar.sampling_time)
    except InputError:
        return False
    return True


def _stacked(table: Table, names: Sequence[str]) -> FloatArray:
    return table.data[:, [table.names.index(name) for name in names]]
