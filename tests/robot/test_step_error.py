"""Steps that err by more than the log's noise are refused, and the cure that is told cures."""

import re
from dataclasses import replace

import numpy as np
import pytest
from joint_cases import SLIDER, STEP, run, slider, slider_log, steps

from identification import InputError, write_log
from identification.__main__ import main
from identification.robot.file import RobotFile
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
    return robot_of(
        RobotFile(
            path=folder / "r.toml",
            model=model,
            free=tuple(records),
            records=records,
            horizon=horizon,
        ),
        log,
    )


@pytest.mark.parametrize(
    ("option", "records", "words"),
    [
        ('timestep="0.01"', None, "integrator Euler and timestep 0.01 s, more than the noise of"),
        ('timestep="0.01" integrator="implicitfast"', None, "integrator implicitfast and"),
        ('timestep="0.01" integrator="RK4"', STIFF, "integrator RK4 and timestep 0.01 s"),
    ],
)  # fmt: skip
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


def test_over_a_short_horizon_less_is_lost(tmp_path, log):
    whole, short = (step_error(robot(tmp_path, log, 'timestep="0.01"', horizon=h)).error
                    for h in (None, 0.1))  # fmt: skip
    assert short < whole
    longer = step_error(robot(tmp_path, log, 'timestep="0.01"', horizon=3.0)).error
    assert longer == whole


def test_a_log_without_noise_or_of_a_coarse_encoder_refuses_no_good_step(tmp_path, log):
    clean = run(slider(), slider_log(log.inputs))
    for y in (clean, np.round(clean, 2)):
        refuse_coarse_steps(robot(tmp_path, slider_log(log.inputs, y), 'timestep="0.002"'
                                  ' integrator="RK4"'))  # fmt: skip
    encoder = slider_log(log.inputs, np.round(clean, 2))
    assert step_error(robot(tmp_path, encoder, 'timestep="0.002"')).noise > 0.01 / 12**0.5 - 1e-9


@pytest.mark.parametrize(
    "command",
    [
        "fit",
    ],
)
def test_the_commands_refuse_in_one_sentence(tmp_path, log, capsys, command):
    (tmp_path / "slider.xml").write_text(SLIDER.replace(OPTION, 'timestep="0.01" gravity="0 0 0"'))
    (tmp_path / "r.toml").write_text('model = "slider.xml"\nfree = ["body/cart.mass"]')
    write_log(replace(log, units={}), tmp_path / "log.csv")
    assert main([command, str(tmp_path / "r.toml"), str(tmp_path / "log.csv")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert f"{tmp_path / 'slider.xml'} errs by" in said
    assert '; write integrator="RK4" into its <option>, or write trust = ["steps"] into ' in said
    assert "m in position with integrator Euler" in said
