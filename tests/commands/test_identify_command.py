"""inca identify as a user meets it: what it keeps, and every option that changes what it does."""

import json
from dataclasses import replace

import numpy as np
import pytest

from identification import write_log
from identification.commands.common import Output
from inca_mj.cli import main
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

TRUTH = {"b_v": 2.3e-4, "b_c": 0.0056}
STEP = 2e-3  # [s] of the log and of the model
FREE = ("--free", "b_v", "b_c", "--step", str(STEP))


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A second of the robot, its drives' noise of two sizes."""
    robot = build_twin(parameter_set("trial", TRUTH), timestep=STEP)
    run = simulate(robot, make_input("prbs", 1.0, seed=0))
    clean = run_to_log(run, "second")
    size = np.array([1e-4, 2e-3] * 4)
    noise = size * np.random.default_rng(1).standard_normal(clean.outputs.shape)
    path = tmp_path_factory.mktemp("logs") / "second.csv"
    write_log(replace(clean, outputs=clean.outputs + noise, extras={}, units={}), path)
    return path


def say(capsys, *arguments):
    """Run with --json; returns the object on stdout."""
    assert main(["identify", *map(str, arguments), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def refused(capsys, *arguments):
    assert main(["identify", *map(str, arguments)]) == 2
    return capsys.readouterr().err


def test_a_folder_of_results_is_whole_and_a_profile_brackets_the_estimate(log, tmp_path, capsys):
    out = tmp_path / "results"
    arguments = ("--profile", "b_c", "--seed", "7", "--out", out)
    result = say(capsys, log, *FREE, *arguments)
    low, high = result["profiles"]["b_c"]["interval"]
    found = result["parameters"]["b_c"]
    assert low < found["value"] < high
    assert len(result["profiles"]["b_c"]["rise"]) == len(result["profiles"]["b_c"]["values"]) == 9
    names = {p.name for p in out.iterdir()}
    assert {"report.html", "result.json", "model.xml", "least-std-by-parameter.png",
            "profile-of-b-c.png", "measured-and-simulated-motor-angles.png"} <= names  # fmt: skip
    for picture in out.glob("*.png"):
        assert picture.read_bytes().startswith(b"\x89PNG")
    record = json.loads((out / "result.json").read_text())
    assert record["seed"] == 7
    assert {"python", "mujoco", "numpy", "scipy", "inca-mj"} <= set(record["versions"])
    assert record["configuration"]["free"] == ["b_v", "b_c"]
    assert record["configuration"]["horizons"] == [0.05, 0.2, 0.5, 1.0]
    page = (out / "report.html").read_text()
    for heading in ("Step 1", "Profile of b_c", "What the experiment can say", "The model"):
        assert heading in page


def test_starts_end_with_the_first_that_is_enough(log, capsys):
    result = say(capsys, log, *FREE, "--starts", "3")
    assert len(result["starts"]) == 1
    assert 1 <= len(result["starts"][0]) <= 3
    assert "start" in result["verdict"][-1]
    assert "give one or more" in refused(capsys, log, *FREE, "--starts", "0")


def test_det_weighs_each_drive_by_its_own_noise(log, capsys):
    """Four drives are twenty times less noisy: who knows that is several times more certain."""
    trace, det = (say(capsys, log, *FREE, "--criterion", c)["parameters"] for c in ("trace", "det"))
    for name, value in TRUTH.items():
        assert det[name]["std"] < 0.4 * trace[name]["std"]
        assert abs(det[name]["value"] - value) < 5 * det[name]["std"]


@pytest.mark.long
def test_windows_can_be_asked_for(log, capsys):
    result = say(capsys, log, *FREE, "--windows", "0.25")
    assert result["windows"]["count"] == 2
    assert set(result["parameters"]) == {*TRUTH, "x", "y", "z", "roll", "pitch", "yaw"}
    for name, value in TRUTH.items():
        assert abs(result["parameters"][name]["value"] / value - 1) < 0.1
    assert "windows of 0.25 s leave" in " ".join(result["verdict"])
    assert "search of its own" in refused(capsys, log, "--windows", "0.25", "--loss", "huber")
    assert "give a length above 0" in refused(capsys, log, "--windows", "nan")


@pytest.mark.parametrize("options", [[], ["--windows", "0.25"]])
def test_an_interrupt_keeps_the_best_values_and_is_told_by_the_exit_code(
    log, monkeypatch, capsys, options
):
    def interrupt(output, line):
        raise KeyboardInterrupt

    def sensitivities(*arguments):
        raise AssertionError("nobody waits for these")

    monkeypatch.setattr(Output, "tell", interrupt)
    monkeypatch.setattr("identification.estimation.fit.resolve", sensitivities)
    monkeypatch.setattr("identification.kalman.estimate.resolve", sensitivities)
    assert main(["identify", str(log), "--json", *options]) == 130
    result = json.loads(capsys.readouterr().out)
    assert len(result["steps"]) == 1  # the second does not begin
    assert "was stopped" in " ".join(result["verdict"])
    assert result["validation_rms"] is None  # whoever stopped it does not wait
    assert {known["std"] for known in result["parameters"].values()} == {None}


def test_innovations_tell_the_noise_of_sensors_and_currents(log, capsys):
    result = say(capsys, log, *FREE, "--innovations")
    assert set(result["parameters"]) == set(TRUTH)
    for name, value in TRUTH.items():
        assert abs(result["parameters"][name]["value"] / value - 1) < 0.2
    assert 1e-4 < result["innovations"]["sensor_std"] < 2.5e-3
    assert "One step ahead it errs by" in " ".join(result["verdict"])
    assert "search of its own" in refused(capsys, log, "--innovations", "--starts", "2")
    assert "choose one" in refused(capsys, log, "--innovations", "--windows", "0.25")


@pytest.mark.usefixtures("undrawn")
def test_an_output_that_never_moves_has_no_fit_and_no_nan(log, tmp_path, capsys):
    rows = [line.split(",") for line in log.read_text().splitlines()]
    at = rows[0].index("angle_3")
    stuck = tmp_path / "stuck.csv"
    stuck.write_text("\n".join(",".join([*r[:at], r[at] if k == 0 else "0", *r[at + 1 :]])
                               for k, r in enumerate(rows)))  # fmt: skip
    assert main(["compare", str(stuck)]) == 2
    assert "write --trust sensors" in capsys.readouterr().err
    trust = ["--trust", "sensors"]
    assert main(["compare", str(stuck), *trust, "--out", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "nan" not in said
    assert "1 outputs never move" in said
    assert ">nan<" not in (tmp_path / "out" / "report.html").read_text()
    assert json.loads((tmp_path / "out" / "result.json").read_text())["fit_percent"][2] is None
