"""Each outcome has its paragraph, and no two can be taken for each other."""

from dataclasses import replace
from math import hypot

import pytest
from fake_discovery import DRIVE_3, NOISE, REJECTED, SLOW, WORSE, found

from identification.discovery.attempts import Failed
from identification.discovery.effect_results import Outside
from identification.report.discovery_json import discovery_to_json
from identification.report.discovery_report import discovery_text
from identification.report.discovery_verdict import discovery_verdict, further_sentences
from identification.report.effect_sections import tried_section
from identification.report.effect_words import DOUBTS, describe_effect, describe_sizes
from identification.report.finding_words import describe_finding, sentence
from identification.report.named_words import nearest_law


def test_a_named_effect_is_said_with_size_place_confidence_and_proof():
    said = discovery_verdict(found())
    assert said[0] == (
        "Missing from the model: friction – Stribeck peak, all drives, f_s = 4.12 ± 0.21 mN m"
        " (height of the peak, but for tanh(βω)), v_s = 1.88 ± 0.10 rad/s"
        " (rate at which it has fallen to 1/e);"
        " confidence 97 %."
        " Less likely: friction – Coulomb part differs at one drive, drive 3 (2 %)."
    )
    alone = replace(found().named[0], rivals=(), compared=0, confidence=0.9)
    alone = replace(found(), named=(alone,))
    basis = "no other came near enough to be refitted in its place"
    assert basis not in " ".join(discovery_verdict(alone))
    assert basis in further_sentences(alone)[0]
    assert further_sentences(found())[0].endswith("1 rival was refitted in its place.")
    assert (
        "On data that the fit has not seen, but on which the search has decided, the error"
        in said[1]
    )
    assert said[1].count("mrad") == 3
    assert said[2] == "Nothing else is missing that this log shows."
    assert further_sentences(found())[-1] == (
        "The fitted noise may still hide effects up to these sizes (the size that the log seems to"
        " show, possibly by luck, plus 1.96 std): "
        "friction – Coulomb part differs at one drive, drive 3, delta 0.600 % (it"
        " would be 30 % of what counts as errors of the inputs)."
    )
    assert len(said) == 3
    assert len(discovery_verdict(replace(found(), hidden=()))) == 2


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


def test_look_alikes_are_a_set():
    first = discovery_verdict(found(one_of=True))[0]
    assert first.startswith("Missing from the model is one of these, which the data do not surely")
    assert "Stribeck peak, all drives (61 %)" in first
    assert "drive 3 (36 %)" in first
    assert "together 97 %" in first


def test_what_is_left_is_said_last():
    said = discovery_verdict(found(unexplained=True))
    assert said[-1].startswith(
        "Something is left that no known effect surely explains: with the named effect in"
    )
    assert said[-1].endswith(sentence(describe_finding(DRIVE_3)))
    proven = replace(REJECTED, bic_gain=50.0, proof=replace(REJECTED.proof, t=8.3, chance=1e-6))
    said = discovery_verdict(replace(found(unexplained=True), nearest=proven))
    nearest = f"The nearest candidate is {describe_effect(REJECTED.candidate)}: with it each next"
    assert nearest in said[-1]
    rise = -100 * REJECTED.proof.fall
    assert f"the mean square of the free run rises by {rise:.2g} %" in said[-1]
    rising = replace(proven, proof=replace(proven.proof, fall=-0.187))
    said = discovery_verdict(replace(found(unexplained=True), nearest=rising))
    assert "the mean square of the free run rises by 19 %" in said[-1]
    assert "(t = 8.3, chance 1e-06 by flips of signs)" in said[-1]


def test_two_effects_are_two_sentences():
    said = discovery_verdict(found(several=True))
    assert said[1].startswith("Missing too: ")
    assert "delta = 20.0 ± 3.0 %" in said[1]
    several = found(several=True)
    tied = replace(several.named[1], one_of=True, rivals=several.named[0].rivals)
    said = discovery_verdict(replace(several, named=(several.named[0], tied)))
    assert said[1].startswith("Missing too is one of these")


