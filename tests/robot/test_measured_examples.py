"""Examples on measured robots: their readers and laws, and what their records are known to show.

Records are read from the folders EMPS_DATA, XL330_DATA and TTK4900_DATA, else from ../shared/data.
"""

import json
import os
from dataclasses import replace
from pathlib import Path

import emps
import numpy as np
import pytest
import winch
import winch_strokes as strokes
import xl330
from plain_logs import plain_log

from identification import Log, Predictor, estimate_windows, read_robot, window_error

EXAMPLES = Path(__file__).parents[2] / "examples"
SHARED = EXAMPLES.parents[1] / "shared" / "data"
DATA = Path(os.environ.get("EMPS_DATA", SHARED / "emps"))


needs_records = pytest.mark.skipif(
    not (DATA / "DATA_EMPS.mat").exists(),
    reason="EMPS_DATA names no folder with DATA_EMPS.mat; get it from nonlinearbenchmark.org",
)


@needs_records
def test_friction_that_differs_by_direction_predicts_pulses_that_were_not_fitted():
    log, pulses = (emps.read_emps(DATA / f"DATA_EMPS{s}.mat") for s in ("", "_PULSES"))
    robot = read_robot(emps.ROBOT, log.between(0.0, 5.0))
    size = "asymmetric_viscous_friction.d_a@slide"
    fit = estimate_windows(robot.plant, robot.log, (*robot.file.free, size), 0.2, tolerance=1e-2)
    assert fit.values["M"] == pytest.approx(emps.PUBLISHED["M"], rel=0.05)
    assert fit.values[size] == pytest.approx(emps.PUBLISHED[size], rel=0.4)
    symmetric, ours = (
        np.mean(window_error(robot.plant, pulses.between(0.0, 8.0), 0.2, values) ** 2)
        for values in ({}, fit.values)
    )
    assert ours < 0.8 * symmetric


RAW = Path(os.environ.get("XL330_DATA", EXAMPLES.parents[1] / "shared" / "data" / "xl330" / "raw"))
MODEL = EXAMPLES.parent / "models" / "xl330.xml"
NAMES = ("g", "D", "J_a", "coulomb_friction.f_c@hinge", "offset.f_0@hinge")
HORIZON = 0.2  # [s]


