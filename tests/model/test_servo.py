"""The gain of a servo is one parameter, and never half of it alone."""

import mujoco
import numpy as np
import pytest
from estimation_plants import record, steps

from identification import InputError, Parameter, ParameterSet
from identification.estimation.estimation import estimate
from identification.model.paths import resolve
from identification.model.plant import ModelPlant
from identification.model.tied import is_set_point, parts, value_of

ARM = """<mujoco><option timestep="0.002" integrator="implicitfast"/>
  <worldbody><body name="arm"><joint name="q" axis="0 1 0" damping="0.2"/>
    <inertial pos="0 0 -0.3" mass="0.8" diaginertia="0.02 0.02 0.001"/></body></worldbody>
  <actuator>{servo}</actuator>
  <sensor><jointpos name="q" joint="q"/></sensor></mujoco>"""
POSITION = '<position name="servo" joint="q" kp="12.5" kv="0.7"/>'
VELOCITY = '<velocity name="servo" joint="q" kv="2.5"/>'
GENERAL = '<general name="servo" joint="q" gainprm="3" biastype="affine" biasprm="0 -2 -0.1"/>'
MOTOR = '<motor name="servo" joint="q"/>'


def arm(servo, *names, values=None, **records):
    model = mujoco.MjModel.from_xml_string(ARM.format(servo=servo))
    given = []
    for name in names:
        where = f"actuator/servo.{name}"
        value = (values or {}).get(name, value_of(model, where))
        given.append(Parameter(name=name, value=value, unit="", where=where, **records))
    return ModelPlant(model, ParameterSet("arm", tuple(given)))


@pytest.mark.parametrize(
    ("servo", "name", "value", "gain", "bias"),
    [
        (POSITION, "kp", 9.0, 9.0, (0.0, -9.0, -0.7)),
        (POSITION, "kv", 0.4, 12.5, (0.0, -12.5, -0.4)),
        (VELOCITY, "kv", 4.0, 4.0, (0.0, 0.0, -4.0)),
    ],
)
def test_a_gain_is_the_model_whose_file_says_it(servo, name, value, gain, bias):
    plant = arm(servo, name, values={name: value})
    assert plant.model.actuator_gainprm[0, 0] == gain
    assert tuple(plant.model.actuator_biasprm[0, :3]) == bias
    _, numbers = arm(servo, name).settings((name,), np.array([[value], [2 * value]]))
    for slot, written in numbers:
        assert written[0] == getattr(plant.model, slot.field)[slot.rows[0], slot.column]
        assert written[1] == 2 * written[0]
    assert len(numbers) == 1 + (gain == value)


@pytest.mark.parametrize(
    ("servo", "truth"), [(POSITION, {"kp": 9.0, "kv": 0.5}), (VELOCITY, {"kv": 4.0})]
)
def test_the_gains_are_recovered(servo, truth):
    log = record(arm(servo, *truth, values=truth), ("q",), inputs=0.5 * steps(300, seed=3))
    found = estimate(arm(servo, *truth, lower=0.0), log, (*truth,))
    assert found.values == pytest.approx(truth, rel=1e-6)


@pytest.mark.parametrize(
    ("servo", "names", "other", "gain"),
    [
        (POSITION, ["gainprm[0]", "biasprm[2]"], "biasprm[1]", "kp"),
        (VELOCITY, ["biasprm[2]"], "gainprm[0]", "kv"),
    ],
)
def test_half_a_gain_is_refused(refusal, servo, names, other, gain):
    said = refusal(arm, servo, *names)
    assert "of the <" in said
    assert f"'servo' alone, whose {other} is tied to it (biasprm[" in said
    assert f"free actuator/servo.{gain}, which moves both, or free actuator/servo.{other}" in said


@pytest.mark.parametrize(
    ("servo", "names"),
    [
        (POSITION, ["gainprm[0]", "biasprm[1]"]),
        (POSITION, ["biasprm[2]"]),
        (GENERAL, ["gainprm[0]"]),
        (MOTOR, ["gainprm[0]"]),
    ],
)
def test_what_is_no_half_is_never_refused(servo, names):
    assert [p.name for p in arm(servo, *names).parameters] == names


def test_a_gain_and_its_half_are_not_free_at_once():
    other = "gainprm[0]"
    with pytest.raises(InputError, match=rf"kp and .* all go to 'actuator/servo.{other[:4]}"):
        arm(POSITION, "kp", other)


def test_one_gain_of_several_servos():
    two = POSITION + POSITION.replace("servo", "server")
    model = mujoco.MjModel.from_xml_string(ARM.format(servo=two))
    places = parts(model, "actuator/serv*.kp")
    assert [resolve(model, path).rows for path, _ in places] == [(0, 1), (0, 1)]


@pytest.mark.parametrize(
    ("servo", "name", "said"),
    [
        (MOTOR, "kp", "'servo' is no <position> servo, whose gain this would be; free the numbers"),
        (VELOCITY, "kp", "'servo' is no <position> servo"),
    ],
)
def test_the_gain_of_what_is_no_servo_is_refused(refusal, servo, name, said):
    model = mujoco.MjModel.from_xml_string(ARM.format(servo=servo))
    assert said in refusal(value_of, model, f"actuator/servo.{name}")
    mixed = mujoco.MjModel.from_xml_string(
        ARM.format(servo=POSITION + VELOCITY.replace("servo", "rate"))
    )
    assert "'*' are not all of one kind of" in refusal(value_of, mixed, "actuator/*.kv")


def test_an_input_is_a_set_point_where_all_that_it_commands_are_servos():
    model = mujoco.MjModel.from_xml_string("""
    <mujoco><worldbody><body><joint name="j"/><geom size="0.1"/></body></worldbody><actuator>
      <motor joint="j"/><position joint="j" kp="20" kv="1"/><velocity joint="j" kv="2"/>
      <general joint="j" gainprm="3" biastype="affine" biasprm="0 -1 0"/>
    </actuator></mujoco>""")
    assert [is_set_point(model, k) for k in range(4)] == [False, True, True, False]
