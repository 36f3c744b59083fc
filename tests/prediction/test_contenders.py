"""Which candidates are refitted, and which comes first."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit
from records_cases import FREE, pendulum, record

from identification.discovery.attempts import collected
from identification.discovery.candidates import list_common
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect
from identification.effects.plant.joint_plant import candidates
from identification.effects.sizes import Shape, Size
from identification.model.parameter import Parameter, ParameterSet
from identification.model.predictor import Predictor
from identification.prediction.judging.evidence import Gains, compute_confidence, evidence
from identification.prediction.judging.trial import (
    LEVEL,
    TWINS,
    Contender,
    evidences,
    find_twin,
    is_at_bound,
)
from identification.prediction.scoring.contenders import (
    count_numbers,
    list_contenders,
    list_limits,
    refit_level,
)
from identification.prediction.scoring.scores import WindowScore
from identification.prediction.selection.selection import STRONG_BIC, _near_best, ranked
from identification.prediction.selection.simpler_laws import list_simpler, simpler_than

OPTIONS = DiscoveryOptions()


@njit
def law(s, p):
    return p[0]


def effect(name, sizes=1, shapes=0, hook="friction", own=False):
    return Effect(
        name, "f", tuple(Size(f"a{k}", "N", 1.0, 0.01) for k in range(sizes)),
        tuple(Shape(f"n{k}", "", (1.0,), 0.5, 2.0) for k in range(shapes)),
        places={"joint a": "@a"}, hooks={hook: law}, own=own,
    )  # fmt: skip


def score(e, fall, p_value=1e-9):
    return WindowScore(
        candidate=Candidate(e, "joint a", {s.name: 1.0 for s in e.shapes}),
        size=np.full(len(e.sizes), 0.1), std=np.full(len(e.sizes), 0.01), fall=fall,
        p_value=p_value, along=np.zeros(0),
    )  # fmt: skip


def names(scores):
    return [s.candidate.effect.name for s in scores]


def begun(cost, numbers=3):
    """An effect that was fitted to some windows, with what decides whether it is refitted."""
    part = SimpleNamespace(cut=SimpleNamespace(outputs=np.zeros((1, 1, 1))))
    of = SimpleNamespace(key=("law", f"{cost:.9g}"))
    return SimpleNamespace(
        cost=cost, q=np.zeros(numbers), windows=100, task=SimpleNamespace(parts=(part,)),
        candidate=of,
    )  # fmt: skip


def behind(best, evidence_lost):
    """The cost of an effect whose evidence is so much smaller."""
    return best * float(np.exp(evidence_lost / 100))


def test_what_some_windows_cannot_tell_from_the_few_best_is_refitted_too():
    few = OPTIONS.max_refits
    apart = [behind(1.0, 100.0 * k) for k in range(few)]  # each surely better than the next
    near = behind(apart[-1], 0.9 * STRONG_BIC)
    far = behind(apart[-1], 1.1 * STRONG_BIC)
    with collected(lambda _: None) as left:
        kept = _near_best([begun(far), begun(near), *map(begun, apart)], OPTIONS)
    assert [b.cost for b in kept] == [*apart, near]
    assert [f.where for f in left] == [f"{far:.9g}"]
    assert _near_best([], OPTIONS) == []


@pytest.mark.parametrize("count", [3, 100])
def test_one_refit_by_luck_is_expected_where_nothing_is_missing(count):
    """Chances of candidates are uniform then: the number of those below the level is one, or 5 %
    of few."""
    rng, refitted = np.random.default_rng(count), []
    every = [score(effect(f"e{k}"), 0.5) for k in range(count)]
    for _ in range(1000):
        chances = rng.uniform(size=count)
        scores = [replace(s, p_value=p) for s, p in zip(every, chances, strict=True)]
        level = refit_level(scores, OPTIONS)
        refitted.append(sum(s.p_value < level for s in scores))
    assert np.mean(refitted) == pytest.approx(min(1.0, 0.05 * count), abs=0.15)


def test_where_something_is_missing_a_weak_law_is_refitted_and_without_the_pass_it_is_not():
    curve, weak = score(effect("curve_speed", 8), 0.9), score(effect("law"), 0.5, p_value=0.005)
    others = [score(effect(f"e{k}"), 0.1, p_value=0.5) for k in range(100)]
    assert names(list_contenders([curve, weak, *others], OPTIONS)) == ["law"]
    strict = DiscoveryOptions(without=("weak_scores",))
    assert list_contenders([curve, weak, *others], strict) == []
    assert list_contenders([weak, *others], OPTIONS) == [weak]  # 0.5 of 101 by luck
    assert list_contenders([weak, *others, *others], OPTIONS) == []


def test_where_much_is_left_a_weak_law_is_refitted_though_no_score_is_beyond_chance():
    weak = score(effect("law"), 0.5, p_value=0.005)
    scores = [weak, *(score(effect(f"e{k}"), 0.1, p_value=0.5) for k in range(300))]
    assert list_contenders(scores, OPTIONS, is_left=False) == []
    assert list_contenders(scores, OPTIONS, is_left=True) == [weak]
    for name in ("scores_of_much_left", "weak_scores"):
        strict = DiscoveryOptions(without=(name,))
        assert list_contenders(scores, strict, is_left=True) == []


def test_laws_that_are_there_or_not_are_fitted_whatever_their_scores_are():
    whole = replace(Size("c", "", 1.0, 0.02, 1), present=1.0)
    limit = replace(effect("limit"), sizes=(whole,))
    best, worse = score(limit, 0.01, p_value=0.9), score(limit, 0.001, p_value=0.9)
    scores = [score(effect("law"), 0.9), best, worse]
    assert list_limits(scores, scores[:1]) == [best]
    assert list_limits(scores, [best]) == []


def test_laws_and_curves_are_asked_apart_whatever_they_promise():
    law_, curve = score(effect("law"), 0.7), score(effect("curve_speed", 8), 0.8)
    weak = score(effect("curve_load", 8), 0.6, p_value=0.5)
    scores = [curve, law_, weak]
    assert names(list_contenders(scores, OPTIONS)) == ["law"]
    assert names(list_contenders(scores, OPTIONS, are_curves=True)) == ["curve_speed"]


def test_a_score_that_asks_for_too_large_a_size_is_refitted_and_one_of_a_wrong_sign_is_not():
    def sized(name, size, sign=0):
        e = replace(effect(name), sizes=(Size("a", "N", 1.0, 0.01, sign),))
        return replace(score(e, 0.8), size=np.array([size]))

    large, wrong, usual = sized("large", 50.0), sized("wrong", -0.5, sign=1), sized("usual", 0.5)
    assert names(list_contenders([large, wrong, usual], OPTIONS)) == ["large", "usual"]
    strict = DiscoveryOptions(without=("large_scores",))
    assert names(list_contenders([large, wrong, usual], strict)) == ["usual"]


def test_simpler_laws_act_as_the_winner_does():
    rich = effect("rich", shapes=1)
    scores = [score(rich, 0.5), score(effect("force", hook="force"), 0.4),
              score(effect("plain"), 0.3), score(effect("as rich", sizes=2), 0.3),
              score(effect("late", hook="input"), 0.3)]  # fmt: skip
    assert count_numbers(scores[0].candidate) == 2
    simpler = simpler_than(scores[0].candidate, scores)
    assert [c.effect.name for c in simpler] == ["force", "plain"]
    assert names(list_simpler(scores, scores, OPTIONS)) == ["rich", "force"]


@dataclass(frozen=True)
class Model:
    """What the ranking sees of a model of one output."""

    candidates: tuple
    scale: tuple = (1.0,)


def contender(e, gain, seed=0, numbers=1, is_proven=True):
    model = Model((score(e, 0.5).candidate,))
    gains = Gains(gain + 0.1 * np.random.default_rng(seed).normal(size=20), 80.0)
    return Contender(
        model=model, prediction=None, gains=gains, numbers=numbers,
        criterion=float(evidence([gains], [numbers], 1)[0, 0]), explained=0.0,
        doubt=None if is_proven else "chance",
    )  # fmt: skip


def order(*contenders):
    return [c.candidate.effect.name for c in ranked(contenders, OPTIONS)]


def test_fewer_numbers_come_first_where_resamples_cannot_tell():
    rich = contender(effect("rich"), 1.06, seed=1, numbers=2)
    plain = contender(effect("plain"), 1.0, seed=2)
    assert order(rich, plain) == ["plain", "rich"]
    better = contender(effect("rich"), 1.07, seed=1, numbers=2)
    assert better.criterion > plain.criterion  # but not surely
    assert order(better, plain) == ["plain", "rich"]


def test_more_numbers_come_first_where_all_windows_tell():
    rich = contender(effect("rich"), 2.0, seed=1, numbers=2)
    plain = contender(effect("plain"), 1.0, seed=2)
    assert order(plain, rich) == ["rich", "plain"]


def test_a_law_that_adds_a_number_and_nothing_else_pays_for_it():
    """The odds of two laws whose E differ by ln N are √N: 80 readings of the cases."""
    plain, rich = contender(effect("plain"), 1.0), contender(effect("rich"), 1.0, numbers=2)
    shares = compute_confidence(evidences([plain, rich]))
    assert shares[0] / shares[1] == pytest.approx(np.sqrt(80))


def test_the_evidence_of_all_blocks_is_twice_the_gain_in_likelihood_less_the_price_of_numbers():
    gains = [Gains(np.array([0.2, 0.4]), 50.0), Gains(np.array([0.1, 0.1]), 50.0)]
    found = evidence(gains, [1, 3], outputs=2)[:, 0]
    np.testing.assert_allclose(found, [2 * 50 * 0.3 - np.log(50), 2 * 50 * 0.1 - 3 * np.log(50)])


def test_confidence_is_shared_by_equals_as_their_blocks_scatter():
    a, b = (contender(effect(n), 1.0, seed=k) for k, n in enumerate("ab"))
    shares = compute_confidence(evidences([a, b]))
    assert shares.sum() == pytest.approx(1.0)
    assert 0 < shares.min() < shares.max() < 1


def fitted(value, lower, upper, shape=1.0, of_log=False):
    """A model whose last effect has one free size and a free shape in [1, 4], which were fitted."""
    size, wide = "law.size@a", "law.n"
    each = ((size, lower, upper), (wide, 1.0, 4.0))
    parameters = ParameterSet("effects", tuple(
        Parameter(name=n, value=max(0.0, low), unit="N", where="", lower=low, upper=high)
        for n, low, high in each
    ))  # fmt: skip
    law = Effect(
        "law", "", (Size("size", "N", 1.0, 1.0),),
        (Shape("n", "", (2.0,), 1.0, 4.0, of_log=of_log),), places={"joint a": "@a"},
    )  # fmt: skip
    return SimpleNamespace(
        plant=SimpleNamespace(parameters=parameters),
        candidates=(Candidate(law, "joint a", {"n": shape}),),
        fit=SimpleNamespace(values={f"{size} [log]": value, wide: shape, "J": 1.0}),
    )


@given(st.floats(0.1, 10.0), st.floats(-0.999, 0.999))
def test_only_a_size_on_a_bound_that_is_not_zero_stands_for_something_else(bound, share):
    inside = 2.0
    assert is_at_bound(fitted(bound, -bound, bound, inside))
    assert is_at_bound(fitted(-bound, -bound, bound, inside))
    assert not is_at_bound(fitted(share * bound, -bound, bound, inside))
    assert not is_at_bound(fitted(0.0, 0.0, bound, inside))
    assert not is_at_bound(fitted(share * bound, -np.inf, np.inf, inside))


@given(st.sampled_from([1.0, 4.0]))
def test_a_law_whose_shape_is_on_its_bound_stands_for_something_else(shape):
    assert is_at_bound(fitted(0.5, -1.0, 1.0, shape))
    assert not is_at_bound(fitted(0.5, -1.0, 1.0, shape), are_shapes_asked=False)
    assert not is_at_bound(fitted(0.5, -1.0, 1.0, shape, of_log=True))


LEVEL_THERE = 0.1  # Coulomb friction [N m]
NAMES = (f"{LEVEL}@hinge", "offset.f_0@hinge", "asymmetric_friction.f_a@hinge")


def angles(offset, asymmetry, seed):
    """Of the pendulum, which rests now and then."""
    log = record(seed, samples=200, largest=0.3)
    values = np.array([[LEVEL_THERE, offset, asymmetry]])
    return np.asarray(Predictor(pendulum(), log, NAMES).predict(values)[0])


@settings(max_examples=10, deadline=None)
@given(st.floats(-0.9, 0.9), st.integers(0, 4))
def test_they_are_one_force_while_friction_is_larger(share, seed):
    f = share * LEVEL_THERE
    np.testing.assert_allclose(angles(f, 0.0, seed), angles(0.0, -f, seed), atol=1e-9)


def test_they_differ_where_the_force_is_larger_than_friction():
    f = 1.5 * LEVEL_THERE
    assert np.abs(angles(f, 0.0, 1) - angles(0.0, -f, 1)).max() > 1e-3


@pytest.mark.parametrize("name", [*TWINS])
@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_twin_is_told_only_below_the_level(name, share):
    (effect,) = (e for e in candidates(pendulum(), FREE) if e.name == name)
    (candidate,) = (c for c in list_common([effect]) if c.where == "joint hinge")
    values = {f"{LEVEL}@hinge": LEVEL_THERE, candidate.sizes[0]: share * LEVEL_THERE}
    model = SimpleNamespace(plant=pendulum(), values=values, fit=SimpleNamespace(shared={}))
    assert find_twin(model, candidate) == (TWINS[name] if share < 1 else "")
