"""An angle that jumps by whole turns is read as it moved; what may be honest motion stays."""

import mujoco
import numpy as np
import pytest

from identification import inspect_log
from identification.logs.wrapped import doubted_jumps, find_jumps
from identification.robot.file.file import read_robot_file
from identification.robot.robot import read_robot_log

TURN = 2 * np.pi
MJCF = """<mujoco><option timestep="0.002" integrator="RK4"/><worldbody><body>
<joint name="rail" type="slide" axis="1 0 0" damping="3"/>
<inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>
<body><joint name="hinge" axis="0 1 0" damping="0.002"/>
<inertial pos="0 0 -0.2" mass="0.3" diaginertia="0.002 0.002 0.001"/></body></body></worldbody>
<actuator><motor name="push" joint="rail" gear="{gear}"/></actuator>
<sensor><jointpos name="rail" joint="rail"/><jointpos name="hinge" joint="hinge"/>
<jointvel name="rate" joint="hinge"/></sensor></mujoco>"""
TOML = """model = "cart.xml"
outputs = ["rail", "hinge", "rate"]
free = ["joint/hinge.damping"]
horizon = 0.3
[log.units]
hinge = "{unit}"
"""


def swung(seed, rate=100, samples=800, speed=18.0):
    """Columns push, rail, hinge and rate of a cart whose pendulum turns over."""
    model = mujoco.MjModel.from_xml_string(MJCF.format(gear=8))
    data, rng = mujoco.MjData(model), np.random.default_rng(seed)
    data.qpos[1], data.qvel[1] = (
        rng.uniform(-2, 2),
        rng.choice([-1, 1]) * rng.uniform(1, 1.5) * speed,
    )
    out = np.zeros((samples, 4))
    for k in range(samples):
        if k % 25 == 0:
            data.ctrl[0] = rng.uniform(-1, 1)
        mujoco.mj_forward(model, data)
        out[k] = *data.ctrl, *data.sensordata
        mujoco.mj_step(model, data, round(500 / rate))
    return out + [0, 1e-5, 1e-3, 1e-2] * rng.standard_normal(out.shape)


def wrapped(angle, turn=TURN, least=-np.pi):
    return (angle - least) % turn + least


def read(folder, time, table, unit="rad"):
    (folder / "cart.xml").write_text(MJCF.format(gear=8))
    (folder / "robot.toml").write_text(TOML.format(unit=unit))
    rows = np.column_stack([time, table])
    np.savetxt(
        folder / "log.csv", rows, "%.12g", ",", header="time,push,rail,hinge,rate", comments=""
    )
    return read_robot_log(read_robot_file(folder / "robot.toml"), folder / "log.csv")


@pytest.mark.parametrize("unit", ["rad", "deg"])
@pytest.mark.parametrize("is_even", [True, False])
def test_a_pendulum_that_turns_over_is_read_as_it_moved(tmp_path, unit, is_even):
    table, turn = swung(3), {"rad": TURN, "deg": 360.0}[unit]
    table[:, 1] *= 30  # a slide that moves by more than a turn has none
    scale = turn / TURN
    time = 0.01 * np.arange(len(table))
    if not is_even:
        time = time + np.random.default_rng(0).uniform(0, 4e-3, len(time))
    table[:, 2] *= scale
    truth = read(tmp_path, time, table, unit)
    assert np.ptp(truth.outputs[:, 1]) > 3 * TURN  # or it proves nothing
    table[:, 2] = wrapped(table[:, 2], turn, -turn / 2)
    log = read(tmp_path, time, table, unit)
    shift = round(float((log.outputs - truth.outputs)[0, 1]) / TURN) * TURN
    assert log.outputs - [0, shift, 0] == pytest.approx(truth.outputs, abs=1e-9)
    assert log.inputs == pytest.approx(truth.inputs)
    (told,) = (r for r in log.remarks if "whole turn" in r)
    jumps = int(np.sum(np.abs(np.diff(table[:, 2])) > turn / 2))
    assert told == (
        f"hinge of log 'log' jumps {jumps} times by about a whole turn (6.283 rad), where its"
        " encoder begins anew, and is read without these jumps."
    )
    assert not doubted_jumps(log.remarks)
    assert not any("whole turn" in r for r in truth.remarks)


@pytest.mark.parametrize("seed", range(12))
def test_right_angles_stay_and_wrapped_ones_become_them(seed):
    rate = (20, 50, 100, 250)[seed % 4]
    angle = swung(seed, rate, samples=400)[:, 2]
    assert find_jumps(angle, TURN) is None
    found = find_jumps(wrapped(angle, least=(0, -np.pi)[seed % 2]), TURN)
    if found.doubt:
        assert np.abs(np.diff(angle)).max() > 0.2 * TURN  # nearly a guess
    else:
        assert np.ptp(found.values - angle) < 1e-9


def test_what_may_be_no_whole_turn_is_told_and_left():
    t = 0.02 * np.arange(400)
    swing = 0.3 * np.sin(3 * t)
    fast = wrapped(np.cumsum(2.4 * np.sin(t)))  # comes near half a turn between two samples
    reset = np.where(t < 4, swing, swing - 5.5)  # an encoder that began at another place
    for angle in (fast, reset):
        found = find_jumps(angle, TURN)
        assert found.doubt
        assert (found.values == angle).all()
    for angle in (swing, np.cumsum(0.9 * np.sin(t)), np.where(t < 4, swing, swing + 3.5)):
        assert find_jumps(angle, TURN) is None
    assert find_jumps(5.5 * np.arange(400.0), TURN) is None  # goes farther than a turn


def test_a_doubt_stands_beside_what_is_told_of_a_log(tmp_path):
    table = swung(1, samples=300)
    table[150:, 2] = table[150:, 2] * 0 + 0.3 * np.sin(0.1 * np.arange(150))
    table[:150, 2] = 5.8 + 0.3 * np.sin(0.1 * np.arange(150))
    log = read(tmp_path, 0.01 * np.arange(300), table)
    assert log.outputs[:, 1] == pytest.approx(table[:, 2])
    assert "and it stays as it is, because its motion before a jump" in doubted_jumps(log.remarks)


def test_an_inspection_tells_it_in_the_unit_of_the_file(tmp_path):
    angle = np.degrees(swung(2)[:, 2])
    rows = np.column_stack([0.01 * np.arange(len(angle)), wrapped(angle, 360.0, -180.0)])
    np.savetxt(tmp_path / "log.csv", rows, "%.9g", ",", header="time,angle_deg", comments="")
    found = inspect_log(tmp_path / "log.csv")
    assert any("by about a whole turn (360 deg)" in remark for remark in found.remarks)
    assert found.columns[0].most < 180.1
    assert np.ptp(found.values["angle_deg"] - angle) < 1e-5
