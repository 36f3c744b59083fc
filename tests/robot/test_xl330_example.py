"""The servo of the example: its reader and its model against what is known, then its records.

The records are read from the folder XL330_DATA, else from ../shared/data/xl330/raw.
"""

import json
import os
import sys
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from identification import Log, Predictor, estimate_windows, read_model, read_robot, window_error

EXAMPLES = Path(__file__).parents[2] / "examples"
RAW = Path(os.environ.get("XL330_DATA", EXAMPLES.parents[1] / "shared" / "data" / "xl330" / "raw"))
MODEL = EXAMPLES.parent / "models" / "xl330.xml"
NAMES = ("g", "D", "J_a", "coulomb_friction.f_c@hinge", "offset.f_0@hinge")
HORIZON = 0.2  # [s]
sys.path.insert(0, str(EXAMPLES))
import xl330  # noqa: E402

sys.path.remove(str(EXAMPLES))


def made_up(n=300, seed=2):
    """A log of a voltage that reverses often, and positions that mean nothing yet."""
    levels = np.random.default_rng(seed).uniform(-5, 5, n // 10 + 1)
    u = np.repeat(levels, 10)[:n, None]
    time = xl330.STEP * np.arange(n)
    return Log(
        time=time,
        inputs=u,
        outputs=np.sin(3 * time)[:, None],
        input_names=("motor",),
        output_names=("angle",),
        hold="foh",
    )


def test_a_record_is_read_on_an_even_grid_with_signs_and_without_what_the_motor_left_alone(
    tmp_path,
):
    time = 100 + np.cumsum(np.random.default_rng(1).uniform(0.003, 0.007, 200))
    entries = [
        {"timestamp": t, "position": 0.5 * (t - time[0]), "load": 2**16 - 442.5,
         "input_volts": 7.0, "torque_enable": True}
        for t in time
    ]  # fmt: skip
    fall = [{**entries[-1], "timestamp": time[-1] + 0.2, "load": 0, "torque_enable": False}]
    record = {"kp": 100, "trajectory": "ramp", "entries": entries + fall}
    (tmp_path / "a.json").write_text(json.dumps(record))
    log = xl330.read_xl330(tmp_path / "a.json")
    np.testing.assert_allclose(log.inputs, -3.5, rtol=1e-12)
    np.testing.assert_allclose(log.outputs[:, 0], 0.5 * log.time, atol=1e-9)
    assert log.sampling_time == xl330.STEP
    assert time[-1] - time[0] - xl330.STEP < log.duration <= time[-1] - time[0]
    assert [one.name for one in xl330.read_all(tmp_path, (100,))] == ["ramp, k_p 100"]
    assert xl330.read_all(tmp_path, (200,)) == []


def test_left_alone_it_swings_with_the_period_of_its_mass_and_armature():
    model = read_model(MODEL).compile()
    model.dof_damping[0] = 0
    data = mujoco.MjData(model)
    data.qpos[0] = 0.01
    angles = []
    while data.time < 3:
        mujoco.mj_step(model, data)
        angles.append(data.qpos[0])
    a = np.array(angles)
    k = np.flatnonzero(a[1:] * a[:-1] < 0)
    crossings = (k + a[k] / (a[k] - a[k + 1])) * model.opt.timestep
    inertia = 0.49 * 0.1**2 + 1e-7 + model.dof_armature[0]
    period = 2 * np.pi * np.sqrt(inertia / (0.49 * 9.80665 * 0.1))
    assert 2 * np.mean(np.diff(crossings)) == pytest.approx(period, rel=1e-4)


def test_known_values_are_recovered_from_the_noisy_angle_of_the_model():
    empty = made_up()
    plant = read_robot(xl330.ROBOT, empty, trust=["steps", "units", "wiring"]).plant
    truth = dict(zip(NAMES, (0.12, 0.03, 0.003, 0.03, 0.005), strict=True))
    y = Predictor(plant, empty, (), truth).predict(np.empty((1, 0)))[0]
    noise = 5e-4 * np.random.default_rng(4).standard_normal(y.shape)
    log = replace(empty, outputs=y + noise)
    fit = estimate_windows(plant, log, NAMES, HORIZON, tolerance=1e-4)
    for (name, value), std in zip(fit.values.items(), fit.std, strict=True):
        assert abs(value - truth[name]) < 4 * std, name
        assert std < 0.05 * truth[name] + 5e-4, name
    assert fit.rms == pytest.approx(5e-4, rel=0.1)


@pytest.mark.long
@pytest.mark.skipif(
    not RAW.exists(), reason="XL330_DATA names no folder of records; see github.com/Rhoban/bam"
)
def test_friction_under_the_transmitted_load_predicts_another_gain_better():
    (log,) = (x for x in xl330.read_all(RAW, (400,)) if x.name.startswith("sin_time_square"))
    (other,) = (x for x in xl330.read_all(RAW, (200,)) if x.name.startswith("sin_time_square"))
    plant, mu = read_robot(xl330.ROBOT, log).plant, "transmitted_load_friction.mu@hinge"
    fit = estimate_windows(plant, log, NAMES, HORIZON, tolerance=1e-2)
    start = {**fit.values, mu: 0.1}
    more = estimate_windows(plant, log, (*NAMES, mu), HORIZON, start, tolerance=1e-2)
    begun, found, better = (
        np.mean(window_error(plant, other, HORIZON, e) ** 2)
        for e in ({}, fit.values, more.values)
    )  # fmt: skip
    assert found < 0.5 * begun
    assert better < 0.7 * found
