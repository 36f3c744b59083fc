"""Base parameters of arms for which they are known."""

import mujoco
import numpy as np
import pytest
from torque_cases import TREE, planar

from identification.torques.equations.base import all_columns, find_base, read_inertia
from identification.torques.equations.bodies import regressor
from identification.torques.equations.consistency import find_inconsistent

PENDULUM = """
<mujoco><worldbody><body name="rod"><joint name="hinge" axis="0 1 0" armature="0.01"/>
<inertial pos="0 0 -0.3" mass="2" diaginertia="0.02 0.02 0.001"/></body></worldbody></mujoco>
"""


def test_a_pendulum_has_its_inertia_and_two_moments():
    base = find_base(mujoco.MjModel.from_xml_string(PENDULUM))
    assert base.names == ("I_yy of rod + armature of hinge", "h_x of rod", "h_z of rod")
    np.testing.assert_allclose(base.values, [0.02 + 2 * 0.09 + 0.01, 0.0, -0.6], atol=1e-12)


def test_a_planar_arm_has_those_of_the_textbook():
    """ZZ_1 + I_a1 + m_2 l², MX_1 + m_2 l, and those of link 2 (Khalil, Dombre 2002)."""
    base = find_base(mujoco.MjModel.from_xml_string(planar()))
    assert base.names == (
        "I_yy of upper + armature of shoulder + 0.25 m of fore",
        "h_x of upper",
        "h_z of upper + 0.5 m of fore",
        "I_yy of fore",
        "armature of elbow",
        "h_x of fore",
        "h_z of fore",
    )
    ZZ_1 = 0.09 + 4 * 0.25**2 + 0.8 + 2 * 0.5**2
    np.testing.assert_allclose(
        base.values, [ZZ_1, 0, 4 * 0.25 + 2 * 0.5, 0.03 + 2 * 0.2**2, 0.3, 0, 2 * 0.2], atol=1e-9
    )


def test_an_anthropomorphic_arm_with_a_wrist_has_forty():
    """36 of six rotating joints (Gautier, Khalil 1990), and the rotors from joint 3 on."""
    axes = ("0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0")
    text = "".join(
        f'<body name="b{k}" pos="{0.1 * k} 0.02 0.3"><joint name="j{k}" axis="{axis}"'
        f' armature="0.1"/><inertial pos="0.01 0.02 0.1" mass="1" diaginertia="0.02 0.02 0.01"/>'
        for k, axis in enumerate(axes)
    )
    model = f"<mujoco><worldbody>{text}{'</body>' * 6}</worldbody></mujoco>"
    assert len(find_base(mujoco.MjModel.from_xml_string(model)).names) == 40


@pytest.mark.parametrize("text", [TREE, planar()])
def test_forces_of_all_numbers_are_those_of_their_combinations(text):
    model = mujoco.MjModel.from_xml_string(text)
    base, inertia, rng = find_base(model), read_inertia(model), np.random.default_rng(4)
    q, v, a = (rng.normal(size=(7, model.nv)) for _ in range(3))
    Y, _ = regressor(model, q, v, a)
    x = rng.normal(size=len(inertia.names)) * inertia.own
    np.testing.assert_allclose(
        base.columns(Y, a) @ (base.K @ x), all_columns(Y, a)[:, :, inertia.place] @ x, rtol=1e-6
    )


@pytest.mark.parametrize("text", [TREE, PENDULUM, planar()])
def test_bodies_have_the_base_parameters_of_a_model(text):
    base = find_base(mujoco.MjModel.from_xml_string(text))
    std = 1e-3 * np.abs(base.values) + 1e-4
    assert find_inconsistent(base, base.values, std) == ()
    assert find_inconsistent(base, 1.3 * base.values, std) == ()  # a heavier arm is one, too


def test_an_inertia_that_nothing_else_feels_pins_no_other():
    base = find_base(mujoco.MjModel.from_xml_string(PENDULUM))
    wide = base.values + np.array([0.1, 0.0, 0.0])  # the two others may grow with it
    assert find_inconsistent(base, wide, np.full(3, 1e-4)) == ()


def test_an_inertia_below_zero_is_no_bodys():
    base = find_base(mujoco.MjModel.from_xml_string(PENDULUM))
    negative = np.array([-0.05, 0.0, -0.6])
    assert 0 in find_inconsistent(base, negative, np.full(3, 1e-3))
    assert find_inconsistent(base, negative, np.array([0.1, 1e-3, 1.0])) == ()  # within its noise
