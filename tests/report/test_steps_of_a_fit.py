"""What the steps of a simulation make of a fit's error is told as theirs, and as nothing else's."""

import mujoco
import numpy as np
import pytest

from identification import fit, read_robot
from identification.model.protocol import FINER

pytestmark = pytest.mark.usefixtures("few_effects")

ARM = """<mujoco><option timestep="{step}" integrator="{by}"/><worldbody><body pos="0 0 1">
  <joint name="elbow" axis="0 1 0" damping="0.08" armature="0.004"/>
  <inertial pos="0.11 0 -0.19" mass="0.5" diaginertia="0.003 0.003 0.001"/></body></worldbody>
  <actuator><position name="servo" joint="elbow" kp="{kp}" kv="{kv}"/></actuator>
  <sensor><jointpos name="angle" joint="elbow"/></sensor></mujoco>"""
STEP, KP, KV, NOISE = 0.003, 14.0, 0.2, 2e-4
GAINS = ["actuator/servo.kp", "actuator/servo.kv"]
PATHS = [f"actuator/servo.{n}" for n in ("gainprm[0]", "biasprm[1]", "biasprm[2]")]


def recorded(path, friction=0.0):
    """Nine seconds of an arm whose servo is asked to jump, simulated all but exactly."""
    model = mujoco.MjModel.from_xml_string(ARM.format(step=2e-4, kp=KP, kv=KV, by="RK4"))
    data, rng, rows = mujoco.MjData(model), np.random.default_rng(4), []
    for k, u in enumerate(rng.uniform(-0.8, 0.8, 25).repeat(60)):
        rows.append([0.006 * k, u, data.qpos[0] + rng.normal(0, NOISE)])
        data.ctrl[:] = u
        for _ in range(30):
            data.qfrc_applied[:] = -friction * np.tanh(50 * data.qvel)
            mujoco.mj_step(model, data)
    np.savetxt(path, rows, delimiter=",", header="time,servo,angle", comments="")
    return path


def fitted(folder, log, step=STEP, free=GAINS, horizon="horizon = 0.3"):
    (folder / "arm.xml").write_text(ARM.format(step=step, kp=22, kv=0.3, by="implicitfast"))
    (folder / "arm.toml").write_text(
        f'model = "arm.xml"\nfree = {free}\ntrust = ["steps"]\n{horizon}\n'
    )
    return fit(read_robot(folder / "arm.toml", log))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("arm")


@pytest.fixture(scope="module")
def log(folder):
    return recorded(folder / "log.csv")


@pytest.fixture(scope="module")
def fits(folder, log):
    """The fits of the gains and of the numbers that MuJoCo has for them, and one by finer steps."""
    return [
        fitted(folder, log), fitted(folder, log, free=PATHS), fitted(folder, log, STEP / FINER)
    ]  # fmt: skip


def test_it_is_that_of_a_fit_with_finer_steps_however_the_model_is_written(fits):
    gains, paths, fine = (each.found for each in fits)
    # the finer fit may take fewer windows, of the same log
    real = fine.rms / gains.rms
    assert real < 0.5  # else there is nothing to be seen
    assert gains.model.finer.error == pytest.approx(real, abs=0.03)
    assert paths.model.finer.error == pytest.approx(gains.model.finer.error, rel=0.03)


@pytest.mark.parametrize("horizon", ["horizon = 0.3", ""])
def test_who_writes_the_steps_that_are_named_is_never_told_that_something_is_missing(
    folder, log, horizon
):
    step, said = STEP / 3, []
    for _ in range(4):
        verdict = fitted(folder, log, step, horizon=horizon).to_dict()["verdict"]
        missing = [s for s in verdict if "is missing" in s and "not from something" not in s]
        assert not missing
        assert not [s for s in verdict if "lacks something" in s]
        said.append(verdict[0])
        if verdict[0].startswith("The model with the fitted values explains the log"):
            break
        step /= FINER
        assert f'write timestep="{step:.6g}"' in verdict[0]
    assert len(said) > 1  # else there is nothing to be seen
    assert said[-1].startswith("The model with the fitted values explains the log")


@pytest.mark.parametrize("friction", [0.05, 0.4])  # 7 and 60 times the noise
@pytest.mark.parametrize("step", [STEP, STEP / FINER])
@pytest.mark.parametrize("horizon", ["horizon = 0.3", ""])
def test_what_is_missing_is_told_also_where_steps_are_coarse(folder, friction, step, horizon):
    log = recorded(folder / "rough.csv", friction)
    verdict = fitted(folder, log, step, horizon=horizon).to_dict()["verdict"]
    assert verdict[0].startswith("Something is missing")
