"""A whole discovery on a slider, where INCA cannot be imported."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from discovery_cases import EFFECTS, STEP, base, record, slider, wander

from identification import InputError
from identification.discovery.confidence import name_effects
from identification.discovery.fitted_model import fit_model
from identification.discovery.search import SHORTEST, _explained, discover
from identification.discovery.selection.forward_selection import select_effect
from identification.discovery.selection.pruning import swap

ROOT = Path(__file__).parents[2]
ROBOT = {"mass": 2.2, "damping": 2.7, "x0": 0.01, "v0": 0.02}


def found(error=0.0, **sizes):
    error = error + wander(500, 0.03, 0.1, seed=8)
    return discover(
        base(), record(slider(**{**ROBOT, **sizes}), 500, seed=11, error=error), EFFECTS
    )


def test_a_hidden_spring_is_named_where_inca_cannot_be_imported():
    code = """
import sys
sys.modules["inca_mj"] = None
from test_discovery_whole import found
answer = found(**{"spring.k": 5.0})
(named,) = answer.named
value, std, unit = named.parameters["k"]
wrong = (
    answer.verdict != "named" or named.candidate.effect.name != "spring" or unit != "N/m"
    or abs(value - 5) > 4 * std or named.proof.t < 2 or named.proof.share < 0.8
)
sys.exit(wrong)
"""
    subprocess.run(
        [sys.executable, "-c", code], check=True, cwd=Path(__file__).parent,
        env={"PYTHONPATH": f"{ROOT}:{ROOT / 'tests' / 'cases'}"},
    )  # fmt: skip


def spied(monkeypatch, function):
    """The arguments of every call that a discovery makes of a function."""
    seen = []

    def spy(*arguments):
        seen.append(arguments)
        return function(*arguments)

    monkeypatch.setattr(f"identification.discovery.search.{function.__name__}", spy)
    return seen


@pytest.mark.parametrize(("name", "size"), [("offset.f", -0.8), ("rubbing.c", 1.0)])
def test_what_is_hidden_is_named_with_its_size(name, size):
    answer = found(**{name: size})
    assert answer.verdict == "named"
    (named,) = answer.named
    assert named.candidate.effect.name == name.split(".")[0]
    value, std, _ = named.parameters[name.split(".")[1]]
    assert value == pytest.approx(size, abs=4 * std)
    assert std < 0.2 * abs(size)
    assert 0.5 < named.confidence <= 0.95
    assert answer.after.rms < answer.before.rms


@pytest.mark.parametrize("k", [9.0, 15.0])
def test_what_is_too_strong_for_a_linear_score_is_at_least_not_misnamed(k):
    answer = found(**{"spring.k": k})
    assert answer.verdict in ("named", "unknown effect")
    assert {n.candidate.effect.name for n in answer.named} <= {"spring"}


def test_where_nothing_is_missing_it_says_so_and_what_it_would_have_seen():
    answer = found()
    assert answer.verdict == "nothing missing"
    assert not answer.named
    assert not answer.located
    assert {d.candidate.effect.name for d in answer.detectable} == {e.name for e in EFFECTS}
    assert all(0 < d.smallest < np.inf for d in answer.detectable)
    np.testing.assert_array_equal(answer.predicted_before, answer.predicted_after)


def test_of_two_effects_neither_is_the_others_rival(monkeypatch):
    seen = spied(monkeypatch, name_effects)
    answer = found(**{"offset.f": -0.8, "rubbing.c": 1.0})
    assert {n.candidate.effect.name for n in answer.named} == {"offset", "rubbing"}
    ((base_, (first, second), *rest),) = seen
    there = replace(first.step, candidates=second.step.candidates[-1:])
    again = name_effects(base_, (replace(first, others=(there,)), second), *rest)
    assert not again[0].rivals
    assert again[0].confidence > 0.5


def test_an_effect_gives_way_to_one_that_was_never_refitted_but_explains_more(monkeypatch):
    seen = spied(monkeypatch, swap)
    found(**{"offset.f": -0.8, "rubbing.c": 1.5})
    ((base_, log, nominal, kept, step, columns),) = seen
    right = {c.effect.name: c for c in step.candidates}
    spring = next(c.candidate for c in columns if c.candidate.effect.name == "spring")
    wrong = fit_model(base_, log, (right["rubbing"], spring), step.refit.point.values)
    alone = replace(kept[0].step, candidates=(spring,))
    first = replace(kept[0], step=alone, others=(), gain=10.0)
    second = next(a for a in kept if a.step.candidates[-1].effect.name == "rubbing")
    _, better = swap(base_, log, nominal, [first, second], wrong, columns)
    assert {c.effect.name for c in better.candidates} == {"offset", "rubbing"}
    assert better.criterion > wrong.criterion


def test_what_fitted_samples_want_and_unseen_ones_do_not_prove_is_neither_named_nor_nothing(
    monkeypatch,
):
    monkeypatch.setattr("identification.discovery.fitted_model.T", 1e9)
    answer = found(**{"offset.f": -0.8})
    assert answer.verdict == "unknown effect"
    assert not answer.named
    (clause,) = [clause for clause in answer.left if "not surely there" in clause]
    (tried,) = [t for t in answer.rejected if t.candidate.effect.name == "offset"]
    value, std, unit = tried.parameters["f"]
    assert abs(value + 0.8) < 4 * std
    assert unit == "N"
    assert "offset, joint, f = " in clause


@pytest.mark.parametrize("sizes", [{"spring.k": 5.0}, {}])
def test_an_effect_that_hides_as_an_error_of_the_inputs_is_refitted_although_its_score_is_luck(
    monkeypatch, sizes
):
    monkeypatch.setattr(
        "identification.discovery.selection.forward_selection.significant", lambda ranked: []
    )
    answer = found(**sizes)
    assert {f"{n.candidate.effect.name}.k" for n in answer.named} == set(sizes)
    assert answer.verdict == ("named" if sizes else "nothing missing")


def test_what_was_refitted_beside_a_name_and_not_believed_is_kept(monkeypatch):
    def spy(*arguments):
        if arguments[2].candidates:  # beside a first name nothing is proven
            monkeypatch.setattr("identification.discovery.fitted_model.T", 1e9)
        return select_effect(*arguments)

    monkeypatch.setattr("identification.discovery.search.select_effect", spy)
    answer = found(**{"offset.f": -0.8, "rubbing.c": 1.0})
    rejected = {t.candidate.effect.name: t for t in answer.rejected}
    assert "rubbing" in rejected
    assert rejected["rubbing"].gain > 0
    named = {n.candidate.effect.name for n in answer.named}
    assert "offset" in (named if answer.verdict == "named" else rejected)


@pytest.mark.parametrize("vibration", [0.0, 0.1])
def test_what_is_proven_and_too_small_to_matter_is_named_where_nothing_else_is_left(
    monkeypatch, vibration
):
    monkeypatch.setattr("identification.discovery.fitted_model.FALL", 1.0)  # nothing matters
    t = STEP * np.arange(500)[:, None]
    answer = found(error=vibration * np.sin(2 * np.pi * 2.3 * t), **{"offset.f": -0.3})
    assert {n.candidate.effect.name for n in answer.named} == (set() if vibration else {"offset"})


def test_a_gap_ends_at_the_sensors_where_input_errors_cannot_be_believed(monkeypatch):
    seen = spied(monkeypatch, swap)
    found(**{"offset.f": -0.8})
    ((_, _, nominal, _, step, _),) = seen
    level = step.refit.level
    loud = replace(level, noise=level.noise.scaled(100.0))
    more = replace(step.validation, disturbance=10 * nominal.validation.rms)
    calm = replace(step, unseen=more)
    wild = replace(calm, refit=replace(step.refit, level=loud))
    assert _explained(nominal, calm, random=True) == pytest.approx(1.0)
    assert _explained(nominal, calm, random=False) == _explained(nominal, wild, random=True)
    fall = 1 - (step.validation.rms / nominal.validation.rms) ** 2
    assert _explained(nominal, wild, random=True) == pytest.approx(fall, abs=1e-3)
    assert _explained(nominal, wild, random=True) < _explained(nominal, calm, random=True)


def test_base_parameters_at_the_end_of_what_is_plausible_are_something_left():
    answer = found(damping=12.0)  # of which 9 is plausible
    assert answer.verdict == "unknown effect"
    assert any(clause.startswith("damping at the end") for clause in answer.left)


def test_inputs_that_err_by_a_third_of_their_motion_are_no_noise():
    answer = found(error=wander(500, 0.3, 0.1, seed=3))
    assert answer.verdict != "nothing missing"
    assert any("% of their own motion" in clause for clause in answer.left)


def test_what_no_candidate_explains_is_unknown():
    t = STEP * np.arange(500)[:, None]
    answer = found(error=0.5 * np.sin(2 * np.pi * 2.3 * t))
    assert answer.verdict == "unknown effect"
    assert not answer.named
    assert answer.unexplained
    assert answer.located
    assert answer.left


def test_a_log_that_is_too_short_is_refused():
    with pytest.raises(InputError, match=f"at least {SHORTEST}"):
        discover(base(), record(slider(), 2 * SHORTEST - 10), EFFECTS)
