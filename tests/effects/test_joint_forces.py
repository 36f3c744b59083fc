"""The compiled forces against slow obvious integrations, and their absence to the bit."""

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
    reached,
    run,
    seen,
    share,
    slider,
    slider_log,
    steps,
    stopping_time,
    sums,
)
from scipy.optimize import lsq_linear

from identification import InputError
from identification.effects.plant.joint_plant import joint_plant
from identification.model.plant import ModelPlant
from identification.native.joints.joint_callback import TAG, Joint

HOOKS = ("force", "friction")
FORCES = {e.name: e for e in (*slider().effects, *arm().effects) if {*HOOKS} & {*e.hooks}}


def some(effect, where, factor=20.0):
    return {effect.parameter(s.name, where): factor * s.probe for s in effect.sizes}


def by_hand(plant, u, step, values):
    """Positions of the slider by RK4 of m v̇ = 5 u - 3 v + f(x, v)."""
    force = forces(plant, "slide", values)

    def rate(s, u, t):
        passive = -3 * s[1]
        more = force(s[0], s[1], 5 * u, 0, passive, 2, t)
        return np.array([s[1], (5 * u + passive + more) / 2])

    s, t, out = np.zeros(2), 0.0, []
    for k in u:
        a = rate(s, k, t)
        b = rate(s + step / 2 * a, k, t + step / 2)
        c = rate(s + step / 2 * b, k, t + step / 2)
        d = rate(s + step * c, k, t + step)
        s, t = s + step / 6 * (a + 2 * b + 2 * c + d), t + step
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


ON_SLIDER = [e for e in slider().effects if {*HOOKS} & {*e.hooks}]


@pytest.mark.parametrize("effect", ON_SLIDER, ids=lambda e: e.name)
def test_each_force_is_that_of_a_slow_integration(effect):
    plant = slider()
    late = effect.name.endswith("_jump") or effect.name == "push"  # something in the second second
    u = steps(400 if late else 150)
    values = some(effect, "joint slide")
    simulated = run(plant, slider_log(u), **values)[1:, 0]
    expected = by_hand(plant, np.repeat(u[:-1, 0], 5), 0.002, values)[4::5]
    np.testing.assert_allclose(simulated, expected, rtol=0, atol=1e-13)
    assert np.abs(expected - run(plant, slider_log(u))[1:, 0]).max() > 1e-4


