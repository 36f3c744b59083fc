"""A factor or a start that a user wrote is named before the model's step is blamed."""

import shutil
from pathlib import Path

import pytest

from identification import InputError, fit, read_robot
from identification.robot.fit_json import robot_fit_to_json

ELBOW = Path(__file__).parents[2] / "examples" / "elbow"
FREE_RUN = "".join(
    line for line in (ELBOW / "elbow.toml").read_text().splitlines(keepends=True)
    if not line.startswith("horizon")
)  # fmt: skip
HORIZON = (ELBOW / "elbow.toml").read_text()


@pytest.fixture
def folder(tmp_path):
    for name in ("elbow.xml", "first.csv"):
        shutil.copy(ELBOW / name, tmp_path / name)
    return tmp_path


def robot_in(folder, toml=FREE_RUN, start="", own=""):
    (folder / "robot.toml").write_text(f"{toml}\n{start}")
    (folder / "first.toml").write_text(own)
    return read_robot(folder / "robot.toml", folder / "first.csv")


def refused(*where, **written):
    with pytest.raises(InputError) as caught:
        robot_in(*where, **written)
    return str(caught.value)


@pytest.mark.parametrize("column", ["current", "angle"])
@pytest.mark.parametrize("toml", [FREE_RUN, HORIZON], ids=["free run", "horizon"])
def test_a_factor_beyond_what_robots_have_is_named(folder, toml, column):
    said = refused(folder, toml, own=f"[factors]\n{column} = 1e20\n")
    assert f"the factor 1e+20 of {column} under 'factors' in {folder / 'first.toml'}" in said
    assert "step" not in said


def test_a_factor_that_no_step_can_follow_is_named(folder):
    said = refused(folder, own="[factors]\ncurrent = 1e6\n")
    assert "its TOML gives the factor 1e+06 of current under [factors]" in said
    assert f'if it is right, write trust = ["steps"] into {folder / "robot.toml"}' in said


@pytest.mark.parametrize(
    "entry",
    [
        '"qpos[0]" = 1e20',
        '"qvel[0]" = 1e8',
    ],
)
def test_a_start_from_which_nothing_can_be_simulated_is_named(folder, entry):
    said = refused(folder, start=f"[start]\n{entry}\n")
    assert f"[start] of {folder / 'robot.toml'} gives {entry[1:5]}[0] = " in said
    assert "from where the log begins it can: correct the start, or leave it out" in said


def test_a_start_elsewhere_is_remarked_where_nothing_fails(folder):
    remarks = robot_in(folder, start='[start]\n"qpos[0]" = 0.5\n').remarks
    (said,) = [r for r in remarks if "[start]" in r]
    assert "gives qpos[0] = 0.5 where angle begins at" in said
    assert "delete qpos[0] under [start] to begin where the log does" in said
    assert not any("[start]" in r for r in robot_in(folder).remarks)


def test_the_verdict_of_a_fit_says_that_the_start_is_elsewhere(folder):
    """What a fit found depends on it, and the remark may be far above."""
    robot = robot_in(folder, start='[start]\n"qpos[0]" = 0.2\n')
    (said,) = [s for s in robot_fit_to_json(fit(robot))["verdict"] if "[start]" in s]
    assert said.startswith("The values make up for qpos[0] under [start] of")
    (remark,) = [r for r in robot.remarks if "[start]" in r]
    assert "so that the values of a fit make up for this; delete qpos[0]" in remark


def test_a_start_that_a_horizon_does_not_use_is_remarked(folder):
    robot = robot_in(folder, HORIZON, '[start]\n"qpos[0]" = 0.0\n"qvel[0]" = 0.1\n')
    (said,) = robot.remarks
    assert "qpos[0] and qvel[0] under [start] of" in said
    assert "are not used, because the file gives a horizon: each window of 0.3 s begins" in said
    assert not robot_in(folder, HORIZON).remarks


@pytest.mark.parametrize(
    "factor",
    [
        "1000",
    ],
)
def test_a_wrong_factor_of_an_output_is_named_over_a_horizon(folder, factor):
    said = refused(folder, HORIZON, own=f"[factors]\nangle = {factor}\n")
    assert f"without the factor {factor} of angle that the log's TOML gives" in said
    assert "correct the factor of angle under [factors] there" in said
    assert "[units]" not in said
    assert 'or write trust = ["units"] into' in said


@pytest.mark.parametrize(
    "factor",
    [
        -0.001,
    ],
)
def test_a_right_factor_of_an_output_is_not_blamed(folder, factor):
    """Numbers of the file that are off by it, and the factor that repairs them."""
    head, *rows = (folder / "first.csv").read_text().splitlines()
    cells = [row.split(",") for row in rows]
    made = [f"{t},{u},{float(y) / factor!r}" for t, u, y in cells]
    (folder / "first.csv").write_text("\n".join([head, *made]) + "\n")
    assert not robot_in(folder, HORIZON, own=f"[factors]\nangle = {factor}\n").remarks


@pytest.mark.parametrize(
    "entry",
    [
        '"qvel[0]" = -1e5',
    ],
)
def test_a_start_beyond_all_that_the_log_shows_is_refused(folder, entry):
    own = '\ntrust = ["steps"]\n'
    said = refused(folder, own + FREE_RUN, start=f"[start]\n{entry}\n")
    assert said.startswith(f"start in {folder / 'robot.toml'}: it gives {entry[1:8]} = ")
    assert f"correct {entry[1:8]}, or delete it to begin where the log does" in said
    assert robot_in(folder, own + FREE_RUN, start='[start]\n"qpos[0]" = 500.0\n').remarks
