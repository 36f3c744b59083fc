"""Free gains of drives: a drive without a gain and an arm without masses explain any torque."""

import numpy as np
import pytest
from torque_cases import TOML, planar_record, planar_robot

from identification import Log, fit_torques, read_robot
from identification.robot.torques import free_numbers
from identification.torques.equations.others import Others

GAIN = "actuator/t2.gear[0]"
FREE = (
    TOML.replace("free = [", f'free = ["{GAIN}", ')
    + f"""
[parameters."{GAIN}"]
known = 0.3
"""
)


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("gain")
    records = [planar_record(k, name=f"r{k}") for k in (51, 52)]
    return fit_torques(planar_robot(folder, records[0], confirm=[records[1]], toml=FREE))


def test_a_gain_is_told_from_others_by_its_column(found):
    robot = found.robot
    logs = (robot.log, *robot.records)
    others = Others.of(free_numbers(robot, logs), found.found.equations, logs)
    assert [f.name for f in others.free] == [GAIN]
    assert others.gains.tolist() == [True]
    plain = others.without_gains()
    assert plain.free == ()
    # what is held at its mean, which is the model's value here, adds nothing
    np.testing.assert_allclose(plain.start, 0.0, atol=1e-12)


def test_the_masses_of_the_model_tell_the_gain_and_no_fit_without_them_has_it(found):
    model, whole = found.found.model, found.found.whole
    at = model.names.index(GAIN)
    assert model.fit.θ[at] == pytest.approx(5.0, rel=0.03)  # the gear with which the log was made
    assert GAIN not in whole.names
    assert found.named == ()
    final = found.found.final  # it holds the gain, which keeps its std
    assert final.fit.std[at] == pytest.approx(model.fit.std[at])
    assert final.fit.std[at] > 0.001


ONE = """
<mujoco><compiler angle="radian"/><option timestep="0.002" integrator="implicitfast"/><worldbody>
<body name="arm"><joint name="hinge" axis="0 1 0" armature="0.02" damping="0.1"/>
<inertial pos="0 0 -0.2" mass="1" diaginertia="1e-6 1e-6 1e-6"/></body></worldbody>
<actuator><motor name="u" joint="hinge" gear="2"/></actuator>
<sensor><jointpos name="q" joint="hinge"/></sensor></mujoco>
"""
TOML_OF_ONE = """
model = "one.xml"
free = ["joint/hinge.armature", "actuator/u.gear[0]"]
horizon = 0.2
[parameters."joint/hinge.armature"]
known = 0.3
[parameters."actuator/u.gear[0]"]
known = 0.3
"""


def swing(seed):
    """A record of the arm, whose drive gives what a motion of five sines needs."""
    rng, t = np.random.default_rng(seed), 0.01 * np.arange(1500)
    ω, a = 2 * np.pi * 0.2 * np.arange(1, 6), rng.uniform(0.05, 0.3, 5)
    phase = np.outer(t, ω) + rng.uniform(0, 2 * np.pi, 5)
    q, v, acc = (x.sum(axis=1) for x in (
        a * np.sin(phase), a * ω * np.cos(phase), -a * ω**2 * np.sin(phase)))  # fmt: skip
    u = ((1 * 0.2**2 + 0.02) * acc + 0.1 * v + 9.81 * 0.2 * np.sin(q)) / 2
    return Log(
        time=t, inputs=(u + 0.005 * rng.standard_normal(len(t)))[:, None],
        outputs=(q + 2e-5 * rng.standard_normal(len(t)))[:, None],
        input_names=("u",), output_names=("q",), name=f"r{seed}", hold="foh",
    )  # fmt: skip


def test_an_effect_that_cancels_the_weight_does_not_explain_all_by_a_drive_without_a_gain(tmp_path):
    """The centre of mass on the axis, no armature and no gain leave nothing, and say nothing."""
    (tmp_path / "one.xml").write_text(ONE)
    (tmp_path / "one.toml").write_text(TOML_OF_ONE)
    trust = ("wiring", "units", "steps")
    found = fit_torques(read_robot(tmp_path / "one.toml", swing(1), [swing(2)], trust))
    assert found.named == ()
    offset = next(s for s in found.found.scores if s.missing.name == "com_offset")
    assert offset.fall < 0.5
