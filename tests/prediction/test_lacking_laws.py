"""Laws that a model lacked: gravity that is not what it has, and a force that grows with time."""

from dataclasses import replace
from functools import cache

import mujoco
import numpy as np
import pytest
from arm_cases import LOG, text
from plain_logs import plain_log

from identification.discovery.nominal_model import NominalModel
from identification.effects.axes import axes
from identification.effects.plant.joint_plant import candidates, joint_plant
from identification.model.parameter import Parameter
from identification.prediction.discovery import discover_records

NOISE, SAMPLES, STEP = 2e-4, 300, 0.01
PLAIN = text(0.002, "implicitfast")
FLOATING = PLAIN.replace("<body ", '<body gravcomp="0.7" ')  # MuJoCo compensates in each body
TURNED = PLAIN.replace("0 0 -9.81", "0 0 9.81")  # it hangs upside down
SHAFT = """<mujoco model="shaft"><option timestep="0.005" integrator="RK4"/>
  <worldbody><body name="rotor"><joint name="shaft" axis="0 0 1" damping="2e-3"/>
    <inertial pos="0 0 0" mass="1" diaginertia="1e-3 1e-3 5e-4"/></body></worldbody>
  <actuator><motor name="torque" joint="shaft"/></actuator>
  <sensor><jointpos name="angle" joint="shaft"/></sensor></mujoco>"""


def free(name, value):
    return Parameter(name=name, value=value, unit="N m s/rad", where=name, lower=0.0, upper=1.0)


def measured(model, u, seed, more=lambda t: 0.0):
    """Angles under inputs (N, nu) with noise, with a further torque on the first joint."""
    m, rng, out = mujoco.MjModel.from_xml_string(model), np.random.default_rng(seed), []
    d = mujoco.MjData(m)
    for row in u:
        out.append(np.array(d.qpos))
        d.ctrl[:] = row
        for _ in range(round(STEP / m.opt.timestep)):
            d.qfrc_applied[0] = more(d.time)
            mujoco.mj_step(m, d)
    return np.array(out) + NOISE * rng.standard_normal((len(u), m.nq))


@cache
def arm_found(model):
    """A search of an arm whose logs another model made."""
    names = ("joint/shoulder.damping", "joint/elbow.damping")
    plant = joint_plant(PLAIN, [free(n, v) for n, v in zip(names, (0.1, 0.05), strict=True)], LOG)
    logs = []
    for seed in range(4):
        levels = np.random.default_rng(seed).uniform(-1, 1, (SAMPLES // 20, 2)) * (4.0, 1.5)
        u = np.repeat(levels, 20, axis=0)
        y = measured(model, u, seed)
        time = STEP * np.arange(SAMPLES)
        logs.append(replace(LOG, time=time, inputs=u, outputs=y, name=f"record {seed}"))
    wanted = ("gravity_force", "mass_mismatch", "stiffness", "offset", "encoder_scale", "cogging")
    effects = [e for e in candidates(plant, names) if e.name in wanted]
    base = NominalModel(plant, names, np.array([0.3, 0.3]), 0.2)
    return discover_records(base, logs[:2], logs[2:], effects)


@pytest.mark.long
@pytest.mark.parametrize(("model", "alpha"), [(FLOATING, 0.7), (TURNED, 2.0)])
def test_gravity_that_is_compensated_or_turned_round_is_named_with_its_share(model, alpha):
    found = arm_found(model)
    (named,) = found.named
    assert named.name == "gravity_force"
    for value, _, _ in named.parameters.values():
        assert value == pytest.approx(alpha, abs=0.01)
    assert found.after.rms < 0.02 * found.before.rms


@pytest.mark.long
def test_a_torque_that_grows_with_time_is_named_on_a_shaft_that_turns_on_and_on():
    """Forward runs have angles above zero and backward ones below: an angle is no place there."""
    growth, logs = 3e-3, []
    for seed, sign in enumerate((1, -1, 1, -1)):
        rng = np.random.default_rng(seed)
        u = sign * np.repeat(rng.uniform(0.02, 0.12, 30), 20)[:, None]
        y = measured(SHAFT, u, seed, lambda t: growth * t)
        logs.append(plain_log(u, y, "torque", "angle", STEP, name=f"record {seed}"))
    names = ("joint/shaft.damping",)
    model = mujoco.MjModel.from_xml_string(SHAFT)
    plant = joint_plant(SHAFT, [free(names[0], 2e-3)], logs[0], joints=axes(model, logs[0]))
    assert plant.axes[0].travel > 20
    effects = candidates(plant, names)
    assert not {e.name for e in effects} & {"stiffness", "position_dependent_friction"}
    base = NominalModel(plant, names, np.array([0.3]), 0.5)
    found = discover_records(base, logs[:2], logs[2:], effects)
    (named,) = found.named
    assert named.name == "force_drift"
    assert named.parameters["f_t"][0] == pytest.approx(growth, rel=0.02)
