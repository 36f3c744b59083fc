"""Curves of a joint's position, speed, drive and of the time, as columns of torques."""

import numpy as np
import pytest
from torque_cases import planar_record, planar_robot

from identification import fit_torques
from identification.native.joints.joint_callback import Joint
from identification.report.torques.report import torque_sections
from identification.torques.laws import CURVES, Missing, _along_curve
from identification.torques.scores import Score


def bump(q, v):
    """A force that no law has, at one place of the elbow [N m]."""
    return 1.5 * np.exp(-(((q[1] - 0.1) / 0.2) ** 2))


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bump")
    records = [planar_record(k, name=f"r{k}", force=bump) for k in (41, 42)]
    return planar_robot(folder, records[0], confirm=[records[1]])


@pytest.fixture(scope="module")
def found(robot):
    return fit_torques(robot)


def test_a_curve_of_a_few_places_is_the_law_everywhere(robot):
    rng, n = np.random.default_rng(3), 60
    sign = np.sign(rng.uniform(-1, 1, n))
    states = Joint(rng.uniform(0, 4, n), *rng.uniform(-1, 1, (4, n)), sign, 0.1, 1.2, 1.5, 1.4, 4.0)
    curves = [e for e in robot.candidates if e.is_curve and e.name.endswith(tuple(CURVES))]
    assert len(curves) == len(CURVES)
    p = rng.uniform(-1, 1, 8)
    for effect in curves:
        (law,) = effect.hooks.values()
        arrays = [np.broadcast_to(x, n) for x in states]
        slow = [law.py_func(Joint(*map(float, one)), p) for one in zip(*arrays, strict=True)]
        np.testing.assert_allclose(_along_curve(law, states, p), slow, atol=2e-4)


def test_a_force_in_no_catalogue_is_drawn_at_its_joint(found):
    (named, *_) = found.named
    assert named.missing.title == "curve_position, joint elbow"
    assert named.reach == pytest.approx(1.5, rel=0.25)
    said = found.to_dict()["verdict"][0]
    assert said.startswith("The torques need a force that no law of the catalogue explains,")
    assert "it changes by" in repr(found)


def test_the_drawn_force_is_the_hidden_one_but_for_its_mean(found):
    model = found.robot.plant.model
    first = torque_sections(found.found, model)[0]
    assert first.title == "Forces that no law explains"
    (axes,) = first.figures[0][1].axes
    (curve,) = [line for line in axes.get_lines() if line.get_label() == "curve"]
    x, y = curve.get_data()
    true = 1.5 * np.exp(-(((x - 0.1) / 0.2) ** 2))
    assert np.std(y - true) < 0.25 * np.std(true)


def score(name, fall, sizes, share=0.5):
    """A proven candidate; its blocks gain alike, so that luck may explain any difference."""
    missing = Missing(
        name=name, where="joint a", phrase="", sizes=("c",) * sizes, units=("N m",) * sizes,
        signs=(0,) * sizes, columns=lambda: None, most=(np.inf,) * sizes,
    )  # fmt: skip
    gains = np.linspace(1.0, 2.0, 12)
    return Score(missing=missing, size=np.ones(sizes), std=np.ones(sizes), chance=1e-6, fall=fall,
                 t=9.0, gains=gains, every=gains, share=share)  # fmt: skip


@pytest.mark.parametrize(("law", "is_like"), [(0.44, True), (0.30, False), (0.499, True)])
def test_a_law_that_leaves_its_joint_far_more_than_a_curve_does_not_predict_alike(law, is_like):
    """Of half of the mean square that the joint has, the curve takes 0.9 away."""
    assert score("hardening", law, 1).is_like(score("curve_position", 0.45, 8)) == is_like
