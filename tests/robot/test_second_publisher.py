"""The commands refuse rows of a second publisher, with exit code 2, if rows are not trusted."""

import numpy as np
import pytest
from joint_cases import SLIDER
from robot_cases import TOML, refused, simulated

from identification import InputError, read_robot, write_log


@pytest.fixture
def path(tmp_path):
    (tmp_path / "slider.xml").write_text(SLIDER)
    (tmp_path / "robot.toml").write_text(TOML)
    write_log(simulated({}, start=1.4), tmp_path / "log.csv")
    return tmp_path / "log.csv"


@pytest.mark.parametrize(("command", "later", "said"), [
    ("fit", 0.0, "there are two rows with one stamp, 0.06 s, and they contradict each other"),
    ("discover", 0.003, "is zero in all columns, as of a second publisher"),
])  # fmt: skip
def test_zeros_between_rows_are_refused(path, capsys, command, later, said):
    robot = path.with_name("robot.toml")
    header, *rows = path.read_text().splitlines()
    mixed = [header]
    for k, row in enumerate(rows):
        mixed.append(row)
        if k % 9 == 6:
            stamp = row.split(",")[0]
            mixed.append(f"{float(stamp) + later},0.0,0.0")
    path.write_text("\n".join(mixed))
    told = refused(capsys, command, robot, path)
    assert told.startswith(f"identification: line 9 of {path}")
    assert said in told
    assert f'or write trust = ["rows"] into {robot}' in told
    # No check but this one speaks against such a log.
    assert len(read_robot(robot, path, trust=["rows"]).log) >= len(rows) - 1


def twice(path, other):
    """Write each row of a log twice, the second time with other cells."""
    header, *rows = path.read_text().splitlines()
    cells = [[float(cell) for cell in row.split(",")] for row in rows]
    second = [",".join(map(repr, other(*each))) for each in cells]
    both = [line for pair in zip(rows, second, strict=True) for line in pair]
    path.write_text("\n".join([header, *both]))


@pytest.mark.parametrize(
    "trust",
    [
        (),
    ],
)
def test_rows_that_are_written_twice_count_once(path, trust):
    robot = path.with_name("robot.toml")
    once = read_robot(robot, path)
    twice(path, lambda *row: row)
    both = read_robot(robot, path, trust=trust)
    np.testing.assert_array_equal(both.log.outputs, once.log.outputs)
    np.testing.assert_array_equal(both.log.inputs, once.log.inputs)
    (said,) = both.log.remarks
    assert said.startswith("1200 rows of log 'log' repeat the row before them")


@pytest.mark.parametrize("trust", [(), ("rows",)])
@pytest.mark.parametrize(("other", "said"), [
    (lambda t, u, x: (t, -u, 2.8 - x), "they contradict each other"),
    (lambda t, u, x: (t, 0.0, x), "nothing says which of them the robot had"),
])  # fmt: skip
def test_rows_that_all_contradict_another_one_are_refused_though_rows_are_trusted(
    path, other, said, trust
):
    twice(path, other)
    with pytest.raises(InputError, match="there are two rows with one stamp, ") as refusal:
        read_robot(path.with_name("robot.toml"), path, trust=trust)
    told = str(refusal.value)
    assert said in told
    assert "keep the rows of one publisher" in told
    assert ("or write trust" in told) == (not trust)
    assert ("no trust in rows tells which" in told) == bool(trust)
