"""A log of whose motion the fitted model explains nothing is told as one, and no right log is."""

import json
from dataclasses import replace

import numpy as np
import pytest
from servo_logs import DRAWN, LIFTING, LYING, goals, servo_log
from tracked_cases import robot

from identification import fit, read_robot, write_log
from identification.robot.results.fit_files import robot_fit_to_json
from identification.robot.results.unexplained import find_unexplained

pytestmark = pytest.mark.usefixtures("few_effects")

DRIVE = '<position name="bend_goal" joint="bend" kp="{k2}" kv="0.3"/>'


def fitted(folder, text, log, horizon="horizon = 0.4"):
    """The fit of gains and dampings of the robot as it was drawn; the log passed all checks."""
    text = text.replace("RK4", "implicitfast")  # stiff values of a fit do not diverge with it
    robot(folder, text.format(**DRAWN), log, horizon)
    path, joints = folder / "robot.toml", ("lift", "bend")
    free = [f"joint/{j}.damping" for j in joints] + [f"actuator/{j}_goal.kp" for j in joints]
    path.write_text(
        f'{horizon}\nmodel = "robot.xml"\nfree = {json.dumps(free)}\ntrust = ["steps"]\n'
    )
    return fit(read_robot(path, folder / "log.csv"))


def other_run(text, log):
    """A log whose second joint moved as in another run."""
    elsewhere = servo_log(text, goals(seed=7, samples=len(log)))
    return replace(log, outputs=np.column_stack([log.outputs[:, 0], elsewhere.outputs[:, 1]]))


@pytest.mark.parametrize("horizon", ["horizon = 0.4", ""])
def test_a_column_of_another_run_is_told(tmp_path, horizon):
    log = other_run(LYING, servo_log(LYING, goals()))
    found = fitted(tmp_path, LYING, log, horizon)
    told = find_unexplained(found.robot, found)
    assert [u.output for u in told] == ["bend_now"]
    assert told[0].share < 0.2
    record = robot_fit_to_json(found)
    (said,) = (s for s in record["verdict"] if "hardly more than a constant would" in s)
    assert "at joint bend" in said
    assert record["findings"][0]["kind"] == "unexplained output"


def test_a_joint_whose_drive_the_model_lacks_is_told_with_the_columns_that_nothing_reads(tmp_path):
    log = servo_log(LIFTING, goals(samples=300))
    text = LIFTING.replace(DRIVE, "")
    robot(tmp_path, LIFTING.format(**DRAWN), log)
    (tmp_path / "robot.xml").write_text(text.format(**DRAWN))
    path = tmp_path / "robot.toml"
    path.write_text('horizon = 0.4\nmodel = "robot.xml"\nfree = ["joint/lift.damping"]\n')
    found = fit(read_robot(path, tmp_path / "log.csv"))
    (told,) = find_unexplained(found.robot, found)
    assert "No actuator of robot.xml moves joint bend" in str(told)
    assert "nothing reads bend_goal of the log" in str(told)
    (tmp_path / "log.toml").write_text('ignore = ["bend_goal"]\n')
    assert not read_robot(path, tmp_path / "log.csv").log.unread


def rubbing(model):
    model.dof_frictionloss[:] = 0.3


def payload(model):
    model.body_mass[-1] += 0.3


@pytest.mark.parametrize("change", [None, rubbing, payload])
@pytest.mark.parametrize("kind", ["steps", "slow", "small"])
def test_no_right_log_is_told(tmp_path, change, kind):
    """What the model lacks is told elsewhere: most of the motion is explained all the same."""
    log = servo_log(LIFTING, goals(kind, samples=300), change=change)
    found = fitted(tmp_path, LIFTING, log)
    assert find_unexplained(found.robot, found) == ()


def test_a_joint_that_no_drive_moves_and_the_model_explains_is_not_told(tmp_path):
    """A link that swings under the one that a servo moves, beside a column that nothing reads."""
    text = LIFTING.replace(DRIVE, "").replace(' limited="true"\nrange="-0.4 2.4"', "")
    u = goals(samples=300)
    log = servo_log(text, u[:, :1] + [np.pi, 0][:1])
    robot(tmp_path, text.format(**DRAWN), log, "horizon = 0.4")
    more = replace(log, extras={"supply": u[:, 1]})
    write_log(more, tmp_path / "log.csv")
    found = fit(read_robot(tmp_path / "robot.toml", tmp_path / "log.csv"))
    assert found.robot.log.unread == ("supply",)
    assert find_unexplained(found.robot, found) == ()
