"""Accepted effects take the kind that explains more beside the others."""

from dataclasses import replace

import pytest
from discovery_cases import EFFECTS, SENSOR, record, slider, task, wander

from identification.discovery.effect_results import Proof
from identification.effects.effect import Candidate
from identification.effects.sizes import Shape
from identification.innovations.fitted_model import AcceptedEffect, fit_model
from identification.innovations.moves import kinds
from identification.innovations.moves.kinds import improve_kinds, improve_rivals
from identification.innovations.replacement import replace_effect
from identification.innovations.scoring.sensitivities import Sensitivity, compute_sensitivities

ROBOT = {"mass": 2.2, "damping": 2.7, "x0": 0.01, "v0": 0.02}
K = 5.0
KIND = Shape("kind", "", (0.0, 1.0), 0.0, 1.0, free=False)
PROOF = Proof(gain=1.0, t=3.0, chance=1e-3, blocks=20, share=1.0, fall=0.5, above=0.5)


def of_kinds(name):
    """An effect of the slider as one that comes in two kinds."""
    (effect,) = (e for e in EFFECTS if e.name == name)
    return replace(effect, shapes=(KIND,))


@pytest.fixture(scope="module")
def asked():
    log = record(slider(**ROBOT, **{"spring.k": K}), 500, 11, wander(500, 0.003, 0.1, 8), SENSOR)
    return task(log)


def fitted(asked, name, start):
    """The slider with an effect, as accepted, and the same effect of two kinds."""
    plain = Candidate(next(e for e in EFFECTS if e.name == name), "joint", {})
    model = fit_model(asked, (plain,), start)
    own = Candidate(of_kinds(name), "joint", {"kind": 0.0})
    model = replace(model, candidates=(own,))
    return model, AcceptedEffect(model, PROOF, 10.0, ())


def sense_as(monkeypatch, other):
    """Make the second kind of an effect that of another effect of the slider."""
    seen = []

    def compute(point, candidates):
        of = Candidate(next(e for e in EFFECTS if e.name == other), "joint", {})
        seen.extend(compute_sensitivities(point, (of,)))
        return [Sensitivity(c, seen[-1].S) for c in candidates]

    monkeypatch.setattr(kinds, "compute_beside", compute)
    return seen


def test_a_kind_that_explains_more_is_refitted_from_its_own_size_and_kept(asked, monkeypatch):
    model, accepted = fitted(asked, "offset", {"offset.f": 0.1})
    seen = sense_as(monkeypatch, "spring")
    tried = []

    def fit(task, candidates, start, near=None, least=None, **_):
        tried.append((candidates, start))
        assert near is None  # the model leaves structure, so that its optimum is no place to begin
        level = replace(model.refit.level, log_likelihood=model.refit.level.log_likelihood + 50)
        return replace(model, candidates=candidates, refit=replace(model.refit, level=level))

    monkeypatch.setattr(kinds, "try_fit", fit)
    (kept,), better = improve_kinds(asked, [accepted], model, ())
    (((candidate,), start),) = tried
    assert candidate.shape == {"kind": 1.0}
    (other,) = seen
    found = replace_effect(model.refit, accepted.candidate, other.S, model.refit.level)
    assert found.loss < 0
    assert start["offset.f"] == pytest.approx(found.size[0])
    assert better.candidates == (candidate,)
    assert kept.candidate == candidate
    assert kept.gain == accepted.gain

    monkeypatch.setattr(kinds, "try_fit", lambda *_, **__: None)  # it cannot be fitted
    assert improve_kinds(asked, [accepted], model, ()) == ((accepted,), model)


def test_a_kind_that_explains_less_is_not_refitted(asked, monkeypatch):
    model, accepted = fitted(asked, "spring", {"spring.k": 4.0})
    seen, level = sense_as(monkeypatch, "offset"), model.refit.level
    monkeypatch.setattr(kinds, "try_fit", None)
    assert improve_kinds(asked, [accepted], model, ()) == ((accepted,), model)
    (other,) = seen
    assert replace_effect(model.refit, accepted.candidate, other.S, level).loss > 100
    # The size that replaces an effect by itself is its own.
    own = Candidate(next(e for e in EFFECTS if e.name == "spring"), "joint", {})
    (same,) = compute_sensitivities(model.refit.point, (own,))
    found = replace_effect(model.refit, accepted.candidate, same.S, level)
    assert found.size[0] == pytest.approx(model.refit.point.values["spring.k"], rel=0.02)
    assert abs(found.loss) < 0.5


def with_gain(model, candidate, gain):
    """A model with an effect that is likelier by a gain of twice the log likelihood."""
    level = model.refit.level
    level = replace(level, log_likelihood=level.log_likelihood + gain / 2)
    return replace(model, candidates=(candidate,), refit=replace(model.refit, level=level))


@pytest.mark.parametrize(("gain", "first"), [(1.0, "spring"), (5.0, "offset"), (-5.0, "spring")])
def test_a_rival_is_compared_as_its_likeliest_kind(asked, monkeypatch, gain, first):
    """It comes first where it is likelier by more than is worth a bare mention."""
    model, _ = fitted(asked, "offset", {"offset.f": 0.1})
    best = with_gain(model, Candidate(of_kinds("spring"), "joint", {"kind": 0.0}), 300.0)
    sense_as(monkeypatch, "offset")  # as good to first order, in which nothing is believed here
    other = Candidate(of_kinds("offset"), "joint", {"kind": 1.0})
    refit = with_gain(model, other, 300.0 + gain)
    monkeypatch.setattr(kinds, "try_fit", lambda *_, **__: refit)
    refits = improve_rivals(asked, best, [model])
    assert refits[0].candidates[-1].effect.name == first
    assert refits[0].candidates == (best if first == "spring" else refit).candidates
    assert any(m is refit for m in refits)
    monkeypatch.setattr(kinds, "try_fit", lambda *_, **__: None)  # it cannot be fitted
    assert [
        m is n for m, n in zip(improve_rivals(asked, best, [model]), (best, model), strict=True)
    ]
