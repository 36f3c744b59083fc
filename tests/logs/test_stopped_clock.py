"""Stamps of a clock that stands are told as that, with the rows and what to do about them."""

import numpy as np
import pytest

from identification import InputError, Log, inspect_log
from identification.logs.read import read_log
from identification.logs.stamps.standing import stopped

TIME = 0.01 * np.arange(300)
EVEN = "sampling_time = 0.01\n"


def write(folder, columns, toml=""):
    data = np.column_stack([*columns.values(), np.sin(TIME), np.cos(TIME)])
    head = ",".join((*columns, "u", "q"))
    np.savetxt(folder / "log.csv", data, "%.12g", ",", header=head, comments="")
    (folder / "log.toml").write_text(toml)
    return folder / "log.csv"


def read(path, lenient=True):
    return read_log(path, ["u"], ["q"], lenient=lenient)


@pytest.mark.parametrize("lenient", [True, False])
@pytest.mark.parametrize("toml", ["", EVEN])
def test_a_clock_that_stands_all_along_is_told_with_its_rows(tmp_path, toml, lenient, refusal):
    path = write(tmp_path, {"time": 5 + 0 * TIME}, toml)
    said = refusal(read, path, lenient)
    assert said.startswith(f"line 2 of {path} and all 299 rows after it have one stamp, 5 s: time")
    assert 'time does not advance; if the rows are even, write ignore = ["time"] and' in said
    read(write(tmp_path, {"time": 5 + 0 * TIME}, f'{EVEN}ignore = ["time"]\n'), lenient)


@pytest.mark.parametrize(("columns", "stamp"), [
    ({"t": 0 * TIME}, "0"), ({"Time [ms]": 0 * TIME + 7}, "0.007"),
    ({"sec": 0 * TIME + 2, "nanosec": 0 * TIME}, "2"), ({"time": 0 * TIME + 1714557600}, "1.71455"),
])  # fmt: skip
def test_whatever_the_columns_are_called(tmp_path, columns, stamp, refusal):
    path = write(tmp_path, columns)
    for reader in (read, inspect_log):
        said = refusal(reader, path)
        assert f"have one stamp, {stamp}" in said
        names = ", ".join(f'"{name}"' for name in columns)
        assert f"does not advance; if the rows are even, write ignore = [{names}] and" in said
    read(write(tmp_path, columns, f"{EVEN}ignore = [{names}]\n"))


def test_another_clock_of_the_log_is_named(tmp_path, refusal):
    columns = {"time": 0 * TIME, "t": TIME}
    path = write(tmp_path, columns)
    for reader in (read, inspect_log):
        said = refusal(reader, path)
        assert 'to take t in its place, write t = "time" under [columns] in' in said
        assert 'log.toml, and ignore = ["time"] at its head' in said
    read(write(tmp_path, columns, 'ignore = ["time"]\n[columns]\nt = "time"\n'))


@pytest.mark.parametrize(("time", "first", "count", "when"), [
    (np.minimum(TIME, 2), 202, 99, "from there on"),
    (np.maximum(TIME - 1, 0), 2, 100, "up to these rows' end"),
    (TIME - np.clip(TIME - 1, 0, 0.5), 102, 50, "in these rows"),
])  # fmt: skip
@pytest.mark.parametrize("toml", ["", EVEN])
def test_a_clock_that_stands_in_a_part_is_told(tmp_path, time, first, count, when, toml, refusal):
    path = write(tmp_path, {"time": time}, toml)
    said = refusal(read, path)
    assert said.startswith(f"line {first} of {path} and the {count} rows after it have one stamp")
    assert f"time does not advance {when}; leave these rows out, or, if all rows" in said
    read(write(tmp_path, {"time": time}, f'{EVEN}ignore = ["time"]\n'))


@pytest.mark.parametrize("time", [
    TIME,
    np.floor(TIME),  # a clock that ticks too slowly
    np.where((TIME > 1) & (TIME < 1.5), 1.5, TIME),  # rows that a bus delivered together
    np.where((TIME > 1) & (TIME < 1.5), 1.0, TIME),
])  # fmt: skip
def test_other_stamps_are_not_of_a_clock_that_stood(time):
    assert stopped(time) is None


def test_a_log_of_arrays_says_so_too():
    with pytest.raises(InputError, match="and all 299 rows after it have one stamp, 0 s: time"):
        Log(time=0 * TIME, inputs=TIME[:, None], outputs=TIME[:, None], input_names=("u",),
            output_names=("q",))  # fmt: skip
