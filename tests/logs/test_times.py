"""Of several columns that look like a log's time, the one that is read and the others are told."""

import numpy as np
import pytest

from identification import inspect_log
from identification.logs.read import read_log
from identification.logs.stamps.times import looks_like_time

TIME = 0.01 * np.arange(200)
CLOCKS = {  # the columns that one clock writes
    "time": TIME, "t": TIME, "Time [ms]": 1e3 * TIME + 7, "timestamp": TIME + 50,
    "sec": np.floor(TIME), "nanosec": np.rint(1e9 * (TIME % 1)), "T": 20 + TIME,
}  # fmt: skip


def remarks(folder, *names, toml=""):
    """What is told of a log with columns of time, to whoever reads it and whoever inspects it."""
    columns = [*(CLOCKS[name] for name in names), np.sin(TIME), np.cos(TIME)]
    head = ",".join((*names, "u", "q"))
    np.savetxt(folder / "log.csv", np.column_stack(columns), "%.12g", ",", header=head, comments="")
    (folder / "log.toml").write_text(toml)
    log = read_log(folder / "log.csv", ["u"], ["q"], lenient=True)
    np.testing.assert_allclose(np.diff(log.time), 0.01)
    found = inspect_log(folder / "log.csv")
    np.testing.assert_allclose(found.time, TIME, atol=1e-9)
    return tuple(" ".join(each).replace(f"{folder}/", "") for each in (log.remarks, found.remarks))


@pytest.mark.parametrize(("taken", "others"), [
    ("Time [ms]", ["t"]), ("time", ["t"]), ("time", ["Time [ms]", "timestamp"]),
    ("t", ["timestamp"]), ("t", ["sec", "nanosec"]), ("time", ["sec", "nanosec"]),
])  # fmt: skip
def test_which_is_read_and_which_are_not_is_told(tmp_path, taken, others):
    for names in ([taken, *others], [*others, taken]):
        for said in remarks(tmp_path, *names):
            assert f"Time of log 'log' is its column {taken}; {', '.join(others)}, which" in said


def test_what_is_told_takes_the_other(tmp_path):
    said, _ = remarks(tmp_path, "t", "Time [ms]")
    assert said.endswith(
        't, which looks like time too, is not read: to take t in its place, write t = "time" under'
        ' [columns] in log.toml, and ignore = ["Time [ms]"] at its head.'
    )
    for toml in ('ignore = ["Time [ms]"]\n[columns]\nt = "time"\n', '[columns]\nt = "time"\n'):
        assert remarks(tmp_path, "t", "Time [ms]", toml=toml) == ("", "")
    said, _ = remarks(tmp_path, "t", "sec", "nanosec")
    assert said.endswith('to take sec, nanosec in its place, write ignore = ["t"] into log.toml.')
    for taken in ("t", "time"):
        for said in remarks(tmp_path, taken, "sec", "nanosec", toml=f'ignore = ["{taken}"]\n'):
            assert said == "Time of log 'log' is sec [s] + nanosec [ns]."


def test_one_column_of_time_is_not_told(tmp_path):
    assert remarks(tmp_path, "time", "T") == ("", "")
    assert remarks(tmp_path, "sec", "nanosec")[0] == "Time of log 'log' is sec [s] + nanosec [ns]."


@pytest.mark.parametrize(("name", "is_one"), [
    ("time_ms", True), ("TIME", True), ("elapsed time (s)", True), ("ros_timestamp", True),
    ("T", False), ("settling_time", False), ("u", False), ("q [ms]", False), ("ms", False),
])  # fmt: skip
def test_a_name_of_the_words_of_a_clock_looks_like_time(name, is_one):
    assert looks_like_time(name) == is_one


def test_the_unit_of_a_header_is_that_of_the_time_also_of_a_slow_log(tmp_path):
    rows = np.column_stack([300.0 * np.arange(50), np.sin(np.arange(50))])
    np.savetxt(tmp_path / "log.csv", rows, "%.9g", ",", header="Time [ms],q", comments="")
    found = inspect_log(tmp_path / "log.csv")
    assert (found.time_column, found.time_unit) == ("Time [ms]", "ms")
    assert found.time[1] == pytest.approx(0.3)
