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


@pytest.mark.parametrize(("several", "chances"), [
    (False, "0.5 % of cases."),
    (True, "0.5 % for friction – Stribeck peak, all drives and 0.5 % for friction"),
])  # fmt: skip
def test_a_name_and_an_error_as_small_as_the_noise_do_not_contradict_each_other(several, chances):
    """The noise is estimated a little too high, and 5 % of the error are beyond chance."""
    made = found(several=several)
    proof = replace(made.named[0].proof, chance=0.005)
    noise = made.before.rms / 1.02
    close = replace(
        made, noise_rms=noise, share=0.9, named=tuple(replace(n, proof=proof) for n in made.named),
        unlogged=None, after=replace(made.after, rms=0.95**0.5 * made.before.rms),
    )  # fmt: skip
    said, text = " ".join(discovery_verdict(close)), discovery_text(close)
    assert (
        "The error before was 1.02 times the estimated noise, which may be estimated a little too"
        f" high: with {'them' if several else 'it'} the mean square falls by 5 %, which chance"
        f" would do in {chances}"
    ) in said
    assert "of the power above the noise" not in said
    assert "as small as the noise" not in text
    assert ", 1.02 times the estimated noise" in text.partition("before")[2].partition("after")[0]
    far = replace(close, noise_rms=made.before.rms / 1.2)
    assert "The error before was" not in " ".join(discovery_verdict(far))
    left = replace(close, unexplained=True, noise_rms=close.after.rms / 1.03)
    assert ", 1.03 times the estimated noise." in " ".join(discovery_verdict(left))


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
