"""Steps that err by more than the log's noise are refused, and the cure that is told cures."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from joint_cases import SLIDER, STEP, run, slider, slider_log, steps

from identification import InputError, read_robot
from identification.robot.file.file import RobotFile
from identification.robot.robot import robot_of
from identification.robot.step_error import refuse_coarse_steps, step_error

NOISE = 1e-4  # [m]
OPTION = 'timestep="0.002" gravity="0 0 0" integrator="RK4"'
# A cart that sticks within a step.
STIFF = {"stiffness.k@slide": {"value": 2e4, "upper": 1e5}}


@pytest.fixture(scope="module")
def log():
    u = steps(400)
    y = run(slider(), slider_log(u))
    return slider_log(u, y + NOISE * np.random.default_rng(3).standard_normal(y.shape))


def robot(folder, log, option, records=None, horizon=None):
    model = folder / "slider.xml"
    model.write_text(SLIDER.replace(OPTION, f'gravity="0 0 0" {option}'))
    records = records or {}
    known = {"free": tuple(records), "records": records, "horizon": horizon}
    return robot_of(RobotFile(path=folder / "r.toml", model=model, **known), log)


@pytest.mark.parametrize(("option", "records", "words"), [
    ('timestep="0.01"', None, "integrator Euler and timestep 0.01 s, more than the noise of"),
    ('timestep="0.01" integrator="RK4"', STIFF, "integrator RK4 and timestep 0.01 s"),
])  # fmt: skip
def test_the_cure_that_is_told_cures(tmp_path, log, option, records, words):
    with pytest.raises(InputError, match=words) as refusal:
        refuse_coarse_steps(robot(tmp_path, log, option, records))
    told = dict(re.findall(r'(\w+)="([^"]+)"', str(refusal.value).partition("; write ")[2]))
    own = dict(re.findall(r'(\w+)="([^"]+)"', option))
    assert told
    assert float(told.get("timestep", own["timestep"])) <= float(own["timestep"])
    cured = " ".join(f'{key}="{value}"' for key, value in {**own, **told}.items())
    refuse_coarse_steps(robot(tmp_path, log, cured, records))


def test_the_error_is_that_of_the_half_step(tmp_path, log):
    """Euler's error is of first order: half of it is what half the step takes away."""
    errors = [step_error(robot(tmp_path, log, f'timestep="{h}"')).error for h in (0.002, 0.001)]
    assert errors[0] == pytest.approx(2 * errors[1], rel=0.1)
    y = [run(robot(tmp_path, log, option).plant, log)[: round(2 / STEP) + 1]
         for option in ('timestep="0.002"', 'timestep="0.0001" integrator="RK4"')]  # fmt: skip
    assert np.sqrt(np.mean((y[0] - y[1]) ** 2)) == pytest.approx(2 * errors[0], rel=0.1)
    found = step_error(robot(tmp_path, log, 'timestep="0.002"'))
    assert found.output == "position"
    assert found.noise == pytest.approx(NOISE, rel=0.1)


def test_over_a_horizon_steps_are_asked_where_the_robot_was(tmp_path):
    """A model that is too light runs into its end stop, where the robot never was."""
    stop = '<joint name="slide" type="slide" range="-0.3 0.35" limited="true" '
    hard = SLIDER.replace('<joint name="slide" type="slide" ', stop).replace('mass="2"', 'mass="1"')
    assert hard.count(stop) == hard.count('mass="1"') == 1
    model = tmp_path / "slider.xml"
    model.write_text(hard)
    y = run(slider(), slider_log(steps(400)))
    noisy = y + NOISE * np.random.default_rng(3).standard_normal(y.shape)
    known = {"free": (), "records": {}}
    free, windows = (
        step_error(robot_of(RobotFile(path=tmp_path / "r.toml", model=model, horizon=h, **known),
                            slider_log(steps(400), noisy))).error
        for h in (None, 0.1)
    )  # fmt: skip
    assert windows < 0.1 * free


def test_a_log_without_noise_or_of_a_coarse_encoder_refuses_no_good_step(tmp_path, log):
    clean = run(slider(), slider_log(log.inputs))
    for y in (clean, np.round(clean, 2)):
        refuse_coarse_steps(robot(tmp_path, slider_log(log.inputs, y), 'timestep="0.002"'
                                  ' integrator="RK4"'))  # fmt: skip
    encoder = slider_log(log.inputs, np.round(clean, 2))
    assert step_error(robot(tmp_path, encoder, 'timestep="0.002"')).noise > 0.01 / 12**0.5 - 1e-9


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


def test_a_factor_that_no_step_can_follow_is_named(folder):
    said = refused(folder, own="[factors]\ncurrent = 1e6\n")
    assert "its TOML gives the factor 1e+06 of current under [factors]" in said
    assert f'if it is right, write trust = ["steps"] into {folder / "robot.toml"}' in said


def test_a_wrong_factor_of_an_output_is_named_over_a_horizon(folder):
    said = refused(folder, HORIZON, own="[factors]\nangle = 1000\n")
    assert "without the factor 1000 of angle that the log's TOML gives" in said
    assert "correct the factor of angle under [factors] there" in said
    assert "[units]" not in said
    assert 'or write trust = ["units"] into' in said


def test_a_right_factor_of_an_output_is_not_blamed(folder):
    """Numbers of the file that are off by it, and the factor that repairs them."""
    factor = -0.001
    head, *rows = (folder / "first.csv").read_text().splitlines()
    cells = [row.split(",") for row in rows]
    made = [f"{t},{u},{float(y) / factor!r}" for t, u, y in cells]
    (folder / "first.csv").write_text("\n".join([head, *made]) + "\n")
    assert not robot_in(folder, HORIZON, own=f"[factors]\nangle = {factor}\n").remarks


def test_a_start_beyond_all_that_the_log_shows_is_refused(folder):
    own = '\ntrust = ["steps"]\n'
    said = refused(folder, own + FREE_RUN, start='[start]\n"qvel[0]" = -1e5\n')
    assert said.startswith(f"start in {folder / 'robot.toml'}: it gives qvel[0] = ")
    assert "correct qvel[0], or delete it to begin where the log does" in said
    assert robot_in(folder, own + FREE_RUN, start='[start]\n"qpos[0]" = 500.0\n').remarks
