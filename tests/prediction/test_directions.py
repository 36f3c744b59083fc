"""Columns of forces by linearised steps, in lockstep with simulations of a small size of each."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from identification import Log, Parameter
from identification.discovery.candidates import list_common, list_single
from identification.discovery.nominal_model import NominalModel
from identification.effects.plant.joint_plant import joint_plant
from identification.model.lean import RK4, slope_integrator
from identification.prediction.fits.nominal_fit import _priors, begin
from identification.prediction.scoring import columns as ways
from identification.prediction.scoring.columns import columns
from identification.prediction.scoring.forced import acts_on_joints
from identification.windows.fit import WindowFit
from identification.windows.problem import no_moves, problem
from identification.windows.records import as_records

STEP, SMALL = 0.01, 1e-5  # between samples [s]; of a probe
SLIDER = """<mujoco model="slider"><option timestep="0.005" integrator="{integrator}"/><worldbody>
  <body><joint name="j0" type="slide" axis="1 0 0" damping="0.5"{more}/><inertial pos="0 0 0"
  mass="1" diaginertia="1 1 1"/></body></worldbody>
  <actuator><motor name="u0" joint="j0" gear="4"/></actuator>
  <sensor><jointpos name="y0" joint="j0"/></sensor></mujoco>"""
ARM = """<mujoco model="arm"><option timestep="0.005" integrator="{integrator}"/><worldbody>
  <body><joint name="j0" axis="0 0 1" damping="0.3" armature="0.05"{more}/>
    <inertial pos="0.1 0 0.05" mass="2" diaginertia="0.02 0.02 0.02"/>
  <body pos="0.2 0 0"><joint name="j1" axis="0 1 0" damping="0.3" armature="0.05"/>
    <inertial pos="0.1 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>
  <body pos="0.2 0 0"><joint name="j2" axis="0 1 0" damping="0.2" armature="0.02"/>
    <inertial pos="0.05 0.01 0" mass="0.5" diaginertia="0.01 0.01 0.01"/></body></body></body>
  </worldbody>
  <actuator><position name="u0" joint="j0" kp="20" kv="1"/><position name="u1" joint="j1" kp="25"/>
    <position name="u2" joint="j2" kp="15" forcerange="-6 6"/></actuator>
  <sensor><jointpos name="y0" joint="j0"/><jointpos name="y1" joint="j1"/>
    <jointvel name="y2" joint="j2"/></sensor></mujoco>"""
PENDULUM = """<mujoco model="pendulum"><option timestep="0.005" integrator="{integrator}"/>
  <worldbody><body><joint name="j0" axis="0 1 0" damping="0.02"{more}/>
    <inertial pos="0 0 -0.1" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/></body></worldbody>
  <actuator><motor name="u0" joint="j0"/></actuator>
  <sensor><jointpos name="y0" joint="j0"/></sensor></mujoco>"""
COULOMB, HARDENING = {"coulomb_friction.f_c@j0": 0.3}, {"hardening.k_3@j0": 2.0}
# With such gains steps of Euler would diverge.
STIFF = ARM.replace('kp="20" kv="1"', 'kp="200" kv="90" forcerange="-40 40"').replace(
    'kp="15"', 'kp="60" kv="8"')  # fmt: skip
RUBS = 'frictionloss="0.2" damping'  # by MuJoCo's own dry friction
TIED = """<equality><joint joint1="j1" joint2="j2" polycoef="0 0.7 0 0 0"/></equality></mujoco>"""
FILTERED = ARM.replace('kp="25"', 'kp="25" timeconst="0.04"').replace(
    'kv="1"', 'kv="1" timeconst="0.1"')  # fmt: skip
CASES = {
    "slider": (SLIDER, "Euler", {}, 1),
    "slider that rubs": (SLIDER, "implicitfast", COULOMB, 1),
    "pendulum": (PENDULUM, "RK4", {"stiffness.k@j0": 0.1}, 1),
    "pendulum that rubs": (PENDULUM, "RK4", {"coulomb_friction.f_c@j0": 0.05}, 1),
    "arm": (ARM, "RK4", {}, 1),
    "arm with longer steps": (ARM, "RK4", HARDENING, 2),
    "arm with implicit steps": (ARM, "implicit", HARDENING, 1),
    "arm that rubs": (ARM, "implicitfast", {"coulomb_friction.f_c": 0.3, **HARDENING}, 1),
    "arm with late sensors": (ARM, "RK4", {"encoder_lag.tau@y1": 0.02, "encoder_scale.s@y2": 0.1},
                              1),
    "slider of a model with friction": (SLIDER.replace("damping", RUBS.replace("0.2", "0.3")),
                                        "Euler", {}, 1),
    "arm of a model with friction": (ARM.replace("damping", RUBS), "implicitfast", HARDENING, 1),
    "arm whose joints are tied": (ARM.replace("</mujoco>", TIED), "implicitfast", HARDENING, 1),
    "arm that filters its setpoints": (
        FILTERED, "implicitfast", {"servo_gain.gamma@j1": 0.2, "dead_band.d@j0": 0.01}, 1,
    ),
    "tied arm of a model with friction": (
        ARM.replace("damping", RUBS).replace("</mujoco>", TIED), "RK4", {}, 1,
    ),
}  # fmt: skip


def log(joints, seed, samples=120):
    rng, t = np.random.default_rng(seed), STEP * np.arange(samples)
    waves = rng.uniform(2, 9, joints), rng.uniform(0, 6, joints)
    return Log(
        time=t, inputs=0.6 * np.sin(np.outer(t, waves[0]) + waves[1]),
        outputs=0.5 * np.sin(np.outer(t, waves[0]) + waves[1] - 0.3),
        input_names=[f"u{k}" for k in range(joints)], name=f"record {seed}",
        output_names=[f"y{k}" for k in range(joints)],
    )  # fmt: skip


@cache
def fitted(text, integrator, values, steps=1, more="", records=2):
    """Windows of some records, linearised where they begin; nothing is fitted."""
    joints = text.count("<jointpos") + text.count("<jointvel")
    logs = [log(joints, k) for k in range(records)]
    free = Parameter(name="d", value=0.1, where="joint/j0.damping", lower=0.0, upper=2.0,
                     unit="N m s/rad")  # fmt: skip
    plant = joint_plant(text.format(integrator=integrator, more=more), (free,), logs[0])
    plant = replace(plant.with_values(dict(values)), slope_steps=steps)
    model = NominalModel(plant, ("d",), np.array([0.5]), 0.3)
    shared, own = _priors(model)
    task = problem(plant, as_records(logs, []), shared, own, 0.3, {}, np.ones(joints))
    q, moves = begin(model, task.unknowns), no_moves(task)
    tangents = task.tangents(q, moves)
    return WindowFit(problem=task, q=q, moves=moves, tangents=tangents, cost=1.0, converged=True,
                     steps=1)  # fmt: skip


def of_case(name):
    text, integrator, values, steps = CASES[name]
    return fitted(text, integrator, tuple(values.items()), steps)


def forces(fit):
    common = list_common([e for e in fit.problem.plant.effects if acts_on_joints(e)])
    return [*common, *list_single(common)]


def simulated(fit, group, share, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(ways, "forces_of", lambda fit: (None,) * len(fit.moves))
        return columns(fit, group, share)


def off(found, truth):
    """How far each column is from another one, of the norm of this."""
    a, b = np.concatenate(found), np.concatenate(truth)
    a, b = (x.reshape(-1, x.shape[-1]) for x in (a, b))
    size = np.linalg.norm(b, axis=0)
    return np.linalg.norm(a - b, axis=0) / np.where(size > 0, size, 1.0)


@pytest.mark.parametrize("name", CASES)
def test_columns_are_those_of_simulations_with_a_small_size(name, monkeypatch):
    fit = of_case(name)
    group = forces(fit)
    assert len(group) > 40
    each = off(columns(fit, group, SMALL), simulated(fit, group, SMALL, monkeypatch))
    assert np.quantile(each, 0.95) < 1e-4
    assert np.mean(each) < 5e-3  # what acts at a few points alone is nearly rounding


def test_what_is_no_force_on_joints_and_where_a_constraint_acts_is_simulated(monkeypatch):
    """A joint's limit, a state of a joint, a shift of a reading, an inertia keep their way."""
    free = fitted(ARM, "RK4", ())
    kept = {e.name for e in free.problem.plant.effects if not acts_on_joints(e)}
    assert kept >= {"joint_elasticity", "presliding", "encoder_offset", "rotor_inertia"}
    assert not kept & {"coulomb_friction", "offset", "cogging", "hardening", "curve_time"}
    other = list_single(list_common([e for e in free.problem.plant.effects if e.name in kept]))
    few = [c for c in other if c.effect.name in ("encoder_offset", "rotor_inertia")]
    assert np.array_equal(columns(free, few), simulated(free, few, 1.0, monkeypatch))

    group = forces(free)[:5]
    stopped = fitted(ARM, "RK4", (), more=' limited="true" range="-1e-3 1e-3"')
    assert not any(f.along.is_smooth.any() for f in ways.forces_of(stopped))
    assert np.array_equal(columns(stopped, group), simulated(stopped, group, 1.0, monkeypatch))

    stiff = fitted(STIFF, "RK4", ())  # its steps have to be those of Runge and Kutta
    assert slope_integrator(stiff.problem.plant.model) == RK4
    assert np.array_equal(columns(stiff, group), simulated(stiff, group, 1.0, monkeypatch))

    gives = fitted(ARM, "RK4", (("joint_elasticity.c@j0", 1e-3),))
    assert not any(ways.forces_of(gives))


def test_some_windows_that_touch_a_limit_are_simulated_and_the_others_are_not(monkeypatch):
    fit = fitted(ARM, "RK4", (), more=' limited="true" range="-115 20"')
    group = [c for c in forces(fit) if c.effect.name in ("offset", "quadratic_friction")]
    smooth = np.concatenate([f.along.is_smooth for f in ways.forces_of(fit)])
    assert 0 < smooth.mean() < 1
    found, truth = (
        np.concatenate([S.reshape(len(t.r), -1, S.shape[1])
                        for S, t in zip(each, fit.tangents, strict=True)])
        for each in (columns(fit, group, SMALL), simulated(fit, group, SMALL, monkeypatch))
    )  # fmt: skip
    assert np.array_equal(found[~smooth], truth[~smooth])
    assert off([found[smooth]], [truth[smooth]]).max() < 1e-3
