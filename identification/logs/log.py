"""A log: what went into a robot and what came out of it, evenly sampled, in SI units."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from math import isnan
from types import MappingProxyType

import numpy as np

from identification.errors import InputError, unknown_name
from identification.logs.names import check_column_names
from identification.logs.sampling import (
    MIN_ROWS,
    FloatArray,
    check_time,
    rows_between,
    sampling_time,
    snapped,
)
from identification.logs.units import check_si

HOLDS = ("zoh", "foh")
Splits = Mapping[str, tuple[float, float]]


@dataclass(frozen=True, eq=False, kw_only=True)
class Log:
    """One experiment: n samples of nu inputs and ny outputs; nothing in it can be changed.

    Attributes:
        time: time stamps (n,) [s], evenly spaced; stamps that are even to their digits are put on
            the grid that they round.
        inputs: what was commanded, shape (n, nu), each column in its unit.
        outputs: what was measured, shape (n, ny), each column in its unit.
        input_names: names of the actuators (nu).
        output_names: names of the sensors (ny).
        extras: optional columns by name, each of shape (n,) in its unit, such as a measured pose.
        units: SI unit by column name, where known.
        name: what to call the log in a report.
        notes: remarks of its author.
        hold: the input between samples: "zoh" keeps the last value, "foh" draws a straight line.
        remarks: what was changed when it was read from a file, a sentence each.
        unread: columns of its file that nobody asked for, and that were not read.
        gaps: where nothing was measured and samples are made up that may be wrong: begin and end of
            each [s]; windows that touch one are left out.
        said_units: units of the numbers in its file, by column, where something says them.
        factors: what its TOML multiplied columns with beside their units, by column.
        zeros: what its TOML takes off columns, in their units, by column.
        splits: named parts [start, end) [s], such as estimation and validation.
        values: values of a robot's parameters that hold in this log alone, by name, such as a
            payload.
        begun: time between the first sample of the whole record and the first one of this part of
            it [s]; what changes with time in a robot goes on from part to part.

    Raises:
        InputError: shapes disagree, a number is not finite, time is uneven, a name is unusable, a
            split is empty, or the splits for estimation and validation overlap.
    """

    time: FloatArray = field(repr=False)
    inputs: FloatArray = field(repr=False)
    outputs: FloatArray = field(repr=False)
    input_names: tuple[str, ...]
    output_names: tuple[str, ...]
    extras: Mapping[str, FloatArray] = field(default_factory=dict, repr=False)
    units: Mapping[str, str] = field(default_factory=dict, repr=False)
    name: str = "log"
    notes: str = ""
    hold: str = "zoh"
    splits: Splits = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)
    begun: float = 0.0
    remarks: tuple[str, ...] = ()
    said_units: Mapping[str, str] = field(default_factory=dict)
    factors: Mapping[str, float] = field(default_factory=dict)
    zeros: Mapping[str, float] = field(default_factory=dict)
    gaps: tuple[tuple[float, float], ...] = ()
    unread: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        def put(attribute: str, value: object) -> None:
            object.__setattr__(self, attribute, value)

        for attribute in ("time", "inputs", "outputs"):
            put(attribute, _frozen(getattr(self, attribute)))
        put("input_names", tuple(self.input_names))
        put("output_names", tuple(self.output_names))
        put("extras", MappingProxyType({k: _frozen(v) for k, v in self.extras.items()}))
        put("units", MappingProxyType(dict(self.units)))
        put("values", MappingProxyType(dict(self.values)))
        put("factors", MappingProxyType(dict(self.factors)))
        put("zeros", MappingProxyType(dict(self.zeros)))
        put("splits", MappingProxyType({k: (a, b) for k, (a, b) in self.splits.items()}))
        self._check()
        # A part is judged by its own stamps, which may be fewer and printed with more digits than
        # those of the whole; on the grid itself every part of an even log is even.
        put("time", _frozen(snapped(self.time)))

    def _check(self) -> None:
        """Refuse values that the class does not admit."""
        names = (*self.input_names, *self.output_names, *self.extras)
        check_column_names(names)
        if not (self.input_names or self.output_names):
            raise InputError(f"log {self.name!r} has no columns; name its inputs or outputs")
        n = self.time.shape[0] if self.time.ndim == 1 else -1
        check_array(self.name, "time", self.time, (n,))
        check_array(self.name, "inputs", self.inputs, (n, len(self.input_names)))
        check_array(self.name, "outputs", self.outputs, (n, len(self.output_names)))
        for name, column in self.extras.items():
            check_array(self.name, name, column, (n,))
        check_time(self.time, lambda row: f"row {row} of log {self.name!r}")
        for name, unit in self.units.items():
            if name not in names:
                raise unknown_name("column with a unit", name, names)
            check_si(unit)
        if self.hold not in HOLDS:
            raise unknown_name("hold of the input", self.hold, HOLDS)
        check_splits(self.name, self.time, self.splits)

    def __len__(self) -> int:
        return len(self.time)

    def __reduce__(self) -> tuple[Callable[[], Log], tuple[()]]:
        # A mapping proxy cannot be pickled, but logs are sent to other processes.
        values = {name: getattr(self, name) for name in self.__dataclass_fields__}
        for name in ("extras", "units", "values", "splits", "factors", "zeros"):
            values[name] = dict(values[name])
        return partial(type(self), **values), ()

    @property
    def columns(self) -> dict[str, FloatArray]:
        """Every column but time, by name, each (n,): inputs, outputs, extras."""
        return {
            **dict(zip(self.input_names, self.inputs.T, strict=True)),
            **dict(zip(self.output_names, self.outputs.T, strict=True)),
            **self.extras,
        }

    @property
    def sampling_time(self) -> float:
        """The constant step h [s]."""
        return sampling_time(self.time)

    @property
    def duration(self) -> float:
        """From the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def output_unit(self) -> str:
        """The unit of all outputs; empty where they have several units or none is known."""
        units = {self.units.get(name, "") for name in self.output_names}
        return units.pop() if len(units) == 1 else ""

    def between(self, start: float, end: float) -> Log:
        """Returns the samples of [start, end) [s]; time stamps stay the same, splits are dropped.

        Raises:
            InputError: there are fewer samples than a log needs.
        """
        first, last = rows_between(self.time, start, end)
        if last - first < MIN_ROWS:
            raise InputError(
                f"log {self.name!r} has {max(0, last - first)} samples in [{start:g}, {end:g}) s; "
                f"take at least {MIN_ROWS} of [{self.time[0]:g}, {self.time[-1]:g}] s"
            )
        rows = slice(first, last)
        return replace(
            self,
            time=self.time[rows],
            inputs=self.inputs[rows],
            outputs=self.outputs[rows],
            extras={name: column[rows] for name, column in self.extras.items()},
            splits={},
            begun=self.begun + float(self.time[first] - self.time[0]),
        )

    def part(self, name: str) -> Log:
        """Returns the samples of a named split; a log without splits has those of `halves`.

        Raises:
            InputError: the name is unknown.
        """
        splits = self.splits or halves(self)
        if name not in splits:
            raise unknown_name("part of the log", name, splits)
        return replace(self.between(*splits[name]), name=f"{self.name} [{name}]")