def test_nothing_missing_says_what_would_have_been_seen():
    (said,) = discovery_verdict(found("nothing missing"))
    assert said.startswith("Nothing is missing: ")
    assert "Stribeck peak, all drives, f_s 200 µN m" in said
    assert (
        "It would not show these effects at any plausible size: motor – current comes late." in said
    )


def test_an_unknown_effect_is_not_named():
    (said,) = discovery_verdict(found("unknown effect"))
    assert said.startswith("Something is missing that none of the 3 known effects surely explains")
    assert sentence(describe_finding(SLOW)) in said
    assert "Stribeck" not in said


@pytest.mark.parametrize("verdict", ["named", "nothing missing", "unknown effect"])
def test_text_begins_with_the_verdict_and_holds_no_nan(verdict):
    outcome = found(verdict)
    text = discovery_text(outcome)
    assert text.startswith(discovery_verdict(outcome)[0])
    assert "nan" not in text
    (b_v,) = [line for line in text.splitlines() if line.startswith("  viscous friction b_v ")]
    assert "240 ± 5 µN m s/rad" in b_v
    assert ("+ friction – Stribeck peak" in text) == (verdict == "named")


def test_what_was_tried_and_not_believed_is_told_with_its_size_and_why():
    text = discovery_text(found())
    told = text[text.index("tried beside what is named, and not believed:") :]
    assert told.splitlines()[1] == (
        "  motor – current comes late, all drives: tau = 250 ± 100 µs (delay); on unseen data the"
        " mean square rises by 0.2 % (t = -0.7, chance 0.75);"
        " it does not predict unseen data better"
    )
    (section,) = tried_section(found())
    assert [*section.table.rows] == [
        ("motor – current comes late, all drives", "tau = 250 ± 100 µs (delay)",
         "rises by 0.2 %", "0.75", "it does not predict unseen data better"),
    ]  # fmt: skip
    assert tried_section(found("nothing missing")) == []
    (kept,) = discovery_to_json(found())["rejected"]
    assert kept["parameters"]["tau"] == {"value": 2.5e-4, "std": 1e-4, "unit": "s"}
    assert kept["proof"]["fall"] == -0.002
    said = discovery_text(found("nothing missing"))
    assert "not believed" not in said
    (line,) = [x for x in said.splitlines() if x.startswith("error on unseen data:")]
    assert "times the noise" in line  # one number is neither before nor after


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"doubt": "chance"}, DOUBTS["chance"]),
        ({"bic_gain": -1.0}, DOUBTS["numbers"]),
        ({"proof": replace(WORSE, fall=0.5)}, ""),
        ({"proof": replace(WORSE, fall=1e-4)}, "it removes too little of the error to matter"),
        ({"doubt": "differ", "proof": replace(WORSE, disagrees=("b",))}, "(worse: b)"),
        ({"outside": Outside("speed", "joint hip", 0.7)}, "likelier is some force that follows"),
    ],
)
def test_what_was_tried_has_one_line_with_the_reason(change, why):
    tried = replace(found(), rejected=(replace(REJECTED, **change),))
    (section,) = tried_section(tried)
    ((*_, said),) = section.table.rows
    assert why in said
    assert bool(said) == bool(why)
    (line,) = section.plain.splitlines()[1:]
    assert line.endswith(f"; {said}" if said else "chance 0.75)")


def test_what_failed_or_was_left_is_a_row_too():
    late, rubbing = Failed("delay", "drive 1", True, ""), Failed("rubbing", "", False, "no", True)
    (section,) = tried_section(replace(found(), rejected=(), failed=(late, rubbing)))
    assert [(row[0], row[-1]) for row in section.table.rows] == [
        ("motor – current comes late, drive 1", "tried, and its simulation diverged"),
        ("rubbing", "left by the search: no"),
    ]


def test_beside_a_curve_the_listed_law_that_comes_nearest_is_told():
    """That law was left for the curve at its own joint; others are not told there."""
    proof = replace(REJECTED.proof, fall=0.59)
    law = replace(REJECTED, doubt="drawn", evidence=5.0, proof=proof)
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
