"""Lag and delay of an input against an integration by brute force; clipping and drift."""

import numpy as np
import pytest
from effect_cases import BY_NAME, CATALOGUE, full, simulate

from identification.effects.laws.inputs import Drive, input_effects
from identification.effects.values import changed_inputs

STEP, FINE = 1e-3, 400
TAUS = [0.0, 1e-7, 3.3e-4, 1e-3, 1.7e-3, 4e-3, 2.5e-2, 10.0]
ANY_ROBOT = {e.name: e for e in input_effects([Drive("u", 1.0)])}


def currents():
    return np.repeat(np.random.default_rng(0).normal(0.7, 0.2, (12, 8)), 5, axis=0)


def stepwise(mean, moment):
    """What a model is given that has mean and moment of a signal, each moment a step later."""
    return mean - moment + np.concatenate([[0.0], moment[:-1]])


def by_brute_force(fine):
    """Steps that have the impulse and the moment of a finely sampled signal (steps, FINE)."""
    middle = (np.arange(FINE) + 0.5) / FINE - 0.5
    return stepwise(fine.mean(axis=1), (fine * middle).mean(axis=1))


def filtered(effect, u, values, things=("1",)):
    """An input after one effect, shape (steps, nu)."""
    every = {name: 0.0 for thing in things for parts in effect.parameters_at(thing)
             for name in parts} | values  # fmt: skip
    return changed_inputs([effect], things, every, u, STEP, 1).reshape(u.shape)


def at_taus(effect, u, before):
    """Currents of eight drives, each with a time of its own."""
    drives = [str(k) for k in range(1, 9)]
    values = {f"{effect.name}.tau@{k}": tau for k, tau in zip(drives, TAUS, strict=True)}
    return filtered(effect, u, {**values, f"{effect.name}.before": before}, drives)


def test_impulse_and_moment_of_the_whole_are_kept():
    """A delay within one step: the input's sum and first moment are those of the late input."""
    u = np.zeros((9, 1))
    u[2:5, 0] = 1.0, -2.0, 0.5
    tau = 0.3e-3
    out = filtered(ANY_ROBOT["delay"], u, {"delay.tau@u": tau}, ("u",))[:, 0]
    assert out.sum() == pytest.approx(u.sum())
    steps = np.arange(9)
    assert steps @ out == pytest.approx(steps @ u[:, 0] + u.sum() * tau / STEP)


@pytest.mark.parametrize("before", [0.0, -2.0])
def test_lag(before):
    u = currents()
    out = at_taus(BY_NAME["current_lag"], u, before)
    for k, tau in enumerate(TAUS):
        i, fine = before * u[0, k], []
        h = STEP / FINE
        keep = np.exp(-h / tau) if tau else 0.0
        for value in u[:, k]:
            run = []
            for _ in range(FINE):  # the middle of a fine step stands for it
                run.append(value + (i - value) * np.sqrt(keep))
                i = value + (i - value) * keep
            fine.append(run)
        expected = by_brute_force(np.array(fine))
        assert out[:, k] == pytest.approx(expected, abs=1e-3 if 0 < tau < 1e-5 else 1e-5), tau
    assert np.array_equal(out[:, 0], u[:, 0])


@pytest.mark.parametrize("before", [0.0, -2.0])
def test_delay(before):
    u = currents()
    out = at_taus(BY_NAME["delay"], u, before)
    fine = np.repeat(u, FINE, axis=0)
    t = (np.arange(len(fine)) + 0.5) * STEP / FINE
    for k, tau in enumerate(TAUS):
        at = np.floor((t - tau) / STEP + 1e-12).astype(int)
        late = np.where(at >= 0, u[np.maximum(at, 0), k], before * u[0, k])
        expected = by_brute_force(late.reshape(-1, FINE))
        assert out[:, k] == pytest.approx(expected, abs=3 / FINE), tau
    assert np.array_equal(out[:, 0], u[:, 0])
    assert np.array_equal(out[:, -1], np.full(len(u), before * u[0, -1]))  # 10 s: nothing arrived


SHIFTS = [0.0, 1e-7, -1e-7, 3.3e-4, -3.3e-4, 1e-3, -1e-3, 1.7e-3, -1.7e-3, 2.5e-2, -10.0, 1e6]


