"""The linearised plant against differences of the simulated one."""

import mujoco
import numpy as np
import pytest

from identification import Log, ParameterSet
from identification.kalman.linear import linearise
from identification.model.plant import ModelPlant
from identification.model.predictor import Predictor
from identification.model.rollout import State, rollout

# A pendulum on a slider, driven through a first-order actuator; a wheel that nothing measures.
CRANE = """<mujoco>
  <option timestep="0.001" integrator="RK4"/>
  <worldbody>
    <body name="cart"><joint name="slide" type="slide" axis="1 0 0" damping="1"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <body name="bob"><joint name="swing" axis="0 1 0" damping="0.1"/>
        <inertial pos="0 0 -0.5" mass="0.5" diaginertia="0.01 0.01 0.01"/></body></body>
    <body name="wheel"><joint name="spin" axis="0 0 1" damping="0.1" stiffness="2"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
  </worldbody>
  <actuator>
    <general name="drive" joint="slide" dyntype="filter" dynprm="0.05" gainprm="3"/>
    <motor name="spinner" joint="spin"/>
  </actuator>
  <sensor><jointpos name="position" joint="slide"/><jointpos name="angle" joint="swing"/>
    <jointpos name="turn" joint="spin"/></sensor>
</mujoco>"""
H, N = 0.01, 6


def crane(outputs):
    model = mujoco.MjModel.from_xml_string(CRANE)
    start = State(np.array([0.1, 0.4, 0.0]), np.array([0.2, -0.5, 1.0]), np.array([0.3]))
    u = np.random.default_rng(0).uniform(-1, 1, (N, 2))
    log = Log(
        time=H * np.arange(N),
        inputs=u,
        outputs=np.zeros((N, len(outputs))),
        input_names=("drive", "spinner"),
        output_names=outputs,
    )
    return Predictor(ModelPlant(model, ParameterSet("crane", ()), start), log, ())


def moved(predictor, k, state, control):
    """State after one sample, from a state (qpos, qvel, act) with an input."""
    model = predictor.plant.model
    start = State(state[None, :3], state[None, 3:6], state[None, 6:])
    out = rollout(model, start, np.tile(control, (2, 1)), H, record=("qpos", "qvel", "act"))
    return np.concatenate([out[f][0, 1] for f in ("qpos", "qvel", "act")])


def states(predictor):
    start = predictor.settings(np.empty((1, 0)))[0]
    out = rollout(
        predictor.plant.model, start, predictor.log.inputs, H, record=("qpos", "qvel", "act")
    )
    return np.concatenate([out[f][0] for f in ("qpos", "qvel", "act")], axis=1)


@pytest.mark.parametrize("outputs", [("position", "angle", "turn"), ("position",)])
def test_transitions_are_differences_of_the_simulation(outputs):
    """To the change of the Jacobian over a sample, which the linearisation holds constant."""
    predictor = crane(outputs)
    linear = linearise(predictor, np.empty((1, 0)))
    along, u = states(predictor), predictor.log.inputs
    felt = [i for i in range(7) if len(outputs) == 3 or i not in (2, 5)]
    assert linear.A.shape == (N - 1, len(felt), len(felt))
    eps = 1e-5
    for k in range(N - 1):
        A = np.array(
            [moved(predictor, k, along[k] + s, u[k]) - moved(predictor, k, along[k] - s, u[k])
             for s in eps * np.eye(7)]
        ).T / (2 * eps)  # fmt: skip
        B = np.array(
            [moved(predictor, k, along[k], u[k] + s) - moved(predictor, k, along[k], u[k] - s)
             for s in eps * np.eye(2)]
        ).T / (2 * eps)  # fmt: skip
        np.testing.assert_allclose(linear.A[k], A[np.ix_(felt, felt)], atol=3e-3)
        np.testing.assert_allclose(linear.B[k], B[felt], atol=3e-4)


def test_what_no_output_feels_is_left_out():
    linear = linearise(crane(("turn",)), np.empty((1, 0)))
    assert linear.A.shape[1:] == (2, 2)
    assert not linear.B[..., 0].any()
    np.testing.assert_array_equal(linear.C, [[1, 0]])


def test_a_spring_oscillates_as_its_exponential_says():
    """ẍ = -2 x - 0.1 ẋ + u, which is linear: only rounding is left."""
    from scipy.linalg import expm

    linear = linearise(crane(("turn",)), np.empty((1, 0)))
    block = expm(np.array([[0, 1, 0], [-2, -0.1, 1], [0, 0, 0]]) * H)
    np.testing.assert_allclose(linear.A, np.broadcast_to(block[:2, :2], (N - 1, 2, 2)), atol=1e-5)
    np.testing.assert_allclose(
        linear.B[..., 1:], np.broadcast_to(block[:2, 2:], (N - 1, 2, 1)), atol=1e-5
    )
