"""The commands refuse rows of a second publisher, with exit code 2, if rows are not trusted."""

import pytest
from joint_cases import SLIDER
from robot_cases import TOML, refused, simulated

from identification import read_robot, write_log


@pytest.fixture
def path(tmp_path):
    (tmp_path / "slider.xml").write_text(SLIDER)
    (tmp_path / "robot.toml").write_text(TOML)
    write_log(simulated({}, start=1.4), tmp_path / "log.csv")
    return tmp_path / "log.csv"


@pytest.mark.parametrize(("later", "said"), [
    (0.0, "there are two rows with one stamp, 0.06 s, and they contradict each other"),
    (0.003, "is zero in all columns, as of a second publisher"),
])  # fmt: skip
@pytest.mark.parametrize("command", ["fit", "discover"])
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
