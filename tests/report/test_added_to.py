"""A size that adds to a number of the model is told beside it, where the model has that number."""

import pytest
from arm_cases import LOG

from identification.effects.joint_plant import candidates, joint_plant
from identification.prediction.screening import Candidate
from identification.report.effect_words import _already

ARM = """<mujoco><worldbody><body {name}><joint name="j1" axis="0 1 0" frictionloss="0.08"/>
  <geom size="0.1" pos="0 0 -0.2" mass="0.5"/>
  <body name="tip" pos="0 0 -0.4"><joint name="j2" axis="0 1 0"/>
  <geom size="0.1" mass="0.25"/></body>
  </body></worldbody>
  <actuator><motor name="one" joint="j1"/><motor name="two" joint="j2"/></actuator>
  <sensor><jointpos name="a" joint="j1"/><jointpos name="b" joint="j2"/></sensor></mujoco>"""


@pytest.mark.parametrize(("name", "body", "told"), [
    ("mass_mismatch", 'name="upper"', "500 g"), ("mass_mismatch", "", ""),
])  # fmt: skip
def test_a_body_without_a_name_is_no_error(name, body, told):
    plant = joint_plant(ARM.format(name=body), (), LOG)
    effect = next(e for e in candidates(plant, ()) if e.name == name)
    first = next(w for w, suffix in effect.places.items() if suffix)
    assert _already(Candidate(effect, first, {}), plant) == told
