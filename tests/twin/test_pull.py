"""A force on the platform: as in the thesis' equations, as MuJoCo's own, and as statics says."""

import mujoco
import numpy as np
import pytest

from inca_mj.effects.platform import PULL
from inca_mj.reference import layout as at
from inca_mj.reference.integrate import simulate_reference
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import GRAVITY, parameter_set
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.pulled import with_force

G, B_G = np.array([0.3, -0.5, 0.8]), np.array([0.03, 0.02, -0.1])


@pytest.fixture(scope="module")
def pulled():
    return with_force(build_twin(), G, B_G)


def test_the_twin_moves_as_the_thesis_equations_say(pulled):
    currents = make_input("prbs", 0.5)
    run = simulate(pulled, currents)
    right = simulate_reference(
        parameter_set("trial"), INCA, run.time, currents, force=G, force_at=B_G
    )
    np.testing.assert_allclose(run.motor_angle, right.angles, atol=1e-5)
    np.testing.assert_allclose(run.angles, right.state[:, at.EULER], atol=1e-5)
    assert np.abs(run.angles).max() > 0.05  # the arm of the force turns the platform


def test_at_the_centre_of_mass_it_is_mujocos_own_force(pulled):
    there = with_force(pulled, G)
    bare = build_twin()
    data = mujoco.MjData(bare.model)
    data.xfrc_applied[bare.model.body("platform").id, :3] = G
    run = simulate(there, np.zeros((21, 8)))
    for k in range(21):
        np.testing.assert_allclose(data.qpos, run.qpos[k], atol=1e-10)
        mujoco.mj_step(bare.model, data, 10)


def test_at_rest_it_is_balanced_by_the_tensions():
    """Σ T s and Σ R b × T s carry the weight less G, and the torque of G at R b_G."""
    pose = {"x": 0.05, "z": 1.4, "roll": 0.05, "yaw": -0.1}
    sizes = {f"pull.{n}": v for n, v in zip("xyz", 0.3 * G, strict=True)}
    point = {f"pull.b_{n}": v for n, v in zip("xyz", B_G, strict=True)}
    robot = build_twin(parameter_set("trial", pose), effects=(PULL,), settled=True)
    robot = robot.with_values({**sizes, **point})
    run = simulate(robot, np.zeros((101, 8)))
    assert np.abs(run.qpos - run.qpos[0]).max() < 1e-9

    data = mujoco.MjData(robot.model)
    data.qpos[:] = run.qpos[0]
    mujoco.mj_kinematics(robot.model, data)
    R = data.body("platform").xmat.reshape(3, 3)
    arm = INCA.B @ R.T
    s = run.position[0] + arm - INCA.A
    s /= np.linalg.norm(s, axis=1)[:, None]
    T = run.tension[0][:, None]
    weight = [0, 0, -robot.parameters["m"].value * GRAVITY]
    np.testing.assert_allclose((-T * s).sum(0) + weight + 0.3 * G, 0, atol=1e-8)
    torque = np.cross(arm, -T * s).sum(0) + np.cross(R @ B_G, 0.3 * G)
    np.testing.assert_allclose(torque, 0, atol=1e-9)


def test_no_force_changes_nothing(pulled):
    currents = make_input("step", 0.2)
    none = with_force(pulled, (0, 0, 0))
    assert [e.name for e in none.effects] == ["pull"]
    np.testing.assert_array_equal(
        simulate(none, currents).qpos, simulate(build_twin(), currents).qpos
    )
