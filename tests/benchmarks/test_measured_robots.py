"""The bench of measured robots: its records, its files and its page."""

from dataclasses import replace

import numpy as np
import pytest
from measured_cases import DATA, oscillator, oscillator_log, with_data
from robots import ROBOTS, reader
from robots.measured_robot import gridded
from robots.unseen import MOST, spread
from robots.written import command, write_files

from identification import read_robot
from identification.effects.plant.rows import read_model

LENGTHS = {  # of the records to fit and of those that confirm [s]
    "emps": ((12.41,), (12.42, 24.84)),
    "silverbox": ((13.42, 13.42), (13.42, 66.19)),
    "xl330": ((5.99, 1.99, 5.99, 5.99) * 2, (5.99, 1.99, 5.99, 5.99) * 2),
    "pendulum": ((5.99, 3.5, 5.99), (3.89, 2.68, 6.49)),
    "double_pendulum": ((9.99,) * 3, (9.99, 9.99, 9.99, 5.99)),
    "ur10e": ((39.3, 31.66), (35.32, 57.12)),
}


@with_data
@pytest.mark.parametrize("name", ROBOTS)
def test_records_are_even_and_have_the_columns_and_units_of_their_model(name):
    try:
        robot = reader(name)(DATA)
    except FileNotFoundError as error:
        pytest.skip(str(error))
    model = read_model(robot.model).compile()
    inputs = tuple(model.actuator(i).name for i in range(model.nu))
    sensors = {model.sensor(i).name for i in range(model.nsensor)}
    for log in (*robot.records, *(log for each in robot.apart for log in each.logs)):
        assert log.input_names == inputs
        assert set(log.output_names) <= sensors
        assert log.hold == "foh"
        assert log.units == robot.fit[0].units
        assert np.all(np.ptp(log.outputs, axis=0) > 0)
        step = np.diff(log.time)
        assert step == pytest.approx(log.sampling_time, rel=1e-9)
        samples = robot.horizon / log.sampling_time
        assert samples == pytest.approx(round(samples), abs=1e-6)  # windows of nulls lie in one
    names = [log.name for log in robot.records]
    assert len(set(names)) == len(names)
    if name in LENGTHS:
        found = tuple(tuple(log.duration for log in logs) for logs in (robot.fit, robot.confirm))
        for ours, said in zip(found, LENGTHS[name], strict=True):
            assert ours == pytest.approx(said, abs=0.03)


@with_data
def test_no_realisation_of_the_silverbox_reaches_into_a_rest_of_its_input():
    from robots.silverbox import REALISATIONS, read_voltages, realisation

    voltages = read_voltages(DATA)
    for k in range(REALISATIONS):
        u = realisation(voltages, k).inputs[:, 0]
        parts = np.std(u[: len(u) // 64 * 64].reshape(-1, 64), axis=1)
        assert parts.min() > 0.4 * np.median(parts)


@with_data
def test_what_the_pendulums_torque_says_below_its_vibration():
    robot = reader("pendulum")(DATA)
    e = robot.evidence(None)
    x, heavy = e["physics"], e["heavy"]
    assert heavy["m l"] / x["m l"] == pytest.approx(heavy["J"] / x["J"], rel=0.1)
    for name in ("ddp", "direct_collocation", "ilqr", "sac"):
        row = e["records"]["3 Hz"][name]
        assert row["left"] < 0.15 * row["torque"]
        assert abs(row["shift_ms"]) <= 10


def test_a_column_on_a_coarser_grid_has_the_mean_over_a_step_and_outputs_their_value():
    t = np.linspace(0, 2, 900)
    t[1:-1] += np.random.default_rng(0).uniform(-7e-4, 7e-4, 898)
    log = gridded(
        t, {"u": 3 * t}, {"y": np.sin(t)}, units={"u": "V"}, name="made up", step=0.02, widest=0.1,
        means=True,
    )  # fmt: skip
    assert log.inputs[1:-1, 0] == pytest.approx(3 * log.time[1:-1], abs=1e-12)
    assert log.outputs[:, 0] == pytest.approx(np.sin(log.time), abs=1e-4)
    fast = gridded(
        t, {"u": np.sin(2 * np.pi * 50 * t)}, {"y": t}, units={}, name="made up", step=0.02,
        widest=0.1, means=True,
    )  # fmt: skip
    assert np.abs(fast.inputs[1:-1]).max() < 0.05  # a whole wave a step has no mean


def test_written_files_are_read_back_as_they_were(tmp_path):
    robot = oscillator(
        (oscillator_log(0), oscillator_log(1)), fixed={"stribeck_friction.v_s": 20.0}
    )
    path, paths = write_files(robot, tmp_path / "new")
    read = read_robot(path, paths["fit"], paths["confirm"])
    assert read.file.free == tuple(p.name for p in robot.free)
    assert read.file.horizon == robot.horizon
    own = read.plant.parameters.values()
    assert {p.name: own[p.name] for p in robot.free} == {p.name: p.value for p in robot.free}
    assert own["stribeck_friction.v_s"] == 20.0
    for log, same in zip((read.log, *read.records), robot.records, strict=True):
        assert np.array_equal(log.inputs, same.inputs)
        assert np.array_equal(log.outputs, same.outputs)
        assert log.hold == same.hold
    assert command(path, paths).split()[4:6] == [str(path), str(paths["fit"][0])]


def test_the_second_split_exchanges_records_and_another_start_changes_nothing_else():
    robot = oscillator((oscillator_log(0, 200), oscillator_log(1, 200)))
    other = robot.split(2)
    assert (other.fit, other.confirm) == (robot.confirm, robot.fit)
    begun = robot.started({"m": 1.0})
    assert [p.value for p in begun.free if p.name == "m"] == [pytest.approx(1.0, rel=0.02)]
    assert begun.free[1:] == robot.free[1:]


def test_a_long_record_is_predicted_in_parts_that_do_not_overlap():
    short = oscillator_log(0, 60)
    many = np.ones((100, 1))
    log = replace(
        short, time=short.sampling_time * np.arange(6000), inputs=np.kron(many, short.inputs),
        outputs=np.kron(many, short.outputs),
    )  # fmt: skip
    parts = spread(log, 60 * log.sampling_time)
    assert sum(len(p) // 60 for p in parts) == MOST
    ends = [p.time[-1] for p in parts]
    assert all(b.time[0] > a for a, b in zip(ends, parts[1:], strict=False))
    assert parts[-1].time[-1] > 0.97 * log.time[-1]