S = Joint(time=2.0, q=0.3, v=0.5, f_u=-7.0, f_g=3.0, sign=1.0)
BACK = S._replace(v=-0.5, sign=-1.0)
CURVE = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0)
LAWS = [
    ("coulomb_friction", (2.0,), S, 2.0),
    ("coulomb_friction", (2.0,), BACK, 2.0),
    ("asymmetric_friction", (2.0,), S, 2.0),
    ("asymmetric_friction", (2.0,), BACK, -2.0),
    ("asymmetric_viscous_friction", (3.0,), S, -1.5),
    ("asymmetric_viscous_friction", (3.0,), BACK, -1.5),
    ("stribeck_friction", (2.0, 0.25, 2.0), S, 2 * np.exp(-4)),
    ("stribeck_friction", (2.0, 0.25, 1.0), BACK, 2 * np.exp(-2)),
    ("quadratic_friction", (3.0,), BACK, 0.75),
    ("sublinear_friction", (3.0, 0.5), BACK, 3 * 0.5**0.5),
    ("sublinear_friction", (3.0, 0.5), S._replace(v=0.0), 0.0),
    ("load_dependent_friction", (0.1,), S, 0.7),
    ("transmitted_load_friction", (0.1,), S, 1.0),
    ("gravity_load_friction", (0.1,), S, 0.3),
    ("load_stribeck_friction", (0.1, 0.25), S, np.exp(-2)),
    ("position_dependent_friction", (2.0,), S, 0.6),
    ("position_dependent_damping", (2.0,), BACK, 0.3),
    ("periodic_friction", (2.0, 3.0, 4.0), S, 2 * np.cos(1.2) + 3 * np.sin(1.2)),
    ("cogging", (2.0, 3.0, 4.0), S, 2 * np.cos(1.2) + 3 * np.sin(1.2)),
    ("offset", (1.0,), S, 1.0),
    ("gravity_force", (0.7,), S, -2.1),
    ("stiffness", (4.0,), S, -1.2),
    ("hardening", (-5.0,), S, 5 * 0.3**3),
    ("torque_saturation", (0.01,), S, 3.43),
    # f_m (1 + v/v_0) = 6 against the motion, f_m (1 - v/v_0) = 2 with it
    ("voltage_limit", (1.0, 4.0, 1.0), S, 1.0),
    ("voltage_limit", (0.5, 4.0, 1.0), S, 0.5),
    ("voltage_limit", (1.0, 4.0, 1.0), S._replace(f_u=7.0), -5.0),
    ("voltage_limit", (1.0, 4.0, 1.0), S._replace(f_u=1.9), 0.0),
    ("voltage_limit", (1.0, 4.0, 0.25), S._replace(f_u=1.9), -5.9),
    ("two_load_friction", (0.2, 0.5), S, 1.7),
    ("two_load_friction", (0.1, 3.0), S._replace(f_u=7.0), 0.2),
    ("quadratic_load_friction", (0.1, 0.2, 0.25), S, 0.9 * np.exp(-2)),
    ("quadratic_load_friction", (0.1, 0.2, 0.25), S._replace(f_g=8.0), 9.8 * np.exp(-2)),
    ("quadratic_load_friction", (0.1, 0.2, 0.25), S._replace(f_u=7.0), 0.0),
    ("friction_drift", (0.4,), S, 0.8),
    ("friction_jump", (0.4, 1.9, 0.1), S, 0.4),
    ("friction_jump", (0.4, 2.0, 0.1), S, 0.2),
    ("friction_jump", (0.4, 2.1, 0.1), S, 0.0),
    ("force_drift", (0.4,), BACK, 0.8),
    ("viscous_friction_drift", (0.4,), BACK, 0.4),
    ("viscous_friction_jump", (0.4, 1.9, 0.1), S, -0.2),
    ("curve_speed", CURVE, S._replace(v_top=2.0), 6.0),
    ("curve_speed", CURVE, BACK._replace(v_top=2.0), 2.0),
    ("curve_speed", CURVE, S._replace(v=2.0 * 0.375**2, v_top=2.0), 5.5),
    ("curve_speed", CURVE, S._replace(v=0.0), 0.0),
    ("curve_speed", CURVE, S._replace(v=9.0), 8.0),
    ("curve_load", CURVE, S._replace(f_top=448.0), 0.5),
    ("curve_load", CURVE, S._replace(f_u=8.0 * 0.875**2, f_top=8.0), 7.5),
    ("curve_position", CURVE, S._replace(q_mid=0.3, q_far=2.0), 4.5),
    ("curve_position", CURVE, S._replace(q_mid=9.3, q_far=2.0), 1.0),
    ("curve_position", CURVE, S._replace(q_mid=-0.7, q_far=1.0), 8.0),
    ("curve_before", CURVE, S._replace(x_before=0.0, x_behind=1.0), 4.5),
    ("curve_before", CURVE, S._replace(x_behind=1.0), 0.0),
    ("curve_behind", CURVE, S._replace(x_before=0.0, x_behind=1.0), 8.0),
    ("curve_behind", CURVE, S._replace(x_before=0.0), 0.0),
    ("curve_speed_before", CURVE, S._replace(v_before=0.25, v_behind=1.0), 6.0),
    ("curve_speed_before", CURVE, S._replace(v_behind=1.0), 0.0),
    ("curve_speed_behind", CURVE, S._replace(v_before=0.25, v_behind=-1.0), 4.0),
    ("curve_speed_behind", CURVE, S._replace(v_before=0.25), 0.0),
    ("curve_time", CURVE, S._replace(t_end=2.0), 8.0),
    ("curve_time", CURVE, S._replace(time=1.0, t_end=2.0), 4.5),
    ("push", (3.0, 1.0, 0.9, 0.1), S, 0.0),
    ("push", (3.0, 1.0, 1.1, 0.1), S, 3.0),
    ("push", (3.0, 2.1, 1.1, 0.1), S, 0.0),
]


@pytest.mark.parametrize(("name", "p", "s", "expected"), LAWS)
def test_a_force_is_what_the_equation_says(name, p, s, expected):
    (law,) = FORCES[name].hooks.values()
    assert law.py_func(s, p) == pytest.approx(expected, rel=1e-14)


def test_every_force_is_held_against_its_equation():
    assert {name for name, *_ in LAWS} == FORCES.keys()


