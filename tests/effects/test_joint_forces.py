"""The compiled forces against slow obvious integrations, and their absence to the bit."""

from math import tanh

import mujoco
import numpy as np
import pytest
from joint_cases import (
    ARM,
    DAMPING,
    MASS,
    SLIDER,
    STEP,
    arm,
    arm_log,
    forces,
    run,
    slider,
    slider_log,
    steps,
)

from identification import InputError
from identification.effects.joint_plant import joint_plant
from identification.model.plant import ModelPlant
from identification.model.predictor import Predictor
from identification.native.joint_callback import TAG, Joint

FORCES = {e.name: e for e in slider().effects if "force" in e.hooks}


def some(effect, where, factor=20.0):
    return {effect.parameter(s.name, where): factor * s.probe for s in effect.sizes}


def by_hand(plant, u, step, values):
    """Positions of the slider by RK4 of m v̇ = 5 u - 3 v + f(x, v)."""
    force = forces(plant, "slide", values)

    def rate(s, u):
        return np.array([s[1], (5 * u - 3 * s[1] + force(s[0], s[1], 5 * u)) / 2])

    s, out = np.zeros(2), []
    for k in u:
        a = rate(s, k)
        b = rate(s + step / 2 * a, k)
        c = rate(s + step / 2 * b, k)
        d = rate(s + step * c, k)
        s = s + step / 6 * (a + 2 * b + 2 * c + d)
        out.append(s[0])
    return np.array(out)


def test_sizes_of_zero_keep_the_bare_model_to_the_bit():
    for plant, text, log in (
        (slider(), SLIDER, slider_log(steps(400))),
        (arm(), ARM, arm_log(steps(300, 2))),
    ):
        own = plant.bare.parameters
        bare = ModelPlant(mujoco.MjModel.from_xml_string(text), own)
        np.testing.assert_array_equal(run(plant, log), run(bare, log))
        assert np.ptp(run(plant, log)) > 0.05


@pytest.mark.parametrize("effect", FORCES.values(), ids=lambda e: e.name)
def test_each_force_is_that_of_a_slow_integration(effect):
    plant = slider()
    u = steps(400)
    values = some(effect, "joint slide")
    simulated = run(plant, slider_log(u), **values)[1:, 0]
    expected = by_hand(plant, np.repeat(u[:-1, 0], 5), 0.002, values)[4::5]
    np.testing.assert_allclose(simulated, expected, rtol=0, atol=1e-13)
    assert np.abs(expected - run(plant, slider_log(u))[1:, 0]).max() > 1e-4


S = Joint(time=2.0, q=0.3, v=0.5, v_0=0.1, sign=tanh(5.0), f_u=-7.0)
BACK = S._replace(v=-0.5, sign=-tanh(5.0))
LAWS = [
    ("coulomb_friction", (2.0,), S, -2 * tanh(5)),
    ("coulomb_friction", (2.0,), BACK, 2 * tanh(5)),
    ("asymmetric_friction", (2.0,), S, -2 * tanh(5)),
    ("asymmetric_friction", (2.0,), BACK, -2 * tanh(5)),
    ("asymmetric_viscous_friction", (3.0,), S, -1.5),
    ("asymmetric_viscous_friction", (3.0,), BACK, -1.5),
    ("stribeck_friction", (2.0, 0.25), S, -2 * np.exp(-4) * tanh(5)),
    ("quadratic_friction", (3.0,), BACK, 0.75),
    ("load_dependent_friction", (0.1,), S, -0.7 * tanh(5)),
    ("position_dependent_friction", (2.0,), S, -0.6 * tanh(5)),
    ("position_dependent_damping", (2.0,), BACK, 0.3),
    ("periodic_friction", (2.0, 3.0, 4.0), S, -(2 * np.cos(1.2) + 3 * np.sin(1.2)) * tanh(5)),
    ("cogging", (2.0, 3.0, 4.0), S, 2 * np.cos(1.2) + 3 * np.sin(1.2)),
    ("offset", (1.0,), S, 1.0),
    ("stiffness", (4.0,), S, -1.2),
    ("hardening", (-5.0,), S, 5 * 0.3**3),
]


