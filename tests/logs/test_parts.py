"""A search decides on one part of what no fit sees, and what it tells is of the other."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from discovery_cases import OPTIONS, record, slider
from hypothesis import given
from hypothesis import strategies as st

from identification.innovations.proof import Validation, prove
from identification.logs.parts import (
    FEWEST_BLOCKS,
    MEMORIES,
    REPORT_EVERY,
    autocorrelation_time,
    divide,
    inside,
    is_told,
    join,
)
from identification.windows.comparison import compare
from identification.windows.unseen import Unseen


@given(st.integers(0, 3000), st.integers(1, 90), st.floats(0, 400), st.integers(0, 50))
def test_every_unseen_sample_is_in_one_part_and_each_part_in_whole_blocks(n, unit, memory, fitted):
    unseen = np.arange(fitted + n) >= fitted
    parts = divide(unseen, unit, memory)
    np.testing.assert_array_equal(parts.select | parts.report, unseen)
    if n < FEWEST_BLOCKS * unit:
        assert parts.block == 0
        np.testing.assert_array_equal(parts.select, parts.report)
        assert parts.is_kept == (n == 0)
        return
    if not parts.is_kept:
        assert parts.block == 0
        return
    edges = np.flatnonzero(np.diff(parts.report[fitted:])) + 1
    assert parts.block % unit == 0
    assert not (edges % parts.block).any()
    blocks = n // parts.block
    assert blocks >= FEWEST_BLOCKS
    assert abs(parts.report.sum() - n / REPORT_EVERY) < 2 * parts.block


def test_neighbouring_blocks_of_a_process_with_memory_hardly_correlate():
    """Sums over blocks of 3 τ of an AR(1) process: its exponential memory is τ/2."""
    a, rng, blocks = 0.9, np.random.default_rng(2), 20_000
    length = round(MEMORIES * (1 + a) / (1 - a))
    x, noise = np.zeros(blocks * length), rng.normal(size=blocks * length)
    for k in range(1, len(x)):
        x[k] = a * x[k - 1] + noise[k]
    sums = x.reshape(blocks, length).sum(axis=1)
    assert np.corrcoef(sums[1:], sums[:-1])[0, 1] == pytest.approx(0.1, abs=0.03)


@pytest.mark.parametrize("a", [0.0, 0.5, 0.9])
def test_the_time_of_memory_is_that_of_a_process_on_paper(a):
    """ρ_k = a^k, so that τ = (1 + a)/(1 - a)."""
    rng = np.random.default_rng(1)
    found = []
    for _ in range(10):
        x = np.zeros((2, 4000))
        for k in range(1, x.shape[1]):
            x[:, k] = a * x[:, k - 1] + rng.normal(size=2)
        found.append(autocorrelation_time([*x]))
    assert np.mean(found) == pytest.approx((1 + a) / (1 - a), rel=0.15)
    assert autocorrelation_time([np.ones(9)]) == 1.0


def test_no_periodic_motion_is_in_one_part_alone():
    """Of every third block alone, a motion whose period is three shows always the same third."""
    blocks = 27
    assert is_told(blocks).sum() == blocks / REPORT_EVERY
    time = (np.arange(64 * blocks) + 0.5) / 64  # in blocks

    def apart(told):
        at = np.repeat(told, 64)
        waves = (np.exp(2j * np.pi * time / period) for period in np.arange(1.5, 10, 0.05))
        return max(abs(wave[at].mean() - wave[~at].mean()) for wave in waves)

    assert apart(np.arange(blocks) % REPORT_EVERY == REPORT_EVERY - 1) > 1.2
    assert apart(is_told(blocks)) < 0.9


@given(st.data())
def test_a_window_is_in_a_part_with_all_of_its_samples_or_not_at_all(data):
    n = data.draw(st.integers(40, 400))
    parts = divide(np.arange(n) >= data.draw(st.integers(0, n)), data.draw(st.integers(1, 9)))
    samples = data.draw(st.integers(1, 12))
    first = np.arange(0, n - samples)
    places = np.column_stack([first, first + samples])
    for part in ("select", "report"):
        slow = [all(parts.rows(part)[k] for k in range(*place)) for place in places]
        np.testing.assert_array_equal(inside(parts, part, places), slow)
    assert inside(None, "report", places).all()


def test_joined_records_keep_their_own_parts():
    each = [divide(np.arange(n) >= n // 2, 5) for n in (400, 90, 1000)]
    whole, begun = join(each), 0
    for parts in each:
        rows = slice(begun, begun := begun + len(parts.select))
        back = whole.between(rows)
        np.testing.assert_array_equal(back.select, parts.select)
        np.testing.assert_array_equal(back.report, parts.report)


# The law for which the parts are there. y = m + ε is what a model leaves: ε is white, and m is
# something that no candidate explains. Each candidate, which is nothing, is fitted to noise and
# tried on unseen data; the best of `TRIED` is told. What it does there is known on paper,
#     fall = (2 θ mean(S m) - θ² mean(S²))/mean(y²),
# and what is told must be that on average, over the choice of the best too.

SAMPLES, TRIED, WORLDS, SIGMA = 1200, 20, 100, 1.0


def world(rng):
    """What the model leaves, the candidates' columns, and their fit to as much of noise."""
    missing = np.sin(np.arange(SAMPLES) / 7.0)
    S = rng.normal(size=(SAMPLES, TRIED))
    theta = rng.normal(size=TRIED) * SIGMA / np.sqrt(SAMPLES / 4)
    return missing, missing + SIGMA * rng.normal(size=SAMPLES), S, theta


