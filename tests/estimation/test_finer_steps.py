"""What the model's step does to an estimate of a free run is what a fit with a finer step finds."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from identification import fit, read_robot
from identification.model.protocol import FINER
from identification.report.fit.fitted_values import LEAST_MOVE
from identification.report.fit.verdict import fit_verdict

pytestmark = pytest.mark.usefixtures("few_effects")

PENDULUM = """<mujoco><option timestep="{step}" integrator="RK4"/><worldbody><body>
  <joint name="hinge" axis="0 1 0" damping="0.04" armature="0.005"/>
  <geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.4" mass="0.5" contype="0" conaffinity="0"/>
  </body></worldbody><actuator><motor name="torque" joint="hinge"/></actuator>
  <sensor><jointpos name="hinge" joint="hinge"/></sensor></mujoco>"""
TOML = """model = "robot.xml"
free = ["joint/hinge.damping", "coulomb_friction.f_c@hinge"]
[parameters."coulomb_friction.f_c@hinge"]
value = 0.08
"""


def recorded(path, seed):
    """Five seconds of a pendulum with dry friction that turns back often, by much finer steps."""
    model = mujoco.MjModel.from_xml_string(PENDULUM.format(step=2e-4))
    model.dof_damping[0] = 0.05
    data, rng, rows = mujoco.MjData(model), np.random.default_rng(seed), []
    for k, u in enumerate(0.9 * rng.uniform(-1, 1, 17).repeat(30)[:500]):
        rows.append([k / 100, u, data.qpos[0] + rng.normal(0, 5e-4)])
        data.ctrl[:] = u
        for _ in range(50):
            data.qfrc_applied[:] = -0.1 * np.tanh(2000 * data.qvel)
            mujoco.mj_step(model, data)
    np.savetxt(path, rows, delimiter=",", header="time,torque,hinge", comments="")
    return path


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    return recorded(tmp_path_factory.mktemp("log") / "log.csv", 1)


def fitted(log, folder, step, file="robot.toml"):
    (folder / "robot.xml").write_text(PENDULUM.format(step=step))
    (folder / "robot.toml").write_text(TOML)
    return fit(read_robot(folder / file, log))


@pytest.fixture(scope="module")
def both(log, tmp_path_factory):
    steps = (2e-3, 2e-3 / FINER)
    return [fitted(log, tmp_path_factory.mktemp("robot"), step).found for step in steps]


def test_what_a_coarse_step_has_told_does_not_pull_a_fit_with_a_fine_one(log, tmp_path):
    """The robot's file keeps std that contain the error of the steps."""
    first = fitted(log, tmp_path, 2e-3)
    shift, std = np.abs(first.found.step_shift), first.found.std
    assert (shift > 2 * np.sqrt(std**2 - shift**2)).all()  # else there is nothing to be seen
    first.save(tmp_path / "out")
    second = fitted(recorded(tmp_path / "second.csv", 2), tmp_path, 2e-4, "out/robot.toml")
    truth = {"joint/hinge.damping": 0.05, "coulomb_friction.f_c@hinge": 0.1}
    for found in (first, second):
        for name, value in found.values.items():
            assert abs(value - truth[name]) < 3 * found.std[name]


@pytest.mark.long
def test_it_is_the_change_of_a_fit_with_a_finer_step(both):
    coarse, fine = both
    names = coarse.estimate.space.names
    change = [fine.estimate.values[n] - coarse.estimate.values[n] for n in names]
    assert {*coarse.far} == {*names}  # else there is nothing to be seen
    np.testing.assert_allclose(coarse.step_shift, change, rtol=0.25)
    assert (np.abs(fine.step_shift) < 0.5 * np.abs(coarse.step_shift)).all()


def test_std_that_are_mostly_of_the_steps_are_told_with_the_step_that_mends_it(both):
    coarse, _ = both
    (said,) = [line for line in fit_verdict(coarse) if "A quarter of the model's step" in line]
    assert 'write timestep="0.0005"' in said
    values, moved = (
        coarse.estimate.values,
        dict(zip(coarse.estimate.space.names, coarse.step_shift, strict=True)),
    )
    told = {n for n, by in moved.items() if abs(by) > LEAST_MOVE * abs(values[n])}
    assert told  # of those that the steps move by enough to be worth finer ones
    assert {n for n in moved if n in said} == told
    still = replace(coarse, step_shift=0.6 * coarse.std)
    unknown = replace(coarse, step_shift=np.full(2, np.nan))
    for each in (still, unknown):
        assert not [line for line in fit_verdict(each) if "quarter" in line]
