"""A hidden effect of a slider is named, where INCA cannot be imported."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from joint_cases import DAMPING, MASS, SLIDER, STEP, run, slider_log, steps
from plain_logs import plain_log

from identification import Parameter
from identification.discovery.nominal_model import NominalModel
from identification.effects.axes import Axis
from identification.effects.plant.joint_plant import candidates, joint_plant
from identification.innovations.discovery import discover

ROOT = Path(__file__).parents[2]
NOISE = 1e-3  # std of the sensor [m]
COULOMB = Parameter(
    name="coulomb_friction.f_c@slide", value=0.5, unit="N", where="effect", lower=0.0, upper=10.0
)
AXIS = Axis("slide", "slide", force=5.0, speed=1.5, travel=3.0)
FREE = ("mass", "damping", COULOMB.name)


def plant(log):
    return joint_plant(SLIDER, (MASS, DAMPING, COULOMB), log, joints=(AXIS,))


def hidden(samples=400, **values):
    """A log of a slider that has some effects, and inputs with a small error of their own."""
    u = steps(samples, hold=15)
    rng, error = np.random.default_rng(8), np.zeros_like(u)
    for k in range(1, samples):  # of std 0.03, forgotten in 0.1 s
        error[k] = 0.905 * error[k - 1] + 0.03 * 0.426 * rng.standard_normal()
    true = {"mass": 2.1, "damping": 2.8, COULOMB.name: 0.6, **values}
    y = run(plant(slider_log(u)), slider_log(u + error), **true)
    return slider_log(u, y + NOISE * np.random.default_rng(4).standard_normal(y.shape))


def found(log, names=()):
    """What a search among some effects finds, among all where none is named."""
    robot = plant(log)
    effects = [e for e in candidates(robot, FREE) if not names or e.name in names]
    return discover(NominalModel(robot, FREE, np.array([0.3, 0.3, 0.5])), log, effects)


def test_a_hidden_effect_is_named_with_its_size_where_inca_cannot_be_imported():
    code = """
import sys
sys.modules["inca_mj"] = None
from test_joint_discovery import found, hidden
few = "asymmetric_viscous_friction", "stribeck_friction", "stiffness"
answer = found(hidden(**{"asymmetric_viscous_friction.d_a@slide": 1.2}), few)
(named,) = answer.named
value, std, unit = named.parameters["d_a"]
print(answer.verdict, named.candidate.effect.name, named.candidate.where, value, std, unit)
wrong = (
    answer.verdict != "named" or named.candidate.effect.name != "asymmetric_viscous_friction"
    or abs(value - 1.2) > 4 * std or std > 0.2 or unit != "N s/m" or named.proof.share < 0.8
)
sys.exit(wrong)
"""
    subprocess.run(
        [sys.executable, "-c", code], check=True, cwd=Path(__file__).parent,
        env={"PYTHONPATH": f"{ROOT}:{ROOT / 'tests' / 'cases'}"},
    )  # fmt: skip


@pytest.mark.long
def test_an_effect_of_the_input_is_named():
    answer = found(hidden(**{"delay.tau@force": 0.012}))
    assert answer.verdict == "named"
    assert answer.named[0].candidate.effect.name in ("delay", "lag")
    assert answer.after.rms < 0.5 * answer.before.rms


def test_where_nothing_is_missing_nothing_is_named():
    answer = found(hidden())
    assert answer.verdict == "nothing missing"
    assert not answer.named


PENDULUM = """<mujoco model="pendulum">
  <option timestep="0.005" integrator="RK4"/>
  <worldbody><body><joint name="hinge" axis="0 1 0"/>
    <inertial pos="0 0 -0.1" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/></body></worldbody>
  <actuator><motor name="drive" joint="hinge"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>"""
WEIGHT = 0.5 * 9.81 * 0.1  # of the arm, level [N m]


def released(angle, seconds=5.0, **values):
    """Angle of a pendulum that is let go without a drive, shape (N,)."""
    t = np.arange(round(seconds / STEP)) * STEP
    log = plain_log(1e-12 * np.sin(t)[:, None], np.sin(t)[:, None], "drive", "angle", time=t)
    start = Parameter(name="q", value=0.0, unit="rad", where="qpos[0]", scale=0.1)
    plant = joint_plant(PENDULUM, (start,), log)
    return run(plant, log, q=angle, **values)[:, 0]


@pytest.mark.parametrize(
    ("name", "size"),
    [("coulomb_friction.f_c", 1.02 * WEIGHT * np.sin(0.6)), ("gravity_load_friction.mu", 1.02),
     ("transmitted_load_friction.mu", 1.02)],
)  # fmt: skip
def test_friction_holds_what_drives_less_and_does_not_creep(name, size):
    q = released(0.6, **{f"{name}@hinge": size})
    assert np.abs(q - 0.6).max() < 1e-12


@pytest.mark.parametrize("name", ["gravity_load_friction.mu", "transmitted_load_friction.mu"])
def test_friction_under_load_lets_go_what_drives_more(name):
    q = released(0.6, **{f"{name}@hinge": 0.98})
    assert q[-1] < 0.59


def test_coulomb_friction_stops_a_pendulum_where_it_holds():
    f_c = 0.3 * WEIGHT
    q = released(1.2, seconds=8.0, **{"coulomb_friction.f_c@hinge": f_c})
    assert np.ptp(q[-100:]) < 1e-12  # at rest
    assert abs(WEIGHT * np.sin(q[-1])) < f_c


def test_coulomb_friction_takes_its_work_from_a_swing():
    """From rest to rest the weight's work is f_c times the way, but for the last T of it."""
    f_c = 0.1 * WEIGHT
    q = released(1.0, seconds=2.0, **{"coulomb_friction.f_c@hinge": f_c})
    turn = int(np.argmin(q))
    fallen = WEIGHT * (np.cos(q[turn]) - np.cos(q[0]))
    assert fallen == pytest.approx(f_c * (q[0] - q[turn]), rel=0.03)
