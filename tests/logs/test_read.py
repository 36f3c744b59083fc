from __future__ import annotations

import json
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
import pytest
from example_logs import INPUTS, OUTPUTS, UNITS, read, wave
from hypothesis import given
from hypothesis import strategies as st
from scipy.io import savemat

from identification import read_log, write_log
from identification.logs.units import UNITS as WORDS

PRACTICE = Path(__file__).parents[3] / "shared" / "data" / "practice_prbs"
TEXT = "time,current_1,current_2,angle_1,angle_2\n0,1,2,3,4\n0.1,1,2,3,5\n0.2,1,2,3,6\n"


def _as_csv(names, columns) -> str:
    rows = zip(*(map(repr, columns[name].tolist()) for name in names), strict=True)
    return "\n".join([",".join(names), *map(",".join, rows)]) + "\n"


@given(order=st.permutations(["time", *INPUTS, *OUTPUTS, "x"]))
def test_the_order_of_columns_does_not_matter(order):
    log = wave()
    with TemporaryDirectory() as folder:
        path = Path(folder) / "log.csv"
        path.write_text(_as_csv(order, {"time": log.time, **log.columns}))
        back = read(path)
    assert np.array_equal(back.inputs, log.inputs)
    assert np.array_equal(back.outputs, log.outputs)
    assert np.array_equal(back.extras["x"], log.extras["x"])


@pytest.mark.parametrize("word", WORDS)
def test_units_convert_to_si(csv, word):
    path = csv(TEXT)
    path.with_suffix(".toml").write_text(f"units.angle = {json.dumps(word)}\n")
    plain = np.array([[3, 4], [3, 5], [3, 6]])
    log = read(path)
    assert log.outputs == pytest.approx(plain * WORDS[word][1], rel=1e-15)
    assert log.units == {"angle_1": WORDS[word][0], "angle_2": WORDS[word][0]}


def test_a_column_s_own_unit_wins_over_its_group_s(csv):
    path = csv(TEXT)
    path.with_suffix(".toml").write_text('[units]\nangle = "deg"\nangle_2 = "rad"\ntime = "ms"\n')
    log = read(path, units=UNITS)
    assert log.outputs[0] == pytest.approx([np.deg2rad(3), 4])
    assert log.sampling_time == pytest.approx(1e-4)
    assert log.units["current_1"] == "A"


def test_a_factor_comes_on_top_of_the_unit(csv):
    path = csv(TEXT)
    path.with_suffix(".toml").write_text(
        'units.angle = "deg"\n[factors]\nangle_1 = -1\ncurrent = 0.5\n'
    )
    log = read(path, units=UNITS)
    assert log.outputs[0] == pytest.approx(np.deg2rad([-3, 4]))
    assert log.inputs[0] == pytest.approx([0.5, 1])
    assert log.units["angle_1"] == "rad"


def test_everything_a_sidecar_can_say(csv):
    path = csv(TEXT.replace("angle_1", "q1").replace("angle_2", "q2").replace("time", "hour"))
    path.with_suffix(".toml").write_text(
        """
        sampling_time = 0.1
        hold = "foh"
        notes = "warm motors"
        ignore = ["hour"]
        [columns]
        q1 = "angle_1"
        q2 = "angle_2"
        [splits]
        all = [0, inf]
        """
    )
    log = read(path)
    assert (log.hold, log.notes, log.name) == ("foh", "warm motors", "log")
    assert dict(log.splits) == {"all": (0, np.inf)}
    assert log.outputs[0].tolist() == [3, 4]
    assert log.time == pytest.approx([0, 0.1, 0.2])


def test_a_declared_sampling_time_replaces_coarse_stamps(csv, refusal):
    body = "".join(f"{round(1000 * k / 187)},1,2,3,4\n" for k in range(50))
    path = csv(TEXT.split("\n")[0] + "\n" + body)
    sidecar = path.with_suffix(".toml")
    sidecar.write_text('units.time = "ms"')
    assert read(path).sampling_time == pytest.approx(1 / 187, rel=1e-3)
    sidecar.write_text(f'sampling_time = {1 / 187}\nunits.time = "ms"')
    assert np.array_equal(read(path).time, np.arange(50) * (1 / 187))
    sidecar.write_text('sampling_time = 0.005\nunits.time = "ms"')
    assert "sampling_time" in refusal(read, path)


@pytest.mark.parametrize(
    "text",
    [
        TEXT.replace("\n", "\r\n"),
        TEXT.replace("\n", "\r"),
        "\ufeff" + TEXT,
        "# made by hand\n#\n\n" + TEXT,
        TEXT + "\n \n\n",
        TEXT.rstrip("\n"),
        TEXT.replace(",", " , "),
        TEXT.replace("time", '"time"'),
        TEXT.replace("3,5", "+3.0e0,.5E1"),
    ],
)
def test_what_programs_write_differently_means_the_same(csv, text):
    log = read(csv(text))
    assert log.outputs.tolist() == [[3, 4], [3, 5], [3, 6]]
    assert log.inputs.tolist() == [[1, 2]] * 3


@pytest.mark.parametrize("turn", [lambda a: a, np.transpose])
def test_matlab(tmp_path, turn):
    log = wave()
    content = {"u": turn(log.inputs), "y": turn(log.outputs), "Ts": 0.01, "x": log.extras["x"]}
    savemat(tmp_path / "log.mat", content)
    back = read(tmp_path / "log.mat", units=UNITS)
    assert np.array_equal(back.inputs, log.inputs)
    assert np.array_equal(back.outputs, log.outputs)
    assert np.array_equal(back.extras["x"], log.extras["x"])
    assert back.time == pytest.approx(log.time)
    assert back.units == log.units


def test_matlab_without_ts_may_have_it_beside(tmp_path):
    savemat(tmp_path / "log.mat", {"u": wave().inputs, "y": wave().outputs})
    (tmp_path / "log.toml").write_text('sampling_time = 0.02\nunits.current = "mA"')
    back = read(tmp_path / "log.mat")
    assert back.sampling_time == 0.02
    assert back.inputs == pytest.approx(wave().inputs / 1000)


def test_a_robot_without_inputs_has_a_log_too(csv):
    log = read_log(csv("time,q\n0,1\n1,2\n2,3\n"), (), ("q",))
    assert log.inputs.shape == (3, 0)


def test_plausible_numbers_pass(tmp_path):
    write_log(wave(), tmp_path / "log.csv")
    log = read(tmp_path / "log.csv", units=UNITS, limits={"current": 1}, rates={"angle": 5})
    assert np.array_equal(log.outputs, wave().outputs)


@pytest.mark.skipif(not PRACTICE.is_dir(), reason="the practice logs are not beside this checkout")
def test_practice_logs():
    inputs = tuple(f"current_{k}" for k in range(1, 9))
    outputs = tuple(f"angle_{k}" for k in range(1, 9))
    paths = sorted(PRACTICE.glob("*.csv"))
    seconds = []
    for path in paths:
        start = perf_counter()
        log = read_log(
            path,
            inputs,
            outputs,
            units={"current": "A", "angle": "rad"},
            limits={"current": 20, "angle": 400},
            rates={"angle": 300},
        )
        seconds.append(perf_counter() - start)
        assert (len(log), log.sampling_time) == (2000, 0.01)
        assert len(log.part("estimation")) == len(log.part("validation")) == 1000
    assert paths
    assert np.median(seconds) < 0.1  # some 15 ms when the machine is free
