"""A fit of several logs: one value for all, own values where they differ, values that are given."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from records_cases import AXIS, MJCF, PARAMETERS, STEP, record
from robot_cases import refused, run

from identification import confirm, discover, fit, joint_plant, read_robot, write_log, write_robot
from identification.model.parameter import Parameter
from identification.report.records_json import records_to_json
from identification.robot.file import read_robot_file
from identification.robot.fit_json import robot_fit_to_json

MASS, OFFSET = "body/arm.mass", "offset.f_0@hinge"
TOML = """
model = "pendulum.xml"
free = ["J", "d"]
horizon = 0.2
[parameters.J]
path = "joint/hinge.armature"
value = 1.5e-3
[parameters.d]
path = "joint/hinge.damping"
value = 0.03
"""
OWN = TOML.replace('"d"]', f'"d", "{OFFSET}"]\nown = ["{OFFSET}"]') + (
    f'[parameters."{OFFSET}"]\nvalue = 0.0\n'
)


@cache
def plant():
    mass = Parameter(name=MASS, value=0.5, unit="kg", where=MASS, lower=0.0)
    return joint_plant(MJCF, (*PARAMETERS, mass), record(samples=50), joints=(AXIS,))


def measured(seed, values=None, samples=240):
    """A record of a pendulum of J = 2e-3 kg m² and d = 0.02 N m s/rad, if nothing else is said."""
    return record(seed, samples=samples, values=values or {}, plant=plant())


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "pendulum.xml").write_text(MJCF)
    (tmp_path / "robot.toml").write_text(TOML)
    (tmp_path / "own.toml").write_text(OWN)
    return tmp_path


def written(folder, *logs):
    paths = [folder / f"log_{k}.csv" for k in range(len(logs))]
    for log, path in zip(logs, paths, strict=True):
        write_log(log, path)
    return paths


def assert_true(found, name, value):
    assert abs(found.values[name] - value) < 4 * found.std[name]
    assert found.values[name] == pytest.approx(value, rel=0.03)


def test_the_command_fits_several_logs_and_confirms_them_on_another(folder, capsys):
    *logs, other = written(folder, *map(measured, (1, 2, 3)))
    out = folder / "out"
    said = run(capsys, "fit", folder / "robot.toml", *logs, "--confirm", other, "--out", out)
    assert [(r["file"], r["role"]) for r in said["records"]] == [
        ("log_0", "fit"), ("log_1", "fit"), ("log_2", "confirm"),
    ]  # fmt: skip
    assert all(r["after"] < 0.5 * r["before"] for r in said["records"])
    (there,) = said["confirm"]
    assert (there["before"], there["after"]) == tuple(said["records"][2][k] for k in
                                                      ("before", "after"))  # fmt: skip
    assert said["validation_rms"] == pytest.approx(there["after"])
    assert sum("On log_2: " in sentence for sentence in said["verdict"]) == 1
    for name, true in (("J", 2e-3), ("d", 0.02)):
        p = said["parameters"][name]
        assert abs(p["value"] - true) < 4 * p["std"]
    again = read_robot_file(out / "robot.toml").records
    assert again["d"]["value"] == said["parameters"]["d"]["value"]


def test_more_logs_make_estimates_finer(folder):
    logs = written(folder, *map(measured, range(1, 4)))
    one, several = (fit(read_robot(folder / "robot.toml", paths)) for paths in (logs[0], logs))
    assert several.std["d"] < one.std["d"]
    assert_true(several, "d", 0.02)
    assert [c.log for c in several.unseen] == [f"log_{k} [validation]" for k in range(3)]
    assert several.converged
    assert not any(several.at_bound.values())
    assert several.start == {"J": pytest.approx(1.5e-3), "d": pytest.approx(0.03)}


def test_other_records_are_compared_as_those_that_were_given_with_the_robot(folder):
    *logs, other = written(folder, *map(measured, (1, 2, 3)))
    robot = read_robot(folder / "robot.toml", logs, confirm=[other])
    found = fit(robot)
    (given,) = confirm(robot, found)
    (again,) = confirm(read_robot(folder / "robot.toml", logs, confirm=[other]), found)
    assert again.before == pytest.approx(given.before)
    assert again.after == pytest.approx(given.after, rel=1e-3)


def test_several_logs_need_a_horizon(folder, capsys):
    (folder / "robot.toml").write_text(TOML.replace("horizon = 0.2\n", ""))
    logs = written(folder, measured(1), measured(2))
    assert "write horizon = 0.2" in refused(capsys, "fit", folder / "robot.toml", *logs)


def test_records_with_masses_of_their_own_give_one_friction(folder):
    masses = 0.5, 1.0, 0.7
    logs = [
        replace(measured(k, {MASS: m}), values={MASS: m}) for k, m in enumerate(masses, start=1)
    ]
    *fitted, other = written(folder, *logs)
    assert f'"{MASS}" = 1.0' in fitted[1].with_suffix(".toml").read_text()
    robot = read_robot(folder / "robot.toml", fitted, confirm=[other])
    found = fit(robot)
    assert_true(found, "d", 0.02)
    assert_true(found, "J", 2e-3)
    (there,) = confirm(robot, found)
    assert there.after < 6e-4
    silent = [replace(log, values={}) for log in (robot.log, *robot.others)]
    wrong = fit(read_robot(folder / "robot.toml", silent, trust=["wiring"]))
    assert abs(wrong.values["J"] - 2e-3) > 4 * abs(found.values["J"] - 2e-3)


def test_a_free_run_has_the_values_of_its_log(folder):
    (folder / "robot.toml").write_text(TOML.replace("horizon = 0.2\n", ""))
    log = replace(measured(1, {MASS: 0.8}), values={MASS: 0.8})
    robot = read_robot(folder / "robot.toml", *written(folder, log))
    assert robot.plant.parameters[MASS].value == 0.5
    assert robot.nominal_model.plant.parameters[MASS].value == 0.8
    assert_true(fit(robot), "d", 0.02)


def test_records_with_offsets_of_their_own_recover_each(folder):
    truth = 0.05, -0.03, 0.02
    paths = written(folder, *(measured(k, {OFFSET: f}) for k, f in enumerate(truth, start=1)))
    robot = read_robot(folder / "own.toml", paths[:2], confirm=paths[2:])
    assert robot.nominal_model.own == (OFFSET,)
    found = fit(robot)
    assert set(found.shared) == {"J", "d"}
    for k in range(2):
        assert_true(found, f"{OFFSET} [log_{k}]", truth[k])
    assert_true(found, "d", 0.02)
    said = json.loads(json.dumps(robot_fit_to_json(found, confirm(robot, found))))
    assert said["parameters"][f"{OFFSET} [log_0]"]["unit"] == "N m"
    assert said["records"][2]["own"][OFFSET]["value"] == pytest.approx(truth[2], rel=0.05)
    path = write_robot(robot, found.shared, folder / "again.toml", folder)
    assert read_robot_file(path).own == (OFFSET,)


def test_a_discovery_has_own_parameters_and_values_of_logs_too(folder):
    own, masses, mu = (0.05, -0.03, 0.02), (0.5, 0.9, 0.7), "transmitted_load_friction.mu@hinge"
    logs = [
        replace(measured(k, {OFFSET: f, MASS: m, mu: 0.15}), values={MASS: m})
        for k, (f, m) in enumerate(zip(own, masses, strict=True), start=1)
    ]
    only = '[effects]\nonly = ["transmitted_load_friction", "quadratic_friction"]\n'
    (folder / "own.toml").write_text(OWN + only)
    *fitted, other = written(folder, *logs)
    robot = read_robot(folder / "own.toml", fitted, confirm=[other])
    found = discover(robot)
    (named,) = found.named
    assert named.effect.parameters["mu"][0] == pytest.approx(0.15, rel=0.05)
    assert records_to_json(found)["final"][f"{OFFSET} [log_1]"]["value"] == pytest.approx(
        -0.03, rel=0.05
    )
    (there,) = confirm(robot, found)
    assert there.after < 0.2 * there.before


def test_logs_of_one_name_are_told_apart(folder):
    truth = 0.05, -0.03
    logs = [replace(measured(k, {OFFSET: f}), name="log") for k, f in enumerate(truth, start=1)]
    found = fit(read_robot(folder / "own.toml", logs))
    for name, f in zip(("log [estimation]", "log (2) [estimation]"), truth, strict=True):
        assert found.values[f"{OFFSET} [{name}]"] == pytest.approx(f, rel=0.05)


def test_what_cannot_be_known_apart_is_said(folder):
    text = TOML.replace('"d"]', '"d", "body/arm.inertia[1]"]')
    (folder / "robot.toml").write_text(text)
    found = fit(read_robot(folder / "robot.toml", *written(folder, measured(1))))
    (said,) = [s for s in robot_fit_to_json(found)["verdict"] if "tell less" in s]
    assert "J +" in said or "J -" in said
    assert "body/arm.inertia[1]" in said
    assert "d " not in said[said.index("(") : said.index(")")]
    total = found.values["J"] + found.values["body/arm.inertia[1]"]
    assert total == pytest.approx(2e-3 + 1e-3, rel=0.02)


def test_a_fit_that_predicts_unseen_records_worse_says_so(folder):
    begun = {"J": 1.5e-3, "d": 0.03}
    logs = written(folder, measured(1), measured(2, begun))
    robot = read_robot(folder / "robot.toml", logs[0], confirm=logs[1:])
    found = fit(robot)
    assert any("worse than" in s for s in robot_fit_to_json(found)["verdict"])
    good = fit(read_robot(folder / "robot.toml", logs[0]))
    assert not any("worse than" in s for s in robot_fit_to_json(good)["verdict"])


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"body/arn.mass": 1.0}, "did you mean 'arm'?"),
        ({"joint/hinge.damping": 1.0}, "frees (as 'd'); keep one"),
        ({"J": 1.0}, "frees (as 'J'); keep one"),
        ({"qpos[0]": 1.0}, "an entry of the start"),
        ({MASS: -1.0}, "outside its range"),
        ({"offset.f_0@hing": 1.0}, "known: hinge"),
        ({"voltage": 1.0}, "known: "),
    ],
)
def test_values_of_a_log_are_checked(folder, capsys, values, said):
    paths = written(folder, measured(1), replace(measured(2), values=values))
    told = refused(capsys, "fit", folder / "robot.toml", *paths)
    assert "values of log 'log_1'" in told
    assert said in told


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ((f'own = ["{OFFSET}"]', 'own = ["offset"]'), "known: J, d, offset.f_0@hinge"),
        ((f'own = ["{OFFSET}"]', "own = 3"), "own in"),
        (("horizon = 0.2\n", ""), "write horizon = 0.2"),
    ],
)
def test_own_parameters_are_checked(folder, refusal, change, said):
    (folder / "own.toml").write_text(OWN.replace(*change))
    assert said in refusal(read_robot_file, folder / "own.toml")


def test_a_value_of_a_size_is_a_value_like_any_other(folder):
    logs = [replace(measured(k, {OFFSET: f}), values={OFFSET: f})
            for k, f in ((1, 0.05), (2, -0.03))]  # fmt: skip
    robot = read_robot(folder / "robot.toml", written(folder, *logs))
    assert robot.values_of(robot.log) == {OFFSET: 0.05}
    assert np.isclose(robot.log.sampling_time, STEP)
    assert_true(fit(robot), "d", 0.02)
