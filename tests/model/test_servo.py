"""The gain of a servo is one parameter, and never half of it alone."""

import mujoco
import pytest

from identification import InputError, Parameter, ParameterSet
from identification.model.plant import ModelPlant
from identification.model.tied import is_set_point, value_of

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


def test_an_input_is_a_set_point_where_all_that_it_commands_are_servos():
    model = mujoco.MjModel.from_xml_string("""
    <mujoco><worldbody><body><joint name="j"/><geom size="0.1"/></body></worldbody><actuator>
      <motor joint="j"/><position joint="j" kp="20" kv="1"/><velocity joint="j" kv="2"/>
      <general joint="j" gainprm="3" biastype="affine" biasprm="0 -1 0"/>
    </actuator></mujoco>""")
    assert [is_set_point(model, k) for k in range(4)] == [False, True, True, False]
