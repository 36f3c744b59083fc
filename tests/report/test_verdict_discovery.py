"""Each outcome has its paragraph, and no two can be taken for each other."""

from dataclasses import replace
from math import hypot
from types import SimpleNamespace

import pytest
from fake_discovery import NOISE, REJECTED, found

from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.findings.records_evidence import UnprovenEffect
from identification.report.discovery.named_words import nearest_law
from identification.report.discovery.report import discovery_text
from identification.report.discovery.verdict import _any_forces, discovery_verdict
from identification.report.words.effects import describe_effect, describe_rejected, describe_sizes


@pytest.mark.parametrize(
    ("verdict", "input_error", "counts"),
    [("named", 1e-3, True), ("nothing missing", 1e-3, True), ("named", 1.0, False),
     ("unknown effect", 1e-3, False)],
)  # fmt: skip
def test_input_errors_that_cannot_be_believed_are_no_noise(verdict, input_error, counts):
    disturbed = replace(found(verdict), disturbance_rms=0.05, input_error=input_error)
    assert disturbed.floor_rms == pytest.approx(hypot(NOISE, 0.05) if counts else NOISE)


def test_a_sensor_is_called_noisy_beside_those_of_its_unit_only():
    names = [*found().outputs]
    alike = dict.fromkeys(names, NOISE)
    assert len(discovery_verdict(replace(found(), noise_by_output=alike))) == 3
    loud = discovery_verdict(replace(found(), noise_by_output={**alike, names[1]: 2.4 * NOISE}))
    assert len(loud) == 4
    assert loud[-1].startswith(f"The noise of {names[1]} is ")
    assert "2.4 times that of the other outputs of its unit" in loud[-1]
    missing = replace(found("unknown effect"), noise_by_output={**alike, names[1]: 2.4 * NOISE})
    assert "The noise of" not in " ".join(discovery_verdict(missing))


@pytest.mark.parametrize("verdict", ["named", "nothing missing", "unknown effect"])
def test_text_begins_with_the_verdict_and_holds_no_nan(verdict):
    outcome = found(verdict)
    text = discovery_text(outcome)
    assert text.startswith(discovery_verdict(outcome)[0])
    assert "nan" not in text
    (b_v,) = [line for line in text.splitlines() if line.startswith("  viscous friction b_v ")]
    assert "240 ± 5 µN m s/rad" in b_v
    assert ("+ friction – Stribeck peak" in text) == (verdict == "named")


def test_beside_a_curve_the_listed_law_that_comes_nearest_is_told():
    """That law was left for the curve at its own joint; others are not told there."""
    proof = replace(REJECTED.proof, fall=0.59)
    law = replace(REJECTED, doubt="smooth", evidence=5.0, proof=proof)
    curve = replace(found().named[0], candidate=replace(
        law.candidate, effect=replace(law.candidate.effect, name="curve_speed")))  # fmt: skip
    behind = replace(law, evidence=4.0, parameters={})
    answer = replace(found(), named=(curve,), rejected=(behind, law))
    said = nearest_law(answer, curve)
    assert describe_sizes(law) in said
    assert f"mean square falls by {100 * law.proof.told.fall:.0f} %" in said
    elsewhere = replace(law, candidate=replace(law.candidate, where="joint of another"))
    for rejected in ((), (REJECTED,), (elsewhere,)):
        assert nearest_law(replace(answer, rejected=rejected), curve) == ""
    assert nearest_law(answer, found().named[0]) == ""


def test_of_an_unknown_effect_the_likeliest_that_was_tried_is_told_once_with_its_size():
    """One number tells its gain wherever it stands, and a chance is that of all that were tried."""
    proof = replace(REJECTED.proof, fall=0.59)
    best = replace(REJECTED, doubt="chance", luck=0.2, evidence=5.0, proof=proof)
    other = replace(best, evidence=9.0, proof=replace(proof, fall=-0.1))
    c = best.candidate
    finding = Finding(
        FindingKind.UNPROVEN_EFFECT,
        UnprovenEffect(*c.key[:1], c.effect.phrase, c.where, 0.59, proof.t, "chance", 0.2),
    )
    answer = replace(found("unknown effect"), rejected=(best, other), findings=(finding,))
    said = " ".join(discovery_verdict(answer))
    assert f"The likeliest is {describe_rejected(best, answer)}." in said
    assert said.count(describe_effect(c)) + said.count(describe_effect(c).capitalize()) == 1
    assert "chance 0.2, all effects that were tried counted" in said


@pytest.mark.parametrize(("shares", "told"), [
    ({"joint b": 0.18, "joint a": 0.03}, ["18 % at joint b", "3 % at joint a"]),
    ({"joint b": 0.18, "joint a": 0.0}, ["18 % at joint b"]),
    ({"joint b": 0.04}, ["No smooth force", "the best one 4 %"]),
    ({"joint b": 0.001}, ["No smooth force", "the best one less than 1 %"]),
    ({"joint b": 0.0}, ["No smooth force"]),
])  # fmt: skip
def test_the_joint_with_the_largest_share_comes_first(shares, told):
    said = SimpleNamespace(smooth_by_joint=shares)
    (sentence,) = _any_forces(said, ())
    places = [sentence.index(words) for words in told]
    assert places == sorted(places)
    assert ("joint a" in sentence) == (shares.get("joint a", 0) > 0)
    assert _any_forces(said, [SimpleNamespace(fall=0.5)]) == []  # a finer force explains more
    assert _any_forces(said, [SimpleNamespace(fall=0.0)]) == [sentence]
