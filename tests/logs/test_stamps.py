"""Stamps as recorders write them: nanoseconds since 1970, or seconds and nanoseconds apart."""

from datetime import datetime, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from joint_cases import SLIDER
from robot_cases import TOML, simulated

from identification import InputError, read_log, read_robot
from identification.logs.stamps.stamps import exact_stamps, seconds_of

N = 400
EPOCH = 1_691_234_567_123_456_789  # [ns]
STEP = 4_000_000  # [ns]


def put(csv, header, row, sidecar=""):
    path = csv(header + "\n" + "".join(row(k) + "\n" for k in range(N)))
    path.with_suffix(".toml").write_text(sidecar)
    return path


def read(path):
    return read_log(path, ["u"], ["y"], lenient=True)


def even(path):
    log = read(path)
    np.testing.assert_allclose(log.time, 4e-3 * np.arange(N), rtol=0, atol=1e-9)
    np.testing.assert_array_equal(log.outputs[:, 0], np.arange(N))
    return log


@given(
    first=st.integers(2**53, 2**63),
    steps=st.lists(st.integers(0, 2**52), min_size=2, max_size=9),
    form=st.sampled_from(["{}", "+{}", " {} ", "{}.0"]),
)
def test_large_stamps_lose_no_digit(first, steps, form):
    stamps = [first, *(first + k for k in steps)]
    found = exact_stamps([form.format(k) for k in stamps])
    assert found.tolist() == [k - first for k in stamps]


@pytest.mark.parametrize("said", ['[units]\ntime = "ns"', "[factors]\ntime = 1e-9"])
def test_nanoseconds_since_1970(csv, said):
    columns = '[columns]\n"%time" = "time"\n'
    rows = lambda k: f"{EPOCH + k * STEP},name,{k},1"  # noqa: E731
    log = even(put(csv, "%time,frame,y,u", rows, columns + said))
    assert not log.factors
    assert log.sampling_time == 4e-3


@pytest.mark.parametrize(
    "form", ["{}T{}{}Z", "{} {}{}", "{}T{}{}+02:00", '"{}T{}{}000Z"', "{}T{}{}-0530"]
)
@pytest.mark.parametrize("name", ["time", "logged at"])
def test_dates_are_read_and_their_time_counts_from_the_first(csv, form, name):
    """Over midnight at the end of a year, whatever the zone is."""

    def row(k):
        at = datetime(2023, 12, 31, 23, 59, 59) + timedelta(microseconds=4000 * k)
        day, clock = at.isoformat(timespec="seconds").split("T")
        return f"{form.format(day, clock, f'.{at.microsecond:06d}')},{k},1"

    columns = "" if name == "time" else f'[columns]\n"{name}" = "time"\n'
    log = even(put(csv, f"{name},y,u", row, columns))
    assert "its time counts from the first one" in log.remarks[0]


def test_a_cell_that_is_no_date_among_dates_is_told_with_its_line(csv, refusal):
    dates = lambda k: f"{'soon' if k == 3 else f'2024-05-01T10:00:0{k}Z'},{k},1"  # noqa: E731
    said = refusal(read, put(csv, "time,y,u", dates))
    assert "line 5 of" in said
    assert "column time: soon is not a number" in said
    assert seconds_of("2024-13-01T10:00:00Z") is None


@pytest.mark.parametrize(
    ("names", "sidecar"),
    [
        (("header.stamp.sec", "header.stamp.nanosec"), ""),
        (("/imu/header/stamp/Sec", "/imu/header/stamp/NanoSec"), ""),
        (("s", "rest"), '[columns]\ns = "time.sec"\nrest = "time.nanosec"'),
        (None, 'columns = ["time.sec", "time.nanosec", "skip", "y", "u"]'),
    ],
)
def test_seconds_and_nanoseconds_in_two_columns(csv, names, sidecar):
    def row(k):
        sec, nanosec = divmod(EPOCH + k * STEP, 10**9)
        return f"{sec},{nanosec},base_link,{k},1"

    path = put(csv, ",".join([*(names or ()), "frame", "y", "u"]), row, sidecar)
    if names is None:
        path.write_text(path.read_text().split("\n", 1)[1])
    log = even(path)
    told = [r for r in log.remarks if "[s] +" in r]
    assert told == ([] if sidecar else [f"Time of log 'log' is {names[0]} [s] + {names[1]} [ns]."])


def test_two_clocks_are_to_be_chosen_from(csv, refusal):
    header = "a.sec,a.nanosec,b.sec,b.nanosec,y,u"
    path = put(csv, header, lambda k: f"0,{k * STEP},7,{k * STEP},{k},1")
    said = refusal(read, path)
    assert "a.sec with a.nanosec or b.sec with b.nanosec" in said
    assert '"a.sec" = "time.sec" and "a.nanosec" = "time.nanosec"' in said
    path.with_suffix(".toml").write_text(
        '[columns]\n"b.sec" = "time.sec"\n"b.nanosec" = "time.nanosec"'
    )
    assert read(path).time[0] == 7.0
    path.with_suffix(".toml").write_text("sampling_time = 0.004")
    assert read(path).time[0] == 0.0


@pytest.mark.parametrize(
    ("cells", "sidecar", "words"),
    [
        ("1.5,{}", "", ["line 2", "column sec: 1.5 is no whole number"]),
        ("1,{}", 'units.time = "ns"', ["gives time under 'units'", "sec [s] and nanosec [ns]"]),
        ("1,{}", "factors.time = 2.0", ["gives time under 'factors'", "leave it out there"]),
        ("1,{}", "factors.time = -1", ["the factor of time", "is negative"]),
    ],
)
def test_bad_stamps(csv, refusal, cells, sidecar, words):
    path = put(csv, "sec,nanosec,y,u", lambda k: cells.format(k * STEP) + f",{k},1", sidecar)
    said = refusal(read, path)
    for word in words:
        assert word in said


@pytest.mark.parametrize(("right", "wrong"), [("us", "ms"), ("ms", "s")])  # fmt: skip
@pytest.mark.parametrize("in_robot", [False, True])
def test_a_wrong_unit_of_time_is_told_the_one_that_repairs_it(tmp_path, right, wrong, in_robot):
    (tmp_path / "slider.xml").write_text(SLIDER)
    robot, path = tmp_path / "robot.toml", tmp_path / "slow.csv"
    log = simulated({}, 200)
    per_second = {"ms": 1e3, "us": 1e6, "ns": 1e9}[right]
    cells = np.column_stack([np.rint(log.time * per_second), log.inputs, log.outputs])
    rows = [f"{t:.0f},{u!r},{y!r}" for t, u, y in cells.tolist()]
    path.write_text("\n".join([f"time,{log.input_names[0]},x", *rows]))
    place = robot if in_robot else path.with_suffix(".toml")

    def say(unit):
        robot.write_text(TOML)
        if in_robot:
            robot.write_text(TOML + f'\n[log.units]\ntime = "{unit}"\n')
        else:
            place.write_text(f'units.time = "{unit}"')

    say(wrong)
    with pytest.raises(InputError, match="is sampled every") as refused:
        read_robot(robot, path)
    said = str(refused.value)
    assert f"is its time in {right}, and not in {wrong} as {place} says?" in said
    assert f'write time = "{right}" under [units] in {place}' in said
    say(right)
    assert read_robot(robot, path).log.sampling_time == pytest.approx(log.sampling_time)
