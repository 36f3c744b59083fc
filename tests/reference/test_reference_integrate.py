"""The integrators: hold, order, conservation, and what they refuse."""

import numpy as np
import pytest
from reference_cases import taut

from identification.errors import DivergenceError, InputError
from inca_mj.reference import integrate, rest, rotation_matrix, simulate_reference
from inca_mj.reference import layout as at
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import SETS, parameter_set


def samples(seconds, rate=100):
    return np.arange(round(seconds * rate) + 1) / rate


def flat_out(t, amperes=1.0):
    return np.full((len(t), 8), amperes)


@pytest.mark.parametrize("name", SETS)
def test_at_rest_it_stays(name):
    t = samples(0.5)
    run = simulate_reference(parameter_set(name), INCA, t, flat_out(t, 0.0))
    assert np.abs(run.state - run.state[0]).max() < 1e-10
    assert np.abs(run.tension - run.tension[0]).max() < 1e-8


def test_a_current_holds_from_its_sample_to_the_next():
    t = samples(0.05)
    u = flat_out(t, 0.0)
    u[2] = 1.0
    run = simulate_reference(parameter_set(), INCA, t, u)
    assert np.abs(run.angles[:3]).max() < 1e-12
    assert np.abs(run.angles[3]).min() > 1e-4
    u[-1] = 100.0
    np.testing.assert_array_equal(run.state, simulate_reference(parameter_set(), INCA, t, u).state)


def test_sampling_changes_nothing_but_the_samples():
    coarse, fine = samples(0.2), samples(0.2, 1000)
    few = simulate_reference(parameter_set(), INCA, coarse, flat_out(coarse), start=taut(2))
    many = simulate_reference(parameter_set(), INCA, fine, flat_out(fine), start=taut(2))
    np.testing.assert_allclose(many.state[::10], few.state, atol=1e-11)


def test_it_agrees_with_its_own_tighter_tolerance(monkeypatch):
    t = samples(0.1)
    usual = simulate_reference(parameter_set(), INCA, t, flat_out(t), start=taut(3))
    monkeypatch.setattr(integrate, "RTOL", 1e-13)
    monkeypatch.setattr(integrate, "ATOL", 1e-14)
    tight = simulate_reference(parameter_set(), INCA, t, flat_out(t), start=taut(3))
    assert not np.array_equal(usual.angles, tight.angles)
    np.testing.assert_allclose(usual.angles, tight.angles, atol=1e-11)
    np.testing.assert_allclose(usual.tension, tight.tension, atol=1e-8)


def test_in_free_flight_momentum_is_conserved():
    t, p = samples(0.3), parameter_set()
    x = rest(p, INCA).state.copy()
    x[at.NO_LOAD] *= 2
    x[at.VELOCITY], x[at.RATES] = (0.2, -0.1, 1.0), (2.0, -1.0, 3.0)
    run = simulate_reference(p, INCA, t, flat_out(t, 0.0), start=x)
    np.testing.assert_array_equal(run.tension, 0)
    fall = np.outer(t, [0.2, -0.1, 1.0]) + np.outer(t**2 / 2, [0, 0, -9.81])
    np.testing.assert_allclose(run.position - run.position[0], fall, atol=1e-10)
    inertia = np.array([0.8e-4, 1.5e-4, 1.8e-4])
    L = np.array([rotation_matrix(x[at.EULER]) @ (inertia * x[at.RATES]) for x in run.state])
    np.testing.assert_allclose(L, np.broadcast_to(L[0], L.shape), atol=1e-10 * np.abs(L).max())


def test_a_start_beyond_all_numbers_diverges_and_says_when():
    t, x = samples(1.0), rest(parameter_set(), INCA).state.copy()
    x[at.SPEEDS] = 1e300
    with pytest.raises(DivergenceError, match=r"left the finite numbers at t = .* wrong unit"):
        simulate_reference(parameter_set(), INCA, t, flat_out(t), start=x)


def test_a_pitch_of_90_degrees_is_refused():
    t = samples(0.5)
    x = rest(parameter_set(), INCA).state.copy()
    x[at.NO_LOAD] *= 2
    x[at.RATES] = 0, 4, 0
    with pytest.raises(DivergenceError, match=r"pitch reached .*° at t = 0\.[34].* singular"):
        simulate_reference(parameter_set(), INCA, t, flat_out(t, 0.0), start=x)


T = samples(0.1)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"time": T[::-1]}, "time must be a row of increasing"),
        ({"start": np.zeros(35)}, "start must be 36 finite numbers"),
    ],
)
def test_bad_input_is_refused_with_a_cure(changes, message):
    asked = {"time": T, "currents": flat_out(T)} | changes
    with pytest.raises(InputError, match=message):
        simulate_reference(parameter_set(), INCA, **asked)
