"""With an unknown effect the answer is the joint, the place and the size of the missing force."""

import runpy
from dataclasses import replace
from types import SimpleNamespace

import fake_discovery
import numpy as np
import pytest
from gap_cases import LEVEL, unknown
from robot_cases import TOML

from identification import read_robot, write_log
from identification.discovery.missing_forces import MissingForce
from identification.report.discovery.horizon_gap import find_gap
from identification.report.discovery.missing_place import (
    MissingPlace,
    find_place,
    force_line,
    place_of,
)
from identification.report.discovery.named_words import Nodes
from identification.report.discovery.needed_forces import NeededForce
from identification.report.discovery.own_stub import own_stub
from identification.report.discovery.verdict import discovery_verdict
from identification.robot.results import discovery_files
from identification.robot.results.discovery_files import STUB, RobotDiscoveryFiles


def needed(force, std, depends_on="position", reads="position of hinge", unit="rad", ends=0.7):
    """A force at nodes, of one row, or of one row for each direction."""
    force, std = np.atleast_2d(force).astype(float), np.atleast_2d(std).astype(float)
    nodes = Nodes("hinge", depends_on, reads, unit, np.linspace(-ends, ends, force.shape[1]))
    return NeededForce(nodes, force, std, "N m", 0.5, 1e-6, has_sides=depends_on != "speed")


def test_the_place_is_the_part_of_the_range_with_half_the_largest_force():
    force = [0.0, 0.1, 0.0, -0.1, 0.2, 0.6, 0.4, 0.0]  # nodes are 0.2 rad apart
    place = place_of(needed(force, [0.05] * 8))
    assert (place.low, place.high) == pytest.approx((0.2, 0.6))
    assert (place.joint, place.force, place.std) == ("hinge", 0.6, 0.05)
    said = "joint hinge, near 0.20 to 0.60 rad, in both directions: about 0.60 N m are missing"
    assert str(place) == said
    alone = place_of(needed([0, 0, 0, 0, 0, 0.6, 0.2, 0], [0.05] * 8))
    assert "near 0.20 to 0.40 rad, in" in str(alone)


def test_the_ends_of_a_narrow_place_are_told_apart():
    force = np.zeros(701)
    force[500] = -1.0
    place = place_of(needed(force, np.full(701, 0.1)))
    assert "near 0.299 to 0.301 rad, in both directions: about -1 N m are" in str(place)


@pytest.mark.parametrize(("rising", "falling", "told"), [
    (-0.6, -0.5, "in both directions: about -0.60"),
    (-0.6, 0.5, "in both directions, against the motion: about 0.60"),
    (0.4, -0.6, "in both directions, with the motion: about 0.60"),
    (-0.6, 0.2, "rising: about -0.60"),
    (0.1, 0.6, "falling: about 0.60"),
])  # fmt: skip
def test_the_direction_is_that_of_the_force_and_of_the_motion(rising, falling, told):
    force = np.zeros((2, 8))
    force[:, 4] = rising, falling
    assert f"rad, {told} N m are missing" in str(place_of(needed(force, np.full((2, 8), 0.05))))


def test_the_largest_force_of_the_surest_place_is_told():
    place = place_of(
        needed([0, 0, 0, 0.4, 0.6, 0, 0, 0], [0.03, 0.03, 0.03, 0.03, 0.2] + [0.03] * 3)
    )
    assert (place.force, place.std) == (0.6, 0.2)


def test_all_that_is_said_of_a_force_has_the_number_of_the_surest_place():
    force, std = np.zeros((1, 64)), np.full((1, 64), 0.01)
    force[0, 20:23], std[0, 20:23] = [2.0, 3.0, 2.1], [0.1, 0.9, 0.02]
    one = needed(force, std)
    assert place_of(one).size in force_line(one)
    assert place_of(one).range in force_line(one)
    assert "3 N m" in force_line(one)


def test_a_node_that_no_motion_tells_is_no_answer():
    force, std = [0.0, 0.0, 0.3, 0.0, 0.0, 0.0, 0.0, 9.0], [0.05] * 7 + [np.inf]
    assert place_of(needed(force, std)).force == 0.3


def test_over_the_rate_it_says_whether_the_force_brakes():
    place = find_place(unknown())
    assert place is not None
    assert place.reads == "rate of hinge"
    assert abs(place.force) == pytest.approx(LEVEL, abs=3 * place.std + 0.2 * LEVEL)
    assert ", against the motion: " in str(place)
    said = " ".join(discovery_verdict(unknown()))
    assert f"Joint hinge, {place.range}: {place.size} are missing; see the figure." in said
    turned = replace(place, force=-place.force)
    assert ", with the motion: " in str(turned)
    assert find_place(replace(unknown(), verdict="named")) is None


@pytest.mark.parametrize("rising", [True, False])
def test_along_a_free_run_the_direction_is_told(rising):
    """A force in a part of the range of one motor, while it turns one way."""
    answer = fake_discovery.found("unknown effect")
    log = answer.run.log
    x = log.outputs[:, 2]
    way = (np.gradient(x) > 0) == rising
    low, high = np.quantile(x[way], [0.4, 0.7])
    force = np.zeros((len(x), 8))
    force[:, 2] = 0.004 * ((x >= low) & (x <= high) & way)
    names = tuple(f"motor_{k}" for k in range(1, 9))
    missing = MissingForce(where="the actuated joints", names=names, units=("N m",) * 8,
                           force=force, gain=9.0, share=0.9)  # fmt: skip

    class Pushed(fake_discovery.ByHand):
        def missing_forces(self):
            return (missing,)

    run = Pushed(log, answer.nominal, answer.final, answer.run.before, answer.run.after)
    place = find_place(replace(answer, run=run))
    assert place.joint == "motor_3"
    assert place.moves == ("rising" if rising else "falling")
    assert 0 < place.force <= 0.004
    width = np.ptp(x) / 8
    assert low - width < place.low < place.high < high + width
    still = replace(missing, names=("nobody",) * 8)
    Pushed.missing_forces = lambda self: (still,)
    assert find_place(replace(answer, run=replace(run))) is None


