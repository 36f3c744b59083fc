"""The verdict depends on names, kinds of findings and numbers, and on nothing else."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from discovery_cases import OPTIONS
from finding_cases import EVIDENCE_OF, FINDINGS

from identification.discovery import verdict as verdicts
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.verdict import decide
from identification.effects.effect import Candidate, Effect, Shape, Size

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


def test_evidence_of_another_kind_is_no_finding():
    with pytest.raises(TypeError, match="RobotChange"):
        Finding(FindingKind.SPECTRAL_LINE, EVIDENCE_OF[FindingKind.ROBOT_CHANGE])


def test_a_size_beyond_belief_is_compared_with_a_name_as_it_was_found(monkeypatch):
    """A jump's first score is a small one: it was scored at the times of a grid."""
    size, when = (
        Size("c", "", 1.0, 0.1, about=""),
        Shape("t_s", "s", (1.0, 8.0), 0.1, 9.0, about=""),
    )
    jump = Effect("jump", "", (size,), (when,), places={"joint": ""}, phrase="")
    huge = Effect("huge", "", (size,), places={"joint": ""}, phrase="")

    def score(effect, gain, value, shape):
        candidate, chance = (
            Candidate(effect, "joint", shape),
            {"p_value": 0.0, "block_p_value": 0.0},
        )
        return SimpleNamespace(candidate=candidate, gain=gain, size=np.array([value]), **chance)

    scored = (score(huge, 60.0, 1e3, {}), score(jump, 10.0, 0.5, {"t_s": 1.0}))
    state = SimpleNamespace(
        task=SimpleNamespace(options=OPTIONS), nominal_scores=scored,
        nominal=SimpleNamespace(refit=SimpleNamespace(point="nominal")),
        accepted=[SimpleNamespace(candidate=scored[1].candidate)],
        model=SimpleNamespace(with_fitted_shape=lambda c: replace(c, shape={"t_s": 3.4})),
    )  # fmt: skip
    asked = []

    def rescored(own_gain):
        def at(nominal, own, options):
            asked.extend(own)
            return tuple(score(c.effect, own_gain, 0.5, c.shape) for c in own)

        monkeypatch.setattr(verdicts, "compute_sensitivities", lambda point, some: some)
        monkeypatch.setattr(verdicts, "score_candidates", at)
        return verdicts._find_oversized(state, ["jump"])

    assert rescored(900.0) == ()
    assert [c.shape for c in asked] == [{"t_s": 3.4}]
    (finding,) = rescored(20.0)
    assert finding.evidence.score is scored[0]
