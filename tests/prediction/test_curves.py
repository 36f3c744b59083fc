"""Curves drawn from the data: a listed law wins over them, and alone they are no name of a law."""

import pytest
from records_cases import AXIS, nominal_model, pendulum, record

from identification.discovery.options import DiscoveryOptions
from identification.effects.axes import Axis
from identification.effects.catalogue import joint_effects
from identification.effects.joint_plant import candidates
from identification.prediction.discovery import discover_records

CURVES = ("curve_speed", "curve_load", "curve_position")
NEIGHBOURS = ("curve_before", "curve_behind", "curve_speed_before", "curve_speed_behind")


def found(values, names, samples=260):
    logs = [record(k, samples=samples, values=values, plant=pendulum()) for k in (1, 2, 3, 4)]
    effects = [e for e in candidates(pendulum(), ("J", "d")) if e.name in names]
    return discover_records(nominal_model(), logs[:2], logs[2:], effects)


@pytest.mark.long
def test_a_law_that_is_listed_wins_over_curves():
    answer = found({"hardening.k_3@hinge": 0.06}, ("hardening", "curve_position"))
    assert answer.verdict == "named"
    assert [n.candidate.effect.name for n in answer.named] == ["hardening"]


@pytest.mark.long
def test_a_law_that_is_not_listed_is_drawn_as_a_curve_of_what_it_depends_on():
    answer = found({"hardening.k_3@hinge": 0.06}, CURVES[1:], samples=500)
    assert answer.verdict == "unlisted effect"
    (named,) = answer.named
    assert named.candidate.effect.name == "curve_position"
    assert answer.share > 0.7


def test_records_without_an_effect_get_no_curve():
    answer = found(None, CURVES[:2])
    assert answer.verdict == "nothing missing"


def test_curves_bend_either_way_and_act_on_single_joints():
    timed = Axis("b", "hinge", 1.0, 1.0, 1.0, plain=False, duration=5.0)
    curves = [e for e in joint_effects((AXIS, timed)) if e.is_curve]
    assert {e.name for e in curves} == {*CURVES, *NEIGHBOURS, "curve_time"}
    assert all(s.sign == 0 for e in curves for s in e.sizes)
    assert all("" not in e.places.values() for e in curves)
    assert all(len(e.sizes) == 8 for e in curves)
    (load,) = (e for e in curves if e.name == "curve_load")
    assert load.places == {"joint hinge": "@hinge"}
    assert DiscoveryOptions().size_factor >= 1


def test_curves_of_slides_are_called_curves_too():
    mixed = joint_effects((AXIS, Axis("s", "slide", 1.0, 1.0, 1.0)))
    some = (*CURVES, *NEIGHBOURS)
    assert {e.name for e in mixed if "curve" in e.name} == {
        *some, *(c.replace("curve", "curve_slide") for c in some)
    }  # fmt: skip
    assert all(e.is_curve for e in mixed if "curve" in e.name)


@pytest.mark.parametrize("name", CURVES)
def test_a_curve_of_a_single_joint_keeps_its_place(name):
    (effect,) = (e for e in pendulum().effects if e.name == name)
    assert effect.places == {"joint hinge": "@hinge"}
    assert not {*NEIGHBOURS} & {e.name for e in pendulum().effects}
