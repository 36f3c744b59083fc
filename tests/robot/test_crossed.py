"""A setpoint and a measured column in each other's place are told, and a late setpoint is not."""

import re
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from advice import advised
from plain_logs import model_log, stepped
from servo_logs import DRAWN, LIFTING, goals, servo_log
from tracked_cases import ARM, refused, robot

from identification import InputError, read_robot
from identification.refusals.crossed import late_pairs, late_sentence
from identification.refusals.wiring import refuse_miswired

pytestmark = pytest.mark.usefixtures("few_effects")

MODEL, HORIZON = LIFTING.format(**DRAWN), "horizon = 0.4"


def crossed(log, joints):
    """A log with the input and the output of some joints in each other's place."""
    u, y = log.inputs.copy(), log.outputs.copy()
    u[:, joints], y[:, joints] = log.outputs[:, joints], log.inputs[:, joints]
    return replace(log, inputs=u, outputs=y)


def late(log, samples):
    """A log whose setpoints were stamped too late."""
    first = np.repeat(log.inputs[:1], samples, axis=0)
    return replace(log, inputs=np.vstack([first, log.inputs[:-samples]]))


@pytest.mark.parametrize(("joints", "kind"), [([0], "steps"), ([1], "slow"), ([0, 1], "small")])
def test_an_exchanged_setpoint_is_told_and_what_is_told_mends_the_log(tmp_path, joints, kind):
    right = servo_log(LIFTING, goals(kind))
    own, _ = robot(tmp_path, MODEL, crossed(right, joints), HORIZON)
    with pytest.raises(InputError, match=r"exchanged with .*_goal, which come.* ms after") as said:
        read_robot(own.file.path, tmp_path / "log.csv")
    assert 'or write trust = ["wiring"] into' in str(said.value)
    read_robot(own.file.path, tmp_path / "log.csv", trust=["wiring"])
    (tmp_path / "log.toml").write_text(advised(str(said.value)))
    mended = read_robot(own.file.path, tmp_path / "log.csv").log
    np.testing.assert_allclose(mended.inputs, right.inputs, rtol=1e-9)
    np.testing.assert_allclose(mended.outputs, right.outputs, rtol=1e-9)


def test_it_is_told_where_the_model_explains_the_log_as_it_is_read(tmp_path):
    right = servo_log(LIFTING, goals("slow"))
    own, log = robot(tmp_path, MODEL, crossed(right, [1]), "horizon = 5.0")
    said = refused(own, log)
    assert int(re.search(r"explains (\d+)[.\d]* % of bend_now", said)[1]) > 95
    assert "exchange bend_now and bend_goal under" in said


@pytest.mark.parametrize("kind", ["steps", "slow"])
def test_setpoints_that_were_stamped_late_are_no_positions_and_are_told(tmp_path, kind):
    right = servo_log(LIFTING, goals(kind))
    own, log = robot(tmp_path, MODEL, late(right, 6), HORIZON)
    refuse_miswired(own, log)
    remarks = read_robot(own.file.path, tmp_path / "log.csv").remarks
    assert any("before lift_goal, " in text and "stamped late" in text for text in remarks)
    assert late_sentence(own.file, own.plant.model, right) is None


def test_the_columns_of_a_motor_are_not_asked(tmp_path):
    """Its torque comes before the motion in a right log, too."""
    model = mujoco.MjModel.from_xml_string(ARM)
    u = np.repeat(4 * np.random.default_rng(3).standard_normal((20, 2)), 20, axis=0)
    assert late_pairs(model, crossed(model_log(model, u, stepped(model, u)), [1])) == []
