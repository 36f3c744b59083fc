"""Which other laws make a name doubtful: those that nothing measured speaks against."""

from types import SimpleNamespace

import pytest

from identification.prediction.rivals import CONTRADICTED, OWN_SHARE, find_rivals

BEFORE, AFTER = (SimpleNamespace(fit=SimpleNamespace(cost=cost)) for cost in (100.0, 50.0))


def law(doubt=None, t=3.0, key=("other", "joint")):
    return SimpleNamespace(
        candidate=SimpleNamespace(key=key), doubt=doubt, prediction=SimpleNamespace(t=t)
    )


def scores(fall, key=("other", "joint")):
    return [SimpleNamespace(candidate=SimpleNamespace(key=key), fall=fall)]


def rivals(other, still=0.0):
    return find_rivals([other], BEFORE, scores(0.4), AFTER, scores(still))


@pytest.mark.parametrize("doubt", [None, "chance", "numbers", "little", "size"])
def test_a_law_that_is_not_proven_is_a_rival_all_the_same(doubt):
    other = law(doubt)
    assert rivals(other) == (other,)


@pytest.mark.parametrize("doubt", CONTRADICTED)
def test_a_law_that_windows_or_records_contradict_is_no_rival(doubt):
    assert rivals(law(doubt)) == ()


@pytest.mark.parametrize("t", [0.0, -0.7])
def test_a_law_that_predicts_unseen_records_no_better_is_no_rival_however_well_it_fits(t):
    assert rivals(law("chance", t)) == ()


def test_what_explains_as_much_beside_the_name_is_missing_too_and_no_rival():
    other = law()
    least = OWN_SHARE * 0.4 * BEFORE.fit.cost / AFTER.fit.cost
    assert rivals(other, 0.9 * least) == (other,)
    assert rivals(other, 1.1 * least) == ()
