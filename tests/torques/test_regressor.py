"""Forces are linear in the ten numbers of each body, and are those of MuJoCo's inverse dynamics."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from torque_cases import TREE, planar, planar_record

from identification.torques.equations.bodies import list_bodies, read_numbers, regressor
from identification.torques.equations.rows import make_rows, refuse_unfit

MODEL = mujoco.MjModel.from_xml_string(TREE)


def motion(model, n=5, seed=0):
    rng = np.random.default_rng(seed)
    return [rng.normal(0, size, (n, model.nv)) for size in (1, 2, 5)]


def inverse(model, q, v, a):
    data, out = mujoco.MjData(model), np.empty(q.shape)
    for k in range(len(q)):
        data.qpos, data.qvel, data.qacc = q[k], v[k], a[k]
        mujoco.mj_inverse(model, data)
        out[k] = data.qfrc_inverse
    return out


def test_the_regressor_times_the_models_numbers_is_its_inverse_dynamics():
    q, v, a = motion(MODEL)
    Y, _ = regressor(MODEL, q, v, a)
    linear = np.einsum("kjbn,bn->kj", Y, read_numbers(MODEL)) + MODEL.dof_armature * a
    linear += MODEL.dof_damping * v + MODEL.jnt_stiffness * (q - MODEL.qpos_spring)
    np.testing.assert_allclose(linear, inverse(MODEL, q, v, a), rtol=1e-9, atol=1e-9)


def test_each_column_is_what_one_body_more_needs():
    q, v, a = motion(MODEL)
    Y, _ = regressor(MODEL, q, v, a)
    b = list_bodies(MODEL).index(MODEL.body("c").id)
    p, m = np.array([0.1, -0.2, 0.3]), 0.6
    load = f'<body pos="0.1 -0.2 0.3"><inertial pos="0 0 0" mass="{m}" diaginertia="0 0 0"/></body>'
    own = '<body name="c" pos="0 0.2 0">'
    loaded = mujoco.MjModel.from_xml_string(TREE.replace(own, own + load))
    more = inverse(loaded, q, v, a) - inverse(MODEL, q, v, a)
    I_O = m * (p @ p * np.eye(3) - np.outer(p, p))
    numbers = [m, *(m * p), *I_O[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]]
    np.testing.assert_allclose(Y[:, :, b] @ numbers, more, rtol=1e-6, atol=1e-6)


def test_gravity_is_the_force_at_rest():
    q, v, a = motion(MODEL)
    _, weight = regressor(MODEL, q, v, a)
    data = mujoco.MjData(MODEL)
    data.qpos = q[2]
    mujoco.mj_forward(MODEL, data)
    np.testing.assert_allclose(weight[2], -data.qfrc_bias, rtol=1e-9, atol=1e-12)


def test_equations_of_a_record_are_fulfilled_by_the_truth():
    model = mujoco.MjModel.from_xml_string(planar())
    (rows,) = make_rows(model, (planar_record(1, noise=0.0),))
    τ = np.einsum("kjbn,bn->kj", rows.bodies, read_numbers(model)) + model.dof_armature * rows.a
    left = rows.y - τ - model.dof_damping * rows.v - model.dof_frictionloss * rows.sign
    assert rows.used.sum() > 100
    assert np.abs(left[rows.used]).max() < 0.03 * np.abs(rows.y).max()
    assert np.sqrt(np.mean(left[rows.used] ** 2)) < 0.005 * rows.y.std()


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (lambda s: s.replace('type="slide"', 'type="ball"'), "neither hinge nor slide"),
        (
            lambda s: s.replace(
                "</mujoco>",
                '<equality><joint joint1="turn" joint2="bend"/></equality></mujoco>',
            ),
            "equality constraints",
        ),
        (
            lambda s: s.replace(
                "</mujoco>",
                '<actuator><general joint="turn" dyntype="filter" dynprm="0.1"/></actuator>'
                "</mujoco>",
            ),
            "state of its own",
        ),
        (lambda s: s, "is the position of joint 'shoulder'"),
    ],
)
def test_what_has_no_equations_is_refused(change, word, refusal):
    log = planar_record(1, lasts=0.5)
    if word.startswith("is the"):
        model = mujoco.MjModel.from_xml_string(planar())
        log = replace(log, outputs=log.outputs[:, 1:], output_names=("q2",))
    else:
        model = mujoco.MjModel.from_xml_string(
            change(TREE.replace('axis="1 0.3 0" stiffness="3" armature="0.1"', 'axis="1 0.3 0"'))
        )
    assert word in refusal(refuse_unfit, model, log)


def test_logs_without_a_drive_are_refused(refusal):
    model = mujoco.MjModel.from_xml_string(planar())
    log = planar_record(1, lasts=2.0)
    assert "no input moves" in refusal(make_rows, model, (replace(log, inputs=0 * log.inputs),))


def test_a_motion_that_reverses_too_often_is_told_in_these_words(refusal):
    """It said "between two turns", which may as well be revolutions of a motor."""
    model, log = mujoco.MjModel.from_xml_string(planar()), planar_record(1, lasts=4.0)
    fast = 0.1 * np.sin(2 * np.pi * 20 * log.time)[:, None] * [1, 0.7]
    said = refusal(make_rows, model, (replace(log, outputs=fast),))
    assert "between two reversals of its direction" in said
    assert "turns" not in said


def test_a_value_of_one_record_is_known_there():
    model, loaded = (mujoco.MjModel.from_xml_string(planar(m)) for m in (0.0, 0.7))
    logs = planar_record(1, lasts=4.0), planar_record(2, 0.7, lasts=4.0)
    for rows in make_rows(model, logs, (model, loaded)):
        τ = np.einsum("kjbn,bn->kj", rows.bodies, read_numbers(model))
        τ += model.dof_armature * rows.a + model.dof_damping * rows.v
        left = rows.y - τ - model.dof_frictionloss * rows.sign
        assert np.sqrt(np.mean(left[rows.used] ** 2)) < 0.02 * rows.y.std()
