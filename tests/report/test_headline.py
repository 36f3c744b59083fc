"""The head of a report: the answer in large letters, with the numbers that the verdict says."""

from dataclasses import replace
from xml.etree import ElementTree

import pytest
from elbow_cases import elbow
from fake_discovery import found

from identification import fit
from identification.quantities import quantity
from identification.report.discovery_headline import discovery_headline
from identification.report.discovery_verdict import discovery_verdict
from identification.report.effect_words import gathered
from identification.report.fit_headline import fit_headline
from identification.report.headline import error_tile
from identification.report.page import Section, Table, write_report
from identification.shares import percent


def plain(words):
    return words.replace("\u00a0", " ")


def test_a_name_has_its_place_its_size_its_confidence_and_the_errors():
    answer = found()
    (one,) = discovery_headline(answer).answers
    assert (one.name, one.place) == ("Friction – Stribeck peak", "all drives")
    size, confidence, error = one.tiles
    value, std, unit = answer.named[0].parameters["f_s"]
    assert plain(size.value) == quantity(value, std, unit)
    assert confidence.value == percent(answer.named[0].confidence)
    assert plain(error.value) == "63 → 0.53 mrad"
    assert error.note == "the noise is 0.50 mrad"
    said = " ".join(discovery_verdict(answer))
    assert plain(size.value) in said
    assert f"confidence {confidence.value}" in said


def test_a_set_tells_its_members_and_what_they_are_worth_together():
    head = discovery_headline(found(one_of=True))
    assert head.lead == "Missing from the model is one of these"
    (one,) = head.answers
    assert one.place == "all drives; or friction – Coulomb part differs at one drive, drive 3"
    assert one.tiles[1].value == "97 %"
    assert one.tiles[1].note == "61 % for the first alone"


def test_each_of_several_names_has_its_line_and_the_error_stands_once():
    one, two = discovery_headline(found(several=True)).answers
    assert (two.name, two.place) == ("Friction – Coulomb part differs at one drive", "drive 3")
    assert [len(a.tiles) for a in (one, two)] == [3, 2]


@pytest.mark.parametrize(
    ("verdict", "name"),
    [("nothing missing", "Nothing is missing"), ("unknown effect", "Something is missing")],
)
def test_without_a_name_the_answer_says_so(verdict, name):
    (one,) = discovery_headline(found(verdict)).answers
    assert one.name == name
    assert 2 <= len(one.tiles) <= 3


def test_a_clean_bill_is_given_to_noise_alone():
    loud = replace(found("nothing missing"), unlogged=None, input_error=0.5)
    assert discovery_headline(loud).answers[0].name == "No effect is named"


def test_a_fit_says_whether_its_values_can_be_used():
    fitted = fit(elbow()[0])
    (one,) = fit_headline(fitted.found, {"mass": "kg", "damping": "N m s/rad"}).answers
    assert one.name == "Fitted, and something is missing"
    mass, damping, error = one.tiles
    assert plain(mass.value) == quantity(fitted.values["mass"], fitted.std["mass"], "kg")
    assert plain(damping.note) == "began at 0.300 N m s/rad"
    before, after = fitted.found.unseen_rms
    assert plain(error.value) == f"{1e3 * before:.1f} → {1e3 * after:.1f} mrad"


def test_errors_of_several_units_are_told_apart():
    tile = error_tile(
        {"rad": 2e-3, "m": 4e-3}, {"rad": 1e-3, "m": 3e-3}, {"rad": 5e-4, "m": 1e-3}, "error"
    )
    each = plain(tile.value).split("; ")
    assert len(each) == 2
    assert all(" → " in one for one in each)
    assert [word in one for one, word in zip(each, ("angles", "slides"), strict=True)] == [True] * 2


def test_parameters_of_many_parts_are_one():
    words = [f"friction smoothness β, drive {k}" for k in range(1, 9)]
    names = ["m", "b@3", "b@1"]
    assert gathered([*words, "mass m"]) == ["friction smoothness β of drives 1 to 8", "mass m"]
    assert gathered(names) == ["m", "b@1, 3"]
    assert gathered(words[:1]) == words[:1]


def test_no_section_stands_empty_and_what_stands_above_stands_once(tmp_path):
    from matplotlib.figure import Figure

    figures = (("A line", Figure((5.0, 3.0))),)
    sections = [
        Section("empty"), Section("drawn above", figures=figures, first=1),
        Section("told", "Words."), Section("no rows", table=Table(("a",), ())),
        Section("drawn here", figures=figures),
    ]  # fmt: skip
    page = write_report(tmp_path / "r.html", "t", ["Verdict."], sections, further=["More."])
    root = ElementTree.fromstring(page.read_text(encoding="utf-8").replace("<!DOCTYPE html>", ""))
    assert [e.text for e in root.iter("h2")] == ["told", "drawn here"]
    assert len([*root.iter("figure")]) == 2
    (fold,) = root.iter("details")
    assert "More." in "".join(fold.itertext())
    text = "".join(root.itertext())
    assert text.index("A line") < text.index("Verdict.")
