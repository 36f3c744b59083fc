"""The winch of a cable robot: laws of the example, and its records where they are at hand."""

import importlib.util
import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from identification import Log, Predictor
from identification.windows.window_estimate import estimate_windows

PATH = Path(__file__).parents[2] / "examples" / "winch.py"
DATA = Path(os.environ.get("TTK4900_DATA", "data/ttk4900")) / "lifting"
sys.path.insert(0, str(PATH.parent))
SPEC = importlib.util.spec_from_file_location("winch", PATH)
winch = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(winch)
sys.path.remove(str(PATH.parent))
strokes = sys.modules["winch_strokes"]
WAVE = np.array([0.3, -0.7, 0.5, 0.2, 0.0, 0.4])  # [A]
MASS, LOAD = 5, 5 * 9.81 * 0.02  # [kg], [N m]


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
    log = winch.winch_log(tmp_path, "5kg/ODrive2/Up05", WAVE)
    assert log.time[0] == pytest.approx(t[3])
    assert log.outputs[:, 0] == pytest.approx(strokes.TURN * 0.5 * log.time, abs=1e-6)
    assert log.inputs == pytest.approx(np.full((len(log), 1), 18.7), abs=1e-5)
    one = winch.stroke(tmp_path, "5kg/ODrive2/Up05", 1.0, 20.0)
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


def test_the_table_of_the_balance_says_what_its_columns_are(capsys):
    mass, w = np.array([[m, w] for m in (1, 5) for w in (-12, -6, -3, 3, 6, 12)], dtype=float).T
    mean = strokes.law(mass, w) @ [0.7, 3.3, 0.8, 0.12, 0.005]
    none = np.zeros(0)
    strokes.balance([
        strokes.Stroke(int(m), motor, v, i, 0.01, none, none, none)
        for motor in (0, 2) for m, v, i in zip(mass, w, mean, strict=True)
    ])  # fmt: skip
    head, *rows = capsys.readouterr().out.splitlines()
    for column in ("motor", "mass", "speed of the drum", "mean current ± its std", "m g r"):
        assert column in head
    assert rows[0] == "motor 0, 1 kg, -1.91 rev/s:   3.02 ± 0.01 A, -15.2 % of m g r"
    (letters,) = (row for row in rows if row.startswith("fitted: "))
    for letter in ("i_0", "r", "c", "μ", "d"):
        assert f" {letter} " in letters


def record(current, seconds=0.6, step=0.03):
    """A log of no motion but its first sample, with a held current [A]; it needs some travel."""
    n = round(seconds / step)
    u = np.broadcast_to(np.asarray(current, dtype=float), (n,))[:, None]
    y = np.linspace(0.0, 1.0, n)[:, None]
    return Log(
        time=step * np.arange(n),
        inputs=u,
        outputs=y,
        input_names=("motor",),
        output_names=("angle",),
        hold="foh",
    )


def test_the_current_m_g_r_over_k_t_holds_the_load_and_no_other():
    def end(current):
        plant = winch.winch_plant(record(current), MASS).with_values({"q_0": 0.0, "v_0": 0.0})
        return Predictor(plant, record(current), ()).predict(np.empty((1, 0)))[0, -1, 0]

    hold = LOAD / strokes.K_T
    assert end(hold) == pytest.approx(0.0, abs=1e-9)
    friction = 0.05 / strokes.K_T  # a little more than it lifts, a little less and it pays out
    assert end(hold + 1.5 * friction) > 1.0
    assert end(hold - 1.5 * friction) < -1.0


def simulated(f_c, f_0):
    """Two seconds up, two down, near balance, with a current that hunts for the speed."""
    t = 0.03 * np.arange(140)
    hunt = 0.3 * np.sin(5 * t) + 0.2 * np.sin(11 * t)
    current = (-f_0 + np.where(t < 2.1, 1, -1) * 1.15 * f_c) / strokes.K_T + hunt
    log = Log(
        time=t,
        inputs=current[:, None],
        outputs=np.sin(t)[:, None],
        input_names=("motor",),
        output_names=("angle",),
        hold="foh",
    )
    plant = winch.winch_plant(log, MASS)
    values = {winch.F_C: f_c, winch.F_0: f_0, "q_0": 0.0, "v_0": 3.0}
    y = Predictor(plant.with_values(values), log, ()).predict(np.empty((1, 0)))[0]
    noise = np.random.default_rng(2).normal(0, 1e-3, y.shape)
    return replace(log, outputs=y + noise)


def test_friction_and_load_come_back_from_a_simulated_record():
    log = simulated(0.077, -0.951)
    assert log.outputs.max() > 3 + log.outputs[0]  # it went up, and came down
    assert log.outputs[-1] < log.outputs.max() - 3
    fit = estimate_windows(winch.winch_plant(log, MASS), log, (winch.F_C, winch.F_0), 0.3)
    assert fit.values[winch.F_C] == pytest.approx(0.077, rel=0.03)
    assert fit.values[winch.F_0] == pytest.approx(-0.951, rel=0.005)


@pytest.mark.skipif(
    not (DATA / "5kg" / "ODrive2" / "Up05.csv").exists(),
    reason="TTK4900_DATA names no folder with lifting; see github.com/eliasoa/TTK4900_CDPR",
)
def test_the_records_show_the_authors_asymmetry_one_cogging_and_friction_that_grows_with_load():
    all_ = [winch.stroke(DATA, *s) for s in winch.STROKES]
    for s in all_:
        if s.mass == MASS and abs(s.w) < 1.5 * strokes.TURN:
            share = s.mean * strokes.K_T / LOAD - 1
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

    name, begin, _, end = winch.LOGS[0]
    log = winch.winch_log(DATA, name).between(begin, end)
    fit = estimate_windows(winch.winch_plant(log, MASS), log, (winch.F_C, winch.F_0), 1.0,
                           tolerance=1e-4)  # fmt: skip
    up, down = (next(s.mean for s in slow if s.mass == MASS and sign * s.w > 5) for sign in (1, -1))
    level = fit.values[winch.F_C] + 4e-4 * strokes.TURN
    assert level == pytest.approx(strokes.K_T * (up - down) / 2, rel=0.06)
    assert -fit.values[winch.F_0] == pytest.approx(strokes.K_T * (up + down) / 2, rel=0.01)
