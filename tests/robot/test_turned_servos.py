"""A servo whose setpoint and encoder are both turned is told; no right log is refused for it."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from advice import advised
from servo_logs import DRAWN, LIFTING, LYING, goals, servo_log
from tracked_cases import robot

from identification import InputError, read_robot
from identification.refusals.columns import Doubt
from identification.refusals.turned_servos import turned_servos
from identification.refusals.wiring import refuse_unbalanced

pytestmark = pytest.mark.usefixtures("few_effects")

WIDE = LIFTING.replace("-0.4 2.4", "-2.6 2.6")  # an elbow that bends to both sides
ALONE = (
    LYING.split("<body pos", maxsplit=1)[0]
    + """</body></worldbody><actuator><position name="lift_goal" joint="lift" kp="{k1}" kv="0.5"/>
</actuator><sensor><jointpos name="lift_now" joint="lift"/></sensor></mujoco>"""
)


def drawn(text):
    return mujoco.MjModel.from_xml_string(text.format(**DRAWN))


def turned(log, joints):
    """A log with the setpoints and encoders of some joints turned."""
    signs = np.where(np.isin(np.arange(log.outputs.shape[1]), joints), -1.0, 1.0)
    return replace(log, inputs=log.inputs * signs, outputs=log.outputs * signs)


def said_of(text, log):
    columns = {n: n for n in (*log.input_names, *log.output_names)}
    return turned_servos(drawn(text), Doubt.of(log, columns))


def payload(model):
    model.body_mass[-1] += 0.2


def floating(model):
    model.opt.gravity[:] = 0


def rubbing(model):
    model.dof_frictionloss[:] = 0.2


def sprung(model):
    model.jnt_stiffness[:] = 1.2
    model.qpos_spring[:] = [0.4, 1.3]


def stiff(model):
    model.actuator_gainprm[:, 0] *= 2
    model.actuator_biasprm[:, 1] *= 2


def tilted(model):
    model.opt.gravity[:] = [3, 1, -9.3]


WORLDS = [None, payload, floating, rubbing, sprung, stiff, tilted]


@pytest.mark.parametrize("joint", [0, 1])
@pytest.mark.parametrize("kind", ["steps", "slow"])
def test_weight_tells_a_turned_servo_and_what_is_told_mends_the_log(tmp_path, joint, kind):
    right = servo_log(WIDE, goals(kind))
    own, _ = robot(tmp_path, WIDE.format(**DRAWN), turned(right, [joint]), "horizon = 0.4")
    with pytest.raises(InputError, match="with the other sign of") as refused:
        read_robot(own.file.path, tmp_path / "log.csv")
    assert 'or write trust = ["wiring"] into' in str(refused.value)
    read_robot(own.file.path, tmp_path / "log.csv", trust=["wiring"])
    (tmp_path / "log.toml").write_text(advised(str(refused.value)))
    mended = read_robot(own.file.path, tmp_path / "log.csv").log
    # both joints turned are the same arm, seen from behind
    signs = np.sign(np.sum(mended.outputs * right.outputs, axis=0))
    assert signs[0] == signs[1]
    np.testing.assert_allclose(mended.outputs, signs * right.outputs, rtol=1e-9)


def test_a_comparison_of_torques_tells_it_too(tmp_path):
    log = turned(servo_log(WIDE, goals()), [0])
    own, read = robot(tmp_path, WIDE.format(**DRAWN), log, "horizon = 0.4")
    with pytest.raises(InputError, match="other sign of both setpoint and encoder"):
        refuse_unbalanced(own, read)
    refuse_unbalanced(replace(own, file=replace(own.file, trust=("wiring",))), read)


def test_neighbours_tell_it_where_nothing_weighs():
    log = servo_log(LYING, goals())
    assert said_of(LYING, log) is None
    assert "lift_now = -1 and lift_goal = -1" in said_of(LYING, turned(log, [0]))
    assert "bend_now, bend_goal alike" in said_of(LYING, turned(log, [0]))


def test_an_arm_seen_from_behind_is_not_refused():
    assert said_of(LYING, turned(servo_log(LYING, goals()), [0, 1])) is None
    assert said_of(WIDE, turned(servo_log(WIDE, goals()), [0, 1])) is None


@pytest.mark.parametrize("world", WORLDS)
@pytest.mark.parametrize("kind", ["steps", "slow"])
def test_no_right_log_is_refused_whatever_the_robot_has(world, kind):
    for text in (WIDE, LYING):
        for std, off in ((4e-4, 0.1), (4e-3, 0)):
            log = servo_log(text, goals(kind, samples=300), std, off, world)
            assert said_of(text, log) is None


def test_a_range_on_one_side_tells_a_turned_servo(tmp_path):
    """Nothing else tells of a joint that turns by itself about an upright axis."""
    text = ALONE.replace('name="lift"', 'name="lift" limited="true" range="-0.1 1.4"')
    right = servo_log(text, goals("slow")[:, :1] + 0.3)
    own, _ = robot(tmp_path, text.format(**DRAWN), right, "horizon = 0.4")
    read_robot(own.file.path, tmp_path / "log.csv")
    robot(tmp_path, ALONE.format(**DRAWN), turned(right, [0]), "horizon = 0.4")
    read_robot(own.file.path, tmp_path / "log.csv")
    (tmp_path / "robot.xml").write_text(text.format(**DRAWN))
    with pytest.raises(InputError, match="would lie in its range with the other sign") as refused:
        read_robot(own.file.path, tmp_path / "log.csv")
    read_robot(own.file.path, tmp_path / "log.csv", trust=["limits"])
    (tmp_path / "log.toml").write_text(advised(str(refused.value)))
    mended = read_robot(own.file.path, tmp_path / "log.csv").log
    np.testing.assert_allclose(mended.outputs, right.outputs, rtol=1e-9)
    np.testing.assert_allclose(mended.inputs, right.inputs, rtol=1e-9)
