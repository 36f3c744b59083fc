"""The error over a horizon: that of the sensors for a right model, whatever pushed it before."""

from dataclasses import replace

import numpy as np
import pytest
from estimation_plants import record, slider
from state_cases import F_C, PRESLIDING, Truth, measured, pendulum

from identification.windows.held import held_records, held_windows
from identification.windows.settling import settle
from identification.windows.window_error import _fixed, window_error
from identification.windows.windows import windows


def fixed(plant, log, length, values):
    return _fixed(plant, log, windows(log, length), values)


NOISE = 1e-4


def noisy(seed=3, **values):
    log = record(slider(**values), ("position",), n=200)
    y = log.outputs + NOISE * np.random.default_rng(seed).standard_normal(log.outputs.shape)
    return replace(log, outputs=y)


def test_a_right_model_leaves_the_noise_less_what_each_start_takes():
    log = noisy(x0=0.3, v0=-0.2)
    error = window_error(slider(), log, 0.4)  # its start is another: windows have their own
    assert error.shape == (10, 20, 1)
    assert np.sqrt(np.mean(error**2)) == pytest.approx(NOISE * np.sqrt(18 / 20), rel=0.1)


def test_a_wrong_model_leaves_more_the_longer_the_horizon():
    log = noisy()
    short, long = (window_error(slider(), log, s, {"mass": 3.0}) for s in (0.4, 2.0))
    assert 2 * NOISE < np.sqrt(np.mean(short**2)) < 0.5 * np.sqrt(np.mean(long**2))


def test_the_start_of_a_window_is_the_best_there_is():
    """Against least squares over position and rate of a linear plant's window."""
    log = noisy()
    error = window_error(slider(), log, 0.4, {"damping": 4.0})[0, :, 0]
    plant = slider(damping=4.0)
    free, right, fast = (
        record(plant.__class__(plant.model, plant.parameters.with_values(start)), ("position",),
               inputs=log.inputs[:20]).outputs[:, 0]
        for start in ({"x0": 0.0, "v0": 0.0}, {"x0": 1.0, "v0": 0.0}, {"x0": 0.0, "v0": 1.0})
    )  # fmt: skip
    X = np.stack([right - free, fast - free], axis=1)
    y = log.outputs[:20, 0] - free
    expected = y - X @ np.linalg.lstsq(X, y, rcond=None)[0]
    np.testing.assert_allclose(error, expected, atol=1e-8)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_friction_that_gives_may_have_pulled_either_way_when_a_window_began(seed):
    """The true model leaves the noise in every window, also where its friction pulled back."""
    log = measured(Truth(slip=3.0, f_c=F_C), seed, samples=150, noise=NOISE)
    plant = pendulum(F_C, 0.0025).with_values({"J": 2e-3, "d": 0.02})
    error = window_error(plant.with_states_of([PRESLIDING]), log, 0.2, {PRESLIDING: 3.0})
    assert np.sqrt(np.mean(error**2, axis=(1, 2))).max() < 2 * NOISE


def test_a_window_ends_where_it_ends_alone():
    shooting, d = fixed(slider(damping=4.0), noisy(), 0.4, None)
    (together,) = settle(held_records([shooting]), [d])
    for k in (0, len(d) // 2, len(d) - 1):
        keep = np.array([k])
        (alone,) = settle(held_records([shooting.rows(keep)]), [d[keep]])
        assert squares(together)[k] == pytest.approx(squares(alone)[0], rel=0.02)


def test_records_settled_together_end_where_each_ends_alone():
    plant = slider(damping=4.0)
    each = [fixed(plant, noisy(seed), 0.4, None) for seed in (0, 1)]
    parts, begun = zip(*each, strict=True)
    for one, part, d in zip(settle(held_records(parts), begun), parts, begun, strict=True):
        (alone,) = settle(held_records([part]), [d])
        np.testing.assert_allclose(squares(one), squares(alone), rtol=0.02)


def test_some_windows_are_simulated_as_if_they_were_all():
    """Of their residuals and slopes; also some of some, and one that is there twice."""
    keep = [2, 2, 0]
    shooting, d = fixed(slider(), noisy(), 0.4, None)
    whole = held_windows(shooting)
    r, slopes = whole.residual(d), whole.slopes(d, whole.residual(d))
    for some in (whole.rows(np.array(keep)), whole.rows(np.arange(len(d)) < 4).rows(keep)):
        np.testing.assert_array_equal(some.residual(d[keep]), r[keep])
        mine = some.slopes(d[keep], r[keep])
        np.testing.assert_array_equal(mine.s, slopes.s[keep])
        np.testing.assert_array_equal(some.rows(np.array([1])).residual(d[keep][1:2]), r[keep][1:2])


def squares(settled):
    return np.sum(settled.r**2, axis=1)
