"""What torques prove is no name where physics forbids its size, and what they do not says why."""

from types import SimpleNamespace

import numpy as np
import pytest
from torque_cases import planar, planar_record

from identification import fit_torques, read_robot
from identification.torques.scores import CHANCE, PROOF, Score

HEAVY = 'mass="2" diaginertia="0.03 0.03', 'mass="{}" diaginertia="{d} {d}'


def believed(folder, mass):
    """What torques say of a planar arm whose fore body is believed to have another mass."""
    shape = HEAVY[1].format(mass, d=0.03 * mass / 2)
    (folder / "arm.xml").write_text(planar().replace(HEAVY[0], shape))
    (folder / "arm.toml").write_text(
        'model = "arm.xml"\nfree = ["joint/elbow.damping"]\nhorizon = 0.2\n'
        "trust = ['wiring', 'units', 'steps']\n[effects]\nonly = ['mass_mismatch', 'stiffness']\n"
    )
    records = [planar_record(k, name=f"r{k}") for k in (81, 82)]
    return read_robot(folder / "arm.toml", records[0], confirm=[records[1]])


@pytest.mark.parametrize(("mass", "is_name"), [(3.5, True), (5.0, False)])
def test_a_mass_that_is_nearly_lost_is_tried_and_no_name(tmp_path, mass, is_name):
    """The arm has 2 kg there: the file loses 43 % of its mass, or 60 %."""
    robot = believed(tmp_path, mass)
    found = fit_torques(robot)
    key = "mass_mismatch", "body fore"
    assert (key in {s.missing.key for s in found.named}) == is_name
    assert (key in {s.missing.key for s in found.found.tried}) != is_name
    (lost,) = [s for s in found.found.added if s.missing.key == key]
    assert lost.size[0] == pytest.approx(2 - mass, rel=0.05)
    record = found.to_dict()
    said = " ".join(record["verdict"])
    assert ("Tried, and no name: mass mismatch, body fore" in said) != is_name
    assert [t["doubt"] for t in record["tried"] if t["name"] == "mass_mismatch"] == (
        [] if is_name else ["mass"]
    )
    if not is_name:
        assert found.named == ()  # nor what was found beside it
        assert record["verdict"][0].endswith("prove no effect that physics allows.")
        trusted = fit_torques(robot, without=["impossible_sizes"])
        assert key in {s.missing.key for s in trusted.named}


def scored(size=0.2, chance=0.001, fall=0.9, t=20.0, sign=0, most=1.0, of_body=None):
    missing = SimpleNamespace(signs=(sign,), most=(most,), of_body=of_body)
    return Score(missing=missing, size=np.array([size]), std=np.array([0.01]), chance=chance,
                 fall=fall, t=t, gains=np.zeros(2), every=np.zeros(2))  # fmt: skip


NO_LOAD = np.eye(10)[:1], np.ones(10)  # a size that is the mass of a load


@pytest.mark.parametrize(("changed", "doubt"), [
    ({}, ""),
    ({"size": -0.2}, ""),
    ({"size": -0.2, "sign": 1}, "sign"),
    ({"size": 1.1}, "large"),
    ({"size": -0.2, "of_body": NO_LOAD}, "body"),
    ({"fall": -0.1}, "rise"),
    ({"t": PROOF - 0.1}, "unseen"),
    ({"chance": CHANCE}, "chance"),
    ({"size": -0.2, "sign": 1, "chance": 1.0}, "sign"),  # what no robot has is told first
])  # fmt: skip
def test_a_score_is_proven_or_says_why_not(changed, doubt):
    score = scored(**changed)
    assert score.doubt == doubt
    assert score.is_proven == (doubt == "")
