"""Each output counts by its own error: one at its noise does not hide what another one gains."""

from types import SimpleNamespace

import numpy as np
import pytest
from fit_of_errors import fit_of_errors
from hypothesis import given
from hypothesis import strategies as st

from identification.discovery.options import DiscoveryOptions
from identification.prediction.judging.evidence import (
    all_gains,
    compute_confidence,
    evidence,
)
from identification.prediction.judging.trial import compared, find_doubt
from identification.windows.blocks import count_blocks
from identification.windows.unseen import Unseen

WINDOWS, SAMPLES = 26, 30
PLAIN, OTHER = DiscoveryOptions(), DiscoveryOptions(without=("gains_of_outputs",))


def model(errors, noise, scale):
    """A model that errs so in windows of fitted and of unseen records, errors (W, L, ny)."""
    fitted, unseen = np.split(errors, 2)
    of_outputs = (np.mean((unseen / scale) ** 2, axis=1),)
    told = SimpleNamespace(of_outputs=of_outputs)
    powers = (noise / scale) ** 2
    return SimpleNamespace(
        fit=fit_of_errors(fitted), scale=scale,
        unseen=SimpleNamespace(select=told, noise=powers, floor=float(powers.mean())),
    )  # fmt: skip


def white(rms, seed):
    """Errors of two outputs with some rms."""
    rng = np.random.default_rng(seed)
    return np.asarray(rms) * rng.standard_normal((WINDOWS, SAMPLES, 2))


def probability(options):
    """Of the law that predicts both outputs to their noise, against one that leaves a part.

    Without any law, the first output errs by 40 times its noise, the second one by its noise.
    """
    noise = np.array([0.3, 0.3])
    scale = np.array([12.0, 0.31])
    without = model(white([12.0, 0.31], 1), noise, scale)
    right, near = (
        all_gains(without, model(white([first, 0.3], 2), noise, scale), options)
        for first in (0.3, 1.8)
    )
    return compute_confidence(evidence([right, near], [3, 1], 2))[0]


def test_a_law_that_predicts_to_the_noise_is_likelier_than_one_that_leaves_six_times_as_much():
    assert probability(PLAIN) > 0.99
    windows = DiscoveryOptions(without=("gains_of_outputs", "independent_readings"))
    assert probability(windows) < 0.5  # the noise of the second output hides the first one


@given(st.floats(1e-3, 1e3), st.integers(0, 2**31 - 1))
def test_units_of_an_output_do_not_matter(unit, seed):
    noise, scale = np.array([0.1, 0.2]), np.array([1.0, 1.0])
    a, b = white([1.0, 0.8], seed), white([0.5, 0.7], seed + 1)
    own = np.array([1.0, unit])
    plain = all_gains(model(a, noise, scale), model(b, noise, scale), PLAIN)
    other = all_gains(
        model(a * own, noise * own, scale * own), model(b * own, noise * own, scale * own), PLAIN
    )
    np.testing.assert_allclose(other.blocks, plain.blocks, rtol=1e-9, atol=1e-12)
    assert other.readings == pytest.approx(plain.readings)
    assert len(plain.blocks) == 2 * count_blocks(WINDOWS // 2)


def test_with_one_output_both_ways_are_the_same():
    noise, scale = np.array([0.1, 0.1]), np.array([1.0, 1.0])
    a, b = (white([s, s], k)[..., :1] for s, k in ((1.0, 5), (0.6, 6)))
    one = [model(x, noise[:1], scale[:1]) for x in (a, b)]
    plain, other = all_gains(*one, PLAIN), all_gains(*one, OTHER)
    np.testing.assert_allclose(plain.blocks, other.blocks, rtol=1e-12)
    assert plain.readings == other.readings


def test_an_output_that_never_errs_says_nothing():
    noise, scale = np.array([0.1, 0.0]), np.array([1.0, 1.0])
    a, b = (white([s, 0.0], 7) for s in (1.0, 0.5))
    both = all_gains(model(a, noise, scale), model(b, noise, scale), PLAIN)
    alone = all_gains(
        model(a[..., :1], noise[:1], scale[:1]), model(b[..., :1], noise[:1], scale[:1]), PLAIN
    )
    told, of_one = (g.readings * outputs * g.blocks for g, outputs in ((both, 2), (alone, 1)))
    np.testing.assert_allclose(told, of_one, rtol=1e-9)
    assert alone.blocks.mean() == pytest.approx(2 * np.log(2.0), abs=0.2)


def unseen(errors, noise):
    """Errors (W, L, ny) over the horizon, and over half and twice as much alike, with s of 1."""
    each = ((np.mean(errors**2, axis=1),),) * 3
    return Unseen(
        lengths=(0.5, 1.0, 2.0), powers=each, moves=each, noise=noise**2,
        fit_percent=np.zeros(len(noise)), places=each, parts=(None,),
    )  # fmt: skip


@given(st.integers(1, 8), st.floats(1.5, 20.0), st.floats(0.005, 0.03), st.integers(0, 2**31 - 1))
def test_a_law_that_takes_one_output_to_its_noise_matters_beside_any_others(
    others, times, least, seed
):
    """Others were never wrong: what the law takes away is little of the mean over all outputs."""
    rng = np.random.default_rng(seed)
    noise = np.array([least, *[1.0] * others])
    white = noise * rng.standard_normal((WINDOWS, SAMPLES, 1 + others))
    before = white * np.array([times, *[1.0] * others])
    found = {
        options: compared(unseen(before, noise), unseen(white, noise), options)
        for options in (PLAIN, OTHER)
    }
    assert find_doubt(found[PLAIN], 1, PLAIN) is None
    assert max(found[PLAIN].output_falls) == pytest.approx(1 - times**-2, abs=0.05)
    if times**2 * least**2 < PLAIN.min_fall * others / 2:
        assert find_doubt(found[OTHER], 1, OTHER) == "little"


def test_of_encoders_that_rest_nothing_falls():
    noise = np.array([0.1, 0.0])
    a, b = (np.stack([x, 0 * x], axis=-1) for x in 0.1 * np.random.default_rng(1).normal(
        size=(2, WINDOWS, SAMPLES)))  # fmt: skip
    found = compared(unseen(a, noise), unseen(b, noise), PLAIN)
    assert np.all(np.abs(found.output_falls) < 0.2)
