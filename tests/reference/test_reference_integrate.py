"""The integrators: hold, order, conservation, and what they refuse."""

import numpy as np
import pytest
from reference_cases import taut

from identification.errors import DivergenceError
from inca_mj.reference import kinematics, rest, simulate_reference
from inca_mj.reference import layout as at
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import SETS, parameter_set


def samples(seconds, rate=100):
    return np.arange(round(seconds * rate) + 1) / rate


def flat_out(t, amperes=1.0):
    return np.full((len(t), 8), amperes)


@pytest.mark.parametrize("method", ["adaptive", "rk4"])
@pytest.mark.parametrize("name", SETS)
def test_at_rest_it_stays(method, name):
    t = samples(0.5)
    run = simulate_reference(parameter_set(name), INCA, t, flat_out(t, 0.0), method=method)
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


def test_the_adaptive_method_agrees_with_its_own_tighter_tolerance():
    t = samples(0.1)
    loose, tight = (
        simulate_reference(
            parameter_set(), INCA, t, flat_out(t), start=taut(3), rtol=r, atol=r / 10
        )
        for r in (1e-11, 1e-13)
    )
    np.testing.assert_allclose(loose.angles, tight.angles, atol=1e-11)
    np.testing.assert_allclose(loose.tension, tight.tension, atol=1e-8)


def test_rk4_is_of_order_4():
    t = samples(0.2)
    exact = simulate_reference(parameter_set(), INCA, t, flat_out(t))
    assert exact.tension.min() > 1
    errors = [
        np.abs(
            simulate_reference(parameter_set(), INCA, t, flat_out(t), method="rk4", step=h).angles
            - exact.angles
        ).max()
        for h in (5e-4, 2.5e-4, 1.25e-4)
    ]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders, 4, atol=0.2)


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
    L = np.array(
        [kinematics.rotation(e) @ (inertia * ω) for e, ω in zip(run.euler, run.rates, strict=True)]
    )
    np.testing.assert_allclose(L, np.broadcast_to(L[0], L.shape), atol=1e-10 * np.abs(L).max())


def test_a_slack_cable_is_no_trouble():
    t = samples(0.3)
    u = np.zeros((len(t), 8))
    u[:, 4] = -3.0  # pays out faster than the platform follows
    run = simulate_reference(parameter_set(), INCA, t, u)
    assert run.tension.min() == 0
    assert np.isfinite(run.state).all()


def test_a_step_that_is_too_long_diverges_and_says_when():
    t = samples(1.0)
    with pytest.raises(DivergenceError, match=r"at t = .* smaller step"):
        simulate_reference(parameter_set(), INCA, t, flat_out(t), method="rk4", step=0.01)


def test_a_pitch_of_90_degrees_is_refused():
    t = samples(0.5)
    x = rest(parameter_set(), INCA).state.copy()
    x[at.NO_LOAD] *= 2
    x[at.RATES] = 0, 4, 0
    with pytest.raises(DivergenceError, match=r"pitch reached .*° at t = 0\.[34].* singular"):
        simulate_reference(parameter_set(), INCA, t, flat_out(t, 0.0), start=x, method="adaptive")
