"""What the commands do on any robot, as functions: the same numbers, and mistakes in a sentence."""

import json

import numpy as np
import pytest
from robot_cases import TOML, run, simulated

from identification import InputError, confirm, discover, fit, read_log, read_robot, write_log
from identification.robot.fit_json import robot_fit_to_json

NAMES = ("force",), ("x",)


def without_time(record):
    return {name: value for name, value in record.items() if name != "seconds"}


@pytest.mark.parametrize(
    "horizon",
    [
        "horizon = 0.5\n",
    ],
)
def test_fit_and_confirm_say_what_the_command_says(folder, capsys, horizon):
    path = folder / f"verbs{len(horizon)}.toml"
    path.write_text(horizon + TOML)
    logs = folder / "short.csv", folder / "short too.csv"
    for log, seed in zip(logs, (1, 5), strict=True):
        write_log(simulated({"damping": 3.6, "mass": 1.8}, 400, seed), log)
    said = run(capsys, "fit", path, logs[0], "--confirm", logs[1])
    robot = read_robot(path, logs[0], confirm=[logs[1]])
    found = fit(robot)
    record = json.loads(json.dumps(robot_fit_to_json(found, confirm(robot, found))))
    assert without_time(record) == without_time(said)
    assert found.values == {n: p["value"] for n, p in said["parameters"].items()}
    std = {n: p["std"] for n, p in said["parameters"].items()}
    assert {n: s if np.isfinite(s) else None for n, s in found.std.items()} == std


@pytest.mark.parametrize(
    "horizon",
    [
        "horizon = 0.5\n",
    ],
)
def test_without_records_the_part_that_was_not_fitted_confirms(folder, tmp_path, horizon):
    path = folder / f"unseen{len(horizon)}.toml"
    path.write_text(horizon + TOML)
    log = simulated({"damping": 3.6, "mass": 1.8}, 600)
    write_log(log, tmp_path / "plain.csv")
    robot = read_robot(path, tmp_path / "plain.csv")
    found = fit(robot)
    (there,) = confirm(robot, found)
    assert there.log == "plain [validation]"
    assert 4e-4 < there.after < 8e-4  # the noise is 5e-4, and a free run drifts a little
    assert there.before > 2 * there.after
    if not horizon:
        assert there.after == pytest.approx(found.found.validation_rms, rel=1e-6)


def test_a_log_that_is_read_already_is_the_same_robot(folder):
    path = folder / "robot.toml"
    from_file = read_robot(path, folder / "plain.csv")
    again = read_robot(path, from_file.log, confirm=[from_file.log])
    assert again.plant.parameters == from_file.plant.parameters
    assert again.records == (from_file.log,)
    with pytest.raises(InputError, match="'x'"):  # the file's name of the column, not the sensor's
        read_robot(path, read_log(folder / "plain.csv", *NAMES))


def test_a_robot_has_its_log_and_a_nominal_model_needs_one(folder):
    robot = read_robot(folder / "robot.toml", folder / "plain.csv")
    with pytest.raises(InputError, match="leave log and effects out"):
        discover(robot, robot.log, robot.candidates)
    with pytest.raises(InputError, match="needs a log and candidate effects"):
        discover(robot.nominal_model)
