from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from identification import fit_percent, loss, rms

signals = arrays(float, (12, 2), elements=st.integers(-1000, 1000).map(float))
scales = st.floats(1e-6, 1e6)


@given(y=signals)
def test_perfect_is_100_and_the_mean_is_0_and_a_constant_has_no_fit(y):
    moves = np.ptp(y, axis=0) > 0
    assert np.all(fit_percent(y, y)[moves] == 100)
    mean = np.broadcast_to(y.mean(axis=0), y.shape)
    assert fit_percent(y, mean)[moves] == pytest.approx(0, abs=1e-9)
    assert np.all(np.isnan(fit_percent(y, y)[~moves]))


@given(y=signals, y_hat=signals, scale=scales, offset=st.integers(-100, 100))
def test_fit_does_not_depend_on_unit_or_zero(y, y_hat, scale, offset):
    before = fit_percent(y, y_hat)
    after = fit_percent(scale * (y + offset), scale * (y_hat + offset))
    assert after == pytest.approx(before, rel=1e-6, abs=1e-6, nan_ok=True)


def test_a_constant_whose_mean_is_rounded_has_no_fit():
    y = np.full((3, 1), 0.1)
    assert np.isnan(fit_percent(y, y + 1)).all()


def test_fit_is_that_of_the_thesis():
    y = np.array([[0.0], [3.0], [0.0], [-3.0]])
    assert fit_percent(y, y + 0.3 * np.sqrt(18) / 2) == pytest.approx([70])


def test_rms_and_loss_by_hand():
    residual = np.array([[3.0, 0.0], [-3.0, 4.0]])
    assert rms(residual) == pytest.approx([3, np.sqrt(8)])
    assert loss(residual) == pytest.approx(17)


@given(residual=signals, scale=scales)
def test_loss_is_the_sum_of_mean_squares_and_scales_squared(residual, scale):
    assert loss(residual) == pytest.approx(np.sum(rms(residual) ** 2))
    assert loss(scale * residual) == pytest.approx(scale**2 * loss(residual))


def test_shapes_that_cannot_be_compared_are_refused(refusal):
    assert "(3, 1)" in refusal(fit_percent, np.zeros((4, 1)), np.zeros((3, 1)))
    assert "(4,)" in refusal(rms, np.zeros(4))
    assert "(0, 2)" in refusal(loss, np.zeros((0, 2)))
