"""A servo whose command has a unit of its own has gains, and keeps what its command means."""

import tomllib

import mujoco
import numpy as np
import pytest
from touching_cases import simulated

from identification import InputError, Parameter, ParameterSet, fit, read_robot, write_log
from identification.inspection.beginning import write_beginning
from identification.inspection.inspected import inspect_log
from identification.model.plant import ModelPlant
from identification.model.scaled_servo import is_scaled_servo
from identification.model.tied import follows, value_of

# Two jaws that one tendon closes, as grippers have them: 0 to 200 is the command of 0 to 0.5 rad.
JAWS = """<mujoco><option timestep="0.002" integrator="RK4"/><worldbody>
<body name="a"><joint name="a" axis="0 1 0" damping="0.2"/>
  <inertial pos="0 0 -0.1" mass="0.3" diaginertia="0.003 0.003 0.001"/></body>
<body name="b" pos="0.3 0 0"><joint name="b" axis="0 1 0" damping="0.3"/>
  <inertial pos="0 0 -0.1" mass="0.2" diaginertia="0.002 0.002 0.001"/></body></worldbody>
<tendon><fixed name="both"><joint joint="a" coef="0.5"/><joint joint="b" coef="0.7"/></fixed>
</tendon>
<actuator>{0}</actuator>
<sensor><jointpos name="at_a" joint="a"/><jointpos name="at_b" joint="b"/></sensor></mujoco>"""


def general(gain, bias, at='tendon="both"'):
    return f'<general name="s" {at} gainprm="{gain}" biastype="affine" biasprm="{bias}"/>'


SERVO = general(0.1, "0 -40 -3")
WITH_ZERO = general(0.1, "-2 -40 -3")


def force(model, q, v, u):
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:], data.ctrl[:] = q, v, u
    mujoco.mj_forward(model, data)
    return float(data.actuator_force[0]), float(data.actuator_length[0]), float(
        data.actuator_velocity[0]
    )  # fmt: skip


@pytest.mark.parametrize(("servo", "zero"), [(SERVO, 0.0), (WITH_ZERO, -0.05)])
@pytest.mark.parametrize("at", ['tendon="both"', 'joint="a"'])
def test_the_force_is_that_of_a_servo_to_what_its_command_means(servo, zero, at):
    rng = np.random.default_rng(4)
    text = JAWS.format(servo.replace('tendon="both"', at))
    model = mujoco.MjModel.from_xml_string(text)
    gains = {"actuator/s.kp": 55.0, "actuator/s.kv": 1.7}
    given = [Parameter(name=n, value=x, unit="", where=n) for n, x in gains.items()]
    moved = ModelPlant(model, ParameterSet("jaws", tuple(given))).model
    for _ in range(5):
        q, v, u = rng.normal(size=2), rng.normal(size=2), rng.uniform(0, 200)
        found, length, rate = force(moved, q, v, u)
        wanted = 0.1 / 40 * u + zero
        assert found == pytest.approx(55.0 * (wanted - length) - 1.7 * rate, rel=1e-12)
    assert value_of(model, "actuator/s.kp") == 40.0
    assert value_of(moved, "actuator/s.kp") == 55.0


@pytest.mark.parametrize(("servo", "what"), [
    (SERVO, "position"), (WITH_ZERO, "position"), (general(-0.1, "0 -40 -3"), "position"),
    (general(40, "0 -40 -3"), "position"), ('<motor name="s" joint="a"/>', None),
    (general(3, "0 0 -0.1"), None),  # a motor and what its own voltage brakes
    (general(3, "1 0 0"), None), (general(0, "0 -40 -3"), None), (general(3, "0 5 0"), None),
    ('<velocity name="s" joint="a" kv="2"/>', "velocity"),
])  # fmt: skip
def test_a_servo_has_a_length_that_it_wants(servo, what):
    model = mujoco.MjModel.from_xml_string(JAWS.format(servo))
    assert follows(model, 0) == what
    assert not is_scaled_servo(model, 0) or what == "position"


def test_servos_whose_commands_mean_different_lengths_have_no_common_gain():
    two = general(0.1, "0 -40 -3") + general(0.2, "0 -40 -3").replace('"s"', '"s2"')
    model = mujoco.MjModel.from_xml_string(JAWS.format(two))
    given = Parameter(name="kp", value=50.0, unit="", where="actuator/s*.kp")
    with pytest.raises(InputError, match="not all of one kind"):
        ModelPlant(model, ParameterSet("jaws", (given,)))


@pytest.mark.usefixtures("few_effects")
def test_new_says_what_it_is_and_a_fit_finds_its_gain(tmp_path):
    scale = 0.02  # of commands from -1 to 1, which the log has
    true, drawn = (JAWS.format(general(k * scale * 20, f"0 {-k} -3")) for k in (47.0, 40.0))
    log = simulated(true, samples=500, noise=1e-5)
    write_log(log, tmp_path / "log.csv")
    (tmp_path / "jaws.xml").write_text(drawn)
    begun = write_beginning(inspect_log(tmp_path / "log.csv"), tmp_path / "jaws.xml",
                            tmp_path / "robot.toml")  # fmt: skip
    assert begun.needs == ()
    text = (tmp_path / "robot.toml").read_text()
    assert (
        "a position servo: 0.4 times its input is the setpoint of the length of tendon both" in text
    )
    assert "actuator/s.kp" in tomllib.loads(text)["free"]
    found = fit(read_robot(tmp_path / "robot.toml", tmp_path / "log.csv"))
    assert found.values["actuator/s.kp"] == pytest.approx(47.0, rel=0.01)
