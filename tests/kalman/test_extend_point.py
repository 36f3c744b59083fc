"""A point on a longer log is the one that is simulated and linearised there from nothing."""

import re
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from test_discovery_linear import CRANE

from identification import Log, Parameter, ParameterSet
from identification.kalman.linear import extend, linearise
from identification.kalman.point import evaluate_point, extend_point
from identification.kalman.trajectory import COARSE_POINTS, follow
from identification.logs.joined import join_logs
from identification.model.coordinates import coordinates
from identification.model.plant import ModelPlant
from identification.model.predictor import Predictor
from identification.model.rollout import State

H, N = 0.01, 40
DAMPING = Parameter(
    name="damping", value=1.0, unit="N s/m", where="joint/slide.damping", lower=0.0, upper=9.0
)


def log(seed, hold):
    rng = np.random.default_rng(seed)
    return Log(
        time=3.0 + H * np.arange(N),
        inputs=np.cumsum(rng.uniform(-1, 1, (N, 2)), axis=0),
        outputs=rng.standard_normal((N, 2)),
        input_names=("drive", "spinner"),
        output_names=("position", "angle"),
        hold=hold,
        splits={"estimation": (3.0, 3.0 + H * (12 + seed)), "validation": (3.2, 3.4)},
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


def test_only_the_rest_is_linearised_and_nothing_is_simulated_twice(monkeypatch):
    whole = log(0, "zoh")
    point = at(whole.part("estimation"))
    seen = []
    derivatives = "identification.kalman.linear.state_derivatives"
    from identification.kalman.linear import state_derivatives

    def counted(along):
        seen.append(len(along.time))
        return state_derivatives(along)

    monkeypatch.setattr(derivatives, counted)
    monkeypatch.setattr(Predictor, "predict", None)
    found = extend_point(point, whole)
    assert seen == [COARSE_POINTS * (N - len(point.log))]
    np.testing.assert_array_equal(found.e[: len(point.log)], point.e)
    np.testing.assert_array_equal(found.linear.A[: len(point.linear.A)], point.linear.A)


def test_a_part_that_is_not_the_beginning_is_linearised_anew():
    whole = log(0, "zoh")
    assert_same(extend_point(at(whole.part("validation")), whole), whole)


def test_the_rest_of_a_free_swing_is_disturbed_by_forces_as_its_beginning_is(monkeypatch):
    free = mujoco.MjModel.from_xml_string(re.sub(r"<actuator>.*</actuator>", "", CRANE, flags=re.S))
    start = State(np.array([0.1, 0.4, 0.0]), np.array([0.2, -0.5, 1.0]), np.empty(0))
    swinging = ModelPlant(free, ParameterSet("crane", (DAMPING,)), start)
    monkeypatch.setitem(globals(), "plant", lambda: swinging)
    whole = replace(log(0, "zoh"), inputs=np.zeros((N, 0)), input_names=())
    found = extend_point(at(whole.part("estimation")), whole)
    assert found.linear.B.shape[2] == free.nv
    assert_same(found, whole)


def test_a_whole_log_stays_as_it_is():
    whole = log(0, "zoh")
    point = at(whole)
    found = extend_point(point, whole)
    np.testing.assert_array_equal(found.linear.A, point.linear.A)
    np.testing.assert_array_equal(found.e, point.e)


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
