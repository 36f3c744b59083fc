"""Values that differ from log to log: those that are sought in each, and those that are given."""

import json
from dataclasses import replace

import numpy as np
import pytest
from pendulum_robot import MASS, OFFSET, OWN, TOML, assert_true, make_folder, measured, written
from records_cases import MJCF
from robot_cases import refused
from state_cases import ELASTIC, Truth, elastic
from state_cases import measured as measured_states

from identification import confirm, fit, read_robot, write_log, write_robot
from identification.robot.file.file import read_robot_file
from identification.robot.results.fit_files import robot_fit_to_json


@pytest.fixture
def folder(tmp_path):
    return make_folder(tmp_path)


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
    path = folder / "again.toml"
    write_robot(robot, found.shared, path, folder, own_values=found.own_values)
    again = read_robot(path, paths[:2], confirm=paths[2:])
    assert again.file.own == (OFFSET,)
    for k in range(3):
        assert again.file.own_values[f"log_{k}"][OFFSET] == pytest.approx(truth[k], rel=0.1)
    begun = again.nominal_model
    refit = fit(again)
    assert refit.start == pytest.approx(found.values)  # a record begins where it ended
    assert refit.values == pytest.approx(found.values, rel=1e-3)
    assert begun.mean == robot.nominal_model.mean
    assert begun.std == pytest.approx(robot.nominal_model.std)


def test_a_named_effect_that_each_record_has_for_itself_is_written_with_its_values(folder):
    shift = "time_shift.tau@drive"
    robot = read_robot(folder / "own.toml", written(folder, measured(1), measured(2)))
    each = {"log_0": {OFFSET: 0.01, shift: 0.02}, "log_1": {OFFSET: 0.03, shift: 0.04}}
    path = folder / "again.toml"
    write_robot(robot, {"J": 2e-3, "d": 0.02}, path, folder, own_values=each)
    again = read_robot(path, [robot.log, *robot.others])
    assert again.file.own == (OFFSET, shift)
    assert again.file.own_values == each
    assert again.plant.parameters[shift].value == pytest.approx(0.03)


def test_a_part_of_a_log_begins_with_the_values_of_the_log(folder):
    robot = read_robot(folder / "own.toml", written(folder, measured(1)))
    each = {robot.log.name: {OFFSET: 0.017}, "another": {OFFSET: 0.05}}
    path = write_robot(robot, {"J": 2e-3, "d": 0.02}, folder / "part.toml", folder, own_values=each)
    found = fit(read_robot(path, robot.log))
    (began,) = [value for name, value in found.start.items() if name.startswith(OFFSET)]
    assert began == pytest.approx(0.017)


def test_what_was_known_stays_known_where_the_fitted_robot_is_fitted_again(folder):
    known = TOML.replace("value = 0.03", "value = 0.03\nknown = 0.05")
    known = known.replace('"d"]', f'"d", "{OFFSET}"]') + f'[parameters."{OFFSET}"]\nvalue = 0.01\n'
    (folder / "robot.toml").write_text(known)
    logs = written(folder, measured(1))
    robot = read_robot(folder / "robot.toml", logs)
    first = fit(robot)
    path = write_robot(robot, first.shared, folder / "again.toml", folder)
    again = read_robot(path, logs)
    assert again.mean == {"J": 1.5e-3, "d": 0.03, OFFSET: 0.01}
    assert again.std == pytest.approx(robot.std)
    second = fit(again)
    assert second.start == pytest.approx(first.values)
    assert second.values == pytest.approx(first.values, rel=2e-3)
    third = read_robot(write_robot(again, second.shared, folder / "third.toml", folder), logs)
    assert (third.mean, third.std.tolist()) == (again.mean, again.std.tolist())


def test_logs_of_one_name_are_told_apart(folder):
    truth = 0.05, -0.03
    logs = [replace(measured(k, {OFFSET: f}), name="log") for k, f in enumerate(truth, start=1)]
    found = fit(read_robot(folder / "own.toml", logs))
    for name, f in zip(("log [estimation]", "log (2) [estimation]"), truth, strict=True):
        assert found.values[f"{OFFSET} [{name}]"] == pytest.approx(f, rel=0.05)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"body/arn.mass": 1.0}, "did you mean 'arm'?"),
        ({"J": 1.0}, "frees (as 'J'); keep one"),
        ({MASS: -1.0}, "outside its range"),
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
        (("[parameters.J]", "[own_values]\nlog_0 = 3\n[parameters.J]"), "must be a table"),
    ],
)
def test_own_parameters_are_checked(folder, refusal, change, said):
    (folder / "own.toml").write_text(OWN.replace(*change))
    assert said in refusal(read_robot_file, folder / "own.toml")


def test_an_elastic_gear_is_written_read_and_fitted(tmp_path):
    (tmp_path / "pendulum.xml").write_text(MJCF.replace('timestep="0.005"', 'timestep="0.0025"'))
    (tmp_path / "robot.toml").write_text(TOML)
    paths = [tmp_path / f"log_{k}.csv" for k in range(2)]
    for k, path in enumerate(paths):
        write_log(measured_states(Truth(c=0.05), k, samples=120), path)
    robot = read_robot(tmp_path / "robot.toml", paths[0], confirm=[paths[1]])
    found = {"J": 1.8e-3, "d": 0.03, **elastic(0.04)}
    again = read_robot(
        write_robot(robot, found, tmp_path / "new.toml", tmp_path), paths[0], confirm=[paths[1]]
    )
    assert [state.kind for state in again.plant.states] == ["motor"]
    fitted = fit(again)
    assert fitted.values[ELASTIC] == pytest.approx(0.05, rel=0.05)
    assert fitted.values["J"] == pytest.approx(2e-3, rel=0.02)
    (told,) = confirm(again, fitted)
    assert np.isfinite(told.after)
    assert told.after < 0.5 * told.before


def test_a_size_that_is_there_or_not_is_held_in_the_file_and_no_fit_frees_it(folder):
    robot = read_robot(folder / "own.toml", written(folder, measured(1)))
    (effect,) = (e for e in robot.plant.effects if e.name == "voltage_limit")
    (where,) = [w for w, suffix in effect.places.items() if suffix]
    size = effect.parameter("c", where)
    values = {"J": 2e-3, "d": 0.02, size: 1.0, "voltage_limit.f_m": 0.5, "voltage_limit.v_0": 9.0}
    write_robot(robot, values, folder / "again.toml", folder)
    again = read_robot(folder / "again.toml", robot.log)
    assert size not in again.file.free
    for name, value in list(values.items())[2:]:
        assert again.file.fixed[name] == value
        assert again.plant.parameters[name].value == value
