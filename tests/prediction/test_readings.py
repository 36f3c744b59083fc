"""How many independent readings a window holds, and what the evidence makes of them."""

import numpy as np
import pytest
from fit_of_errors import fit_of_errors
from hypothesis import given
from hypothesis import strategies as st

from identification.prediction.fits.readings import independent_readings
from identification.prediction.judging.evidence import Gains, evidence

WINDOWS, SAMPLES, STATES = 20, 30, 2
TIME = np.linspace(0.0, 1.0, SAMPLES)


def white(rng, windows=WINDOWS):
    """Errors of a sensor's noise, (W, L)."""
    return rng.standard_normal((windows, SAMPLES))


def forced(rng, windows=WINDOWS):
    """Errors of inputs that are wrong by another number in each window, (W, L)."""
    return rng.standard_normal((windows, 1)) * TIME**2


def readings(*errors):
    """Of outputs that err so."""
    return independent_readings(fit_of_errors(np.stack(errors, axis=-1)))


def test_of_white_noise_nearly_every_reading_counts():
    rng = np.random.default_rng(1)
    found = np.array([readings(white(rng))[0] for _ in range(100)]) / (SAMPLES - STATES)
    assert 0.6 < np.median(found) <= 1.0  # the largest of some directions is above their mean
    assert np.quantile(found, 0.05) > 0.35
    many = readings(white(rng, 3000))[0] / (SAMPLES - STATES)
    assert 0.9 < many <= 1.0


def test_a_window_that_is_wrong_as_a_whole_is_one_reading():
    rng = np.random.default_rng(2)
    found = [readings(forced(rng))[0] for _ in range(20)]
    assert min(found) >= 1.0
    assert max(found) < 1.5


def test_outputs_count_by_themselves():
    rng = np.random.default_rng(3)
    a, b = readings(white(rng), forced(rng))
    assert a > 10 * b


@given(st.floats(1e-6, 1e6), st.integers(0, 2**31 - 1))
def test_units_do_not_matter(unit, seed):
    errors = white(np.random.default_rng(seed))
    assert readings(unit * errors)[0] == pytest.approx(readings(errors)[0], rel=1e-9)


@given(st.floats(0.0, 30.0), st.integers(0, 2**31 - 1))
def test_there_are_no_more_than_readings_and_no_less_than_windows(share, seed):
    rng = np.random.default_rng(seed)
    (found,) = readings(white(rng) + share * forced(rng))
    assert 1.0 <= found <= (SAMPLES - STATES) * (1 + 1e-9)


def test_outputs_that_never_err_do_not_stop_it():
    assert readings(np.zeros((WINDOWS, SAMPLES)))[0] == pytest.approx(SAMPLES - STATES)


def share_with_evidence(error, count):
    """How often a law that does nothing has evidence, of 400 fits; count(fit) are its readings.

    The law acts as a force of another number in each window, as one of an input does.
    """
    rng, found = np.random.default_rng(4), 0
    for _ in range(400):
        e, s = error(rng), forced(rng)
        level = np.stack([np.ones(SAMPLES), TIME])
        off = np.eye(SAMPLES) - np.linalg.pinv(level) @ level
        e, s = e @ off, s @ off
        left = e - s * (np.sum(e * s) / np.sum(s * s))
        gain = np.log(np.mean(e**2) / np.mean(left**2))
        n = count(fit_of_errors(e[..., None]))
        found += evidence([Gains(np.array([gain]), WINDOWS * n)], [1], 1)[0, 0] > 0
    return found / 400


@pytest.mark.parametrize("error", [white, forced])
def test_a_law_that_does_nothing_has_seldom_evidence(error):
    """ln N is the price of a number: χ² with one degree of freedom is above it in 1 to 9 %."""
    assert share_with_evidence(error, lambda fit: independent_readings(fit)[0]) < 0.12


def test_counting_every_reading_would_give_evidence_to_what_does_nothing():
    assert share_with_evidence(forced, lambda fit: SAMPLES - STATES) > 0.5


def test_counting_windows_hides_what_takes_a_tenth_away():
    """Of 20 windows of white noise, each of 30 readings: t is about 7."""
    rng = np.random.default_rng(5)
    n = independent_readings(fit_of_errors(white(rng)[..., None]))[0]
    blocks = np.full(10, -np.log(0.9))
    assert evidence([Gains(blocks, WINDOWS * n)], [1], 1)[0, 0] > 0
    assert evidence([Gains(blocks, WINDOWS)], [1], 1)[0, 0] < 0
