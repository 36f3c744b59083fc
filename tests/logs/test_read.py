import json
import tomllib
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from example_logs import INPUTS, OUTPUTS, UNITS, read, wave
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.io import savemat

from identification import write_log
from identification.logs.units import UNITS as WORDS
from identification.storage.files import toml_table, toml_value

TEXT = "time,current_1,current_2,angle_1,angle_2\n0,1,2,3,4\n0.1,1,2,3,5\n0.2,1,2,3,6\n"


def _as_csv(names, columns):
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


finite = st.floats(allow_nan=False, allow_infinity=False)
texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=30)


@st.composite
def logs(draw):
    n = draw(st.integers(3, 12))
    ends = st.one_of(st.floats(0.5, 9), st.just(np.inf))
    return replace(
        wave(n),
        time=draw(st.floats(-1e3, 1e3))
        + draw(st.sampled_from([1e-4, 0.01, 1 / 187])) * np.arange(n),
        inputs=draw(arrays(float, (n, 2), elements=finite)),
        outputs=draw(arrays(float, (n, 2), elements=finite)),
        extras={"y": draw(arrays(float, n, elements=finite))} if draw(st.booleans()) else {},
        units=draw(st.sampled_from([{}, {"angle_1": "rad"}, {"angle_1": "rad", "angle_2": "m"}])),
        name="log",
        notes=draw(texts),
        hold=draw(st.sampled_from(["zoh", "foh"])),
        splits={draw(texts): (-np.inf, 1e3 + draw(ends))} if draw(st.booleans()) else {},
    )


def assert_same(a, b):
    """Equal to the bit, the sign of zero included."""
    for x, y in ((a.time, b.time), (a.inputs, b.inputs), (a.outputs, b.outputs)):
        assert x.tobytes() == y.tobytes()
    assert {k: v.tobytes() for k, v in a.extras.items()} == {
        k: v.tobytes() for k, v in b.extras.items()
    }
    for name in ("input_names", "output_names", "units", "splits", "name", "notes", "hold"):
        assert getattr(a, name) == getattr(b, name)


@given(log=logs())
def test_what_is_written_is_read_back_to_the_bit(log):
    with TemporaryDirectory() as folder:
        path = Path(folder) / "log.csv"
        write_log(log, path)
        assert_same(read(path), log)


@pytest.mark.parametrize("digits", [1, 4, 9])
def test_digits_round_the_columns_and_leave_the_time_even(tmp_path, digits):
    log = wave(n=2000, step=1 / 187)
    write_log(log, tmp_path / "log.csv", digits=digits)
    back = read(tmp_path / "log.csv")
    assert np.array_equal(back.time, log.time)
    assert back.outputs == pytest.approx(log.outputs, rel=10.0 ** (1 - digits))


def test_values_of_a_robot_are_read_back_by_those_who_have_use_for_them(tmp_path, refusal):
    log = replace(wave(), values={"body/weight.mass": 1.0, 'a "name"': 0.1 / 3})
    write_log(log, tmp_path / "log.csv")
    assert read(tmp_path / "log.csv", lenient=True).values == log.values
    assert "under [values]" in refusal(read, tmp_path / "log.csv")
    (tmp_path / "log.toml").write_text("values.mass = inf")
    assert "values in" in refusal(read, tmp_path / "log.csv", lenient=True)


def test_an_older_sidecar_does_not_speak_of_the_new_log(tmp_path):
    (tmp_path / "log.toml").write_text('units.current = "mA"\n')
    log = replace(wave(), units={})
    write_log(log, tmp_path / "log.csv")
    assert np.array_equal(read(tmp_path / "log.csv").inputs, log.inputs)


def test_a_failed_write_leaves_nothing_and_harms_nothing(tmp_path, monkeypatch, refusal):
    path = tmp_path / "log.csv"
    write_log(wave(), path)
    before = {f.name: f.read_bytes() for f in tmp_path.iterdir()}

    def full(self, *args, **kwargs):
        self.touch()
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    text = refusal(write_log, replace(wave(), notes="new"), path)
    assert "No space left" in text
    assert str(path) in text
    assert {f.name: f.read_bytes() for f in tmp_path.iterdir()} == before


def test_what_is_written_as_toml_is_read_as_it_was():
    odd = {
        "name": 'a "b" \\ \x7f\n\u20ac',
        "free": ["a.b", "c"],
        "on": True,
        "step": 1e-300,
        "n": [[0.1, 2]],
    }
    assert tomllib.loads(f"x = {toml_value(odd)}")["x"] == odd
    assert tomllib.loads("\n".join(toml_table("t", odd)))["t"] == odd
    assert toml_table("t", {}) == []