def test_on_an_arm_the_forces_are_those_of_qfrc_applied():
    plant, u = arm(), steps(40, 2)
    values = {}
    for effect in (e for e in plant.effects if e.name in FORCES):
        for where, factor in (("all joints", 3.0), ("joint elbow", 5.0)):
            values |= some(effect, where, factor) if where in effect.places else {}
    simulated = run(plant, arm_log(u), **values)
    model = mujoco.MjModel.from_xml_string(ARM)
    assert model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    ends = []
    for fraction in (40, 80):  # Euler's error is of first order: two steps tell the limit
        model.opt.timestep = STEP / fraction
        ends.append(
            applied(plant, values, model, np.repeat(u[:-1], fraction, axis=0))[
                fraction - 1 :: fraction
            ]
        )
    limit = 2 * ends[1] - ends[0]
    error = np.abs(simulated[1:] - limit).max()
    assert error < 2e-4 < 0.02 < np.abs(simulated - run(plant, arm_log(u))).max()


@pytest.mark.parametrize("alpha", [1.0, 2.0])
def test_gravity_that_is_taken_away_is_that_of_another_model(alpha):
    """By MuJoCo's own compensation in every body; or by its gravity turned round."""
    floating = ARM.replace("<body ", '<body gravcomp="1" ')
    other = mujoco.MjModel.from_xml_string(floating if alpha == 1.0 else ARM)
    other.opt.gravity *= 1 if alpha == 1.0 else -1
    data, u, samples = mujoco.MjData(other), steps(100, 2), []
    for now in u:
        samples.append(np.array(data.qpos))
        data.ctrl[:] = now
        mujoco.mj_step(other, data, nstep=10)
    alike = run(arm(), arm_log(u), **{"gravity_force.alpha": alpha})
    start = run(arm(), arm_log(u))
    np.testing.assert_allclose(alike, samples, rtol=0, atol=1e-11)
    assert np.abs(start - samples).max() > 0.1


def applied(plant, values, model, inputs):
    """Positions of the arm whose friction is a bounded least-squares problem of its own."""
    data, still, out = mujoco.MjData(model), mujoco.MjData(model), []
    joints, M = ("shoulder", "elbow"), np.empty((2, 2))
    laws = [sums(plant, joint, values) for joint in joints]
    T = stopping_time(plant, joints[0])
    for u in inputs:
        data.ctrl = u
        drive = np.array([
            2 * (u[0] + 0.1 - 0.3 * 2 * data.qpos[0] - 0.05 * 2 * data.qvel[0]),
            0.5 * np.clip(u[1], -0.4, 0.4),
        ])  # fmt: skip
        still.qpos = data.qpos
        mujoco.mj_forward(model, still)  # at rest, all of the bias is gravity
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, M, data.qM) if hasattr(data, "qM") else mujoco.mj_fullM(
            model, data, M
        )
        x = [share(plant, joint, data.qpos[j]) for j, joint in enumerate(joints)]
        states = [
            seen(plant, joint, data.qpos[j], data.qvel[j], drive[j], -still.qfrc_bias[j], data.time)
            for j, joint in enumerate(joints)
        ]
        tops = [reached(plant, joint)[2] for joint in joints]
        v = [data.qvel[j] / top for j, top in enumerate(tops)]
        states = [
            states[0]._replace(x_behind=x[1], v_behind=v[1]),
            states[1]._replace(x_before=x[0], v_before=v[0]),
        ]
        more = np.array([force(s) for (force, _), s in zip(laws, states, strict=True)])
        g = M @ data.qvel / T + drive + data.qfrc_passive + more - data.qfrc_bias
        low, high = (
            np.array([b(s._replace(sign=sign)) for (_, b), s in zip(laws, states, strict=True)])
            for sign in (-1.0, 1.0)
        )
        data.qfrc_applied = more - slow_friction(M, g, low, high)
        mujoco.mj_step(model, data)
        out.append(np.array(data.qpos))
    return np.array(out)


def slow_friction(M, g, low, high):
    """argmin (f - g)ᵀ M⁻¹ (f - g), -low <= f <= high."""
    L = np.linalg.inv(np.linalg.cholesky(M))
    return lsq_linear(L, L @ g, (-low - 1e-15, high + 1e-15), method="bvls", tol=1e-15).x


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
