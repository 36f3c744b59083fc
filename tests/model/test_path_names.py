"""A path that names nothing is told with what the model has, and with what was likely meant."""

import mujoco
import pytest

from identification.model.paths import KINDS, attributes, resolve

CRANE = mujoco.MjModel.from_xml_string(
    """<mujoco><worldbody>
  <body name="trolley"><joint name="rail" type="slide" axis="1 0 0"/>
    <geom name="box" size="0.1" mass="3"/>
    <body name="jib" pos="0 0 -1"><joint name="pivot" axis="0 1 0" damping="0.2"/>
      <geom size="0.1" mass="1"/></body></body></worldbody>
  <actuator><motor name="pivot" joint="pivot"/></actuator></mujoco>"""
)
UNNAMED = mujoco.MjModel.from_xml_string(
    """<mujoco><worldbody><body name="jib"><joint name="pivot" axis="0 1 0"/>
    <geom size="0.1"/></body></worldbody></mujoco>"""
)


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ("joint/pivot.armatur", "unknown attribute of a joint 'armatur'; did you mean 'armature'?"),
        ("joint/pivot.friction", "did you mean 'frictionloss'? known: actfrcrange, armature, axis"),
        (
            "body/jib.diaginertia",
            "of a body 'diaginertia'; did you mean 'inertia'?",
        ),
        ("actuator/pivot.geer", "did you mean 'gear'?"),
        ("geom/box.mass", "; or did you mean 'body/trolley.mass'?"),
        ("joint/pivot.mass", "; or did you mean 'body/jib.mass'?"),
        ("body/jib.damping", "; or did you mean 'joint/pivot.damping'?"),
        ("joint/pivot.gear", "; or did you mean 'actuator/pivot.gear'?"),
        ("joint/pivot.kp", "; or did you mean 'actuator/pivot.kp'?"),
        ("geom/jib.mass", "unknown geom 'jib'; known: box; or did you mean 'body/jib.mass'?"),
        ("body/pivot.mass", "known: jib, trolley, world; or did you mean 'body/jib.mass'?"),
        ("joint/jib.damping", "known: pivot, rail; or did you mean 'joint/pivot.damping'?"),
        ("site/jib.pos", "the model has no site; did you mean 'body/jib.pos'?"),
        ("tendon/cable.range", "the model has no tendon; free a number that"),
    ],
)
def test_what_was_meant_is_offered(refusal, path, said):
    assert said in refusal(resolve, CRANE, path)


def test_a_kind_of_which_nothing_has_a_name_is_told_so(refusal):
    said = refusal(resolve, UNNAMED, "geom/jib.mass")
    assert "unknown geom 'jib': no geom of the model has a name; did you mean 'body/jib.ma" in said
    said = refusal(resolve, UNNAMED, "geom/ball.friction[0]")
    assert said.endswith("no geom of the model has a name; give it one to free its friction")


def test_every_attribute_that_is_listed_can_be_named():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="x"><joint name="x"/><geom name="x" size="0.1"/>
        <site name="x"/></body></worldbody>
        <tendon><fixed name="x"><joint joint="x" coef="1"/></fixed></tendon>
        <actuator><motor name="x" joint="x"/></actuator></mujoco>"""
    )
    elsewhere = {"spread", "kp", "kv", "user"}  # read by other modules; user data has no columns
    for kind in KINDS:
        for attribute in {*attributes(model, kind)} - elsewhere:
            column = "" if attribute in _single(model, kind) else "[0]"
            assert resolve(model, f"{kind}/x.{attribute}{column}").field.endswith(attribute)


def _single(model, kind):
    start = "jnt_" if kind == "joint" else f"{kind}_"
    fields = {n: getattr(model, n) for n in dir(model) if n.startswith((start, "dof_"))}
    return {n.partition("_")[2] for n, array in fields.items() if getattr(array, "ndim", 0) == 1}
