"""Which column of a log is its time, where others look like it too.

    t, Time [ms]           one is read, and which is a matter of order, not of knowledge
    time, timestamp_ms     time is read, for its name is the very one

Both may be clocks of the log that are not alike. So a sentence names the one that is read and those
that are not, unless the log's TOML says which one it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from identification.logs.headers.column_words import words_of
from identification.logs.headers.headers import split_header
from identification.logs.names import listed, quoted
from identification.logs.sidecar import Sidecar
from identification.logs.table import Table
from identification.storage.files import toml_key, toml_value

TIME = "time"
_NANO = {"nanosec", "nanosecs", "nsec", "nsecs"}
_PARTS = {"sec", "secs", "seconds", *_NANO}  # words of the two columns that make one time
_CLOCKS = {TIME, "t", "timestamp", "timestamps", "stamp", "stamps", "clock", *_PARTS}
_KINDS = {  # words of a clock that may stand beside one of these
    "ms", "us", "ns", "elapsed", "epoch", "unix", "system", "ros", "utc", "local", "wall", "sim",
    "log", "record", "recorded", "rel", "relative", "abs", "absolute", "host", "device",
}  # fmt: skip
_OTHER = "T"  # a temperature or a torque, rather than a time


def looks_like_time(column: str) -> bool:
    """Returns whether all words of a column's name, without its unit, are those of a clock."""
    name = split_header(column)[0]
    words = {*words_of(name)}
    return name != _OTHER and bool(words & _CLOCKS) and words <= _CLOCKS | _KINDS


def told_of_times(table: Table, sidecar: Sidecar, is_said: bool) -> Table:
    """Returns a table that tells which column is its time, where others look like it too.

    Args:
        table: as it stands in its file, with the columns that are not read as `unread`.
        sidecar: what its TOML says, and which column is its time where a header tells that.
        is_said: whether the TOML itself says which one it is.
    """
    taken = next((old for old, new in sidecar.columns.items() if new == TIME), TIME)
    if is_said or taken not in table.names:
        return table
    others = [n for n in table.unread if looks_like_time(n) and n not in sidecar.ignore]
    return table.told(times_sentence(table.path, taken, others, sidecar.path)) if others else table


def times_sentence(log: Path, taken: str, others: Sequence[str], toml: Path) -> str:
    """Returns one sentence on the column of time and the others that look like it, and the cure."""
    one = len(others) == 1
    return (
        f"Time of log {log.stem!r} is its column {quoted(taken)};"
        f" {listed(others)}, which {'looks' if one else 'look'} like time too,"
        f" {'is' if one else 'are'} not read: {how_to_take(taken, others, toml)}."
    )


def how_to_take(taken: str, others: Sequence[str], toml: Path) -> str:
    """Says how to take another column as the time of a log."""
    without = f"ignore = {toml_value([taken])}"
    words = {n: {*words_of(split_header(n)[0])} for n in others}
    single = [n for n in others if not words[n] <= _PARTS]
    if not single or any(of & _NANO for of in words.values()):  # two columns make one time
        return f"to take {listed(others)} in its place, write {without} into {toml}"
    line = f'{toml_key(single[0])} = "{TIME}"'
    return (
        f"to take {quoted(single[0])} in its place, write {line} under [columns] in {toml}, and"
        f" {without} at its head"
    )
