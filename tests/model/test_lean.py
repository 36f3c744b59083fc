"""A model whose steps leave out what cannot act moves as the whole one does."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from identification.model.lean import (
    CONSTRAINTS,
    EULER,
    IMPLICIT,
    RK4,
    is_constrained,
    lean,
    slope_integrator,
)
from identification.model.paths import resolve
from identification.model.rollout import State, rollout

STEPS = 100
PLAIN = """<mujoco><option timestep="0.002" integrator="RK4"/>
  <worldbody>{floor}<body name="a" pos="0 0 0.2"><joint name="j" type="{kind}" axis="0 1 0"
    {joint}/><geom size="0.1" mass="1" {geom}/>
    <body name="b" pos="0 0 -0.4"><joint name="k" axis="0 1 0" damping="0.1"/>
      <geom size="0.05" mass="0.5" contype="0" conaffinity="0"/></body></body></worldbody>
  {more}<actuator><motor joint="k"/></actuator></mujoco>"""


def compiled(floor="", kind="hinge", joint="", geom="", more=""):
    text = PLAIN.format(floor=floor, kind=kind, joint=joint, geom=geom, more=more)
    return mujoco.MjModel.from_xml_string(text)


def stepped(model, v):
    """Positions after each step of the whole model, shape (STEPS, 2)."""
    data, out = mujoco.MjData(model), []
    data.qvel[:] = v
    for _ in range(STEPS):
        data.ctrl[:] = 0.2
        mujoco.mj_step(model, data)
        out.append(data.qpos.copy())
    return np.array(out)


def simulated(model, v, numbers=()):
    u = np.full((STEPS + 1, 1), 0.2)
    start = State(np.zeros(2), np.asarray(v), np.zeros(0))
    return rollout(model, start, u, model.opt.timestep, numbers=numbers)["qpos"][0, 1:]


CONSTRAINED = {
    "limit": {"joint": 'limited="true" range="-5 5"'},
    "friction": {"joint": 'frictionloss="0.3"'},
    "contact": {"floor": '<geom type="plane" size="1 1 1"/>', "kind": "slide"},
    "equality": {"more": '<equality><joint joint1="j" joint2="k"/></equality>'},
    "tendon": {"more": '<tendon><fixed name="t" frictionloss="0.2"><joint joint="j" coef="1"/>'
               "</fixed></tendon>"},
}  # fmt: skip


@given(st.floats(-5, 5), st.floats(-5, 5), st.sampled_from(["hinge", "slide"]))
@settings(max_examples=20, deadline=None)
def test_what_nothing_constrains_moves_the_same_to_the_bit_without_constraints(v, w, kind):
    model = compiled(kind=kind)
    assert not is_constrained(model)
    assert lean(model).opt.disableflags & CONSTRAINTS == CONSTRAINTS
    np.testing.assert_array_equal(simulated(model, (v, w)), stepped(model, (v, w)))


@pytest.mark.parametrize("kind", CONSTRAINED)
def test_a_model_that_something_may_constrain_keeps_its_constraints(kind):
    model = compiled(**CONSTRAINED[kind])
    assert is_constrained(model)
    assert not lean(model).opt.disableflags & CONSTRAINTS
    np.testing.assert_array_equal(simulated(model, (3.0, -2.0)), stepped(model, (3.0, -2.0)))


def test_dry_friction_that_only_a_value_set_has_acts_on_it():
    model = compiled()
    slot = resolve(model, "joint/j.frictionloss")
    assert is_constrained(model, [(slot, np.array([0.4]))])
    there = compiled(joint='frictionloss="0.4"')
    moved = simulated(model, (3.0, -2.0), [(slot, np.array([0.4]))])
    np.testing.assert_allclose(moved, stepped(there, (3.0, -2.0)), rtol=1e-12, atol=1e-12)


DAMPED = """<mujoco><option timestep="0.004" integrator="RK4"{option}/>
  <worldbody><body><joint name="a" axis="0 1 0" {joint}/><geom size="0.1" mass="1" pos="0.2 0 0"/>
    <body pos="0.4 0 0"><joint name="b" axis="0 1 0" damping="0.3"/>
      <geom size="0.1" mass="1" pos="0.2 0 0"/></body></body></worldbody>
  <tendon><fixed name="t" {tendon}><joint joint="a" coef="1"/><joint joint="b" coef="-1"/></fixed>
  </tendon><actuator>{actuator}</actuator></mujoco>"""
BY_JOINTS = [
    {}, {"joint": ""}, {"joint": 'damping="0.5" frictionloss="0.3" stiffness="4"'},
    {"joint": 'limited="true" range="-10 10"'}, {"tendon": 'stiffness="4"'},
    {"actuator": '<position joint="a" kp="10"/>'},
    {"actuator": '<general joint="a" dyntype="filter" dynprm="0.05" gainprm="2"/>'},
]  # fmt: skip
BY_OTHERS = [
    {"actuator": '<position joint="a" kp="10" kv="2"/>'},
    {"actuator": '<general joint="a" gaintype="affine" gainprm="1 0 -0.5"/>'},
    {"actuator": '<muscle joint="a" lengthrange="-1 1"/>'}, {"tendon": 'damping="0.4"'},
    {"option": ' density="100" viscosity="0.1"'},
]  # fmt: skip


def damped(what):
    plain = {"option": "", "joint": 'damping="0.5"', "tendon": "",
             "actuator": '<motor joint="a"/>'}  # fmt: skip
    return mujoco.MjModel.from_xml_string(DAMPED.format(**{**plain, **what}))


def moved_with(model, integrator):
    model.opt.integrator = integrator
    start = State(np.zeros(2), np.array([3.0, -5.0]), np.zeros(model.na))
    u = np.random.default_rng(0).standard_normal((STEPS + 1, 1))
    return rollout(model, start, u, model.opt.timestep)["qpos"]


@pytest.mark.parametrize("what", BY_JOINTS, ids=str)
def test_where_joints_alone_are_damped_the_simpler_integrator_takes_the_same_steps(what):
    model = damped(what)
    assert slope_integrator(model) == EULER
    np.testing.assert_array_equal(moved_with(model, EULER), moved_with(model, IMPLICIT))


@pytest.mark.parametrize("what", BY_OTHERS, ids=str)
def test_other_damping_needs_the_implicit_integrator(what):
    model = damped(what)
    assert slope_integrator(model) == IMPLICIT
    assert np.any(moved_with(model, EULER) != moved_with(model, IMPLICIT))


SERVO = """<mujoco><option timestep="0.002" integrator="{integrator}"/>
  <worldbody><body><joint name="j" axis="0 1 0" damping="0.02"/>
    <inertial pos="0.1 0 0" mass="0.3" diaginertia="1e-4 1e-4 1e-4"/></body></worldbody>
  <actuator><position joint="j" kp="10" kv="{kv}" forcerange="-1 1"/></actuator></mujoco>"""


def jump(model):
    """Largest change of a step's end between starts that lie close together, over a usual one."""
    v = np.linspace(0.0, 5.0, 20_001)  # the servo comes to its limit on the way
    start = State(np.zeros((len(v), 1)), v[:, None], np.zeros((len(v), 0)))
    end = rollout(model, start, np.full((2, 1), 0.2), 0.002, record=("qvel",))["qvel"][:, -1, 0]
    return np.abs(np.diff(end)).max() / np.median(np.abs(np.diff(end)))


@pytest.mark.parametrize("integrator", ["RK4", "implicitfast"])
@pytest.mark.parametrize("kv", [0.3, 4.0])  # stable without an implicit step, and not
def test_slopes_of_a_servo_that_comes_to_its_limit_have_no_jumps(integrator, kv):
    model = mujoco.MjModel.from_xml_string(SERVO.format(integrator=integrator, kv=kv))
    model.opt.integrator = IMPLICIT
    assert jump(model) > 10
    model.opt.integrator = {"RK4": RK4, "implicitfast": IMPLICIT}[integrator]
    chosen = model.opt.integrator = slope_integrator(model)
    if kv == 4.0:  # what no explicit step can take is simulated as the model says
        assert chosen == {"RK4": RK4, "implicitfast": IMPLICIT}[integrator]
    else:
        assert jump(model) < 3
