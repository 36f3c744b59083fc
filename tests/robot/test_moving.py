"""Forces of moving bodies are those of recursive Newton-Euler, body by body."""

import copy

import mujoco
import numpy as np
import pytest

from identification.robot.moving import follow_bodies, inertial_force, point_force, weights

ARM = """
<mujoco>
  <worldbody>
    <body name="a" pos="0 0 0.2" euler="10 20 30">
      <joint name="turn" axis="0.2 0.1 1"/>
      <inertial pos="0.1 0.02 0.3" mass="2" fullinertia="0.03 0.02 0.04 0.001 0.002 0.003"/>
      <body name="b" pos="0.3 0 0.1" euler="40 0 10">
        <joint name="slip" type="slide" axis="1 0.3 0"/>
        <inertial pos="0 0.1 0.05" mass="1" fullinertia="0.01 0.02 0.015 0.001 0 0.002"/>
        <body name="c" pos="0 0.2 0">
          <joint name="bend" axis="0 1 0.4" pos="0 0.01 0"/>
          <inertial pos="0.05 0 0.1" mass="0.5" diaginertia="0.004 0.003 0.002"/>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
MODEL = mujoco.MjModel.from_xml_string(ARM)
POINT = np.array([0.1, -0.2, 0.05])


def motion(seed):
    rng = np.random.default_rng(seed)
    return [rng.normal(0, size, (4, MODEL.nv)) for size in (1, 2, 5)]


def newton_euler(model, q, v, a):
    """Forces without gravity of a model whose other bodies weigh nothing."""
    data, force = mujoco.MjData(model), np.empty(v.shape)
    for k in range(len(q)):
        data.qpos, data.qvel, data.qacc = q[k], v[k], a[k]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 1, force[k])
    return force


def alone(body, mass, inertia, ipos):
    model = copy.copy(MODEL)
    model.body_mass[:], model.body_inertia[:], model.opt.gravity[:] = 0, 0, 0
    model.body_mass[body], model.body_inertia[body], model.body_ipos[body] = mass, inertia, ipos
    return model


@pytest.mark.parametrize("body", [1, 2, 3])
def test_a_body_by_itself_and_a_point_of_it(body):
    q, v, a = motion(body)
    found = follow_bodies(MODEL, q, v, a, [1, 2, 3])[body]
    mass, inertia, ipos = (x[body] for x in (MODEL.body_mass, MODEL.body_inertia, MODEL.body_ipos))
    exact = newton_euler(alone(body, mass, inertia, ipos), q, v, a)
    np.testing.assert_allclose(inertial_force(found, mass, inertia), exact, atol=1e-10)
    exact = newton_euler(alone(body, 1.0, 0.0, ipos + POINT), q, v, a)
    np.testing.assert_allclose(point_force(found, POINT), exact, atol=1e-10)


@pytest.mark.parametrize("body", [1, 2, 3])
def test_a_weight_is_the_jacobian_of_its_point(body):
    q, v, a = motion(body)
    found = np.stack(weights(follow_bodies(MODEL, q, v, a, [body])[body], POINT), axis=1)
    data = mujoco.MjData(MODEL)
    for k in range(len(q)):
        data.qpos = q[k]
        mujoco.mj_forward(MODEL, data)
        at, J = data.xipos[body] + data.ximat[body].reshape(3, 3) @ POINT, np.zeros((3, MODEL.nv))
        mujoco.mj_jac(MODEL, data, J, None, at, body)
        np.testing.assert_allclose(found[k], J, atol=1e-12)


def test_all_bodies_together_are_the_robot():
    q, v, a = motion(7)
    bodies = follow_bodies(MODEL, q, v, a, [1, 2, 3])
    every = sum(
        inertial_force(body, MODEL.body_mass[b], MODEL.body_inertia[b])
        for b, body in bodies.items()
    )
    whole = copy.copy(MODEL)
    whole.opt.gravity[:] = 0
    np.testing.assert_allclose(every, newton_euler(whole, q, v, a), atol=1e-10)
