"""A law that is alone is what MuJoCo holds; beside others it moves its robot as it did alone."""

import subprocess
import sys

PROGRAM = """
import mujoco, numpy as np
from inca_mj import build_twin, simulate
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.robot.inputs import make_input

u = make_input("prbs", 0.3)
alone = build_twin()
first = simulate(alone, u)
held = mujoco.get_mjcb_passive()
both = build_twin(effects=CATALOGUE)
both.state()
assert mujoco.get_mjcb_passive() is not held
for robot in (alone, both, alone):
    again = simulate(robot, u)
    for field in ("qpos", "qvel", "tension"):
        np.testing.assert_array_equal(getattr(again, field), getattr(first, field))
build_twin()
assert mujoco.get_mjcb_passive() is not held
"""


def test_a_law_alone_and_beside_others():
    subprocess.run([sys.executable, "-W", "error", "-c", PROGRAM], check=True)
