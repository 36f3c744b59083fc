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
    run,
    slider,
    slider_log,
    steps,
)

from identification import InputError
from identification.effects.joint_plant import joint_plant
from identification.model.plant import ModelPlant
from identification.model.predictor import Predictor
from identification.native import installer as native
from identification.native.joint_callback import KEY, WIDTH
from identification.native.joint_law import Numbers, force

FORCES = [e for e in slider().effects if e.columns]


def some(effect, where, factor=20.0):
    return {effect.effect.parameter(s.name, where): factor * s.probe for s in effect.effect.sizes}


def by_hand(plant, u, step, **sizes):
    """Positions of the slider by RK4 of m v̇ = 5 u - 3 v + f(x, v)."""
    p = Numbers(*plant.model.jnt_user[0, 1:])._replace(**sizes)

    def rate(s, u):
        return np.array([s[1], (5 * u - 3 * s[1] + force.py_func(s[0], s[1], 5 * u, p)) / 2])

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


@pytest.mark.parametrize("effect", FORCES, ids=lambda e: e.name)
def test_each_force_is_that_of_a_slow_integration(effect):
    plant = slider()
    u = steps(400)
    values = some(effect, "joint slide")
    simulated = run(plant, slider_log(u), **values)[1:, 0]
    n = len(effect.effect.sizes)
    sizes = dict(zip(effect.columns[:n], values.values(), strict=True))
    expected = by_hand(plant, np.repeat(u[:-1, 0], 5), 0.002, **sizes)[4::5]
    np.testing.assert_allclose(simulated, expected, rtol=0, atol=1e-13)
    assert np.abs(expected - run(plant, slider_log(u))[1:, 0]).max() > 1e-4


def test_a_force_is_what_the_equation_says():
    p = Numbers(*np.zeros(len(Numbers._fields)))._replace(
        v_0=0.1, f_c=2.0, d_a=3.0, v_s=1.0, f_0=1.0
    )
    for v in (-0.7, 0.02, 0.5):
        assert force(0.3, v, 0.0, p) == pytest.approx(1 - 2 * tanh(v / 0.1) - 3 * abs(v), abs=1e-15)
    spring = p._replace(v_0=1.0, f_c=0.0, d_a=0.0, f_0=0.0, k=4.0, k_3=-5.0)
    assert force(0.3, 0.0, 0.0, spring) == pytest.approx(-4 * 0.3 + 5 * 0.3**3, abs=1e-15)
    up, down = force(0.0, 0.5, 0.0, p) - 1, force(0.0, -0.5, 0.0, p) - 1
    assert (up, down) == pytest.approx((-2 - 1.5, 2 - 1.5), abs=1e-3)  # d_a brakes one way only


def test_on_an_arm_the_forces_are_those_of_qfrc_applied():
    plant, u = arm(), steps(60, 2)
    values = {}
    for effect in (e for e in plant.effects if e.columns):
        values |= some(effect, "all joints", 3.0) | some(effect, "joint elbow", 5.0)
    _, numbers = plant.settings(tuple(values), np.array([[*values.values()]]))
    simulated = run(plant, arm_log(u), **values)
    rows = np.array(plant.model.jnt_user)
    for slot, column in numbers:
        rows[slot.index()] = column[0]
    model = mujoco.MjModel.from_xml_string(ARM)
    assert model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    ends = []
    for fraction in (20, 40):  # Euler's error is of first order: two steps tell the limit
        model.opt.timestep = STEP / fraction
        ends.append(
            applied(model, rows, np.repeat(u[:-1], fraction, axis=0))[fraction - 1 :: fraction]
        )
    limit = 2 * ends[1] - ends[0]
    error = np.abs(simulated[1:] - limit).max()
    assert error < 2e-4 < 0.02 < np.abs(simulated - run(plant, arm_log(u))).max()


def applied(model, rows, inputs):
    data, out = mujoco.MjData(model), []
    for u in inputs:
        data.ctrl = u
        load = (
            2 * (u[0] + 0.1 - 0.3 * 2 * data.qpos[0] - 0.05 * 2 * data.qvel[0]),
            0.5 * np.clip(u[1], -0.4, 0.4),
        )
        for j in range(2):
            p = Numbers(*rows[j, 1:])
            data.qfrc_applied[j] = force.py_func(data.qpos[j], data.qvel[j], load[j], p)
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
    assert list(plant.model.jnt_user[0, :4]) == [7, 8, 9, KEY]
    wide = SLIDER.replace('damping="3"', f'damping="3" user="{"1 " * (WIDTH + 2)}"')
    native.install()
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
