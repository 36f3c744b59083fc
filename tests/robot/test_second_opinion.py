"""What the joints' torques say of the names of a search."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from elbow_cases import elbow

from identification.errors import InputError
from identification.report.opinion_words import opinion_sentences
from identification.robot import second_opinion
from identification.robot.second_opinion import ask_torques, opinions, suggest, with_torques


def test_torques_find_the_size_that_a_search_over_windows_has_found():
    _, found = elbow()
    (told,) = found.torques
    value, std, unit = told.sizes["f_c"]
    assert (told.name, told.where, unit) == ("coulomb_friction", "joint elbow", "N m")
    assert told.is_named
    assert told.is_proven
    assert value == pytest.approx(0.15, abs=3 * std)  # the level with which the logs were made
    (sentence,) = opinion_sentences(found)
    assert "prove the same: friction – Coulomb, joint elbow, f_c = " in sentence


def test_another_size_of_torques_is_told_as_such():
    _, found = elbow()
    (told,) = found.torques
    value, std, unit = found.named[0].parameters["f_c"]
    for far, other in ((2.8, False), (3.2, True)):
        size = value + far * np.hypot(std, 0.004), 0.004, unit
        moved = replace(found, torques=(replace(told, sizes={"f_c": size}),))
        (sentence,) = opinion_sentences(moved)
        assert ("prove a friction there too, with another size: friction" in sentence) == other
        assert ("prove the same: " in sentence) != other


def score(name, is_proven=True, where="joint a"):
    missing = SimpleNamespace(key=(name, where), name=name, where=where, sizes=(f"{name}.k@a",),
                              units=("N m",))  # fmt: skip
    return SimpleNamespace(
        missing=missing, size=np.array([0.2]), std=np.array([0.01]), fall=0.5,
        t=9.0 if is_proven else 0.4, is_proven=is_proven,
    )  # fmt: skip


def asked(names, scores=(), own=()):
    """What torques with these scores, which name `own` themselves, say of the names."""
    fit = SimpleNamespace(inertial=0, names=(), fit=None)
    evidence = SimpleNamespace(scores=scores, named=own, friction=(), final=fit)
    named = [SimpleNamespace(candidate=SimpleNamespace(key=(n, "joint a"))) for n in names]
    told = opinions(SimpleNamespace(named=named), evidence)
    return [(o.name, o.is_proven, o.is_named) for o in told]


def test_an_opinion_is_given_on_names_that_torques_can_tell():
    law = score("stiffness")
    assert asked(["stiffness"], [law], [law]) == [("stiffness", True, True)]
    assert asked(["encoder_lag"], [law], [law]) == []  # of a sensor: no contradiction
    assert asked(["stiffness", "encoder_lag"], [law], [law]) == [("stiffness", True, True)]


def test_another_effect_is_told_where_torques_prove_none_of_the_names():
    law, other = score("stiffness", is_proven=False), score("cogging")
    assert asked(["stiffness"], [other, law], [other]) == [
        ("stiffness", False, True), ("cogging", True, False),
    ]  # fmt: skip
    assert asked(["stiffness"], [other, law]) == [("stiffness", False, True)]
    assert asked([], [other], [other]) == [("cogging", True, False)]


def test_torques_that_tell_nothing_are_no_opinion_and_where_nothing_is_missing_none_is_given(
    monkeypatch,
):
    robot, found = elbow()
    evidence = ask_torques(robot)
    silent = replace(found, verdict="nothing missing", named=())
    assert with_torques(silent, evidence) is silent
    assert with_torques(found, None) is found

    def refused(_):
        raise InputError("a drive has a state")

    monkeypatch.setattr(second_opinion, "fit_torques", refused)
    assert ask_torques(robot) is None


def test_a_jump_that_torques_see_within_a_sample_takes_some_time_in_a_simulation():
    """With a width of zero its law divided by zero, and its score was whatever memory held."""
    robot, _ = elbow()
    jump = next(e for e in robot.candidates if e.name == "friction_jump")
    missing = SimpleNamespace(
        name=jump.name, where=next(iter(jump.places)), shape=(("t_j", 0.6, "s"), ("w", 0.0, "s")),
    )  # fmt: skip
    evidence = SimpleNamespace(named=[SimpleNamespace(missing=missing)], scores=(), friction=())
    (found,) = suggest(evidence, robot)
    width = next(s for s in jump.shapes if s.name == "w")
    assert found.shape["t_j"] == pytest.approx(0.6, rel=0.5)
    assert found.shape["w"] == width.lower > 0
