"""The bridge to `mujoco.sysid`: the same values predict the same outputs on both sides."""

from dataclasses import replace

import numpy as np
import pytest

from identification import InputError
from identification.bridge_sysid import from_sysid, sysid_residual, to_sysid_parameters
from identification.model.predictor import Predictor
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

NAMES = ("lambda", "J", "b_c", "m", "x", "roll")
VALUES = np.array([23000.0, 9e-5, 0.004, 0.18, 0.01, 0.02])


def missing():
    """Why `mujoco.sysid` cannot be used here, or nothing."""
    try:
        from identification.bridge_sysid import _sysid

        _sysid()
    except InputError as error:
        return str(error)
    return ""


needs_sysid = pytest.mark.skipif(bool(missing()), reason=missing() or "mujoco.sysid is there")


@pytest.fixture(scope="module")
def robot():
    return build_twin()


@pytest.fixture(scope="module")
def log(robot):
    return run_to_log(simulate(robot, make_input("prbs", 0.6)))


@needs_sysid
@pytest.mark.parametrize("hold", ["zoh", "foh"])
def test_both_predict_the_same_trajectory(robot, log, hold):
    log = replace(log, hold=hold)
    ours = Predictor(robot, log, NAMES).predict(VALUES)[0]
    parameters = to_sysid_parameters(robot, NAMES)
    residual = sysid_residual(robot, log, NAMES)
    _, (predicted,), (measured,) = residual(VALUES, parameters)
    rows = np.searchsorted(log.time, predicted[0].times - 1e-6)
    assert len(rows) >= len(log) - 2
    np.testing.assert_allclose(predicted[0].data, ours[rows], rtol=0, atol=1e-9)
    np.testing.assert_array_equal(measured[0].data, log.outputs[rows])


@needs_sysid
def test_values_bounds_and_starts_round_trip(robot):
    parameters = to_sysid_parameters(robot, NAMES, {"J": 7e-5})
    own = robot.parameters.values()
    assert from_sysid(parameters) == {**{n: own[n] for n in NAMES}, "J": 7e-5}
    lower, upper = parameters.get_bounds()
    records = [robot.parameters[name] for name in NAMES]
    assert lower.tolist() == [r.lower for r in records]
    assert upper.tolist() == [r.upper for r in records]
    parameters.update_from_vector(VALUES)
    assert from_sysid(parameters) == dict(zip(NAMES, VALUES.tolist(), strict=True))


@needs_sysid
def test_its_optimiser_finds_our_values(robot, log):
    from mujoco import sysid

    true = robot.parameters.values()
    start = {"b_c": 1.2 * true["b_c"], "J": 1.2 * true["J"]}
    result = sysid.optimize(
        to_sysid_parameters(robot, tuple(start), start),
        sysid_residual(robot, log, tuple(start)),
        verbose=False,
        max_iters=20,
    )
    found = from_sysid(result)
    for name in start:
        assert found[name] == pytest.approx(true[name], rel=1e-4)
