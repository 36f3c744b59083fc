"""The verdict depends on names, kinds of findings and numbers, and on nothing else."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from discovery_cases import OPTIONS
from finding_cases import EVIDENCE_OF, FINDINGS

from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.verdict import decide

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


@pytest.mark.parametrize("finding", FINDINGS, ids=lambda f: f.kind)
def test_a_name_stands_beside_a_finding_where_it_explains_most_of_a_believed_model(finding):
    right = "unknown effect" if finding.kind in REFUTING else "named"
    assert verdict(NAMED, (finding,)) == right
    assert verdict(NAMED, (finding,), explained=LITTLE) == "unknown effect"
    assert verdict(NAMED, (finding,), input_error=1.0) == "unknown effect"
    more = replace(OPTIONS, min_explained_share=0.0, max_named_input_error=2.0)
    assert verdict(NAMED, (finding,), LITTLE, 1.0, more) == right


def test_evidence_of_another_kind_is_no_finding():
    with pytest.raises(TypeError, match="RobotChange"):
        Finding(FindingKind.SPECTRAL_LINE, EVIDENCE_OF[FindingKind.ROBOT_CHANGE])
