"""A log whose second half is at rest proves little, and every answer says so."""

from dataclasses import replace

import numpy as np
import pytest
from page_text import text_of
from pendulum_robot import TOML, make_folder, measured, written
from robot_cases import run

from identification import fit, read_robot
from identification.logs.joined import REPLAYED, replayed_share
from identification.robot.discovery import discover
from identification.robot.results.discovery_files import RobotDiscoveryFiles
from identification.robot.results.fit_files import robot_fit_to_json
from identification.robot.results.record_error import find_repetitions, find_rests

pytestmark = pytest.mark.usefixtures("few_effects")

LITTLE = "the robot hardly moves, so that this proves little"


@pytest.fixture
def folder(tmp_path):
    return make_folder(tmp_path)


def then_at_rest(log, samples=None):
    """A log that goes on at rest where the pendulum hangs."""
    samples = samples or len(log)
    noise = 3e-4 * np.random.default_rng(9).standard_normal((samples, 1))
    return replace(
        log, time=0.01 * np.arange(len(log) + samples),
        inputs=np.concatenate([log.inputs, np.zeros((samples, 1))]),
        outputs=np.concatenate([log.outputs, noise]),
    )  # fmt: skip


def at_rest(log):
    noise = 3e-4 * np.random.default_rng(8).standard_normal(log.outputs.shape)
    return replace(log, inputs=0 * log.inputs, outputs=noise)


@pytest.mark.parametrize("samples", [240, 440])
def test_a_fit_that_only_a_robot_at_rest_confirms_says_so(folder, capsys, samples):
    """It said that the model explains the log; and where the fitted half ends at rest, that the
    other half repeats it."""
    log = then_at_rest(measured(1), samples)
    halves = [log.part("estimation")], log.part("validation")
    assert (replayed_share(*halves) > REPLAYED) == (samples > 240)
    path = written(folder, log)
    said = run(capsys, "fit", folder / "robot.toml", *path)
    verdict = " ".join(said["verdict"])
    assert f"In log_0 [validation] {LITTLE}" in verdict
    assert "Confirm on a record that moves as much as the fitted data do" in verdict
    assert said["verdict"][0].startswith("Whether the model explains a motion that was not fitted")
    assert "explains the log" not in verdict
    assert "repeats" not in verdict
    assert [f["kind"] for f in said["findings"]] == ["record at rest"]


def test_the_head_of_its_page_does_not_say_that_the_model_is_confirmed(folder, undrawn):
    found = fit(read_robot(folder / "robot.toml", *written(folder, then_at_rest(measured(1)))))
    page = text_of(found.files.write_page(folder / "report.html").read_text())
    assert "Fitted, and not confirmed" in page
    assert "but there the robot hardly moves, so that this proves little" in page


def test_along_a_free_run_it_is_said_of_the_unseen_data(folder):
    (folder / "robot.toml").write_text(TOML.replace("horizon = 0.2\n", ""))
    log = measured(1)
    swing = replace(log, inputs=log.inputs * (log.time < 0.6)[:, None])  # it has come to rest
    path = written(folder, then_at_rest(swing))
    found = fit(read_robot(folder / "robot.toml", *path))
    assert found.found.validation_rests
    (said,) = [s for s in robot_fit_to_json(found)["verdict"] if s.startswith("On unseen data")]
    assert said.endswith(": but there the robot hardly moves, so that this proves little.")
    moving = fit(read_robot(folder / "robot.toml", *written(folder, measured(2, samples=480))))
    assert not moving.found.validation_rests
    (said,) = [s for s in robot_fit_to_json(moving)["verdict"] if s.startswith("On unseen data")]
    assert "hardly moves" not in said


def test_a_search_that_only_a_robot_at_rest_confirms_says_so(folder):
    robot = read_robot(folder / "robot.toml", *written(folder, then_at_rest(measured(1))))
    found = discover(robot)
    files = RobotDiscoveryFiles(found, robot)
    said = " ".join([*files.record["sentences"], *files.sentences])
    assert found.verdict == "nothing missing"
    assert "Nothing is missing, as far as data can tell in which the robot hardly moves:" in said
    assert said.count(f"In log_0 [validation] {LITTLE}") == 1
    assert "repeat" not in said
    assert files.record["resting"] == ["log_0 [validation]"]
    assert "record at rest" in [f["kind"] for f in files.record["findings"]]


def test_a_record_that_moves_is_not_said_to_rest_and_one_at_rest_does_not_repeat(folder):
    logs = written(folder, measured(1), measured(2), at_rest(measured(3)))
    robot = read_robot(folder / "robot.toml", logs[0], confirm=logs[1:], trust=["sensors"])
    (rest,) = find_rests(robot)
    assert (rest.log, rest.share < 0.03) == ("log_2", True)
    assert find_repetitions(robot) == ()
