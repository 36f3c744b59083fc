"""Sizes that physics forbids are told as tried, whichever evidence speaks for them."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from joint_cases import ARM, arm, arm_log, steps
from records_cases import records, search

from identification.discovery.impossible import MOST_DRIFT, find_impossible
from identification.effects.axes import Axis
from identification.effects.catalogue import MOST_TURNS, OF_ANGLE, joint_effects
from identification.effects.effect import Candidate
from identification.effects.plant.joint_plant import joint_plant
from identification.prediction.scoring.screening import contains
from identification.report.discovery.report import discovery_text

LOG = arm_log(steps(400, 2))  # 4 s


@cache
def servos():
    """The arm, whose drives are told positions."""
    text = ARM.replace('biastype="affine"', "").replace('biasprm="0.1 -0.3 -0.05"', "")
    for name in ("up", "low"):
        text = text.replace(f'<general name="{name}"', f'<position kp="50" name="{name}"')
    return joint_plant(text, (), LOG)


def asked(name, where, values, plant=None):
    plant = plant or arm()
    effect = next(e for e in plant.effects if e.name == name)
    fit = SimpleNamespace(plant=plant, told_values=values)
    return find_impossible(Candidate(effect, where, {}), fit, [LOG])


def test_a_body_keeps_more_than_half_of_the_mass_in_its_file():
    """The upper arm has 1 kg and the lower one 0.5 kg."""
    for body, mass in (("upper", 1.0), ("lower", 0.5)):
        for share, expected in ((-0.51, "mass"), (-0.49, None), (2.0, None)):
            values = {f"mass_mismatch.dm@{body}": share * mass}
            assert asked("mass_mismatch", f"body {body}", values) == expected


def test_a_gain_stays_within_half_of_itself_in_the_longest_record():
    for factor, expected in ((0.99, None), (1.01, "gain"), (-1.01, "gain")):
        values = {"gain_drift.alpha@up": factor * MOST_DRIFT / LOG.duration}
        assert asked("gain_drift", "input up", values) == expected


def test_no_servo_is_followed_before_it_is_told_but_a_clock_may_be_early():
    for shift in (-0.02, 0.02):
        for name in ("time_shift.tau [record 1]", "time_shift.tau"):
            assert asked("time_shift", "all inputs", {name: shift}) is None
            expected = "command" if shift < 0 else None
            assert asked("time_shift", "all inputs", {name: shift}, servos()) == expected
    within = {"time_shift.tau [record 1]": -0.5 * LOG.sampling_time}  # as stamps may be
    assert asked("time_shift", "all inputs", within, servos()) is None


@cache
def afloat(without=()):
    """A pendulum that compensates its weight, where no candidate does."""
    logs = records(4, {"gravity_force.alpha@hinge": 0.6}, samples=300)
    return search(logs, ("mass_mismatch", "stiffness"), without=without)


def test_a_mass_that_is_nearly_lost_is_no_name_and_is_told():
    found = afloat()
    assert found.verdict == "unknown effect"
    assert found.named == ()
    (lost,) = [r for r in found.rejected if r.name == "mass_mismatch"]
    assert lost.doubt == "mass"
    assert 2 * lost.parameters["dm"][0] < -0.5  # of 0.5 kg
    assert "the body would lose half or more of the mass" in discovery_text(found)


def test_who_believes_it_gets_the_name():
    found = afloat(("impossible_sizes",))
    assert [n.name for n in found.named] == ["mass_mismatch"]


def test_an_effect_at_more_places_is_the_same_effect_and_forbids_no_name_of_it():
    mass = next(e for e in arm().effects if e.name == "mass_mismatch")
    other = next(e for e in arm().effects if e.name == "stiffness")
    lower, upper = (Candidate(mass, f"body {b}", {}) for b in ("lower", "upper"))
    both = Candidate(mass, "body upper and body lower", {})
    assert contains(both, lower)
    assert not contains(lower, both)
    assert not contains(upper, lower)
    every, elbow = (Candidate(other, where, {}) for where in ("all joints", "joint elbow"))
    assert contains(every, elbow)
    assert not contains(every, lower)


@pytest.mark.parametrize("turns", [0.9, 1.1])
def test_laws_of_the_angle_act_on_no_shaft_that_turns_on_and_on(turns):
    shaft = Axis("shaft", "hinge", force=1.0, speed=50.0, travel=turns * MOST_TURNS * 2 * np.pi,
                 duration=9.0)  # fmt: skip
    arm_axis = replace(shaft, joint="arm", travel=2.0)
    places = {e.name: {*e.places.values()} for e in joint_effects((shaft, arm_axis))}
    every = {"", "@arm", "@shaft"}
    for name in OF_ANGLE:
        if name.startswith("curve"):
            assert places[name] == ({"@arm"} if turns > 1 else every - {""})
        else:
            assert places[name] == ({"@arm"} if turns > 1 else every)
    assert places["coulomb_friction"] == places["force_drift"] == every
    alone = {e.name for e in joint_effects((shaft,))}
    assert not alone & {*OF_ANGLE} if turns > 1 else alone >= {*OF_ANGLE}
    told = {e.name: {*e.places.values()} for e in joint_effects((shaft, arm_axis), asked=OF_ANGLE)}
    assert told["stiffness"] == every
    slide = replace(shaft, kind="slide")
    assert {e.name for e in joint_effects((slide,))} >= {*OF_ANGLE}
