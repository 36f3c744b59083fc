"""What is tried is paid for: of many candidates, or of several refits, none is proven by luck.

Without the price each of these laws fails: the best of many chances is small although none is.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import binom

from identification.chances import mean_above_zero
from identification.discovery.effect_results import Proof
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect, Size
from identification.innovations.fitted_model import is_confirmed
from identification.innovations.proof import flip_chance
from identification.innovations.scoring.significance import select_significant
from identification.prediction.contenders import list_contenders
from identification.prediction.trial import find_doubt

OPTIONS = DiscoveryOptions()
DRAWS = 2000


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


def is_rate(found, level):
    """Whether so many of all draws are within what chance makes of a level, or fewer."""
    return found <= binom.ppf(0.9999, DRAWS, level)


@pytest.mark.parametrize("count", [10, 100])
def test_of_many_candidates_one_is_beyond_chance_as_seldom_as_of_one(count):
    """Along a free run and over a horizon; candidates that are alike make it rarer still."""
    rng = np.random.default_rng(1)
    smallest = rng.uniform(size=(DRAWS, count)).min(axis=1)
    along = over = 0
    for x in smallest:
        some = scores_of([x, *[0.5] * (count - 1)])
        along += bool(select_significant(some, OPTIONS))
        over += bool(list_contenders(some, OPTIONS, 500))
    for found in (along, over):
        assert is_rate(found, OPTIONS.significance)
        assert found >= binom.ppf(1e-4, DRAWS, OPTIONS.significance / 2)


def gains(rng, refits):
    """Gains by block of refitted effects of which none is there."""
    return rng.standard_normal((refits, OPTIONS.proof_blocks))


def proof_of(blocks):
    return Proof(t=2.0, chance=flip_chance(blocks), fall=0.1, above=0.5, blocks=len(blocks))


@pytest.mark.parametrize("refits", [1, 3, 8])
def test_of_several_refits_along_a_free_run_one_is_proven_as_seldom_as_of_one(refits):
    rng = np.random.default_rng(refits)
    found = sum(
        any(is_confirmed(proof_of(b), OPTIONS, refits) for b in gains(rng, refits))
        for _ in range(DRAWS)
    )
    assert is_rate(found, 0.031)  # Student's t above 2 with 19 degrees of freedom


@pytest.mark.parametrize("refits", [1, 3, 8])
def test_of_several_refits_over_a_horizon_one_is_proven_as_seldom_as_of_one(refits):
    rng = np.random.default_rng(refits)
    found = 0
    for _ in range(DRAWS):
        each = []
        for b in gains(rng, refits):
            t, chance = mean_above_zero(b)
            seen = SimpleNamespace(
                t=t, chance=chance, is_everywhere=True, record_falls=(0.1,), typical_falls=(0.1,)
            )
            each.append(find_doubt(seen, refits, OPTIONS) is None)
        found += any(each)
    assert is_rate(found, OPTIONS.significance)
