"""Both roles of the records prove a law together: a law of statistics, by simulation.

Two records of a linear model y = X q + c s + e, of windows of 20 samples: the law c is fitted to
one record and predicts the other, and the other way round.
"""

from functools import cache

import numpy as np
import pytest

from identification.discovery.options import DiscoveryOptions
from identification.prediction.judging.trial import find_doubt, luck_of
from identification.windows.comparison import compare, joined
from identification.windows.unseen import Unseen

OPTIONS = DiscoveryOptions(without=("signed_ranks",))
WINDOWS, SAMPLES, WORLDS = 26, 20, 600


def unseen(errors):
    """Errors of one record (W, L) as a search has them, over one length."""
    powers = np.mean(errors**2, axis=1)[:, None]
    return Unseen(
        lengths=(1.0,), powers=((powers,),), moves=((powers,),), noise=np.array([1.0]),
        fit_percent=np.zeros(1), places=((powers,),), parts=(None,),
    )  # fmt: skip


def gained(fitted, other, size):
    """What a law predicts better in one record, fitted to the other beside three parameters."""
    (X, c, e), (X_other, c_other, e_other) = fitted, other
    y, y_other = e + size * c, e_other + size * c_other
    q = np.linalg.lstsq(X, y, rcond=None)[0]
    more = np.linalg.lstsq(np.column_stack([X, c]), y, rcond=None)[0]
    bare = y_other - X_other @ q
    with_it = y_other - np.column_stack([X_other, c_other]) @ more
    each = (unseen(r.reshape(WINDOWS, SAMPLES)) for r in (bare, with_it))
    return compare(*each)


@cache
def chances(size):
    """Chances of the law by one role and by both, and whether both prove it, (`WORLDS`, 3)."""
    rng, out, n = np.random.default_rng(5), [], WINDOWS * SAMPLES
    for _ in range(WORLDS):
        records = [
            (rng.standard_normal((n, 3)), rng.standard_normal(n), rng.standard_normal(n))
            for _ in range(2)
        ]
        one, other = gained(*records, size), gained(*records[::-1], size)
        both = joined(one, other)
        is_proven = find_doubt(both, 1, OPTIONS) is None
        out.append((one.chance, both.chance, is_proven))
    return np.array(out)


@pytest.mark.parametrize("level", [0.01, 0.05])
def test_what_is_not_there_is_proven_no_more_often_than_by_chance(level):
    most = level + 3 * np.sqrt(level * (1 - level) / WORLDS)
    assert np.mean(chances(0.0)[:, 1] < level) <= most


def test_what_is_there_is_proven_far_more_often():
    one, both, _ = (chances(0.25) < OPTIONS.significance).mean(axis=0)
    assert both > one + 0.3


def test_a_fall_that_is_too_little_is_proven_by_neither():
    assert not chances(0.02)[:, 2].any()  # of 0.04 % of the mean square


def test_the_refits_are_paid_for():
    """Without the price, the better of ten laws that are not there would be proven too often."""
    rng = np.random.default_rng(7)
    n, paid, unpaid = WINDOWS * SAMPLES, [], []
    for _ in range(150):
        X = [rng.standard_normal((n, 3)) for _ in range(2)]
        e = [rng.standard_normal(n) for _ in range(2)]
        tried = []
        for _ in range(10):
            records = [(X[k], rng.standard_normal(n), e[k]) for k in range(2)]
            tried.append(joined(gained(*records, 0.0), gained(*records[::-1], 0.0)))
        best = min(tried, key=lambda p: p.chance)
        paid.append(luck_of(best, 10, OPTIONS) < 0.05)
        unpaid.append(luck_of(best, 1, OPTIONS) < 0.05)
    assert np.mean(paid) <= 0.05 + 3 * np.sqrt(0.05 * 0.95 / 150)
    assert np.mean(unpaid) > np.mean(paid)


def test_each_record_has_its_own_blocks_and_falls():
    rng, n = np.random.default_rng(1), WINDOWS * SAMPLES
    records = [
        (np.ones((n, 3)), np.arange(n) / 100.0, rng.standard_normal(n)) for _ in range(2)
    ]  # fmt: skip
    one, other = gained(*records, 1.0), gained(*records[::-1], 1.0)
    both = joined(one, other)
    assert len(both.blocks) == 2
    assert both.record_falls == (*one.record_falls, *other.record_falls)
    assert both.fall == one.fall  # what is told is of the records that confirm
