"""The verdict depends on names, kinds of findings and numbers, and on nothing else."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from discovery_cases import OPTIONS
from fake_discovery import LATE, REJECTED
from finding_cases import EVIDENCE_OF, FINDINGS

from identification.discovery.attempts import listed_once
from identification.discovery.findings.finding import Finding, FindingKind
from identification.innovations import verdict as verdicts
from identification.innovations.verdict import decide

NAMED = (SimpleNamespace(),)
ENOUGH, LITTLE = OPTIONS.min_explained_share + 0.1, OPTIONS.min_explained_share
REFUTING = (FindingKind.PARAMETERS_AT_LIMIT, FindingKind.OVERSIZED_EFFECT)


def verdict(named, findings, explained=ENOUGH, input_error=0.5, options=OPTIONS):
    model = SimpleNamespace(refit=SimpleNamespace(relative_input_error=input_error))
    return decide(named, findings, explained, model, options)


def test_without_findings_the_names_decide():
    assert verdict((), ()) == "nothing missing"
    assert verdict(NAMED, (), explained=0.0, input_error=9.0) == "named"


@pytest.mark.parametrize("finding", FINDINGS, ids=lambda f: f.kind)
def test_a_finding_without_a_name_is_an_unknown_effect_whatever_it_is(finding):
    assert verdict((), (finding,)) == "unknown effect"


LEFT = [f for f in FINDINGS if f.kind is not FindingKind.UNTRIED_EFFECT]


@pytest.mark.parametrize("finding", LEFT, ids=lambda f: f.kind)
def test_a_name_stands_beside_a_finding_where_it_explains_most_of_a_believed_model(
    finding, monkeypatch
):
    right = "unknown effect" if finding.kind in REFUTING else "named"
    assert verdict(NAMED, (finding,)) == right
    assert verdict(NAMED, (finding,), explained=LITTLE) == "unknown effect"
    assert verdict(NAMED, (finding,), input_error=1.0) == "unknown effect"
    more = replace(OPTIONS, min_explained_share=0.0)
    monkeypatch.setattr(verdicts, "MAX_BELIEVED_INPUT_ERROR", 2.0)
    assert verdict(NAMED, (finding,), LITTLE, 1.0, more) == right


def test_a_proven_name_stands_beside_what_the_time_limit_left_untried():
    untried = Finding(FindingKind.UNTRIED_EFFECT, EVIDENCE_OF[FindingKind.UNTRIED_EFFECT])
    assert verdict(NAMED, (untried,), explained=LITTLE) == "named"


def test_evidence_of_another_kind_is_no_finding():
    with pytest.raises(TypeError, match="RobotChange"):
        Finding(FindingKind.SPECTRAL_LINE, EVIDENCE_OF[FindingKind.ROBOT_CHANGE])


def late(tau, std=1e-4, where="all drives", letter="tau"):
    """A delay that was refitted."""
    there = replace(LATE, where=where, probe=tau / 1e-3)
    return replace(REJECTED, candidate=there, parameters={letter: (tau, std, "s")})


def test_two_searches_with_one_end_are_one():
    best, again, other = late(2.5e-4), late(2.51e-4), late(9e-4)
    assert listed_once([best, again, other, again]) == (best, other)
    assert listed_once([]) == ()


@pytest.mark.parametrize("different", [{"tau": 4e-4}, {"tau": 2.5e-4, "letter": "t"}])
def test_another_end_another_place_and_another_number_are_listed(different):
    both = (late(2.5e-4), late(**different))
    assert listed_once(both) == both


@pytest.mark.parametrize("std", [float("nan"), float("inf")])
def test_values_without_a_std_are_the_same_where_their_digits_are(std):
    a, b, c = late(2.5e-4, std), late(2.50001e-4, std), late(2.52e-4, std)
    assert listed_once([a, b, c]) == (a, c)
