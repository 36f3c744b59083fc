"""The bench of measured robots: nulls, comparisons of models, and what is measured again."""

from types import SimpleNamespace

import numpy as np
import pytest
from measured_cases import oscillator, oscillator_log
from robots.measurement import measure_again
from robots.nulls import best_model, null_log, null_of
from robots.unseen import compare, errors_of
from robots.written import write_files, write_model

from identification import read_robot, window_error


@pytest.fixture(scope="module")
def plant(tmp_path_factory):
    robot = oscillator((oscillator_log(0, 300), oscillator_log(1, 300)))
    path, paths = write_files(robot, tmp_path_factory.mktemp("robot"))
    return robot, read_robot(path, paths["fit"], paths["confirm"]).plant


TRUE = {"m": 5.4e-6, "d": 2.3e-4, "g": 1.0, "offset.f_0@slide": 0.0}


@pytest.mark.long
def test_a_null_of_an_exact_model_is_the_log_and_else_its_errors_are_only_mixed(plant):
    robot, own = plant
    linear = oscillator_log(3, 300, k_3=0.0, noise=1e-4)
    null = null_log(own, linear, robot.horizon, TRUE, seed=1)
    mixed = null.outputs - linear.outputs[: len(null)]
    assert np.std(mixed) < 0.005 * np.std(linear.outputs)  # noise, and the model's coarser steps
    cubic = robot.fit[0]
    errors = window_error(own, cubic, 2 * robot.horizon, TRUE)
    null = null_log(own, cubic, robot.horizon, TRUE, seed=1)
    added = null.outputs - (cubic.outputs[: len(null)] - errors.reshape(-1, 1))
    added = added.reshape(errors.shape)
    assert all(np.any(np.all(np.isclose(errors, e, atol=1e-12), axis=(1, 2))) for e in added)


@pytest.mark.long
def test_the_best_model_has_what_was_named_and_its_nulls_are_read(plant, tmp_path):
    robot, own = plant
    values = {**TRUE, "hardening.k_3@slide": 2.0}
    found = SimpleNamespace(final=SimpleNamespace(values=values))
    best = best_model(robot, own, found)
    null = null_of(best, own, values, 2)
    read = read_robot(write_model(null, tmp_path), list(null.fit), list(null.confirm))
    assert read.plant.parameters.values()["hardening.k_3@slide"] == 2.0
    assert "hardening.k_3@slide" in read.nominal_model.names
    assert not np.array_equal(null.fit[0].outputs, null_of(best, own, values, 3).fit[0].outputs)


def test_a_record_is_predicted_with_what_it_has_for_itself(plant):
    robot, own = plant
    (record,) = robot.confirm
    ((where, suffix),) = (
        item for e in own.effects if e.name == "time_shift" for item in e.places.items()
    )
    late = {"discovery": {
        "effects": [{"name": "time_shift", "where": where, "parameters": {
            f"tau [{record.name}]": {"value": 2 * record.sampling_time}}}],
        "nominal": {n: {"value": v} for n, v in TRUE.items()},
        "final": {n: {"value": v} for n, v in TRUE.items()}
        | {"time_shift.tau [another]": {"value": 1.0}},
    }}  # fmt: skip
    seen = measure_again(robot, late)["unseen"]
    values = {**TRUE, f"time_shift.tau{suffix}": 2 * record.sampling_time}
    expected = np.sqrt(np.mean(window_error(own, record, robot.horizon, values) ** 2))
    assert seen["rms"]["with what is named"] == pytest.approx(expected)
    assert seen["rms"]["with what is named"] > 1.2 * seen["rms"]["nominal, fitted"]


def test_a_true_model_predicts_better_than_one_with_a_wrong_mass(plant):
    robot, own = plant
    models = {"wrong": errors_of(own, {**TRUE, "m": 8e-6}), "right": errors_of(own, TRUE)}
    seen = compare(models, robot.confirm, robot.horizon)
    assert seen["better"] == {"right": 1}
    assert seen["change"]["right"] < -0.5
    assert seen["rms"]["right"] == pytest.approx(
        np.sqrt(np.mean(models["right"](robot.confirm[0], robot.horizon) ** 2))
    )
