"""Energy: at every state, and over a trajectory, what goes in is what is stored and lost."""

import numpy as np
import pytest
from hypothesis import given, settings
from reference_cases import FORCE, FORCE_AT, currents, sets, states, taut, without_losses
from scipy.integrate import solve_ivp

from inca_mj.reference import derivative, energy, pack, power, rest
from inca_mj.reference import layout as at
from inca_mj.reference.equations import cables
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set


@settings(deadline=None)
@given(states, currents, sets)
def test_energy_changes_at_the_power_at_any_state(x, i, name):
    check_power(parameter_set(name), x, i)


def check_power(p, x, i):
    q = pack(p, INCA, force=FORCE, force_at=FORCE_AT)
    rate = derivative(x, i, q)
    # Rounding of E limits short steps and curvature long ones; E is smooth through slackness.
    h = 1e-5 / np.abs(rate[at.SPEEDS]).max()
    change = sum(energy(x + h * rate, q)) - sum(energy(x - h * rate, q))
    flow = np.abs(power(x, i, q)).sum()
    assert change / (2 * h) == pytest.approx(sum(power(x, i, q)), abs=1e-5 * flow)


def balance(p, x, i, seconds):
    """Stored energy and the integral of the powers over an adaptive trajectory."""
    q = pack(p, INCA, force=FORCE, force_at=FORCE_AT)

    def augmented(_, y):
        terms = power(y[:36], i, q)
        return np.concatenate([derivative(y[:36], i, q), terms, [np.abs(terms).sum()]])

    y = np.concatenate([x, np.zeros(6)])
    end = solve_ivp(augmented, (0, seconds), y, method="DOP853", rtol=1e-12, atol=1e-13)
    stored = sum(energy(end.y[:36, -1], q)) - sum(energy(x, q))
    tension = np.array([cables(state, q)[0] for state in end.y[:36].T])
    return stored, end.y[36:41, -1], end.y[41, -1], tension


CURRENT = np.array([1.0, 0.5, 1.0, 0.5, 0.5, 1.0, 1.0, 0.5])


@pytest.mark.parametrize("losses", [False, True])
def test_the_balance_closes_over_a_taut_trajectory(losses):
    p = parameter_set() if losses else without_losses()
    stored, terms, exchanged, tension = balance(p, taut(4), CURRENT, 0.2)
    assert tension.min() > 0
    motor, viscous, coulomb, damper, wound = terms
    assert stored == pytest.approx(terms.sum(), abs=1e-9 * exchanged)
    assert motor > 0
    # The wound term is small and yet seen: without it the balance is off by far more.
    assert abs(wound) > 1e-6 * exchanged
    if losses:
        assert max(viscous, coulomb, damper) < 0
    else:
        assert [viscous, coulomb, damper] == [0, 0, 0]


def test_the_balance_closes_while_cables_turn_slack_and_taut():
    x = rest(parameter_set(), INCA).state.copy()
    x[at.VELOCITY] = 0.5, 0.3, 0.4
    stored, terms, exchanged, tension = balance(parameter_set(), x, CURRENT, 0.1)
    assert (tension == 0).any(axis=0).sum() >= 2
    assert stored == pytest.approx(terms.sum(), abs=1e-9 * exchanged)


def test_a_spring_without_stiffness_pulls_with_a_constant_force():
    p = parameter_set("trial", {"k_s": 0.0})
    q, x = pack(p, INCA), rest(p, INCA).state.copy()
    x[at.ANGLES] = 2.0
    assert energy(x, q).spring == pytest.approx(-2.0 * 0.0175 * rest(p, INCA).tension.sum())
