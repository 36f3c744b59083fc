"""A free swing, or a drop test, is fitted: no input moves, or the model has no actuator at all."""

import json
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from joint_cases import SLIDER, run, slider_log, steps
from plain_logs import model_log, noise, stepped
from records_cases import MJCF, pendulum, record

from identification import fit, joint_plant, read_robot, write_log
from identification.__main__ import main
from identification.errors import InputError
from identification.report.fit.verdict import fit_verdict
from identification.robot.free_swing import impossible_sentence

DOUBLE = """<mujoco model="double"><option timestep="0.005" integrator="RK4"/>
<worldbody><body name="upper" pos="0 0 2"><joint name="a" axis="0 1 0" damping="{a}"/>
<inertial pos="0 0 -0.3" mass="1.2" diaginertia="0.02 0.02 0.01"/>
<body name="lower" pos="0 0 -0.6"><joint name="b" axis="0 1 0" damping="{b}"/>
<inertial pos="0 0 -0.2" mass="0.5" diaginertia="0.005 0.005 0.002"/></body></body></worldbody>
<sensor><jointpos name="a" joint="a"/><jointpos name="b" joint="b"/></sensor></mujoco>"""
SPRING = """<mujoco model="spring"><option timestep="0.005" integrator="RK4"/>
<worldbody><body name="cart"><joint name="x" type="slide" axis="1 0 0" damping="{damping}"
stiffness="{stiffness}" frictionloss="{friction}"/>
<inertial pos="0 0 0" mass="{mass}" diaginertia="0.01 0.01 0.01"/></body></worldbody>{motor}
<sensor><jointpos name="x" joint="x"/></sensor></mujoco>"""
MOTOR = '<actuator><motor name="push" joint="x" gear="{gear}"/></actuator>'
TRUE = {"damping": 0.6, "stiffness": 30.0, "friction": 0.0, "mass": 2.0, "motor": ""}


def swing(xml, start, samples, h=0.02, force=0.0):
    """A log of a motion from a start, with no input or with a constant one."""
    model = mujoco.MjModel.from_xml_string(xml)
    u = np.full((samples, model.nu), force)
    y = stepped(model, u, start, h)
    return model_log(model, u, y + noise(y.shape, 3e-4, seed=4), h)


def robot(folder, xml, log, free, more=""):
    """The path of a robot's file, and that of its log."""
    (folder / "robot.xml").write_text(xml)
    content = f'model = "robot.xml"\nfree = {json.dumps(free)}\n{more}'
    (folder / "robot.toml").write_text(content)
    write_log(log, folder / "log.csv")
    return folder / "robot.toml", folder / "log.csv"


def spring(**values):
    return SPRING.format(**{**TRUE, **values})


def test_a_double_pendulum_without_actuators_tells_its_dampings(tmp_path):
    log = swing(DOUBLE.format(a=0.05, b=0.03), (0.6, -0.4), 500)
    assert log.inputs.shape == (500, 0)
    paths = robot(tmp_path, DOUBLE.format(a=0.1, b=0.02), log,
                  ["joint/a.damping", "joint/b.damping"], "horizon = 1.0")  # fmt: skip
    found = fit(read_robot(*paths))
    assert found.converged
    assert found.values["joint/a.damping"] == pytest.approx(0.05, rel=0.02)
    assert found.values["joint/b.damping"] == pytest.approx(0.03, rel=0.02)


def test_what_only_an_input_would_show_is_told_and_the_rest_is_fitted(tmp_path):
    motor = MOTOR.format(gear=3)
    log = swing(spring(motor=motor), 0.2, 400)
    gear = "actuator/push.gear[0]"
    paths = robot(tmp_path, spring(motor=motor, damping=1.5), log, ["joint/x.damping", gear])
    read = read_robot(*paths)
    assert (
        f"No input moves in 'log', and a free swing does not tell {gear}: it keeps its value."
        in (read.remarks)
    )
    assert fit(read).values == {"joint/x.damping": pytest.approx(0.6, rel=0.02)}
    (tmp_path / "robot.toml").write_text(f'model = "robot.xml"\nfree = ["{gear}"]\n')
    with pytest.raises(InputError, match=r"does not tell actuator/push.gear\[0\]; free what it"):
        read_robot(*paths)


def test_a_constant_input_is_fitted_with_the_gear_that_it_tells(tmp_path):
    motor = MOTOR.format(gear=2)
    log = swing(spring(motor=motor), 0.2, 400, force=1.5)
    gear = "actuator/push.gear[0]"
    paths = robot(tmp_path, spring(motor=MOTOR.format(gear=3)), log, ["joint/x.damping", gear])
    found = fit(read_robot(*paths))
    assert found.values[gear] == pytest.approx(2.0, rel=0.01)


def test_ratios_alone_are_told_of_masses_springs_and_friction(tmp_path):
    free = ["body/cart.mass", "joint/x.damping", "joint/x.stiffness"]
    paths = robot(tmp_path, spring(damping=0.9), swing(spring(), 0.2, 400), free, "")
    found = fit(read_robot(*paths))
    mass, damping, stiffness = (found.values[n] for n in free)
    assert damping / mass == pytest.approx(0.3, rel=0.02)
    assert stiffness / mass == pytest.approx(15.0, rel=0.001)
    said = " ".join(fit_verdict(found.found))
    assert "a free swing tells masses, inertias, frictions and stiffnesses by their ratios" in said
    assert all(name in said for name in free)


@pytest.mark.parametrize(
    ("motor", "horizon"),
    [("", "horizon = 0.4"), pytest.param(MOTOR.format(gear=2), "", marks=pytest.mark.long)],
)
@pytest.mark.usefixtures("undrawn")
def test_a_search_names_the_hidden_coulomb_friction(tmp_path, motor, horizon, capsys):
    log = swing(spring(motor=motor, friction=0.15), 0.25, 500)
    paths = robot(tmp_path, spring(motor=motor), log, ["joint/x.damping"], horizon)
    of_inputs = {"delay", "lag", "saturation", "gain_drift", "time_shift"}
    assert not of_inputs & {e.name for e in read_robot(*paths).candidates}
    few = '[effects]\nonly = ["coulomb_friction", "quadratic_friction", "hardening"]\n'
    paths = robot(tmp_path, spring(motor=motor), log, ["joint/x.damping"], f"{horizon}\n{few}")
    out = tmp_path / "found"
    assert main(["discover", *map(str, paths), "--out", str(out), "--json"]) == 0
    effects = json.loads(capsys.readouterr().out)["effects"]
    assert effects[0]["name"] == "coulomb_friction"
    assert json.loads((out / "result.json").read_text())["effects"] == effects


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