@pytest.mark.parametrize(("name", "p", "s", "expected"), LAWS)
def test_a_force_is_what_the_equation_says(name, p, s, expected):
    assert FORCES[name].hooks["force"].py_func(s, p) == pytest.approx(expected, rel=1e-14)


def test_every_force_is_held_against_its_equation():
    assert {name for name, *_ in LAWS} == FORCES.keys()


def test_on_an_arm_the_forces_are_those_of_qfrc_applied():
    plant, u = arm(), steps(60, 2)
    values = {}
    for effect in (e for e in plant.effects if "force" in e.hooks):
        values |= some(effect, "all joints", 3.0) | some(effect, "joint elbow", 5.0)
    simulated = run(plant, arm_log(u), **values)
    by_joint = [forces(plant, joint, values) for joint in ("shoulder", "elbow")]
    model = mujoco.MjModel.from_xml_string(ARM)
    assert model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    ends = []
    for fraction in (20, 40):  # Euler's error is of first order: two steps tell the limit
        model.opt.timestep = STEP / fraction
        ends.append(
            applied(model, by_joint, np.repeat(u[:-1], fraction, axis=0))[fraction - 1 :: fraction]
        )
    limit = 2 * ends[1] - ends[0]
    error = np.abs(simulated[1:] - limit).max()
    assert error < 2e-4 < 0.02 < np.abs(simulated - run(plant, arm_log(u))).max()


def applied(model, by_joint, inputs):
    data, out = mujoco.MjData(model), []
    for u in inputs:
        data.ctrl = u
        load = (
            2 * (u[0] + 0.1 - 0.3 * 2 * data.qpos[0] - 0.05 * 2 * data.qvel[0]),
            0.5 * np.clip(u[1], -0.4, 0.4),
        )
        for j in range(2):
            data.qfrc_applied[j] = by_joint[j](data.qpos[j], data.qvel[j], load[j])
        mujoco.mj_step(model, data)
        out.append(np.array(data.qpos))
    return np.array(out)


def test_a_batch_has_sizes_of_its_own_in_each_simulation():
    plant, log = slider(), slider_log(steps(100))
    name = "stribeck_friction.f_s@slide"
    many = Predictor(plant, log, (name,)).predict(np.array([[0.0], [0.3], [0.6]]))
    for row, size in zip(many, (0.0, 0.3, 0.6), strict=True):
        np.testing.assert_array_equal(row, run(plant.with_values({name: size}), log))
    assert not np.array_equal(many[1], many[2])


def test_other_models_are_left_alone_and_their_user_data_kept():
    text = SLIDER.replace('damping="3"', 'damping="3" user="7 8 9"')
    plant = joint_plant(text, (MASS, DAMPING), slider_log(steps(400)))
    assert list(plant.model.jnt_user[0, :3]) == [7, 8, 9]
    assert plant.model.jnt_user[0, -1] == TAG
    wide = SLIDER.replace('damping="3"', f'damping="3" user="{"1 " * 40}"')
    run(plant, slider_log(steps(10)))  # installs the law
    data = [mujoco.MjData(mujoco.MjModel.from_xml_string(t)) for t in (wide, SLIDER)]
    for d in data:
        d.ctrl = 1.0
        mujoco.mj_step(d.model, d, nstep=100)
    assert data[0].qpos[0] == data[1].qpos[0] > 0


def test_a_foreign_callback_is_refused():
    before = mujoco.get_mjcb_passive()
    mujoco.set_mjcb_passive(lambda m, d: None)
    try:
        with pytest.raises(InputError, match="mjcb_passive"):
            run(slider(), slider_log(steps(10)))
    finally:
        mujoco.set_mjcb_passive(before)