def halves(log: Log) -> Splits:
    """Returns the default splits: the first half is for estimation, the second for validation."""
    step = log.sampling_time
    start, end = float(log.time[0]), float(log.time[-1]) + step
    middle = float(log.time[len(log) // 2])
    return {"estimation": (start, middle), "validation": (middle, end)}


def check_array(log: str, what: str, array: FloatArray, shape: tuple[int, ...]) -> None:
    """Refuse an array of a log of another shape than it should have, or with infinite numbers."""
    if array.shape != shape:
        raise InputError(
            f"log {log!r}: {what} has shape {array.shape} and should have {shape}; "
            "give one row for each sample and one column for each name"
        )
    bad = np.argwhere(~np.isfinite(array))
    if bad.size:
        raise InputError(
            f"log {log!r}: {what}{bad[0].tolist()} is {array[tuple(bad[0])]}; "
            "a log holds finite numbers only"
        )


def check_splits(log: str, time: FloatArray, splits: Mapping[str, tuple[float, float]]) -> None:
    """Refuse an empty part [start, end) [s], and overlapping ones to estimate and to validate."""
    span = f"[{time[0]:g}, {time[-1]:g}] s"
    for name, (start, end) in splits.items():
        first, last = rows_between(time, start, end)
        if isnan(start) or isnan(end) or last - first < MIN_ROWS:
            raise InputError(
                f"split {name!r} = [{start:g}, {end:g}) s of log {log!r} holds fewer than "
                f"{MIN_ROWS} samples; choose a part of {span}"
            )
    if {"estimation", "validation"} <= set(splits):
        (a, b), (c, d) = (rows_between(time, *splits[n]) for n in ("estimation", "validation"))
        if max(a, c) < min(b, d):
            raise InputError(
                f"splits 'estimation' and 'validation' of log {log!r} overlap; keep the data "
                "that confirm a model apart from those that made it"
            )


def _frozen(values: FloatArray) -> FloatArray:
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
