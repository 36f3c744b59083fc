"""A whole log in degrees or in counts is told with its cure; no right log of servos is refused."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from advice import advised
from plain_logs import model_log, stepped
from servo_logs import COUNTS, DRAWN, LIFTING, LYING, goals, servo_log
from tracked_cases import robot

from identification import DivergenceError, InputError, read_robot
from identification.refusals.far_angles import far_sentence
from identification.refusals.wiring import refuse_miswired
from identification.robot.blame import told_of_factors
from identification.robot.robot import read_robot_log

pytestmark = pytest.mark.usefixtures("few_effects")

DEG, COUNT = 180 / np.pi, COUNTS / (2 * np.pi)
ARMS = {"lifting": LIFTING, "lying": LYING}


def written(folder, text, log):
    """The TOML of the robot as it was drawn, and its log."""
    own, _ = robot(folder, text.format(**DRAWN), log, "horizon = 0.4")
    return own.file.path, folder / "log.csv"


def scaled(log, factor, zero=0.0, whole=False):
    """A log whose setpoints and angles are written in another unit."""
    inputs, outputs = (factor * x + zero for x in (log.inputs, log.outputs))
    if whole:
        inputs, outputs = np.round(inputs), np.round(outputs)
    return replace(log, inputs=inputs, outputs=outputs)


@pytest.mark.parametrize("kind", ["steps", "slow", "small"])
def test_a_log_in_degrees_is_told_and_what_is_told_mends_it(tmp_path, kind):
    right = servo_log(LIFTING, goals(kind))
    paths = written(tmp_path, LIFTING, scaled(right, DEG))
    with pytest.raises(InputError, match="were it in deg") as refused:
        read_robot(*paths)
    (tmp_path / "log.toml").write_text(advised(str(refused.value)))
    mended = read_robot(*paths).log
    np.testing.assert_allclose(mended.outputs, right.outputs, rtol=1e-9)
    np.testing.assert_allclose(mended.inputs, right.inputs, rtol=1e-9)


@pytest.mark.parametrize("zero", [0, COUNTS // 2])
@pytest.mark.parametrize("kind", ["steps", "slow"])
def test_a_log_in_counts_is_told_with_its_zero_and_what_is_told_mends_it(tmp_path, kind, zero):
    right = servo_log(LIFTING, goals(kind))
    paths = written(tmp_path, LIFTING, scaled(right, COUNT, zero, whole=True))
    with pytest.raises(InputError, match=f"counts of an encoder, {COUNTS} a turn") as refused:
        read_robot(*paths)
    (tmp_path / "log.toml").write_text(advised(str(refused.value)))
    mended = read_robot(*paths).log
    np.testing.assert_allclose(mended.outputs, right.outputs, atol=1 / COUNT)
    np.testing.assert_allclose(mended.inputs, right.inputs, atol=1 / COUNT)


def test_whole_numbers_of_many_turns_are_counts_where_no_simulation_tells(tmp_path):
    """Without gravity and ends a servo does the same in every unit of the angle."""
    log = scaled(servo_log(LYING, goals("small")), COUNT, COUNTS // 2, whole=True)
    with pytest.raises(InputError, match=r"whole numbers, which angles in radians never are"):
        read_robot(*written(tmp_path, LYING, log))


@pytest.mark.parametrize("arm", ARMS)
@pytest.mark.parametrize("kind", ["steps", "slow", "small"])
@pytest.mark.parametrize("std", [4e-4, 4e-3])
def test_no_right_log_is_refused(tmp_path, arm, kind, std):
    read_robot(*written(tmp_path, ARMS[arm], servo_log(ARMS[arm], goals(kind), std, off=0.02)))


def test_a_servo_that_turns_many_times_is_not_refused(tmp_path):
    text = LYING.split("<body pos", maxsplit=1)[0] + (
        '</body></worldbody><actuator><position name="goal" joint="lift" kp="3" kv="0.4"/>'
        '</actuator><sensor><jointpos name="now" joint="lift"/></sensor></mujoco>'
    )
    model = mujoco.MjModel.from_xml_string(text.format(**DRAWN))
    u = np.linspace(0, 80, 600)[:, None] + 3 * goals(samples=600)[:, :1]
    read_robot(*written(tmp_path, text, model_log(model, u, stepped(model, u, u[0], 0.02), 0.02)))


def test_trust_overrules_it(tmp_path):
    log = scaled(servo_log(LYING, goals("small")), COUNT, whole=True)
    own, read = robot(tmp_path, LYING.format(**DRAWN), log, "horizon = 0.4")
    with pytest.raises(InputError, match=r'or write trust = ."units".'):
        refuse_miswired(own, read)
    refuse_miswired(replace(own, file=replace(own.file, trust=("units",))), read)


def test_a_zero_is_taken_off_before_unit_and_factor(tmp_path):
    own, plain = robot(tmp_path, LIFTING.format(**DRAWN), servo_log(LIFTING, goals()), "")
    (tmp_path / "log.toml").write_text(
        '[units]\nlift_now = "deg"\n[factors]\nlift_now = -2\n[zeros]\nlift_now = 90\n'
    )
    read = read_robot_log(own.file, tmp_path / "log.csv")
    np.testing.assert_allclose(read.outputs[:, 0], -2 * (plain.outputs[:, 0] - 90) / DEG)
    np.testing.assert_array_equal(read.outputs[:, 1], plain.outputs[:, 1])


def test_a_zero_of_no_column_and_of_time_are_refused(tmp_path):
    own, _ = robot(tmp_path, LIFTING.format(**DRAWN), servo_log(LIFTING, goals()), "")
    for name, said in (("wrist", "wrist"), ("time", "leave it out")):
        (tmp_path / "log.toml").write_text(f"[zeros]\n{name} = 1\n")
        with pytest.raises(InputError, match=said):
            read_robot_log(own.file, tmp_path / "log.csv")


def test_a_simulation_that_fails_asks_for_the_unit_of_angles_of_many_turns(tmp_path):
    log = scaled(servo_log(LYING, goals()), DEG)
    own, read = robot(tmp_path, LYING.format(**DRAWN), log, "horizon = 0.4")
    said = far_sentence(own.plant.model, read, {})
    assert 'if they are in degrees, write lift_now = "deg" and bend_now = "deg"' in said
    with (
        pytest.raises(DivergenceError, match="if they are in degrees"),
        told_of_factors(own),
    ):
        raise DivergenceError("the simulation of a window diverged")
    right = servo_log(LYING, goals())
    assert not far_sentence(own.plant.model, right, {})
