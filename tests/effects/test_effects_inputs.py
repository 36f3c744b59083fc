"""Lag and delay of the current against an integration by brute force."""

import numpy as np
import pytest
from effect_cases import BY_NAME, full, simulate

from inca_mj.effects.impulse import stepwise

STEP, FINE = 1e-3, 400
TAUS = [0.0, 1e-7, 3.3e-4, 1e-3, 1.7e-3, 4e-3, 2.5e-2, 10.0]


def currents() -> np.ndarray:
    return np.repeat(np.random.default_rng(0).normal(0.7, 0.2, (12, 8)), 5, axis=0)


def by_brute_force(fine: np.ndarray) -> np.ndarray:
    """Steps that have the impulse and the moment of a finely sampled signal (steps, FINE)."""
    middle = (np.arange(FINE) + 0.5) / FINE - 0.5
    return stepwise(fine.mean(axis=1), (fine * middle).mean(axis=1))


def test_impulse_and_moment_of_the_whole_are_kept():
    rng = np.random.default_rng(1)
    mean, moment = rng.normal(size=9), rng.normal(size=9)
    moment[-1] = 0.0  # it would go on to a step that is not there
    out = stepwise(mean, moment)
    assert out.sum() == pytest.approx(mean.sum())
    assert np.arange(9) @ out == pytest.approx(np.arange(9) @ mean + moment.sum())


@pytest.mark.parametrize("before", [0.0, 1.0])
def test_lag(before):
    u = currents()
    out = BY_NAME["current_lag"].inputs(u, STEP, np.array([TAUS, [before] * 8]))
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


@pytest.mark.parametrize("before", [0.0, 1.0])
def test_delay(before):
    u = currents()
    out = BY_NAME["delay"].inputs(u, STEP, np.array([TAUS, [before] * 8]))
    fine = np.repeat(u, FINE, axis=0)
    t = (np.arange(len(fine)) + 0.5) * STEP / FINE
    for k, tau in enumerate(TAUS):
        at = np.floor((t - tau) / STEP + 1e-12).astype(int)
        late = np.where(at >= 0, u[np.maximum(at, 0), k], before * u[0, k])
        expected = by_brute_force(late.reshape(-1, FINE))
        assert out[:, k] == pytest.approx(expected, abs=3 / FINE), tau
    assert np.array_equal(out[:, 0], u[:, 0])
    assert np.array_equal(out[:, -1], np.full(len(u), before * u[0, -1]))  # 10 s: nothing arrived


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