def beyond(told, truth):
    """How far what is told is from the truth on average, in its std."""
    apart = np.array(told) - np.array(truth)
    return float(apart.mean() / (apart.std() / np.sqrt(len(apart))))


def true_fall(missing, S, theta, rows):
    s, m = S[rows], missing[rows]
    return (2 * theta * np.mean(s * m) - theta**2 * np.mean(s**2)) / (np.mean(m**2) + SIGMA**2)


def errors(e, parts, windows):
    powers = np.mean(e.reshape(windows, -1, 1) ** 2, axis=1)
    places = np.arange(SAMPLES).reshape(windows, -1)[:, [0, -1]] + [0, 1]
    return Unseen(
        lengths=(1.0,), powers=((powers,),), moves=((np.zeros((windows, 1)),),),
        noise=np.array([1e-6]), fit_percent=np.zeros(1),
        places=((places,),), parts=(parts,),
    )  # fmt: skip


def test_over_windows_what_is_told_of_the_best_of_many_is_true_on_average():
    rng, parts = np.random.default_rng(3), divide(np.ones(SAMPLES, bool), 20)
    told, decided, truths = [], [], []
    for _ in range(WORLDS):
        missing, y, S, theta = world(rng)
        before = errors(y, parts, 120)
        found = [compare(before, errors(y - S[:, k] * theta[k], parts, 120)) for k in range(TRIED)]
        best = max(range(TRIED), key=lambda k: found[k].t)
        truths.append([true_fall(missing, S[:, best], theta[best], parts.rows(part))
                       for part in ("select", "report")])  # fmt: skip
        decided.append(found[best].fall)
        told.append(found[best].told.fall)
    of_select, of_report = np.transpose(truths)
    assert abs(beyond(told, of_report)) < 3
    assert beyond(decided, of_select) > 4


@pytest.fixture(scope="module")
def log():
    return record(slider(), SAMPLES + 400, seed=1)


def validated(log, e, parts):
    e = np.concatenate([np.zeros(len(log) - SAMPLES), e])[:, None]
    seen = np.arange(len(log)) < len(log) - SAMPLES
    level = SimpleNamespace(sigma=SIGMA)
    return Validation(
        refit=SimpleNamespace(level=level), log=log, e=e, innovations=e / SIGMA, filter=np.array,
        seen=seen, parts=parts, moved=np.zeros_like(e),
    )  # fmt: skip


def test_along_a_free_run_what_is_told_of_the_best_of_many_is_true_on_average(log):
    rng = np.random.default_rng(4)
    unseen = np.arange(len(log)) >= len(log) - SAMPLES
    parts = divide(unseen, 5)
    falls, shares = ({"told": [], "decided": []} for _ in range(2))
    true = {"told": [], "decided": []}
    options = replace(OPTIONS, proof_blocks=10)
    for _ in range(WORLDS):
        missing, y, S, theta = world(rng)
        before = validated(log, y, parts)
        proofs = [
            prove(before, validated(log, y - S[:, k] * theta[k], parts), options)
            for k in range(TRIED)
        ]
        best = max(range(TRIED), key=lambda k: proofs[k].gain)
        for kind, part in (("decided", "select"), ("told", "report")):
            proof = proofs[best] if kind == "decided" else proofs[best].told
            rows = parts.rows(part)[unseen]
            true[kind].append(true_fall(missing, S[:, best], theta[best], rows))
            falls[kind].append(proof.fall)
            shares[kind].append(proof.share)
    above = np.mean(missing**2) / (np.mean(missing**2) + SIGMA**2)
    for numbers, scale in ((falls, 1.0), (shares, above)):
        assert abs(beyond(numbers["told"], np.array(true["told"]) / scale)) < 3
        assert beyond(numbers["decided"], np.array(true["decided"]) / scale) > 4
