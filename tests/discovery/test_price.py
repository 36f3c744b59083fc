"""What is tried is paid for: of many candidates, or of several refits, none is proven by luck.

Without the price each of these laws fails: the best of many chances is small although none is.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import binom, wilcoxon

from identification.chances import (
    mean_above_zero,
    ranks_above_zero,
    stratified_mean_above_zero,
)
from identification.discovery.effect_results import Proof
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect
from identification.effects.sizes import Size
from identification.innovations.fitted_model import is_confirmed
from identification.innovations.proof import flip_chance
from identification.innovations.scoring.significance import select_significant
from identification.prediction.judging.trial import TESTS, find_doubt
from identification.prediction.scoring.contenders import list_contenders
from identification.windows.blocks import block_gains
from identification.windows.comparison import Prediction

OPTIONS = DiscoveryOptions()
STRICT = DiscoveryOptions(without=("weak_scores",))
DRAWS, FEWER = 2000, 500  # without their price 8 refits prove 40 of 500, and with it 5


CANDIDATES = [
    Candidate(Effect(f"e{k}", "", (Size("a", "N", 1.0, 0.1),), places={"all": ""}), "all", {})
    for k in range(100)
]


def scores_of(p):
    """Scores of as many effects, each of a plausible size that explains a tenth."""
    return [
        SimpleNamespace(candidate=c, size=np.array([0.5]), p_value=x, gain=-2 * np.log(x), fall=0.1)
        for c, x in zip(CANDIDATES, p, strict=False)
    ]


def is_rate(found, level, draws=DRAWS):
    """Whether so many of all draws are within what chance makes of a level, or fewer."""
    return found <= binom.ppf(0.9999, draws, level)


@pytest.mark.parametrize("count", [10, 100])
def test_of_many_candidates_one_is_beyond_chance_as_seldom_as_of_one(count):
    """Along a free run, and over a horizon without weak scores, of which unseen records decide.

    Candidates that are alike make it rarer still.
    """
    rng = np.random.default_rng(1)
    smallest = rng.uniform(size=(DRAWS, count)).min(axis=1)
    along = over = 0
    for x in smallest:
        some = scores_of([x, *[0.5] * (count - 1)])
        along += bool(select_significant(some, OPTIONS))
        over += bool(list_contenders(some, STRICT))
    for found in (along, over):
        assert is_rate(found, OPTIONS.significance)
        assert found >= binom.ppf(1e-4, DRAWS, OPTIONS.significance / 2)


def gains(rng, refits):
    """Gains by block of refitted effects of which none is there."""
    return rng.standard_normal((refits, OPTIONS.proof_blocks))


def proof_of(blocks):
    return Proof(t=2.0, chance=flip_chance(blocks), fall=0.1, above=0.5, blocks=len(blocks))


@pytest.mark.parametrize("refits", [1, 8])
def test_of_several_refits_along_a_free_run_one_is_proven_as_seldom_as_of_one(refits):
    rng = np.random.default_rng(refits)
    found = sum(
        any(is_confirmed(proof_of(b), OPTIONS, refits) for b in gains(rng, refits))
        for _ in range(FEWER)
    )
    assert is_rate(found, 0.031, FEWER)  # Student's t above 2 with 19 degrees of freedom


def prediction(blocks, record_falls, t=5.0, chance=1e-6, rank_chance=1.0):
    """A gain over every length, of records with these blocks and falls."""
    return Prediction(
        t=t, chance=chance, rank_chance=rank_chance, gain=0.1, gains=(0.1,), fall=0.1,
        falls=(0.1,), typical_falls=(0.1,), output_falls=(0.1,), times_noise=(9.0,),
        record_falls=record_falls,
        blocks=blocks,
    )  # fmt: skip


def test_a_window_that_begins_badly_seldom_lets_its_record_contradict_a_law():
    """A law that halves the errors of 20 windows, of which one begins badly now and then."""
    rng = np.random.default_rng(2)
    found = {without: 0 for without in ((), ("losing_blocks",))}
    for _ in range(DRAWS // 4):
        before = np.exp(0.5 * rng.standard_normal(40))
        after = 0.25 * before * np.exp(0.5 * rng.standard_normal(40))
        after[rng.integers(40)] *= np.exp(6 * rng.uniform())
        gains = block_gains([before], [after], 0.01)
        seen = prediction(tuple(gains), (1 - after.mean() / before.mean(),))
        for without in found:
            options = DiscoveryOptions(without=without)
            found[without] += find_doubt(seen, 1, options) == "record"
    assert found[()] == 0
    assert found["losing_blocks",] > 0.1 * DRAWS / 4


def test_a_record_in_which_a_law_does_nothing_contradicts_it():
    gains = (np.full(20, 3.0), np.full(20, -0.1))
    assert find_doubt(prediction(gains, (0.9, -0.1)), 1, OPTIONS) == "record"


@pytest.mark.parametrize("refits", [1, 8])
def test_of_several_refits_over_a_horizon_one_is_proven_as_seldom_as_of_one(refits):
    rng = np.random.default_rng(refits)
    by_mean, by_both = DiscoveryOptions(without=("signed_ranks",)), OPTIONS
    found = {options: 0 for options in (by_mean, by_both)}
    for _ in range(FEWER):
        every = [
            prediction((b,), (0.1,), *mean_above_zero(b), ranks_above_zero(b))
            for b in gains(rng, refits)
        ]
        for options in found:
            found[options] += any(find_doubt(seen, refits, options) is None for seen in every)
    assert is_rate(found[by_mean], OPTIONS.significance, FEWER)
    assert is_rate(found[by_both], OPTIONS.significance, FEWER)


def unlike_records(rng):
    """Gains of blocks of three records whose means differ, and are zero together."""
    records = (-0.7, 0.2), (0.2, 0.5), (0.5, 0.8)  # mean and scatter of each
    return [mean + scatter * rng.standard_normal(6) for mean, scatter in records]


def test_one_number_tells_nothing_and_warns_of_nothing():
    assert np.isnan(mean_above_zero(np.array([1.0]))).all()
    assert np.isnan(stratified_mean_above_zero([np.array([1.0])])).all()


def test_unlike_records_prove_by_luck_as_seldom_as_the_test_says():
    rng, level = np.random.default_rng(0), 0.01
    found = sum(stratified_mean_above_zero(unlike_records(rng))[1] < level for _ in range(DRAWS))
    assert is_rate(found, level, DRAWS)


def test_that_records_differ_does_not_hide_what_all_of_them_gain():
    """One record gains nothing, as a slow one of a drag, and the other one much in each block."""
    rng, found = np.random.default_rng(1), {True: 0, False: 0}
    for _ in range(FEWER):
        blocks = [0.2 * rng.standard_normal(6), 1.6 + 0.3 * rng.standard_normal(6)]
        found[True] += stratified_mean_above_zero(blocks)[1] < 1e-3
        found[False] += mean_above_zero(np.concatenate(blocks))[1] < 1e-3
    assert found[True] > 0.95 * FEWER
    assert found[False] < 0.05 * FEWER


def test_records_too_short_to_tell_their_scatter_count_as_one():
    rng = np.random.default_rng(2)
    a, b, c = rng.standard_normal(8), rng.standard_normal(1), rng.standard_normal(2)
    assert stratified_mean_above_zero([a, b, c]) == stratified_mean_above_zero([a, np.r_[b, c]])
    assert stratified_mean_above_zero([a, b]) == mean_above_zero(np.r_[b, a])


def test_gains_of_many_blocks_prove_where_a_few_large_ones_hide_their_mean():
    """A force that acts far out: a little in all blocks, much in two of them."""
    gains = np.r_[np.linspace(0.05, 0.2, 14), 0.9, 1.1]
    t, chance = mean_above_zero(gains)
    assert t > OPTIONS.min_proof_t
    seen = prediction((gains,), (0.5,), t, chance, ranks_above_zero(gains))
    assert find_doubt(seen, 6, OPTIONS) is None
    assert find_doubt(seen, 6, DiscoveryOptions(without=("signed_ranks",))) == "chance"


@pytest.mark.parametrize("count", [1, 5, 13, 40])
def test_the_chance_of_signed_ranks_is_that_of_scipy(count):
    x = np.random.default_rng(count).normal(0.3, 1.0, count)
    known = wilcoxon(x, alternative="greater", method="exact").pvalue
    assert ranks_above_zero(x) == pytest.approx(known, rel=1e-9)


def test_the_price_of_two_tests_is_what_they_pass_by_luck_together():
    """More often than one alone, so that a price is due, and no more often than it."""
    blocks, draws, level = 16, 10_000, 0.05
    rng = np.random.default_rng(0)
    passed = sum(
        min(mean_above_zero(x)[1], ranks_above_zero(x)) < level
        for x in rng.standard_normal((draws, blocks))
    )
    assert passed > binom.ppf(0.999, draws, level)
    assert passed <= binom.ppf(0.999, draws, TESTS * level)
