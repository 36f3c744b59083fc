"""A curve that is a straight line is a number of the model, and one that is bent is none."""

from dataclasses import replace
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from gap_cases import named, unknown
from records_cases import MJCF, listed, pendulum

from identification.effects.effect import Candidate
from identification.report.discovery.named_words import Nodes, curve_nodes
from identification.report.discovery.needed_forces import NeededForce
from identification.report.discovery.straight_curves import (
    STRAIGHT,
    find_line,
    limit_of_named,
    line_of_named,
    line_words,
    lines_needed,
)
from identification.report.discovery.verdict import discovery_verdict

AT = np.array([-1, -0.5625, -0.25, -0.0625, 0.0625, 0.25, 0.5625, 1.0])
STD = np.full(8, 0.01)
BENT = {  # forces that no line explains
    "a cube": AT**3,
    "a dead zone": np.sign(AT) * np.maximum(np.abs(AT) - 0.4, 0.0),
    "a limit": np.clip(AT, -0.2, 0.2),
    "dry friction": np.sign(AT),
    "a constant": np.ones(8),
    "nothing": np.zeros(8),
}


@pytest.mark.parametrize("slope", [-0.15, -0.6, 0.2])
def test_the_slope_of_a_line_is_found_within_its_std(slope):
    rng = np.random.default_rng(3)
    off = []
    for _ in range(200):
        line = find_line(AT, slope * AT + STD * rng.standard_normal(8), STD)
        assert line is not None
        assert line.share > STRAIGHT
        off.append((line.slope - slope) / line.std)
    assert abs(np.mean(off)) < 0.25
    assert np.std(off) < 1.1


@pytest.mark.parametrize("force", BENT.values(), ids=BENT)
def test_what_is_bent_is_no_line(force):
    assert find_line(AT, 0.3 * force, STD) is None


def test_nodes_that_no_motion_tells_do_not_count():
    force, std = -0.15 * AT, STD.copy()
    force[[0, 7]], std[[0, 7]] = 9.0, np.inf
    assert find_line(AT, force, std).slope == pytest.approx(-0.15)
    std[1:5] = np.inf  # what is left is on one side of zero
    assert find_line(AT, force, std) is None
    std[:] = 0.0
    assert find_line(AT, force, std) is None


def said(depends_on, slope, plant=None, force=None):
    unit = "N m" if depends_on == "load" else "rad/s"
    nodes = Nodes("hinge", depends_on, "drive", unit, AT)
    return line_words(
        nodes, slope * AT if force is None else force, STD, "N m", plant or pendulum()
    )


def drives(*lines):
    """A plant whose model has these actuators."""
    text = MJCF.replace('<motor name="drive" joint="hinge"/>', "".join(lines))
    return SimpleNamespace(model=mujoco.MjModel.from_xml_string(text))


def test_a_line_of_the_drive_is_its_gain_and_one_of_the_rate_a_damping():
    assert "a gain of 0.850" in said("load", -0.15)
    assert 'add "actuator/drive.gear[0]" to the list free' in said("load", -0.15)
    assert "differs from the model's by -0.150 ± 0.006 N m s/rad" in said("speed", 0.15)
    assert 'add "joint/hinge.damping"' in said("speed", -0.15)
    assert said("load", -1.2) == ""  # a drive that turns the other way
    assert said("position", -0.15) == said("time", -0.15) == ""
    assert said("load", 0.0, force=AT**3) == ""


def test_the_number_to_free_is_the_one_gain_of_the_one_drive():
    aim, turn = '<position name="aim" joint="hinge" kp="4"/>', '<velocity joint="hinge" kv="1"/>'
    assert 'add "actuator/aim.kp" to the list free' in said("load", -0.15, drives(aim))
    named = turn.replace("joint=", 'name="turn" joint=')
    assert 'add "actuator/turn.kv" to the list free' in said("load", -0.15, drives(named))
    for of in ((), (turn,), (aim, turn)):  # none, one without a name, and two
        told = said("load", -0.15, drives(*of))
        assert told.endswith("a gain of 0.850 ± 0.006.")


def named_curve(name, slope):
    (curve,) = listed(name)
    answer = named()
    candidate = Candidate(curve, "joint hinge", {})
    (nodes,) = curve_nodes(candidate, answer.final.plant)
    values = {f"c_{k + 1}": (slope * x, 0.002, "N m") for k, x in enumerate(nodes.at)}
    return replace(answer.named[0], candidate=candidate, parameters=values)


def test_a_named_curve_that_is_a_line_is_told_as_a_gain_and_a_law_is_not():
    answer = named()
    drawn = named_curve("curve_load", -0.15)
    told = "The force on hinge is a straight line of the force of the drives of hinge, which"
    verdict = discovery_verdict(replace(answer, named=(drawn,)))[0]
    assert f"{told} explains 100 % of its changes: a gain of 0.85" in verdict
    assert told not in " ".join(discovery_verdict(answer))
    assert line_of_named(answer.named[0], answer.final.plant) == ""


def test_a_force_that_is_needed_is_told_as_a_gain_where_it_is_a_line(monkeypatch):
    answer = unknown()
    assert lines_needed(answer) == []  # dry friction, over the rate
    nodes = Nodes("hinge", "load", "force of the drives of hinge", "N m", AT)
    line = NeededForce(nodes, -0.3 * AT[None], STD[None], "N m", 0.5, 1e-6)
    two = NeededForce(nodes, -0.3 * np.stack([AT, AT**3]), np.stack([STD, STD]), "N m", 0.4, 1e-6)
    from identification.report.discovery import straight_curves

    class Gap:
        needed = SimpleNamespace(forces=(line, two))  # one that differs by direction is no line

    monkeypatch.setattr(straight_curves, "find_gap", lambda _: Gap)
    (sentence,) = lines_needed(answer)
    assert sentence.startswith("The force on hinge is a straight line")
    assert "a gain of 0.70" in sentence


def test_a_voltage_limit_that_falls_with_no_speed_is_told_as_a_limit_of_the_force():
    model = mujoco.MjModel.from_xml_string("""<mujoco><worldbody><body><joint name="elbow"/>
        <geom size="0.1"/></body></worldbody><actuator><motor name="low" joint="elbow" gear="2"/>
        </actuator></mujoco>""")

    def said(effect, at_bound):
        candidate = SimpleNamespace(effect=SimpleNamespace(name=effect), where="joint elbow")
        named = SimpleNamespace(candidate=candidate, parameters={"f_m": (3.0, 0.01, "N m")})
        return limit_of_named(
            named, SimpleNamespace(at_bound=at_bound, plant=SimpleNamespace(model=model))
        )

    told = said("voltage_limit", ("voltage_limit.v_0",))
    assert 'forcerange="-1.5 1.5" into its actuator low' in told
    assert 'add "actuator/low.forcerange" to the list free' in told
    assert said("voltage_limit", ()) == ""
    assert said("coulomb_friction", ("voltage_limit.v_0",)) == ""
