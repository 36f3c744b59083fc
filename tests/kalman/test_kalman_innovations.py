"""White innovations pass, and what is not white is found where it is."""

import numpy as np
import pytest
from scipy.stats import kstest

from identification.estimation.residuals import innovation_tests

H, N, NY = 0.01, 600, 8


def white(seed):
    return np.random.default_rng(seed).standard_normal((N, NY))


def test_chances_are_uniform_under_white_innovations():
    found = [innovation_tests(white(seed), H) for seed in range(300)]
    assert kstest([w.p_louder for w in found], "uniform").pvalue > 0.01
    lines, correlation = (
        np.array([getattr(w, name) for w in found]) for name in ("p_line", "p_correlation")
    )
    for level in (0.02, 0.1):  # of the lines it is a bound
        assert np.mean(lines < level) < level + 3 * np.sqrt(level * (1 - level) / 300)
    assert np.mean(lines < 0.1) > 0.03
    # Sums of correlations over few samples are a little larger than their χ².
    assert 0.03 < np.mean(correlation < 0.1) < 0.25
    assert np.mean(correlation < 1e-3) < 0.015


@pytest.mark.parametrize(("frequency", "channel"), [(7.0, 3), (0.5, 0), (31.0, 7)])
def test_a_sine_is_found_at_its_frequency_and_channel(frequency, channel):
    E = white(1)
    E[:, channel] += 0.5 * np.sin(2 * np.pi * frequency * H * np.arange(N) + 1)
    w = innovation_tests(E, H)
    assert w.p_line < 1e-6
    assert w.channel == channel
    assert w.frequency == pytest.approx(frequency, abs=1 / (N * H))


def test_a_loud_channel_is_found():
    E = white(2)
    E[:, 5] *= 1.4
    w = innovation_tests(E, H)
    assert w.p_louder < 1e-6
    assert w.loudest == 5


def test_colour_is_found():
    E = white(3)
    E[1:, 2] += 0.4 * E[:-1, 2]
    assert innovation_tests(E, H).p_correlation < 1e-4


def test_one_channel_is_no_louder_than_itself():
    w = innovation_tests(white(4)[:, :1], H)
    assert w.p_louder == 1
    assert w.p_correlation > 1e-3


def test_a_constant_is_no_line():
    shifted = innovation_tests(white(5) + 3.0, H)
    same = innovation_tests(white(5), H)
    assert shifted.p_line == pytest.approx(same.p_line, rel=1e-6)
    assert shifted.p_correlation == pytest.approx(same.p_correlation, rel=1e-6)


@pytest.mark.parametrize("a", [0.1, 0.3, 0.6])
def test_the_predictable_share_of_a_first_order_process(a):
    rng = np.random.default_rng(5)
    E = rng.standard_normal((20000, 4))
    for k in range(1, len(E)):
        E[k] += a * E[k - 1]
    w = innovation_tests(E, H)
    assert w.predictable == pytest.approx(a**2, rel=0.1)
    assert w.p_correlation < 1e-4  # beyond chance in all three, but of the first too little
    assert w.is_correlated(1e-4, 0.03) == (a > 0.1)
