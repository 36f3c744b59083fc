"""The simulators of hidden worlds: energy, order, MuJoCo beside them, friction that holds."""

import mujoco
import numpy as np
import pytest
from joint_worlds import slots as at
from joint_worlds.motion import ROBOTS, terms, windows
from joint_worlds.slots import plain_joints
from joint_worlds.world import held_base

ALL = pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)


def run(robot, joints, start, inputs, steps):
    """Positions [rad or m] at samples under inputs, from a start (q, v), shape (N, n)."""
    state = np.zeros((1, 4, robot.n))
    state[0, :2], state[0, 3] = start, inputs[0]
    out = windows(
        robot.code, robot.plain()[0], joints, np.array([0]), state, inputs,
        np.zeros_like(inputs), len(inputs), robot.sampling_time / steps, steps,
    )  # fmt: skip
    return out[0]


def moving(robot, seconds=0.5):
    """A start in motion, and inputs that are no torque at all."""
    rng = np.random.default_rng(3)
    start = rng.uniform(-0.5, 0.5, (2, robot.n)) * [robot.travel, robot.speed]
    return start, np.zeros((round(seconds / robot.sampling_time), robot.n))


@ALL
def test_dynamics_are_those_of_mujoco(robot):
    model = mujoco.MjModel.from_xml_string(robot.mjcf(robot.plain()[0], np.zeros(robot.n)))
    data, rng, n = mujoco.MjData(model), np.random.default_rng(5), robot.n
    for _ in range(5):
        data.qpos[:], data.qvel[:] = rng.normal(size=(2, n))
        mujoco.mj_forward(model, data)
        want = rng.normal(size=n)
        M, c, g = np.zeros((n, n)), np.zeros(n), np.zeros(n)
        terms(robot.code, data.qpos, data.qvel, robot.plain()[0], M, c, g)
        data.qacc[:] = want
        mujoco.mj_inverse(model, data)
        np.testing.assert_allclose(M @ want + c + g, data.qfrc_inverse, rtol=1e-9, atol=1e-11)


@ALL
def test_trajectories_without_effects_are_those_of_mujoco(robot):
    joints = plain_joints(robot.n)
    joints[:, at.VISCOUS] = robot.damping
    start, inputs = moving(robot)
    inputs += 0.1 * np.array(robot.coulomb)
    ours = run(robot, joints, start, inputs, robot.substeps)
    model = mujoco.MjModel.from_xml_string(robot.mjcf(robot.plain()[0], np.array(robot.damping)))
    model.opt.timestep, data = robot.sampling_time / 20, mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = start
    theirs = np.empty_like(ours)
    for k, u in enumerate(inputs):
        data.ctrl[:] = u
        mujoco.mj_step(model, data, 20)
        theirs[k] = data.qpos
    assert np.abs(ours - theirs).max() < 1e-7 * np.abs(theirs).max()


@ALL
def test_steps_are_of_fourth_order(robot):
    start, inputs = moving(robot, 0.2)
    joints = plain_joints(robot.n)
    joints[:, at.VISCOUS] = robot.damping
    exact = run(robot, joints, start, inputs, 64)[-1]
    errors = [np.abs(run(robot, joints, start, inputs, m)[-1] - exact).max() for m in (1, 2)]
    assert errors[0] / errors[1] > 12  # 16 in the limit


@ALL
def test_energy_stays_without_friction_and_input(robot):
    """By the power of gravity and springs along the way: d(v^T M v / 2) = -(g + k q) v dt."""
    start, inputs = moving(robot)
    q = run(robot, plain_joints(robot.n), start, inputs, 20)
    h, p, n = robot.sampling_time, robot.plain()[0], robot.n
    q = np.vstack([start[0], q])
    v = (q[:-4] - 8 * q[1:-3] + 8 * q[3:-1] - q[4:]) / (12 * h)
    q = q[2:-2]
    kinetic, power, zero = np.empty(len(q)), np.empty(len(q)), np.zeros(n)
    for k in range(len(q)):
        M, c, g = np.zeros((n, n)), np.zeros(n), np.zeros(n)
        terms(robot.code, q[k], zero, p, M, c, g)
        kinetic[k], power[k] = v[k] @ M @ v[k] / 2, -(c + g) @ v[k]
    work = np.concatenate([[0.0], np.cumsum(power[:-1] + power[1:]) * h / 2])
    turned = kinetic.max() - kinetic.min()
    assert np.abs(kinetic - kinetic[0] - work).max() < 5e-3 * turned  # the trapezoid's order


@ALL
def test_friction_holds_what_drives_less(robot):
    joints = held_base(robot).joints
    within = joints[:, at.COULOMB] / joints[:, at.STIFF]
    inputs = gravity(robot) + 0.5 * joints[:, at.COULOMB]
    count = round(0.5 / robot.sampling_time)
    q = run(robot, joints, np.zeros((2, robot.n)), np.tile(inputs, (count, 1)), robot.substeps)
    np.testing.assert_allclose(q[-1], 0.5 * within, rtol=0.01)  # the contact carries the load
    assert (np.ptp(q[count // 2 :], axis=0) < 0.01 * within).all()  # no creep


def test_a_cart_is_braked_by_as_much_as_friction_is():
    """v(t) = v_0 - f t/m until it stands, without spring and damping."""
    robot = ROBOTS["cart"]
    joints = plain_joints(1)
    joints[:, at.COULOMB], joints[:, at.STIFF], joints[:, at.DAMP] = 6.0, 1e6, 5e3
    p = robot.plain()[0]
    p[1] = 0.0
    state = np.zeros((1, 4, 1))
    state[0, 1] = 0.5
    nothing = np.zeros((400, 1))
    x = windows(1, p, joints, np.array([0]), state, nothing, nothing, 400, 1e-4, 50)[0, :, 0]
    assert x[-1] == pytest.approx(0.5**2 * p[0] / (2 * 6.0), abs=2e-5)
    assert np.ptp(x[300:]) < 1e-9


def gravity(robot):
    M, c, g, zero = np.zeros((robot.n, robot.n)), *np.zeros((3, robot.n))
    terms(robot.code, zero, zero, robot.plain()[0], M, c, g)
    return g
