"""Sets of names hold the true one as often as they say, whatever the odds are worth."""

import numpy as np
import pytest
from joint_page import section
from joint_sets import MISSED, odds, sets_of, share_of_truth, threshold


def row(shares, true, effect=None, **more):
    """A world whose names have these shares of the odds."""
    (name, share), *rivals = shares.items()
    return {
        "duration": 12.0, "verdict": "named", "unexplained": False, "processor_seconds": 1.0,
        "truth": {"robot": "cart", "effect": effect or true, "names": [true], "joint": "rail",
                  "places": ["rail"], "size": 1.0, "parameters": {}},
        "named": [{"name": name, "where": "joint rail", "confidence": share, "one_of": False,
                   "rivals": [n for n, _ in rivals], "shares": [s for _, s in rivals]}],
        "errors": {"written": 3.0, "fit": 2.0, "discover": 1.0},
    } | more  # fmt: skip


def world(rng, honesty):
    """Odds over five names, and a true one that is drawn with a power of them."""
    p = rng.dirichlet(np.full(5, 0.5))
    q = p**honesty / np.sum(p**honesty)
    order = np.argsort(-p)
    return row({f"e{k}": float(p[k]) for k in order}, f"e{rng.choice(5, p=q)}")


@pytest.mark.parametrize("honesty", [0.3, 1.0, 3.0])
def test_a_set_holds_the_truth_as_often_as_it_says_whatever_the_odds_are_worth(honesty):
    rng = np.random.default_rng(round(10 * honesty))
    held = []
    for _ in range(300):
        rows = [world(rng, honesty) for _ in range(60)]
        τ = threshold([share_of_truth(r) for r in rows[:59]])
        held.append(share_of_truth(rows[59]) >= τ)
    assert np.mean(held) == pytest.approx(1 - MISSED, abs=3.5 * np.sqrt(0.09 / 300))


def test_odds_that_are_worth_less_make_larger_sets():
    rng = np.random.default_rng(1)
    size = [sets_of([world(rng, h) for _ in range(200)])["size"] for h in (0.3, 3.0)]
    assert size[0] > 1.5 * size[1]


def test_too_few_worlds_give_all_names():
    assert threshold([0.9] * 8) == 0.0
    assert threshold([0.9, 0.3, *[0.8] * 8]) == 0.3


def test_a_true_name_that_was_not_compared_has_no_share_and_a_name_at_two_places_its_larger_one():
    assert share_of_truth(row({"a": 0.7, "b": 0.3}, "c")) == 0
    two = row({"a": 0.5, "b": 0.3}, "b")
    two["named"][0]["rivals"].append("b")
    two["named"][0]["shares"].append(0.2)
    assert odds(two) == {"a": 0.5, "b": 0.3}


def test_worlds_without_a_name_or_with_no_listed_effect_do_not_count_and_the_page_tells_the_rest():
    rng = np.random.default_rng(2)
    some = [world(rng, 1.0) for _ in range(30)]
    others = [
        row({"e0": 1.0}, "e1", effect="nothing"), row({"curve_speed": 1.0}, "e1"),
        row({"e0": 1.0}, "e1") | {"named": [], "verdict": "unknown effect"},
    ]  # fmt: skip
    assert sets_of([*some, *others]) == sets_of(some)
    assert sets_of(others)["coverage"] is None
    assert "30 of 30" in section([{**r, "key": str(k)} for k, r in enumerate(some)])
