"""The linearised plant against differences of the simulated one."""

import re
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from plain_logs import plain_log

from identification import Log, Parameter, ParameterSet
from identification.kalman.linear import extend, linearise
from identification.kalman.point import evaluate_point, extend_point
from identification.kalman.trajectory import COARSE_POINTS, Run, follow
from identification.logs.joined import join_logs
from identification.model.coordinates import coordinates
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
    log = plain_log(u, np.zeros((N, len(outputs))), "drive spinner", outputs, H)
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


STEP, SAMPLES = 0.01, 40
DAMPING = Parameter(
    name="damping", value=1.0, unit="N s/m", where="joint/slide.damping", lower=0.0, upper=9.0
)


def log(seed, hold):
    rng = np.random.default_rng(seed)
    return Log(
        time=3.0 + STEP * np.arange(SAMPLES),
        inputs=np.cumsum(rng.uniform(-1, 1, (SAMPLES, 2)), axis=0),
        outputs=rng.standard_normal((SAMPLES, 2)),
        input_names=("drive", "spinner"),
        output_names=("position", "angle"),
        hold=hold,
        splits={"estimation": (3.0, 3.0 + STEP * (12 + seed)), "validation": (3.2, 3.4)},
    )


def plant():
    start = State(np.array([0.1, 0.4, 0.0]), np.array([0.2, -0.5, 1.0]), np.array([0.3]))
    model = mujoco.MjModel.from_xml_string(CRANE)
    return ModelPlant(model, ParameterSet("crane", (DAMPING,)), start)


def predictor(whole):
    return Predictor(plant(), whole, ("damping",))


def at(whole, value=1.3):
    space = coordinates(plant().parameters, ("damping",), np.array([value]))
    return evaluate_point(predictor(whole), space, space.encode(np.array([value])))


def assert_same(found, whole, value=1.3):
    fresh = predictor(whole)
    expected = linearise(fresh, np.array([value]))
    np.testing.assert_array_equal(found.e, whole.outputs - fresh.predict(np.array([value]))[0])
    for name in "ABC":
        one, other = getattr(found.linear, name), getattr(expected, name)
        np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(found.linear.felt, expected.felt)


@pytest.mark.parametrize("hold", ["zoh", "foh"])
@pytest.mark.parametrize("records", [1, 3])
def test_it_is_that_of_the_whole_log(hold, records):
    whole = join_logs([log(k, hold) for k in range(records)])
    assert_same(extend_point(at(whole.part("estimation")), whole), whole)


def test_the_rest_of_a_free_swing_is_disturbed_by_forces_as_its_beginning_is(monkeypatch):
    free = mujoco.MjModel.from_xml_string(re.sub(r"<actuator>.*</actuator>", "", CRANE, flags=re.S))
    start = State(np.array([0.1, 0.4, 0.0]), np.array([0.2, -0.5, 1.0]), np.empty(0))
    swinging = ModelPlant(free, ParameterSet("crane", (DAMPING,)), start)
    monkeypatch.setitem(globals(), "plant", lambda: swinging)
    whole = replace(log(0, "zoh"), inputs=np.zeros((SAMPLES, 0)), input_names=())
    found = extend_point(at(whole.part("estimation")), whole)
    assert found.linear.B.shape[2] == free.nv
    assert_same(found, whole)


def test_where_more_states_are_felt_later_all_is_linearised():
    """As if the actuator had moved nothing in the first part."""
    whole = log(0, "zoh")
    own = predictor(whole)
    values = np.array([1.3])
    expected = linearise(own, values)
    kept = expected.felt.copy()
    kept[-1] = False  # the activation
    small = kept[expected.felt]
    known = replace(
        expected, A=expected.A[:9][:, small][:, :, small], B=expected.B[:9, small],
        C=expected.C[:, small], felt=kept,
    )  # fmt: skip
    found = extend(known, own, follow(own, values, COARSE_POINTS))
    np.testing.assert_array_equal(found.felt, expected.felt)
    np.testing.assert_allclose(found.A, expected.A, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("hold", ["zoh", "foh"])
def test_its_outputs_are_those_that_are_predicted(hold):
    joined = join_logs([log(1, hold), log(2, hold)])
    predictor, values = Predictor(plant(), joined, ("damping",)), np.array([1.7])
    run = Run(predictor, values)
    np.testing.assert_array_equal(run.outputs, predictor.predict(values)[0])
    for along, own in zip(run.along, (joined.outputs[:40], joined.outputs[40:]), strict=True):
        assert len(along.states["qpos"]) == len(own)
