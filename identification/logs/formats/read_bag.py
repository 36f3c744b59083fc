"""Recordings of ROS to a table: MCAP, ROS 2 bags with MCAP or SQLite, and bags of ROS 1.

A column is a number of a message, called by its topic, its field, and the joint or the place in a
list that it belongs to:

    joint_states.position.elbow      sensor_msgs/JointState on /joint_states
    commands.data_2                  std_msgs/Float64MultiArray on /commands

A message that has a list of names (`name`, `joint_names`, `interface_names`) gives them to the
entries of its other lists. Time is the stamp in a message's header, or else the time at which it
was recorded, less the first one. The rows of several topics are joined where their stamps are the
same; elsewhere a row has empty cells, which `identification.logs.stamps.resampling` fills.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from identification.errors import InputError
from identification.logs.names import listed, quoted
from identification.logs.sampling import FloatArray
from identification.logs.table import Table
from identification.runtime.lazy import needed
from identification.storage.files import check_file, is_file

EXTRA = "ros"
SUFFIXES = (".mcap", ".db3", ".bag")
WIDEST = 256  # numbers of a list in a message: more is a picture or a cloud of points
FIRST = 50  # messages of a topic that show which columns it has
_NAMES = ("name", "joint_names", "interface_names")  # fields that name the entries of the others
_NO_SIGNALS = ("header", "layout")  # fields that say how a message is to be read
_LARGEST = 8 * 2**30  # [bytes] of a recording, of which only the wanted topics are read
_STORE = "ROS2_HUMBLE"  # types of messages of recordings that do not say theirs

Numbers = dict[str, float]  # of a message, by the names of its columns


def is_bag_folder(path: Path) -> bool:
    """Tells whether a path is a folder that `ros2 bag record` made."""
    return is_file(path / "metadata.yaml")


def read_bag(
    path: Path,
    wanted: Callable[[Sequence[str]], Collection[str]] | None,
    asked: Collection[str] = (),
) -> Table:
    """Reads the table in a recording of ROS; see `formats.log_table`.

    Raises:
        InputError: rosbags is not installed, the recording is damaged, lacks the topic of an asked
            column, or has no numbers.
    """
    with _open(path) as reader:
        topics = _columns(reader)
        _refuse_missing(path, topics, asked)
        every = ("time", *(name for names in topics.values() for name in names))
        chosen = every if wanted is None else wanted(every)
        series, untimed = [], []
        for topic, names in topics.items():
            kept = [name for name in names if name in chosen]
            if kept:
                stamps, data, is_recorded = _read(reader, topic, kept)
                series.append((kept, stamps, data))
                untimed += [topic] * is_recorded
    if not topics:
        raise InputError(f"{path} has no topic with numbers; record the states of the joints")
    stamps, data = _joined(series)
    names = tuple(name for kept, _, _ in series for name in kept)
    first = stamps[0] if len(stamps) else 0
    time = (stamps - first) * 1e-9
    return Table(
        path, ("time", *names), np.column_stack([time, data]),
        lambda row: f"the message of {stamps[row] - first:d} ns after the first in {path}",
        tuple(name for name in every[1:] if name not in names),
        (*_said_of_stamps(path, untimed), *_said_of_joining(path, series, len(stamps))),
    )  # fmt: skip


@contextmanager
def _open(path: Path) -> Iterator[Any]:
    """Yields a reader of a recording; its refusals and what damage makes of it are one sentence."""
    module = needed("rosbags.highlevel", EXTRA, "reading MCAP and bags of ROS")
    typesys = needed("rosbags.typesys", EXTRA, "reading MCAP and bags of ROS")
    for file in [*path.iterdir()] if path.is_dir() else [path]:
        check_file(file, _LARGEST, "recording of ROS")
    store = typesys.get_typestore(getattr(typesys.Stores, _STORE))
    try:
        with module.AnyReader([path], default_typestore=store) as reader:
            yield reader
    except InputError:
        raise
    except Exception as error:  # a damaged file may raise any
        raise InputError(
            f"{path} cannot be read as a recording of ROS ({quoted(str(error), 120)}); see whether"
            " it was closed when it was recorded (ros2 bag reindex, or mcap recover, mends that)"
        ) from error


def _columns(reader: Any) -> dict[str, tuple[str, ...]]:
    """Returns the names of the columns by topic, as the first messages of each have them.

    Several nodes may publish the states of some joints each.
    """
    out: dict[str, dict[str, float]] = {}
    for connection in reader.connections:
        for _, _, raw in islice(reader.messages([connection]), FIRST):
            message = reader.deserialize(raw, connection.msgtype)
            found = _numbers(message, _short(connection.topic))
            if found:
                out.setdefault(connection.topic, {}).update(found)
    return {topic: tuple(names) for topic, names in out.items()}


def _read(reader: Any, topic: str, names: list[str]) -> tuple[np.ndarray, FloatArray, bool]:
    """Returns the stamps of a topic in order, shape (n,) [ns], and its columns, shape (n, c).

    The last item tells whether the stamps are the times at which messages were recorded.
    """
    recorded, stamped, rows = [], [], []
    connections = [c for c in reader.connections if c.topic == topic]
    for connection, time, raw in reader.messages(connections):
        message = reader.deserialize(raw, connection.msgtype)
        header = getattr(getattr(message, "header", None), "stamp", None)
        recorded.append(time)
        stamped.append(0 if header is None else 10**9 * header.sec + header.nanosec)
        found = _numbers(message, _short(topic))
        rows.append([found.get(name, np.nan) for name in names])
    is_recorded = not all(stamped)
    stamps = np.array(recorded if is_recorded else stamped, np.int64)
    order = np.argsort(stamps, kind="stable")
    return stamps[order], np.array(rows, np.float64)[order], is_recorded


def _joined(series: Sequence[tuple[list[str], np.ndarray, FloatArray]]) -> tuple[np.ndarray, Any]:
    """Returns the stamps of all topics in order, shape (n,) [ns], and their columns, shape (n, c).

    The k-th message of a topic at a stamp stands in one row with the k-th of another topic there.
    """
    if len(series) == 1:
        return series[0][1], series[0][2]
    keys = [np.column_stack([stamps, _repeats(stamps)]) for _, stamps, _ in series]
    if not keys:
        return np.zeros(0, np.int64), np.zeros((0, 0))
    rows, which = np.unique(np.concatenate(keys), axis=0, return_inverse=True)
    data, at, column = np.full((len(rows), sum(len(s[0]) for s in series)), np.nan), 0, 0
    for names, stamps, values in series:
        data[which.ravel()[at : at + len(stamps)], column : column + len(names)] = values
        at, column = at + len(stamps), column + len(names)
    return rows[:, 0], data


def _repeats(stamps: np.ndarray) -> np.ndarray:
    """Returns how many rows before each one have its stamp, for stamps in order, shape (n,)."""
    return np.arange(len(stamps)) - np.searchsorted(stamps, stamps)


def _numbers(message: Any, name: str, labels: Sequence[str] = ()) -> Numbers:
    """Returns the numbers of a message, or of a part of it, by the names of their columns."""
    if isinstance(message, bool | int | float | np.number | np.bool_):
        return {name: float(message)}
    if isinstance(message, str) or message is None:
        return {}
    if is_dataclass(message):
        numbers = [getattr(message, n) for n in _NAMES if hasattr(message, n)]
        labels = next((tuple(v) for v in numbers if isinstance(v, list)), labels)
        parts = {f.name: getattr(message, f.name) for f in fields(message)}
        return {
            column: number
            for field, part in parts.items()
            if field not in (*_NAMES, *_NO_SIGNALS) and not field.startswith("__")
            for column, number in _numbers(part, f"{name}.{field}", labels).items()
        }
    if not isinstance(message, list | np.ndarray) or not 0 < len(message) <= WIDEST:
        return {}
    has_names = len(labels) == len(message)
    return {
        column: number
        for k, part in enumerate(message)
        for column, number in _numbers(
            part, f"{name}.{labels[k]}" if has_names else f"{name}_{k + 1}"
        ).items()
    }


def _short(topic: str) -> str:
    return topic.removeprefix("/")


def _refuse_missing(path: Path, topics: dict[str, tuple[str, ...]], asked: Collection[str]) -> None:
    """Refuse a recording without the topic of an asked column."""
    known = {_short(topic) for topic in topics}
    for name in asked:
        topic = name.partition(".")[0]
        if "." in name and topic not in known:
            raise InputError(
                f"{path} has no topic {quoted(topic)} with numbers, which the column {quoted(name)}"
                f" needs; it has {listed(sorted(known)) or 'none'}; correct the name, or record"
                " this topic too"
            )


def _said_of_joining(
    path: Path, series: Sequence[tuple[list[str], np.ndarray, FloatArray]], rows: int
) -> tuple[str, ...]:
    """Tells of topics that were joined, where they do not come at the same stamps."""
    if all(len(stamps) == rows for _, stamps, _ in series):
        return ()
    each = [f"{names[0].partition('.')[0]} ({len(stamps)} messages)" for names, stamps, _ in series]
    return (
        f"The topics {listed(each)} of {path.name} were joined by their stamps; a row has empty"
        " cells where another topic came.",
    )


def _said_of_stamps(path: Path, untimed: Sequence[str]) -> tuple[str, ...]:
    """Tells of topics whose messages have no stamps of their own."""
    if not untimed:
        return ()
    one = len(untimed) == 1
    return (
        f"The messages of {listed(untimed)} in {path.name} have no stamps of their own; the time at"
        f" which {'it was' if one else 'they were'} recorded counts, and is late by what the"
        " recorder took.",
    )
