"""Robots of many joints and long logs are read in a bounded time, and right ones are not refused.

In a chain the noises of all accelerations act on its first joint, where the accelerations cancel.
"""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from test_robot_wiring import robot

from identification import Log
from identification.errors import InputError
from identification.robot import wiring
from identification.robot.balance import unbalanced_share
from identification.robot.scale import NEEDED, rescaled
from identification.robot.wiring import refuse_miswired

STEP, HELD = 0.01, 20  # [s], and samples for which a torque is held


def chain_of(joints, mass, stiffness):
    """Bodies that hang on each other, with a motor and an encoder at each joint."""
    axes = ("0 1 0", "1 0 0")
    bodies = "".join(
        f"""<body pos="0 0 {-0.15 if k else 0}"><joint name="j{k}" axis="{axes[k % 2]}"
        damping="0.1" stiffness="{stiffness}" armature="0.01"/>
        <inertial pos="0 0 -.07" mass="{mass}" diaginertia="4e-4 4e-4 2e-4"/>"""
        for k in range(joints)
    )
    motors = "".join(f'<motor name="u{k}" joint="j{k}"/>' for k in range(joints))
    sensors = "".join(f'<jointpos name="y{k}" joint="j{k}"/>' for k in range(joints))
    return (
        f'<mujoco><option timestep="{STEP / 2}" integrator="RK4"><flag contact="disable"/></option>'
        f"<worldbody>{bodies}{'</body>' * joints}</worldbody><actuator>{motors}</actuator>"
        f"<sensor>{sensors}</sensor></mujoco>"
    )


def measured(model, samples, torque, noise, still=0):
    """A right log of a chain: torques by chance, after some samples without, and noise."""
    rng, data, joints = np.random.default_rng(7), mujoco.MjData(model), model.nv
    u = np.repeat(torque * rng.standard_normal((samples // HELD + 1, joints)), HELD, axis=0)
    u[:still] = 0.0
    y = np.empty((samples, joints))
    for k in range(samples):
        y[k] = data.qpos + noise * rng.standard_normal(joints)
        data.ctrl[:] = u[k]
        mujoco.mj_step(model, data, 2)
    return Log(
        time=STEP * np.arange(samples), inputs=u[:samples], outputs=y,
        input_names=[f"u{k}" for k in range(joints)],
        output_names=[f"y{k}" for k in range(joints)],
        units={f"y{k}": "rad" for k in range(joints)},
    )  # fmt: skip


@pytest.mark.parametrize(
    ("joints", "mass", "stiffness"),
    [
        (16, 0.3, 2.0),
    ],
)
def test_noise_is_no_missing_force_of_a_long_chain(joints, mass, stiffness):
    model = mujoco.MjModel.from_xml_string(chain_of(joints, mass, stiffness))
    log = measured(model, 600, 0.5, 5e-4)
    left = unbalanced_share(model, log)
    assert left is None or left.max() < NEEDED
    assert rescaled(model, log, {n: n for n in (*log.input_names, *log.output_names)}) is None


def test_a_short_chain_keeps_its_balance_in_any_unit():
    model = mujoco.MjModel.from_xml_string(chain_of(4, 0.3, 2.0))
    log = measured(model, 600, 0.5, 5e-4)
    assert unbalanced_share(model, log).max() < 0.05
    in_degrees = replace(log, outputs=np.rad2deg(log.outputs))
    assert unbalanced_share(model, in_degrees).max() > NEEDED


@pytest.mark.parametrize("still", [0, 500])
def test_of_a_long_log_a_beginning_that_moves_is_judged(tmp_path, monkeypatch, still):
    monkeypatch.setattr(wiring, "MOST_SAMPLES", 200)
    seen, plain = set(), wiring.first_error

    def counted(plant, log, *others):
        seen.add(len(log))
        return plain(plant, log, *others)

    monkeypatch.setattr(wiring, "first_error", counted)
    text = chain_of(2, 0.3, 2.0)
    right = measured(mujoco.MjModel.from_xml_string(text), 1000, 0.5, 1e-3, still)
    own, log = robot(tmp_path, text, right, "joint/j0.damping")
    refuse_miswired(own, log)
    assert max(seen) < len(log) if not still else min(seen) > still
    with pytest.raises(InputError, match="exchange"):
        refuse_miswired(own, replace(log, outputs=log.outputs[:, ::-1]))
