"""A sensor that freezes is refused with its time; a joint that rests is not."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from joint_cases import SLIDER, STEP, arm, arm_log, run, slider, slider_log, steps

from identification import InputError, write_log
from identification.__main__ import main
from identification.effects.axes import axes

FROM = 300  # sample of 400
NOISE = 1e-4  # [m]


def moved(u, encoder=0.0):
    y = run(slider(), slider_log(u))
    if encoder:
        return encoder * np.round(y / encoder)
    return y + NOISE * np.random.default_rng(2).standard_normal(y.shape)


def frozen(y, first=FROM, column=0):
    y = y.copy()
    y[first:, column] = y[first, column]
    return y


def seen(u, y):
    return axes(slider().model, slider_log(u, y))


@pytest.mark.parametrize("encoder", [0.0, 1e-3])
def test_a_frozen_sensor_is_told_with_value_and_time(encoder):
    u = steps(400)
    y = frozen(moved(u, encoder))
    with pytest.raises(InputError, match=r"^position of log 'log' repeats .*: a frozen") as refusal:
        seen(u, y)
    first = int(np.flatnonzero(np.diff(y[:, 0]))[-1]) + 1
    assert f"repeats {y[-1, 0]:g} from {first * STEP:g} s to the end" in str(refusal.value)
    assert abs(first - FROM) <= 3
    seen(u[:first], y[:first])  # the cure that is told


def test_a_robot_that_rests_is_not_refused():
    u, still = steps(400), np.arange(400)[:, None] >= FROM - 100
    resting = frozen(moved(u, 1e-3))
    for inputs in (np.where(still, 0.0, u), np.where(still, 1.0, u), np.where(still, 0.4 * u, u)):
        seen(inputs, resting)


def test_what_is_short_or_fades_below_an_encoder_is_not_refused():
    u = steps(400)
    seen(u, frozen(moved(u), 400 - 79))  # of 400 samples 79 are less than a fifth
    few = 150
    seen(u[:few], frozen(moved(u), few - 49)[:few])
    t = STEP * np.arange(400)
    chirp = np.sin(40 * t**2)[:, None]
    fading = 0.01 * np.round(0.1 * np.exp(-t) * chirp[:, 0] / 0.01)[:, None]
    assert not np.ptp(fading[FROM:])
    seen(chirp, fading)


def test_another_sensor_of_the_joint_or_another_joint():
    u, t = steps(400), STEP * np.arange(400)
    model = SLIDER.replace("</sensor>", '<jointvel name="rate" joint="slide"/></sensor>')
    both = np.stack([np.sin(3 * t), 3 * np.cos(3 * t)], axis=1)
    log = replace(slider_log(0 * u + 1.0), outputs=both, output_names=("position", "rate"))
    compiled = mujoco.MjModel.from_xml_string(model)
    axes(compiled, log)
    with pytest.raises(InputError, match="rate of log"):
        axes(compiled, replace(log, outputs=frozen(both, column=1)))
    u = steps(400, 2, hold=5)
    both = np.stack([np.sin(3 * t), np.cos(2 * t)], axis=1)
    with pytest.raises(InputError, match="b of log"):
        axes(arm().model, replace(arm_log(u), outputs=frozen(both, column=1)))
    u[FROM:, 1] = 0.0  # one joint after the other: the second is no longer driven
    axes(arm().model, replace(arm_log(u), outputs=frozen(both, column=1)))


@pytest.mark.parametrize("command", ["fit", "discover"])
def test_the_commands_refuse_in_one_sentence(tmp_path, capsys, command):
    (tmp_path / "slider.xml").write_text(SLIDER)
    (tmp_path / "r.toml").write_text('model = "slider.xml"\nfree = ["body/cart.mass"]')
    u = steps(400)
    log = slider_log(u, frozen(moved(u)))
    write_log(replace(log, units={}), tmp_path / "stuck.csv")
    assert main([command, str(tmp_path / "r.toml"), str(tmp_path / "stuck.csv")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "position of log 'stuck' repeats" in said
    assert "from 3 s to the end" in said
