"""Free inertias stay those of a body, and what cannot be known apart is named."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from joint_cases import SLIDER, run, slider_log, steps
from records_cases import MJCF, pendulum, record

from identification import fit, joint_plant, read_robot, write_log
from identification.estimation.identifiability import identifiability
from identification.report.untold_words import weak_sentences
from identification.robot.free_inertias import impossible_sentence


def test_a_free_spread_is_fitted_and_a_single_inertia_keeps_within_what_a_body_can_have(tmp_path):
    log = slider_log(steps(600))
    spun = SLIDER.replace('type="slide" axis="1 0 0"', 'axis="0 0 1"')
    spun = spun.replace('diaginertia="1 1 1"', 'diaginertia="1 1.5 2"')
    plant = joint_plant(spun, (), slider_log(steps(600)))
    write_log(replace(log, outputs=run(plant, log), units={}), tmp_path / "log.csv")
    (tmp_path / "disc.xml").write_text(spun)
    path = tmp_path / "disc.toml"
    path.write_text(
        'model = "disc.xml"\nhorizon = 0.5\nfree = ["body/cart.spread[0]"]\n'
        '[parameters."body/cart.spread[0]"]\nvalue = 0.9\n'
    )
    found = fit(read_robot(path, tmp_path / "log.csv"))
    assert found.values["body/cart.spread[0]"] == pytest.approx((1.5 + 2 - 1) / 2, rel=1e-3)
    path.write_text('model = "disc.xml"\nfree = ["body/cart.inertia[2]"]\n')
    turning = '<joint name="turn" axis="1 1 1"/><joint name="slide"'
    (tmp_path / "disc.xml").write_text(spun.replace('<joint name="slide"', turning))
    inertia = read_robot(path, tmp_path / "log.csv").plant.parameters["body/cart.inertia[2]"]
    assert (inertia.lower, inertia.upper) == (0.5, 2.5)


def test_values_that_noise_drowns_are_named_with_what_they_trade_off_along():
    S = np.array([[1.0, 1.0, 0.0], [1e-2, -1e-2, 0.0], [0.0, 0.0, 9.0]])
    found = identifiability(S, ("m1", "m2", "b"), np.zeros((3, 3)), 1e-9)
    result = SimpleNamespace(found=found, values={"m1": 2.7, "m2": 1.3, "b": 1.0},
                             std=np.array([17.0, 17.0, 0.1]))  # fmt: skip
    (said,) = weak_sentences(result)
    assert said.startswith("Too weakly for this noise: m1, m2, their std exceeds half the value.")
    assert "(m1 +0.71, m2 -0.71)" in said or "(m1 -0.71, m2 +0.71)" in said
    assert weak_sentences(SimpleNamespace(**{**vars(result), "std": np.full(3, 0.1)})) == []


def test_inertias_that_are_free_together_are_told_before_and_where_no_body_has_them(tmp_path):
    (tmp_path / "arm.xml").write_text(MJCF)
    path, both = tmp_path / "robot.toml", ("body/arm.inertia[0]", "body/arm.inertia[2]")
    path.write_text(f'model = "arm.xml"\nfree = ["{both[0]}", "{both[1]}", "body/arm.mass"]\n')
    log = record(seed=1, samples=100, plant=pendulum())
    robot = read_robot(path, log)
    (said,) = [s for s in robot.remarks if "no body has" in s]
    assert f"frees {both[0]}, {both[1]}: together" in said
    assert "free body/arm.spread[0] to [2] instead" in said
    assert impossible_sentence(robot, {both[0]: 1e-3, both[1]: 2e-3}) == ""  # flat
    assert "body/arm: one is larger" in impossible_sentence(robot, {both[0]: 1e-3, both[1]: 3e-3})
    path.write_text(f'model = "arm.xml"\nfree = ["{both[0]}", "body/arm.mass"]\n')
    assert read_robot(path, log).remarks == ()
