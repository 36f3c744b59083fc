"""Drives whose forces all have the other sign are told by inertias that would be negative."""

from dataclasses import replace

import numpy as np
import pytest
from torque_cases import planar_record, planar_robot

from identification import InputError, fit_torques
from identification.errors import DivergenceError
from identification.robot.blame import told_of_factors
from identification.torques.turned import find_turned, is_opposite


class Base:
    """Base parameters of a made-up arm: five inertias and three first moments."""

    units = ("kg m^2",) * 5 + ("kg m",) * 3
    values = np.array([0.8, 0.3, 0.1, 0.02, 0.05, 2.0, 0.6, 0.1])


STD = 0.02 * np.abs(Base.values) + 0.005


def drawn(rng, factor):
    return factor * Base.values + STD * rng.standard_normal(len(STD))


@pytest.mark.parametrize(("factor", "told"), [(-1.0, True), (-1.6, True), (1.0, False),
                                              (0.3, False), (0.0, False)])  # fmt: skip
def test_only_numbers_of_the_other_sign_are_turned(factor, told):
    rng = np.random.default_rng(0)
    for _ in range(300):
        k = find_turned(Base, drawn(rng, factor), STD)
        assert (k is not None) == told
        assert not told or Base.units[k] == "kg m^2"


def test_turned_gravity_is_not_turned_drives():
    rng = np.random.default_rng(1)
    hangs = np.where(np.array(Base.units) == "kg m", -1.0, 1.0)
    for _ in range(300):
        assert find_turned(Base, drawn(rng, hangs), STD) is None
        assert find_turned(Base, drawn(rng, -hangs), STD) is None


def test_what_records_do_not_tell_is_in_no_doubt():
    rng = np.random.default_rng(2)
    wide = 3 * np.linalg.norm(Base.values) * np.ones(len(STD))
    for _ in range(300):
        noise = wide * rng.standard_normal(len(STD))
        assert find_turned(Base, noise - Base.values, wide) is None
    assert is_opposite(np.array([-1.0]), np.array([1.0])) is None


def test_an_arm_whose_drives_are_turned_is_refused_with_the_cure_and_a_word_overrules(tmp_path):
    log = planar_record(61)
    turned = replace(log, inputs=-log.inputs)
    robot = planar_robot(tmp_path, turned)
    asked = replace(robot, file=replace(robot.file, trust=()))
    with pytest.raises(InputError, match="have the other sign") as refusal:
        fit_torques(asked)
    assert "no inertia is negative" in str(refusal.value)
    assert 'trust = ["wiring"]' in str(refusal.value)
    with pytest.raises(DivergenceError, match="have the other sign"), told_of_factors(asked):
        raise DivergenceError("the simulation of a window diverged")
    assert fit_torques(robot).found.whole.fit.θ[0] < 0  # the file trusts the wiring
    right = planar_robot(tmp_path, log)
    fit_torques(replace(right, file=replace(right.file, trust=())))
