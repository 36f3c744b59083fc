"""What the joints' torques say of the names of a search, and what they name first."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from elbow_cases import elbow
from torque_cases import planar, planar_record

from identification import read_robot
from identification.discovery.second_opinion import TorqueOpinion
from identification.effects.effect import Candidate
from identification.errors import InputError
from identification.prediction.scoring.screening import AND, at_several
from identification.report.torques.opinion_words import (
    AGAINST,
    _advice,
    _is_one_number,
    opinion_sentences,
)
from identification.robot import second_opinion
from identification.robot.second_opinion import ask_torques, opinions, with_torques
from identification.robot.suggestions import suggest
from identification.torques.evidence import Doubt as Untold
from identification.torques.scores import Doubt

AT = "joint elbow"


def test_torques_find_the_size_that_a_search_over_windows_has_found():
    _, found = elbow()
    (told,) = found.torques
    value, std, unit = told.sizes["f_c"]
    assert (told.name, told.where, unit) == ("coulomb_friction", AT, "N m")
    assert (told.is_named, told.is_proven, told.standing) == (True, True, "named")
    assert value == pytest.approx(0.15, abs=3 * std)  # the level with which the logs were made
    (sentence,) = opinion_sentences(found)
    assert "prove the same: friction – Coulomb, joint elbow, f_c = " in sentence


@pytest.mark.parametrize("far", [0.5, 2.8, 3.2])
def test_sizes_are_the_same_within_their_std_and_how_many_is_told(far):
    _, found = elbow()
    (told,) = found.torques
    value, std, unit = found.named[0].parameters["f_c"]
    size = value + far * np.hypot(std, 0.004), 0.004, unit
    (sentence,) = opinion_sentences(
        replace(found, torques=(replace(told, sizes={"f_c": size}),))
    )  # fmt: skip
    assert f"({far:g} std from the size over windows)" in sentence
    assert ("prove the same: friction" in sentence) == (far < 3)
    assert ("prove a friction there too, with another size: friction" in sentence) == (far > 3)


def test_no_size_is_the_same_that_nothing_can_be_compared_with():
    _, found = elbow()
    (told,) = found.torques
    (sentence,) = opinion_sentences(replace(found, torques=(replace(told, sizes={}),)))
    assert "the same" not in sentence
    assert "prove a friction there too: friction" in sentence


def test_a_friction_that_torques_know_is_told_where_the_search_names_nothing():
    robot, found = elbow()
    evidence = ask_torques(robot)
    lost = replace(found, named=(), verdict="unknown effect")
    (told,) = opinions(lost, evidence, robot)
    assert (told.name, told.where, told.standing) == ("coulomb_friction", AT, "named")
    said = " ".join(opinion_sentences(replace(lost, torques=(told,))))
    assert "coulomb friction, joint elbow, f_c = 0.1" in said
    level = "coulomb_friction.f_c@elbow"
    free = replace(robot, file=replace(robot.file, free=(*robot.file.free, level)))
    assert opinions(lost, evidence, free) == ()


def score(name, doubt="", where=AT):
    """A score whose key is that of an effect, with a size of 0.20 ± 0.01 N m."""
    missing = SimpleNamespace(
        key=(name, where), name=name, where=where, sizes=(f"{name}.k@elbow",), units=("N m",),
        phrase="", is_curve=False,
    )  # fmt: skip
    return SimpleNamespace(missing=missing, size=np.array([0.2]), std=np.array([0.01]), fall=0.5,
                           t=9.0, chance=0.002, doubt=doubt)  # fmt: skip


def told(names, scores=(), own=(), rivals=(), doubts=None):
    """A discovery of these names, and what torques say that add `own` to their fit."""
    robot, found = elbow()
    effects = {e.name: e for e in robot.candidates}
    (named,) = found.named
    every = [(n, AT) if isinstance(n, str) else n for n in names]
    named = [replace(named, candidate=Candidate(effects[n], where, {}),
                     parameters={"k": (0.2, 0.01, "N m")}) for n, where in every]  # fmt: skip
    doubts = doubts or {}
    fit = SimpleNamespace(inertial=0, names=(), fit=None)
    evidence = SimpleNamespace(
        scores=scores, added=own, found=own, rivals=rivals, doubts=doubts, friction=(), final=fit,
        named=[s for s in own if s.missing.key not in doubts],
        tried=[s for s in own if s.missing.key in doubts],
    )  # fmt: skip
    found = replace(found, named=tuple(named), verdict="named" if named else "unknown effect")
    return replace(found, torques=opinions(found, evidence, robot), torques_refused="")


STANDING = [
    # names of the search, scores of torques, what they add, what predicts as well; standings
    (["stiffness"], "", ["stiffness"], [], {"stiffness": "named"}),
    (["stiffness"], "", ["cogging"], [], {"stiffness": "alone", "cogging": "named"}),
    (["stiffness"], "", ["cogging"], ["stiffness"], {"stiffness": "alike", "cogging": "named"}),
    (["stiffness"], "chance", ["cogging"], [], {"stiffness": "unproven", "cogging": "named"}),
    (["stiffness"], "chance", [], [], {"stiffness": "unproven"}),
    (["stiffness"], "", [], [], {"stiffness": "unproven"}),  # more is left elsewhere with it
    ([], "", ["cogging"], [], {"cogging": "named"}),
    (["stiffness"], "", ["stiffness", "cogging"], [], {"stiffness": "named", "cogging": "named"}),
]


@pytest.mark.parametrize(("names", "doubt", "own", "rivals", "expected"), STANDING)
def test_each_effect_has_its_standing_and_only_what_torques_name_is_the_same(
    names, doubt, own, rivals, expected
):
    scores = [score("stiffness", doubt), score("cogging")]
    found = told(names, scores, [score(n) for n in own], [score(n) for n in rivals])
    assert {o.name: o.standing for o in found.torques} == expected
    assert {o.name for o in found.torques if o.is_named} == {*names}
    said = " ".join(opinion_sentences(found))
    assert ("prove the same" in said) == (expected.get("stiffness") == "named")
    only = [n for n in own if n not in names]
    assert ("only the torques name" in said or "do not tell it from" in said) == bool(only)
    assert ("first: cogging, joint elbow, k = 0.200" in said) == (own[:1] == ["cogging"])
    assert ("too: cogging, joint elbow" in said) == (own[1:] == ["cogging"])
    assert ("name no effect of their own; friction, which they" in said) == (not own)
    one_sided = bool(names) and bool(only) and names[0] not in own
    assert ("only the search over windows names spring" in said) == one_sided


def test_torques_that_tell_a_friction_do_not_say_that_they_name_nothing():
    """An offset was told with its size, and the next sentence said "They name no effect"."""
    found = told(["stiffness"], [score("stiffness", "small")])
    (o,) = [replace(o, fall=None, sizes={"f_0": (0.3, 0.2, "N m")}) for o in found.torques]
    first, last = opinion_sentences(replace(found, torques=(o,)))
    assert "f_0 = 0.30 ± 0.20 N m: it may be what the model has" in first
    assert last == (
        "They name no effect of their own; friction, which they always fit, does not count as one."
    )


def test_what_torques_tell_as_good_within_chance_has_its_own_size():
    scores = [score("cogging"), score("stiffness")]
    said = opinion_sentences(told([], scores, own=scores[:1], rivals=scores[1:]))[0]
    assert said.endswith("; within chance as good: stiffness, joint elbow, k = 0.200 ± 0.010 N m.")


def test_the_same_law_at_another_place_is_another_name():
    found = told([("mass_mismatch", "body forearm")], own=[score("mass_mismatch", where="body a")])
    said = " ".join(opinion_sentences(found))
    assert "name the same law at another place first: mass mismatch, body a" in said
    assert "cannot judge body – another mass, body forearm" in said
    assert "prove the same" not in said


def test_what_torques_cannot_tell_is_said_to_be_so():
    """An effect of a sensor has no column."""
    found = told([("encoder_scale", "sensor angle")], own=[score("stiffness")])
    first, second, last = opinion_sentences(found)
    assert "name another effect first: stiffness" in first
    assert second.startswith("They cannot judge sensor")
    assert last.startswith("So only the search over windows names sensor")


def test_an_effect_at_several_places_is_judged_at_each():
    found = told(["stiffness"], own=[score("stiffness"), score("stiffness", where="joint b")])
    (named,) = found.named
    effect = replace(named.candidate.effect, places={AT: "@elbow", "joint b": "@b"})
    both = at_several(effect, [AT, "joint b"])
    candidate = Candidate(both, AND.join([AT, "joint b"]), {})
    values = {"k@elbow": (0.2, 0.01, "N m"), "k@b": (0.9, 0.01, "N m")}
    found = replace(found, named=(replace(named, candidate=candidate, parameters=values),))
    known = [replace(o, is_named=True) for o in found.torques]
    first, second = opinion_sentences(replace(found, torques=tuple(known)))
    assert "prove the same: spring" in first
    assert "with another size: spring – pulls back to zero, joint b, k = 0.200" in second


@pytest.mark.parametrize("doubt", [*Doubt.__args__, "mass", "gain", "command", "beside"])
def test_each_doubt_of_torques_has_its_reason(doubt):
    """A fall of 99 % with t 28.8 was not proven, and nothing said that its sign was the reason."""
    found = told(["stiffness"], [score("stiffness", doubt)])
    (o,) = [replace(o, fall=0.99, t=28.8) for o in found.torques]
    said = opinion_sentences(replace(found, torques=(o,)))[0]
    assert "do not prove spring" in said
    assert AGAINST[doubt or "otherwise"].partition("{")[0] in said
    assert said.endswith("falls by 99 %, t 28.8.")
    assert ("chance of 0.2 %" in said) == (doubt == "chance")


def test_a_size_that_physics_forbids_is_no_name_of_torques():
    lost = score("mass_mismatch", where="body forearm")
    doubts: dict[tuple[str, str], Untold] = {lost.missing.key: "mass"}
    first, last = opinion_sentences(told([], own=[lost], doubts=doubts))
    assert "would name mass mismatch, body forearm, k = 0.200" in first
    assert "no drawing is so wrong" in first
    assert last == "So something is missing that acts like it."


GEAR = 'gear="5"', 'gear="5.88"'  # of the elbow's drive: its gain is 15 % lower than in the file


@pytest.fixture(scope="module")
def weak(tmp_path_factory):
    """A planar arm whose model believes in a gain that is too large, and what its torques say."""
    folder = tmp_path_factory.mktemp("weak")
    (folder / "arm.xml").write_text(planar().replace(*GEAR))
    (folder / "arm.toml").write_text(
        'model = "arm.xml"\nfree = ["joint/elbow.damping"]\nhorizon = 0.2\n'
        "trust = ['wiring', 'units', 'steps']\n"
    )
    records = [planar_record(k, name=f"r{k}") for k in (71, 72)]
    robot = read_robot(folder / "arm.toml", records[0], confirm=[records[1]])
    return robot, ask_torques(robot)


def test_a_gain_is_told_before_another_mass_with_the_number_to_free(weak):
    robot, evidence = weak
    _, found = elbow()
    mass = next(e for e in robot.candidates if e.name == "mass_mismatch")
    (named,) = found.named
    wrong = replace(named, candidate=Candidate(mass, "body fore", {}),
                    parameters={"dm": (0.3, 0.02, "kg")})  # fmt: skip
    found = with_torques(replace(found, named=(wrong,)), evidence, robot)
    gain = next(o for o in found.torques if o.is_first)
    assert (gain.name, gain.where, gain.free) == ("gain", "input t2", "actuator/t2.gear[0]")
    value, std, _ = gain.sizes["gamma"]
    assert value == pytest.approx(5 / 5.88 - 1, abs=max(0.01, 3 * std))
    said = " ".join(opinion_sentences(found))
    assert "name another effect first: input – another gain, input t2, gamma = -1" in said
    assert "only the search over windows names body – another mass, body fore" in said
    assert 'add "actuator/t2.gear[0]" to the list free' in said
    assert "prove the same" not in said


def test_torques_that_cannot_serve_say_why_and_where_nothing_is_missing_none_are_asked(
    monkeypatch,
):
    robot, found = elbow()
    evidence = ask_torques(robot)
    silent = replace(found, verdict="nothing missing", named=(), torques=(), torques_refused=None)
    assert with_torques(silent, evidence, robot) is silent
    assert opinion_sentences(silent) == []

    def refused(_):
        raise InputError("an actuator has a state of its own; log the torque: write a motor")

    monkeypatch.setattr(second_opinion, "fit_torques", refused)
    error = ask_torques(robot)
    assert isinstance(error, InputError)
    (said,) = opinion_sentences(with_torques(found, error, robot))
    assert said.endswith("give no second opinion: an actuator has a state of its own.")


def test_a_jump_that_torques_see_within_a_sample_takes_some_time_in_a_simulation():
    """With a width of zero its law divided by zero, and its score was whatever memory held."""
    robot, _ = elbow()
    jump = next(e for e in robot.candidates if e.name == "friction_jump")
    missing = SimpleNamespace(
        name=jump.name, where=next(iter(jump.places)), shape=(("t_j", 0.6, "s"), ("w", 0.0, "s")),
    )  # fmt: skip
    evidence = SimpleNamespace(added=[SimpleNamespace(missing=missing)], scores=(), friction=())
    (found,) = suggest(evidence, robot)
    width = next(s for s in jump.shapes if s.name == "w")
    assert found.shape["t_j"] == pytest.approx(0.6, rel=0.5)
    assert found.shape["w"] == width.lower > 0


def opinion(free, **sizes):
    """What only torques name, with some sizes of no unit, and the number that is to be freed."""
    told = {n: (v, 0.1 * abs(v), "") for n, v in sizes.items()}
    return TorqueOpinion(
        name="law", where=AT, sizes=told, fall=0.5, t=9.0, standing="own", is_named=False, free=free
    )  # fmt: skip


@pytest.mark.parametrize(("free", "sizes", "said"), [
    ("joint/elbow.armature", {"a": 0.02},
     '"joint/elbow.armature" (where the model has zero, with value = 0.02 in the table'
     ' [parameters."joint/elbow.armature"])'),
    ("joint/elbow.frictionloss", {"f_c": -0.1}, '"joint/elbow.frictionloss"'),
    ("actuator/m.gear[0]", {"s": 0.1}, '"actuator/m.gear[0]"'),
    ("cogging.a@elbow", {"a": 0.3},
     '"cogging.a@elbow" (with value = 0.3 in the table [parameters."cogging.a@elbow"])'),
])  # fmt: skip
def test_a_number_to_be_freed_has_a_value_to_begin_with(free, sizes, said):
    advice = _advice([opinion(free, **sizes)] * 2)  # what is told twice is one thing to do
    assert advice.startswith(f"To decide, add {said} to the list free of the robot's file, and")


def test_a_law_of_several_numbers_is_not_tested_by_one_of_them():
    assert _is_one_number(opinion("cogging.a@elbow", a=0.3))
    assert not _is_one_number(opinion("cogging.a@elbow", a=0.3, b=0.1))
    assert _is_one_number(opinion("body/fore.mass", M=0.3, z=0.1))
    assert not _is_one_number(opinion("", a=0.3))
    assert "identification torques" in _advice([])
