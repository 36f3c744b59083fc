"""Windows of the cable robot: 36 states each, of which the angles measure 8."""

from dataclasses import replace

import numpy as np
import pytest

from identification import InputError
from identification.windows.window_estimate import estimate_windows
from identification.windows.windows import apart, moved
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.thesis.trials import SMALL
from inca_mj.twin.logs import POSE, run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.disturbed import identify_windows

NOISE = 2e-4  # [rad]
STEP = 2e-3  # [s] of the log and of the model
OFF = {"x": 0.002, "y": -0.002, "z": 1.433}  # where the platform begins, and no angle says so


@pytest.fixture(scope="module")
def measured():
    robot = build_twin(parameter_set("trial", OFF), timestep=STEP)
    log = run_to_log(simulate(robot, make_input("prbs", 0.4, seed=0)), "a short log")
    noise = NOISE * np.random.default_rng(3).standard_normal(log.outputs.shape)
    return replace(log, outputs=log.outputs + noise, extras={}, units={})


@pytest.mark.long  # test_identify_command has windows that find the truth of two parameters
def test_windows_find_the_truth_of_the_cable_robot(measured):
    robot = build_twin(parameter_set("trial"), timestep=STEP)
    found = estimate_windows(robot, measured, (*SMALL, *POSE), 0.2, SMALL)
    true = parameter_set("trial", OFF).values()
    error = np.array([found.values[n] - true[n] for n in SMALL])
    assert (np.abs(error) < 4.5 * found.std[: len(SMALL)]).all(), error / found.std[: len(SMALL)]
    relative = error / [true[n] for n in SMALL]
    assert np.abs(relative).max() < 0.05, relative
    assert found.rms < 1.1 * NOISE
    for name in OFF:  # felt through the springs alone
        assert found.values[name] == pytest.approx(true[name], abs=1e-3)


def test_steps_between_states_undo_each_other(measured):
    model = build_twin().model
    rng = np.random.default_rng(0)
    state = build_twin().state()
    start = type(state)(*(np.tile(getattr(state, f), (3, 1)) for f in ("qpos", "qvel", "act")))
    step = 0.3 * rng.standard_normal((3, 2 * model.nv + model.na))
    np.testing.assert_allclose(apart(model, start, moved(model, start, step)), step, atol=1e-12)


def test_windows_need_a_parameter_of_the_robot(measured):
    with pytest.raises(InputError, match="windows cannot find x, z alone"):
        identify_windows(measured, 0.2, parameter_set(), free=("x", "z"))
