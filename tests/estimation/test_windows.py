"""Windows recover what a free run recovers, and what a free run loses."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from estimation_plants import SLIDER, measured, record, slider, steps
from plain_logs import plain_log

from identification import InputError, ParameterSet
from identification.estimation.estimation import estimate
from identification.model.plant import ModelPlant
from identification.windows.window_error import joined
from identification.windows.window_estimate import estimate_windows
from identification.windows.windows import apart, moved, windows
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.thesis.trials import TRIALS
from inca_mj.twin.logs import POSE, run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

SMALL = TRIALS[2].start  # 5 % off

NAMES = ("mass", "damping")
START = {"mass": 2.4, "damping": 2.3}
TRUTH = np.array([2.0, 3.0])


def test_windows_cut_a_log_without_overlap():
    log = record(slider(), ("position",), n=107)
    cut = windows(log, 0.2)
    assert cut.outputs.shape == (10, 10, 1)
    np.testing.assert_array_equal(cut.outputs.ravel(), log.outputs[:100].ravel())
    with pytest.raises(InputError, match="do not fit"):
        windows(log, 0.02)
    with pytest.raises(InputError, match="do not fit"):
        windows(log, 9.0)


def test_windows_that_feel_inputs_beyond_the_ends_are_left_out_unless_they_are_many():
    log = record(slider(), ("position",), n=300)  # 50 Hz
    every, few = windows(log, 0.2).starts, windows(log, 2.0).starts
    np.testing.assert_array_equal(windows(log, 0.2, 0.0).starts, every)
    np.testing.assert_array_equal(windows(log, 0.2, 0.08).starts, every[1:-1])
    np.testing.assert_array_equal(windows(log, 0.2, 0.21).starts, every[2:-2])
    np.testing.assert_array_equal(windows(log, 2.0, 0.08).starts, few)  # it would be two of three


@pytest.mark.parametrize("outputs", [("position",), ("position", "rate")])
def test_clean_data_gives_the_truth_either_way(outputs):
    log = record(slider(x0=0.3, v0=-0.2), outputs, n=150)
    free = estimate(slider(), log, (*NAMES, "x0", "v0"), START)
    short = estimate_windows(slider(), log, NAMES, 0.5, START)
    np.testing.assert_allclose([free.values[n] for n in NAMES], TRUTH, rtol=1e-6)
    np.testing.assert_allclose(list(short.values.values()), TRUTH, rtol=1e-6)
    np.testing.assert_allclose(short.states.qpos[0], 0.3, atol=1e-6)
    np.testing.assert_allclose(short.states.qvel[0], -0.2, atol=1e-6)


def disturbed(plant, n, push, seed):
    """Positions of a plant that is pushed by white noise the log does not hold."""
    u = steps(n)
    unseen = u + push * np.random.default_rng(seed).standard_normal(u.shape)
    log = record(plant, ("position",), inputs=unseen)
    noisy = log.outputs + 1e-4 * np.random.default_rng(seed + 1).standard_normal(log.outputs.shape)
    return measured(replace(log, inputs=u), noisy)


def test_windows_beat_a_free_run_where_unseen_pushes_add_up_in_an_integrator():
    """A cart without a spring remembers each push for ever; a window forgets it."""
    records = tuple(p for p in slider().parameters if p.name in NAMES)
    xml = SLIDER.replace('stiffness="20"', 'stiffness="-0.5"')
    plant = ModelPlant(mujoco.MjModel.from_xml_string(xml), ParameterSet("cart", records))
    errors = {"free": [], "windows": []}
    for seed in range(2):
        log = disturbed(plant, 200, 0.5, seed)
        free = estimate(plant, log, NAMES, START).values
        short = estimate_windows(plant, log, NAMES, 0.5, START).values
        errors["free"].append([free[n] for n in NAMES] / TRUTH - 1)
        errors["windows"].append([short[n] for n in NAMES] / TRUTH - 1)
    free, short = (np.sqrt(np.mean(np.square(e))) for e in errors.values())
    assert short < 0.5 * free, (short, free)


NOISE = 2e-4  # [rad]
STEP = 2e-3  # [s] of the log and of the model
OFF = {"x": 0.002, "y": -0.002, "z": 1.433}  # where the platform begins, and no angle says so


@pytest.fixture(scope="module")
def measured_inca():
    robot = build_twin(parameter_set("trial", OFF), timestep=STEP)
    log = run_to_log(simulate(robot, make_input("prbs", 0.4, seed=0)), "a short log")
    noise = NOISE * np.random.default_rng(3).standard_normal(log.outputs.shape)
    return replace(log, outputs=log.outputs + noise, extras={}, units={})


@pytest.mark.long  # test_identify_command has windows that find the truth of two parameters
def test_windows_find_the_truth_of_the_cable_robot(measured_inca):
    robot = build_twin(parameter_set("trial"), timestep=STEP)
    found = estimate_windows(robot, measured_inca, (*SMALL, *POSE), 0.2, SMALL)
    true = parameter_set("trial", OFF).values()
    error = np.array([found.values[n] - true[n] for n in SMALL])
    assert (np.abs(error) < 4.5 * found.std[: len(SMALL)]).all(), error / found.std[: len(SMALL)]
    relative = error / [true[n] for n in SMALL]
    assert np.abs(relative).max() < 0.05, relative
    assert found.rms < 1.1 * NOISE
    for name in OFF:  # felt through the springs alone
        assert found.values[name] == pytest.approx(true[name], abs=1e-3)


def test_steps_between_states_undo_each_other(measured_inca):
    model = build_twin().model
    rng = np.random.default_rng(0)
    state = build_twin().state()
    start = type(state)(*(np.tile(getattr(state, f), (3, 1)) for f in ("qpos", "qvel", "act")))
    step = 0.3 * rng.standard_normal((3, 2 * model.nv + model.na))
    np.testing.assert_allclose(apart(model, start, moved(model, start, step)), step, atol=1e-12)


def record_joined(n, seed, step=0.01, hold="foh"):
    rng = np.random.default_rng(seed)
    time = step * np.arange(n)
    u, y = rng.standard_normal((n, 2)), rng.standard_normal((n, 1))
    return plain_log(u, y, "a b", "x", time=time, hold=hold, name=f"record {seed}")


def test_windows_of_joined_records_are_those_of_each():
    logs = [record_joined(n, n) for n in (300, 251, 57)]
    both, each = windows(joined(logs, 0.2), 0.2), [windows(log, 0.2) for log in logs]
    np.testing.assert_array_equal(both.outputs, np.concatenate([cut.outputs for cut in each]))
    np.testing.assert_array_equal(both.inputs, np.concatenate([cut.inputs for cut in each]))


@pytest.mark.parametrize(
    ("second", "said"),
    [
        (record_joined(100, 2, step=0.02), "sampling time"),
        (record_joined(100, 2, hold="zoh"), "hold"),
        (replace(record_joined(100, 2), output_names=("z",)), "columns"),
        (record_joined(15, 2), "windows of 0.2 s do not fit"),
    ],
)
def test_records_that_do_not_belong_together_are_refused(second, said):
    with pytest.raises(InputError, match=said):
        joined([record_joined(100, 1), second], 0.2)
