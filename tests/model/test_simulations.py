"""Simulations that are prepared once and run many times are those of a call for each run."""

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification.errors import DivergenceError
from identification.model.paths import resolve
from identification.model.rollout import State, hold, rollout, simulations

STEPS, N = 40, 5
XML = """<mujoco><option timestep="0.002" integrator="RK4"/>
  <worldbody><body name="a"><joint name="j" axis="0 1 0" limited="true" range="-20 20"
    frictionloss="0.05"/><geom size="0.1" mass="1" pos="0 0 -0.3"/></body></worldbody>
  <actuator><motor joint="j"/></actuator></mujoco>"""
MODEL = mujoco.MjModel.from_xml_string(XML)
MASS = resolve(MODEL, "body/a.mass")


def case(seed):
    """Numbers, starts, inputs and times of N simulations."""
    rng = np.random.default_rng(seed)
    start = State(rng.uniform(-1, 1, (N, 1)), rng.uniform(-3, 3, (N, 1)), np.zeros((N, 0)))
    numbers = [(MASS, rng.uniform(0.5, 2.0, N))]
    return numbers, start, rng.uniform(-1, 1, (N, STEPS + 1, 1)), rng.uniform(0, 9, N)


@given(st.integers(0, 100), st.lists(st.booleans(), min_size=N, max_size=N).filter(any))
def test_some_of_them_run_again_as_if_each_call_had_prepared_them(seed, chosen):
    numbers, start, inputs, times = case(seed)
    at = np.flatnonzero(chosen)
    some = State(start.qpos[at], start.qvel[at], start.act[at])
    h = 4 * MODEL.opt.timestep
    right = rollout(
        MODEL, some, inputs[at], h, numbers=[(s, x[at]) for s, x in numbers],
        record=("qpos", "qvel"), time=times[at],
    )  # fmt: skip
    prepared = simulations(MODEL, N, numbers)
    controls = hold(inputs, 4)
    for which in (None, at, at):  # the constraints' warm start of a run is not that of the next
        k = np.arange(N) if which is None else which
        begun = State(start.qpos[k], start.qvel[k], start.act[k])
        run = prepared.run(begun, controls[k], 4, ("qpos", "qvel"), times[k], which)
    for field, states in right.items():
        np.testing.assert_array_equal(run[field], states)


def test_one_that_diverged_runs_again():
    numbers, start, inputs, _ = case(0)
    prepared, controls = simulations(MODEL, N, numbers), hold(inputs, 1)
    right = prepared.run(start, controls, 1, ("qpos",))["qpos"]
    lost = State(start.qpos, np.where(np.arange(N)[:, None] == 2, np.nan, start.qvel), start.act)
    with pytest.raises(DivergenceError, match="value set 3 of 5"):
        prepared.run(lost, controls, 1, ("qpos",))
    kept = prepared.run(lost, controls, 1, ("qpos",), keeps_diverged=True)["qpos"]
    assert np.isnan(kept[2, 1:]).all()
    np.testing.assert_array_equal(np.delete(kept, 2, 0), np.delete(right, 2, 0))
    np.testing.assert_array_equal(prepared.run(start, controls, 1, ("qpos",))["qpos"], right)