def test_the_stub_is_an_effect_at_the_place_that_a_search_takes(tmp_path):
    place = find_place(unknown())
    text = own_stub(place, "robot.toml", ["a.csv"], ["../b c.mcap", "d.csv"])
    names = {"__name__": "stub"}
    exec(compile(text, STUB, "exec"), names)
    (size,) = names["MINE"].sizes
    assert size.probe < abs(place.force) < size.largest

    class At:
        q = s = f_u = f_g = time = 0.0
        v = (place.low + place.high) / 2

    law = names["mine"].py_func
    assert law(At, (2.0,)) == pytest.approx(2.0, rel=0.1)
    assert law(At, (0.0,)) == 0.0
    assert 'read_robot(\n        here / "robot.toml", [here / "a.csv"], ' in text
    assert 'confirm=[here / "../b c.mcap", here / "d.csv"]' in text


@pytest.mark.parametrize(("moves", "rising", "falling"), [
    ("both", -2, -2), ("rising", -2, 0), ("falling", 0, -2), ("against", 2, -2), ("with", -2, 2),
])  # fmt: skip
def test_the_stub_acts_in_the_direction_and_at_the_place_that_are_told(moves, rising, falling):
    """At the middle it is its size, at the ends of the place half of it; p[0] is negative here."""
    place = MissingPlace("rail", "position of rail", "m", 0.4172, 0.4288, moves, 1.2, 0.1, "N")
    names = {"__name__": "stub"}
    exec(compile(own_stub(place, "robot.toml", ["a.csv"]), STUB, "exec"), names)
    law = names["mine"].py_func
    for v, force in ((0.3, rising), (-0.3, falling)):
        at = [SimpleNamespace(q=q, v=v) for q in (0.423, place.low, place.high, 0.47)]
        middle, *ends, far = (law(s, (-2.0,)) for s in at)
        assert middle == pytest.approx(force, rel=1e-3)
        assert ends == pytest.approx([force / 2] * 2, rel=0.05)
        assert abs(far) < 1e-6


def test_there_is_no_stub_where_another_joint_tells_the_place():
    place = MissingPlace("elbow", "position of wrist", "rad", 0.4, 0.5, "both", 1.2, 0.1, "N m")
    assert place.range == "where the position of wrist is 0.40 to 0.50 rad, in both directions"
    assert own_stub(place, "robot.toml", ["a.csv"]) == ""


def test_an_own_effect_is_a_candidate_of_a_robot_beside_those_of_its_file(tmp_path):
    from joint_cases import SLIDER
    from robot_cases import simulated

    place = replace(find_place(unknown()), joint="slide", reads="rate of slide", force_unit="N")
    names = {"__name__": "stub"}
    exec(compile(own_stub(place, "robot.toml", ["log.csv"]), STUB, "exec"), names)
    (tmp_path / "slider.xml").write_text(SLIDER)
    (tmp_path / "robot.toml").write_text(TOML + '\n[effects]\nonly = ["offset"]\n')
    write_log(simulated({"damping": 3.0, "mass": 2.0}, 200), tmp_path / "log.csv")
    robot = read_robot(tmp_path / "robot.toml", tmp_path / "log.csv", own_effects=[names["MINE"]])
    assert [e.name for e in robot.candidates] == ["offset", "mine"]


def test_the_stub_reads_its_files_from_any_folder(tmp_path, monkeypatch):
    from elbow_cases import ELBOW, elbow

    place, (robot, found) = find_place(unknown()), elbow()
    monkeypatch.setattr(discovery_files, "find_place", lambda _: place)
    out = tmp_path / "out"
    out.mkdir()
    RobotDiscoveryFiles(found, robot).keep(out, out)
    monkeypatch.chdir(tmp_path)
    read = []
    monkeypatch.setattr("identification.read_robot", lambda *a, **k: read.append((a, k)))
    monkeypatch.setattr("identification.discover", lambda robot: None)
    monkeypatch.setattr("identification.discovery_text", lambda found: "")
    runpy.run_path(str(out / STUB), run_name="__main__")
    ((file, logs), more) = read[0]
    paths = [file, *logs, *more["confirm"]]
    names = "elbow.toml", "first.csv", "second.csv"
    assert [p.resolve() for p in paths] == [(ELBOW / n).resolve() for n in names]


def test_the_folder_of_a_search_without_a_name_has_the_stub(tmp_path):
    from elbow_cases import elbow

    robot, found = elbow()
    nothing = replace(found, verdict="unknown effect", named=(), final=found.nominal,
                      after=found.before, remaining=found.scores)  # fmt: skip
    files = RobotDiscoveryFiles(nothing, robot)
    files.keep(tmp_path, tmp_path)
    has_force = bool(find_gap(nothing).needed.forces)
    assert (tmp_path / STUB).exists() == has_force == bool(find_place(nothing))
    assert [s.code != "" for s in files.sections][-1] == has_force
    named = RobotDiscoveryFiles(found, robot)
    assert not any(s.code for s in named.sections)
