"""A whole discovery on a slider."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from discovery_cases import (
    EFFECTS,
    OPTIONS,
    STEP,
    disturbed,
    nominal_model,
    record,
    slider,
    wander,
)

from identification import InputError
from identification.discovery.findings.finding import FindingKind
from identification.innovations.discovery import discover
from identification.innovations.findings import find_untried_effect

OFFSET = {"offset.f": -0.8}


def found(error=0.0, options=OPTIONS, **values):
    return discover(nominal_model(), disturbed(error, **values), EFFECTS, options=options)


@cache
def found_offset():
    return found(**OFFSET)


def evidence_of(answer, kind):
    """The evidence of the findings of one kind."""
    return [f.evidence for f in answer.findings if f.kind is kind]


@pytest.mark.parametrize(("name", "size"), [*OFFSET.items(), ("rubbing.c", 1.0), ("spring.k", 5.0)])
def test_what_is_hidden_is_named_with_its_size(name, size):
    answer = found_offset() if name in OFFSET else found(**{name: size})
    assert answer.verdict == "named"
    (named,) = answer.named
    assert named.candidate.effect.name == name.split(".")[0]
    value, std, _ = named.parameters[name.split(".")[1]]
    assert value == pytest.approx(size, abs=4 * std)
    assert std < 0.2 * abs(size)
    assert 0.5 < named.confidence <= 0.95
    assert answer.after.rms < answer.before.rms


def test_where_nothing_is_missing_it_says_so_and_what_it_would_have_seen():
    answer = found()
    assert answer.verdict == "nothing missing"
    assert not answer.named
    assert not answer.located
    assert {d.candidate.effect.name for d in answer.detectable} == {e.name for e in EFFECTS}
    assert all(0 < d.smallest < np.inf for d in answer.detectable)
    np.testing.assert_array_equal(answer.run.before, answer.run.after)


def test_what_fitted_samples_want_and_unseen_ones_do_not_prove_is_neither_named_nor_nothing():
    answer = found(options=replace(OPTIONS, min_proof_t=1e9), **OFFSET)
    assert answer.verdict == "unknown effect"
    assert not answer.named
    (doubt,) = evidence_of(answer, FindingKind.DOUBTFUL_EFFECT)
    (offset,) = [r for r in answer.rejected if r.candidate.effect.name == "offset"]
    value, std, unit = offset.parameters["f"]
    assert abs(value + 0.8) < 4 * std
    assert unit == "N"
    assert doubt.rejected is offset


def test_what_the_time_limit_left_untried_is_not_nothing():
    """The noise model takes what is missing for an error of the inputs, and nothing is left."""
    hurried = replace(OPTIONS, max_minutes=0.0)
    answer = found(options=hurried, **OFFSET)
    assert answer.verdict == "unknown effect"
    (untried,) = evidence_of(answer, FindingKind.UNTRIED_EFFECT)
    assert untried.score.candidate.effect.name == "offset"
    tried = found(options=replace(OPTIONS, min_proof_t=1e9), **OFFSET)
    assert "offset" in {r.candidate.effect.name for r in tried.rejected}
    left = find_untried_effect(tried.scores, tried.rejected, OPTIONS)
    assert untried.score.candidate.key not in [f.evidence.score.candidate.key for f in left]
    silent = found(options=hurried)
    assert silent.verdict == "nothing missing"
    assert silent.cut_short


@pytest.mark.parametrize("vibration", [0.0, 0.1])
def test_what_is_proven_and_too_small_to_matter_is_named_where_nothing_else_is_left(vibration):
    error = vibration * np.sin(2 * np.pi * 2.3 * STEP * np.arange(500)[:, None])
    nothing_matters = replace(OPTIONS, min_fall=1.0)
    answer = found(error, nothing_matters, **{"offset.f": -0.3})
    assert {n.candidate.effect.name for n in answer.named} == (set() if vibration else {"offset"})


def test_base_parameters_at_the_end_of_what_is_plausible_are_something_left():
    answer = found(damping=12.0)  # of which 9 is plausible
    assert answer.verdict == "unknown effect"
    assert [e.parameters for e in evidence_of(answer, FindingKind.PARAMETERS_AT_LIMIT)] == [
        ("damping",)
    ]


def test_inputs_that_err_by_a_third_of_their_motion_are_no_noise():
    answer = found(error=wander(500, 0.3, 0.1, seed=3))
    assert answer.verdict != "nothing missing"
    (evidence,) = evidence_of(answer, FindingKind.LARGE_INPUT_ERROR)
    assert OPTIONS.allowed_input_error < evidence.share < 1


def test_what_no_candidate_explains_is_unknown():
    t = STEP * np.arange(500)[:, None]
    answer = found(error=0.5 * np.sin(2 * np.pi * 2.3 * t))
    assert answer.verdict == "unknown effect"
    assert not answer.named
    assert answer.unexplained
    assert answer.located
    assert answer.findings


def test_a_log_that_is_too_short_is_refused():
    least = OPTIONS.min_samples
    with pytest.raises(InputError, match=f"at least {least}"):
        discover(nominal_model(), record(slider(), 2 * least - 10), EFFECTS)
