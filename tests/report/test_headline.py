"""The head of a report: the answer in large letters, with the numbers that the verdict says."""

from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
from elbow_cases import fitted

from identification.quantities import quantity
from identification.report.fit.headline import fit_headline
from identification.report.fit.verdict import ABOVE, answer_sentence
from identification.report.page.page import Section, Table, write_report


def plain(words):
    return words.replace("\u00a0", " ")


def test_a_fit_says_whether_its_values_can_be_used():
    fit = fitted()
    (one,) = fit_headline(fit.found, {"mass": "kg", "damping": "N m s/rad"}).answers
    assert one.name == "Fitted, and something is missing"
    mass, damping, error = one.tiles
    assert plain(mass.value) == quantity(fit.values["mass"], fit.std["mass"], "kg")
    assert plain(damping.note) == "began at 0.300 N m s/rad"
    before, after = fit.found.unseen_rms
    assert plain(error.value) == f"{1e3 * before:.1f} → {1e3 * after:.1f} mrad"


@pytest.mark.parametrize("ratio", [0.9, 1.1, 1.4, 20.0, np.inf])
def test_the_first_sentence_of_a_fit_says_whether_the_model_explains_the_log(ratio):
    log = SimpleNamespace(name="third")
    found = SimpleNamespace(noise_by_unit={"m": 2.0}, unseen_by_unit={"m": 2.0 * ratio},
                            records=[SimpleNamespace(role="confirm", log=log)],
                            model=SimpleNamespace(finer=SimpleNamespace(left=1.0)))  # fmt: skip
    explained, missing = ("explains the log", "is missing")
    said = answer_sentence(found)
    assert (explained in said, missing in said) == (ratio <= ABOVE, ratio > ABOVE)
    assert "its error on unseen data (third) is " in said
    # what the first values explain better is not called an explanation
    assert explained not in answer_sentence(found, is_better=False)
    found.noise_by_unit = {"m": 0.0}
    assert "not known" in answer_sentence(found)


def test_the_sentence_comes_before_all_else_that_is_said_of_a_fit():
    fit = fitted()
    verdict = fit.to_dict()["verdict"]
    assert verdict[0] == answer_sentence(fit.found)
    assert any(" windows of 0.3 s of first leave " in s for s in verdict)  # not of the same record


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