def made_up(n=300, seed=2):
    """A log of a voltage that reverses often, and positions that mean nothing yet."""
    levels = np.random.default_rng(seed).uniform(-5, 5, n // 10 + 1)
    u = np.repeat(levels, 10)[:n, None]
    time = xl330.STEP * np.arange(n)
    return plain_log(u, np.sin(3 * time)[:, None], "motor", "angle", time=time, hold="foh")


def test_a_record_is_read_on_an_even_grid_with_signs_and_without_what_the_motor_left_alone(
    tmp_path,
):
    time = 100 + np.cumsum(np.random.default_rng(1).uniform(0.003, 0.007, 200))
    entries = [
        {"timestamp": t, "position": 0.5 * (t - time[0]), "load": 2**16 - 442.5,
         "input_volts": 7.0, "torque_enable": True}
        for t in time
    ]  # fmt: skip
    fall = [{**entries[-1], "timestamp": time[-1] + 0.2, "load": 0, "torque_enable": False}]
    record = {"kp": 100, "trajectory": "ramp", "entries": entries + fall}
    (tmp_path / "a.json").write_text(json.dumps(record))
    log = xl330.read_xl330(tmp_path / "a.json")
    np.testing.assert_allclose(log.inputs, -3.5, rtol=1e-12)
    np.testing.assert_allclose(log.outputs[:, 0], 0.5 * log.time, atol=1e-9)
    assert log.sampling_time == xl330.STEP
    assert time[-1] - time[0] - xl330.STEP < log.duration <= time[-1] - time[0]
    assert [one.name for one in xl330.read_all(tmp_path, (100,))] == ["ramp, k_p 100"]
    assert xl330.read_all(tmp_path, (200,)) == []


def test_known_values_are_recovered_from_the_noisy_angle_of_the_model():
    empty = made_up()
    plant = read_robot(xl330.ROBOT, empty, trust=["steps", "units", "wiring"]).plant
    truth = dict(zip(NAMES, (0.12, 0.03, 0.003, 0.03, 0.005), strict=True))
    y = Predictor(plant, empty, (), truth).predict(np.empty((1, 0)))[0]
    noise = 5e-4 * np.random.default_rng(4).standard_normal(y.shape)
    log = replace(empty, outputs=y + noise)
    fit = estimate_windows(plant, log, NAMES, HORIZON, tolerance=1e-4)
    for (name, value), std in zip(fit.values.items(), fit.std, strict=True):
        assert abs(value - truth[name]) < 4 * std, name
        assert std < 0.05 * truth[name] + 5e-4, name
    assert fit.rms == pytest.approx(5e-4, rel=0.1)


@pytest.mark.long
@pytest.mark.skipif(
    not RAW.exists(), reason="XL330_DATA names no folder of records; see github.com/Rhoban/bam"
)
def test_friction_under_the_transmitted_load_predicts_another_gain_better():
    (log,) = (x for x in xl330.read_all(RAW, (400,)) if x.name.startswith("sin_time_square"))
    (other,) = (x for x in xl330.read_all(RAW, (200,)) if x.name.startswith("sin_time_square"))
    plant, mu = read_robot(xl330.ROBOT, log).plant, "transmitted_load_friction.mu@hinge"
    fit = estimate_windows(plant, log, NAMES, HORIZON, tolerance=1e-2)
    start = {**fit.values, mu: 0.1}
    more = estimate_windows(plant, log, (*NAMES, mu), HORIZON, start, tolerance=1e-2)
    begun, found, better = (
        np.mean(window_error(plant, other, HORIZON, e) ** 2)
        for e in ({}, fit.values, more.values)
    )  # fmt: skip
    assert found < 0.5 * begun
    assert better < 0.7 * found


WINCH_DATA = Path(os.environ.get("TTK4900_DATA", SHARED / "ttk4900")) / "lifting"
F_C, F_0 = "coulomb_friction.f_c@cable", "offset.f_0@cable"
TRUST = ["units", "wiring", "start"]
WAVE = np.array([0.3, -0.7, 0.5, 0.2, 0.0, 0.4])  # [A]
MASS, LOAD = 5, 5 * 9.81  # [kg], [N]


def write_record(folder, t, turns, rate, current):
    """As the authors log: four drives, those that have not answered yet are NaN."""
    path = folder / "5kg" / "ODrive2" / "Up05.csv"
    path.parent.mkdir(parents=True)
    table = np.full((len(t), 13), np.nan)
    table[:, 0], table[:, 3], table[:, 7], table[:, 11] = t, turns, rate, current
    table[:3, 1:] = np.nan
    np.savetxt(path, table, delimiter=",", header="time,...", fmt="%.9g")


def test_a_record_is_read_in_si_units_and_lifting_is_positive(tmp_path):
    t = np.cumsum(np.random.default_rng(1).uniform(0.005, 0.05, 900))
    q = strokes.TURN * 0.5 * t
    current = -(18.7 + strokes.waves(q) @ WAVE)  # the drive's sign
    write_record(tmp_path, t, q / strokes.TURN, np.full(len(t), 0.5), current)
    log = winch.winch_log(tmp_path, "5kg/ODrive2/Up05", 1.0, 20.0)
    first = t[t >= 1.0][0]  # the log begins at its first sample
    expected = strokes.RADIUS * strokes.TURN * 0.5 * (first + log.time)
    assert log.outputs[:, 0] == pytest.approx(expected, abs=1e-6)
    assert np.mean(log.inputs) == pytest.approx(18.7, abs=0.1)
    one = strokes.stroke(tmp_path, "5kg/ODrive2/Up05", 1.0, 20.0)
    assert (one.mass, one.motor) == (5, 2)
    assert one.mean == pytest.approx(18.7, abs=1e-5)
    assert one.wave == pytest.approx(WAVE, abs=1e-5)
    assert one.explained(WAVE) == pytest.approx(1.0)
    assert one.explained(-WAVE) < 0


def test_the_law_of_the_strokes_is_told_from_two_masses_and_both_directions():
    mass, w = np.array([[m, w] for m in (1, 5) for w in (-6, -3, 3, 6)], dtype=float).T
    true = np.array([0.7, 3.3, 0.8, 0.12, 0.005])
    found, _ = strokes.fitted(strokes.law(mass, w), strokes.law(mass, w) @ true)
    assert found == pytest.approx(true)
    # With one mass, a constant current and gravity are one column.
    assert np.linalg.matrix_rank(strokes.law(mass, w)[mass == 5]) == 3


def record(current, seconds=0.6, step=0.03):
    """A log of a held current [A]; its travel means nothing, but there has to be some."""
    n = round(seconds / step)
    return Log(
        time=step * np.arange(n), inputs=np.full((n, 1), current),
        outputs=np.linspace(0.0, 1.0, n)[:, None], input_names=("motor",), output_names=("wound",),
        units={"motor": "A", "wound": "m"}, hold="foh",
    )  # fmt: skip


def test_the_current_m_g_r_over_k_t_holds_the_load_and_a_motor_within_friction_stands():
    def end(current):
        log = record(current)
        plant = read_robot(winch.ROBOT, log, trust=TRUST).plant
        return Predictor(plant, log, ()).predict(np.empty((1, 0)))[0, -1, 0]

    hold, friction = LOAD / 2.755, 2.5 / 2.755  # [A]
    for share in (0.0, 0.9, -0.9):
        assert end(hold + share * friction) == pytest.approx(0.0, abs=1e-6)
    assert end(hold + 1.5 * friction) > 0.01
    assert end(hold - 1.5 * friction) < -0.01


@pytest.mark.long
@pytest.mark.skipif(
    not (WINCH_DATA / "5kg" / "ODrive2" / "Up05.csv").exists(),
    reason="TTK4900_DATA names no folder with lifting; see github.com/eliasoa/TTK4900_CDPR",
)
def test_the_records_show_the_authors_asymmetry_one_cogging_and_friction_that_grows_with_load():
    all_ = [strokes.stroke(WINCH_DATA, *s) for s in strokes.STROKES]
    for s in all_:
        if s.mass == MASS and abs(s.w) < 1.5 * strokes.TURN:
            share = s.mean * strokes.K_T / (LOAD * strokes.RADIUS) - 1
            assert (0.045 < share < 0.07) if s.w > 0 else (-0.12 < share < -0.10)
    two = [s for s in all_ if s.motor == 2]
    slow = [s for s in two if abs(s.w) < 1.5 * strokes.TURN]
    assert all(s.explained(two[0].wave) > 0.75 for s in slow)  # up, down, 1 kg, 5 kg
    columns = np.array([(s.mass, s.w, s.mean) for s in slow]).T
    (i_0, per_kg, c, mu, _), std = strokes.fitted(strokes.law(*columns[:2]), columns[2])
    assert 0.018 < strokes.K_T * per_kg / strokes.G < 0.020  # a radius, and below the authors'
    assert 0.032 < strokes.K_T * c < 0.045
    assert mu > 10 * std[3]
    assert i_0 > 10 * std[0]

    log = winch.winch_log(WINCH_DATA, *winch.FITTED[0])
    plant = read_robot(winch.ROBOT, log, trust=["wiring", "units"]).plant
    fit = estimate_windows(plant, log, (F_C, F_0), 0.96, tolerance=1e-3)
    up, down = (next(s.mean for s in slow if s.mass == MASS and sign * s.w > 5) for sign in (1, -1))
    force = strokes.K_T / strokes.RADIUS
    viscous = strokes.TURN * strokes.RADIUS  # 1 N s/m at 1 rev/s
    assert fit.values[F_C] + viscous == pytest.approx(force * (up - down) / 2, rel=0.06)
    assert LOAD - fit.values[F_0] == pytest.approx(force * (up + down) / 2, rel=0.01)
