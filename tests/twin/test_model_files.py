"""The model files explain themselves, keep that when they are saved, and rest after a reset."""

import mujoco
import numpy as np
import pytest

from identification.model.export import to_xml
from inca_mj.files import model_path
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.mjcf import build
from inca_mj.twin.plain import build_plain
from inca_mj.twin.twin import build_twin

FILES = ("inca6d.xml", "inca6d_plain.xml")
MOVED = {"x": 0.02, "y": 0.03, "z": 1.41, "roll": 0.04, "pitch": -0.06, "yaw": 0.1}


@pytest.mark.parametrize("name", FILES)
def test_a_file_keeps_its_comment_when_it_is_saved_again(name):
    text = model_path(name).read_text(encoding="utf-8")
    spec = mujoco.MjSpec.from_string(text)
    assert "python -m mujoco.viewer" in spec.comment
    assert to_xml(spec) == text
    assert f"<!--{spec.comment}-->" in to_xml(mujoco.MjSpec.from_string(to_xml(spec)))


def test_a_comment_names_the_robot_that_it_is_of():
    spec = build(parameter_set("simulation"), INCA)
    assert "Parameter set simulation" in spec.comment
    assert INCA.source in spec.comment


@pytest.mark.parametrize("name", FILES)
def test_a_program_can_read_what_a_file_needs(name):
    model = mujoco.MjModel.from_xml_path(str(model_path(name)))
    assert b"law of inca_mj" in bytes(model.text_data)
    title = model.names.split(b"\0")[0].decode()  # MuJoCo's viewer shows it
    assert title == {FILES[0]: "inca6d_needs_the_law_of_inca_mj", FILES[1]: "inca6d_plain"}[name]


@pytest.mark.parametrize("start", [{}, MOVED])
def test_the_default_reset_is_the_start_and_rests(tmp_path, start):
    robot = build_twin(parameter_set("trial", start))
    model = mujoco.MjModel.from_xml_path(str(robot.save(tmp_path / "robot.xml")))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.act, model.key("start").act, rtol=1e-14)
    np.testing.assert_allclose(data.qpos, model.key("start").qpos, rtol=1e-14)
    for _ in range(1000):
        mujoco.mj_step(model, data)
    assert np.abs(data.qpos - model.qpos0).max() < 1e-10
    mujoco.mj_resetData(model, data)  # as in the viewer, in the middle of a simulation
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.act, model.key("start").act, rtol=1e-14)
    assert np.abs(data.qacc).max() < 1e-6  # rounding of the tensions, over inertias of 1e-4


def test_the_plain_file_is_the_builders():
    built, read = build_plain().compile(), mujoco.MjModel.from_xml_path(str(model_path(FILES[1])))
    for name in ("tendon_lengthspring", "tendon_stiffness", "tendon_damping", "wrap_prm",
                 "actuator_gear", "jnt_stiffness", "qpos_spring", "dof_damping", "body_mass",
                 "dof_frictionloss", "dof_solref", "dof_solimp", "site_pos"):  # fmt: skip
        ours, theirs = getattr(built, name), getattr(read, name)
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-15, err_msg=name)
