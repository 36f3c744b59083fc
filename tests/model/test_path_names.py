"""A path that names nothing is told with what the model has, and with what was likely meant."""

import mujoco
import pytest

from identification.model.paths import KINDS, attributes, resolve
from identification.model.tied import NAMES

CRANE = mujoco.MjModel.from_xml_string(
    """<mujoco><worldbody>
  <body name="trolley"><joint name="rail" type="slide" axis="1 0 0"/>
    <geom name="box" size="0.1" mass="3"/>
    <body name="jib" pos="0 0 -1"><joint name="pivot" axis="0 1 0" damping="0.2"/>
      <geom size="0.1" mass="1"/></body></body></worldbody>
  <actuator><motor name="pivot" joint="pivot"/></actuator></mujoco>"""
)


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ("joint/pivot.armatur", "unknown attribute of a joint 'armatur'; did you mean 'armature'?"),
        ("actuator/pivot.geer", "did you mean 'gear'?"),
        ("joint/pivot.mass", "; or did you mean 'body/jib.mass'?"),
        ("joint/pivot.kp", "; or did you mean 'actuator/pivot.kp'?"),
        ("joint/jib.damping", "known: pivot, rail; or did you mean 'joint/pivot.damping'?"),
    ],
)
def test_what_was_meant_is_offered(refusal, path, said):
    assert said in refusal(resolve, CRANE, path)


def test_every_attribute_that_is_listed_can_be_named():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="x"><joint name="x"/><geom name="x" size="0.1"/>
        <site name="x"/></body></worldbody>
        <tendon><fixed name="x"><joint joint="x" coef="1"/></fixed></tendon>
        <actuator><motor name="x" joint="x"/></actuator></mujoco>"""
    )
    # read by other modules (`tied.py`); user data has no columns
    elsewhere = {"spread", "user", *NAMES}
    for kind in KINDS:
        for attribute in {*attributes(model, kind)} - elsewhere:
            column = "" if attribute in _single(model, kind) else "[0]"
            assert resolve(model, f"{kind}/x.{attribute}{column}").field.endswith(attribute)


def _single(model, kind):
    start = "jnt_" if kind == "joint" else f"{kind}_"
    fields = {n: getattr(model, n) for n in dir(model) if n.startswith((start, "dof_"))}
    return {n.partition("_")[2] for n, array in fields.items() if getattr(array, "ndim", 0) == 1}