@pytest.mark.parametrize("tau", SHIFTS)
def test_a_time_shift_of_either_sign(tau):
    u = currents()[:, :1]
    out = filtered(ANY_ROBOT["time_shift"], u, {"time_shift.tau@u": tau}, ("u",))
    fine = (np.arange(len(u) * FINE) + 0.5) * STEP / FINE
    at = np.floor((fine - tau) / STEP + 1e-12).clip(0, len(u) - 1).astype(int)
    expected = by_brute_force(u[at, 0].reshape(-1, FINE))
    assert out[:, 0] == pytest.approx(expected, abs=3 / FINE)
    if tau == 0.0:
        np.testing.assert_array_equal(out, u)


@pytest.mark.parametrize(("one", "other"), [("delay", "delay"), ("current_lag", "lag")])
def test_lag_and_delay_are_those_of_any_robot(one, other):
    u = currents()[:, :1]
    mine = filtered(BY_NAME[one], u, {f"{one}.tau@1": 1.7e-3, f"{one}.before": 1.0})
    values = {f"{other}.tau@u": 1.7e-3, f"{other}.before": 1.0}
    assert np.array_equal(mine, filtered(ANY_ROBOT[other], u, values, ("u",)))
    assert not np.array_equal(mine, u)


def test_an_input_is_clipped_and_its_gain_drifts():
    u = np.sin(np.arange(500) * 0.02)[:, None]
    clipped = {"saturation.c@u": 1.0, "saturation.u_max": 0.5}
    out = filtered(ANY_ROBOT["saturation"], u, clipped, ("u",))
    np.testing.assert_array_equal(out, np.clip(u, -0.5, 0.5))
    out = filtered(ANY_ROBOT["gain_drift"], u, {"gain_drift.alpha@u": 0.1}, ("u",))
    middle = (np.arange(500)[:, None] + 0.5) * STEP
    np.testing.assert_allclose(out, u * (1 - 0.1 * middle), rtol=1e-14)


@pytest.mark.parametrize("name", ["current_lag", "delay"])
def test_a_few_microseconds_grow_from_zero_in_proportion(name):
    none, one, two = simulate(full(), [f"{name}.tau"], [[0.0], [1e-5], [2e-5]])
    assert np.abs(two - none - 2 * (one - none)).max() < 1e-3 * np.abs(two - none).max()
    assert np.abs(one - none).max() > 1e-5


def test_a_delay_of_whole_samples_is_the_shifted_log():
    shifted = simulate(full(), ["delay.tau"], [[0.02]], seconds=0.3)[0]
    straight = simulate(full(), seconds=0.3)[0]
    assert np.abs(shifted[:3]).max() < 1e-12
    assert shifted[2:] == pytest.approx(straight[:-2], abs=1e-9)


@pytest.mark.parametrize("soft", [0.0, 1.0])
def test_a_current_is_limited_before_it_lags(soft):
    """The lag of the limited current, which is not the limit of the lagged one."""
    u = np.repeat([[0.2], [1.5], [-1.4]], 40, axis=0)
    limit = {"current_saturation.c@1": 1.0, "current_saturation.i_max": 0.8,
             "current_saturation.soft": soft}  # fmt: skip
    lag = {"current_lag.tau@1": 5e-3, "current_lag.before": 1.0}
    order = [e for e in CATALOGUE if e.name in ("current_saturation", "current_lag")]
    absent = {name: 0.0 for e in order for parts in e.parameters_at("1") for name in parts}
    both = changed_inputs(order, ("1",), {**absent, **limit, **lag}, u, STEP, 1).reshape(u.shape)
    limited = filtered(BY_NAME["current_saturation"], u, limit)
    np.testing.assert_allclose(
        limited, 0.8 * np.tanh(u / 0.8) if soft else np.clip(u, -0.8, 0.8), rtol=1e-14
    )
    np.testing.assert_array_equal(both, filtered(BY_NAME["current_lag"], limited, lag))
    lagged = filtered(BY_NAME["current_lag"], u, lag)
    assert np.abs(both - filtered(BY_NAME["current_saturation"], lagged, limit)).max() > 0.1
