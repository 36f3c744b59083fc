"""Fewer samples of the same experiment: the inputs keep their work."""

import numpy as np
import pytest

from identification import InputError, Log
from identification.logs.decimation import decimate

T = 0.001
U = np.sin(np.arange(1001) * 0.01)[:, None] * [1.0, 2.0]
LOG = Log(
    time=np.arange(1001) * T,
    inputs=U,
    outputs=np.cumsum(U, axis=0),
    input_names=("a", "b"),
    output_names=("x", "y"),
)


def test_outputs_are_every_nth_and_means_are_kept():
    few = decimate(LOG, 10, "zoh")
    assert len(few) == 101
    assert few.sampling_time == pytest.approx(0.01)
    np.testing.assert_array_equal(few.outputs, LOG.outputs[::10])
    np.testing.assert_allclose(few.inputs[:-1], U[:-1].reshape(100, 10, 2).mean(axis=1))


def test_straight_lines_are_kept_and_are_the_nearest_ones():
    few = decimate(LOG, 10)
    assert few.hold == "foh"
    weight = (np.arange(10) + 0.5) / 10
    fine = (1 - weight)[:, None] * few.inputs[:-1, None] + weight[:, None] * few.inputs[1:, None]
    error = U[:-1].reshape(100, 10, 2) - fine
    # nearest: what is left is at right angles to every hat
    hats = (
        np.einsum("i,kiu->ku", 1 - weight, error)[1:] + np.einsum("i,kiu->ku", weight, error)[:-1]
    )
    np.testing.assert_allclose(hats, 0, atol=0.01 * np.abs(U).max())
    assert np.abs(error).max() < 0.01


def test_both_moments_of_a_pulse_between_samples_are_kept():
    pulse = np.zeros((401, 1))
    pulse[203:207] = 1.0
    log = Log(
        time=np.arange(401) * T,
        inputs=pulse,
        outputs=pulse,
        input_names=("u",),
        output_names=("y",),
    )
    few = decimate(log, 10)
    weight = (np.arange(2000) + 0.5) / 2000
    u = (1 - weight) * few.inputs[:-1] + weight * few.inputs[1:]
    t = (np.arange(40)[:, None] + weight) * 0.01
    assert u.mean() * 0.4 == pytest.approx(0.004, rel=1e-6)
    assert (u * t).mean() * 0.4 / 0.004 == pytest.approx(0.205, abs=1e-6)


def test_what_makes_no_log_is_refused():
    for every in (0, 600):
        with pytest.raises(InputError, match="makes no log"):
            decimate(LOG, every)


def lines_of(u, every=7, hold="foh"):
    n = len(u)
    log = Log(time=T * np.arange(n), inputs=u[:, None], outputs=np.arange(n)[:, None],
              input_names=("u",), output_names=("y",), hold="foh")  # fmt: skip
    return decimate(log, every, hold)


def test_straight_lines_between_samples_stay_what_they_are():
    t = np.arange(106) * T
    few = lines_of(3 - 40 * t)
    assert few.hold == "foh"
    np.testing.assert_allclose(few.inputs[:, 0], 3 - 40 * few.time, atol=1e-12)
    corners = np.interp(t, t[::7], np.random.default_rng(1).standard_normal(16))
    np.testing.assert_allclose(lines_of(corners).inputs[:, 0], corners[::7], atol=1e-12)
    np.testing.assert_array_equal(few.outputs[:, 0], np.arange(0, 106, 7))


@pytest.mark.parametrize("every", [2, 5])
def test_lines_that_are_thinned_do_the_same_work_at_the_same_time(every):
    rng = np.random.default_rng(every)
    u = np.where((np.arange(401) > 150) & (np.arange(401) < 260), rng.standard_normal(401), 0)
    few = lines_of(u, every)
    fine = np.linspace(0, 400 * T, 400 * 60 + 1)
    was = np.interp(fine, np.arange(401) * T, u)
    found = np.interp(fine, few.time, few.inputs[:, 0])
    for moment in (np.ones_like(fine), fine, np.interp(fine, few.time, np.eye(len(few))[40])):
        assert np.trapezoid((found - was) * moment, fine) == pytest.approx(0, abs=2e-6)
    held = lines_of(u, every, "zoh").inputs[:-1, 0]
    assert held.sum() * every * T == pytest.approx(np.trapezoid(u, dx=T), rel=1e-12)


def test_noise_above_the_new_rate_is_not_folded_into_slow_waves():
    # Every other sample of this wave has one sign: without means it would look like a constant.
    u = np.cos(np.pi * np.arange(601))
    assert np.abs(lines_of(u, 2).inputs[5:-5]).max() < 0.05
    assert np.abs(u[::2]).min() == 1.0
