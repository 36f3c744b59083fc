"""A curve of a neighbour is that of the neighbour's position or speed at the same instant."""

import mujoco
import numpy as np
import pytest
from joint_cases import arm, arm_log, reached, run, steps
from numpy.testing import assert_allclose
from scipy.interpolate import CubicSpline

C = (0.1, -0.2, 0.3, -0.25, 0.2, -0.15, 0.1, -0.05)
OTHER = {"shoulder": "elbow", "elbow": "shoulder"}
CURVES = [
    (name, joint)
    for joint, side in (("shoulder", "behind"), ("elbow", "before"))
    for name in (f"curve_{side}", f"curve_speed_{side}")
]


def forward(values, q, v):
    """Passive forces of the arm at positions and velocities, shape (2,)."""
    model = arm().with_values(values).model
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = q, v
    mujoco.mj_forward(model, data)
    return np.array(data.qfrc_passive)


@pytest.mark.parametrize(("name", "joint"), CURVES)
def test_it_is_a_function_of_the_neighbour_alone(name, joint):
    run(arm(), arm_log(steps(10, 2)))  # the law is compiled
    (effect,) = (e for e in arm().effects if e.name == name)
    where = f"joint {joint}"
    values = {effect.parameter(s.name, where): c for s, c in zip(effect.sizes, C, strict=True)}
    mine, other = (arm().model.joint(j).id for j in (joint, OTHER[joint]))
    middle, far, top = reached(arm(), OTHER[joint])[:3]
    for x in np.linspace(-1.3, 1.3, 27):
        q, v = np.array([0.2, -0.3]), np.array([0.5, -0.7])
        if "speed" in name:
            v[other] = np.sign(x) * x**2 * top
            drawn = np.interp(x, np.arange(-4, 5) / 4, [*C[3::-1], 0.0, *C[4:]])
        else:
            q[other] = middle + x * far
            drawn = CubicSpline(np.linspace(-1, 1, 8), C, bc_type="natural")(np.clip(x, -1, 1))
        more = forward(values, q, v) - forward({}, q, v)
        expected = np.zeros(2)
        expected[mine] = drawn
        assert_allclose(more, expected, rtol=0, atol=1e-12)
