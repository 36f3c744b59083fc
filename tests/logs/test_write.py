from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from example_logs import read, wave
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from identification import Log, write_log
from identification.files import toml_table, toml_value
from identification.folders import whole_folder

finite = st.floats(allow_nan=False, allow_infinity=False)
texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=30)


@st.composite
def logs(draw) -> Log:
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


def assert_same(a: Log, b: Log) -> None:
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


def test_a_log_that_says_no_more_than_its_columns_is_one_file(tmp_path):
    write_log(replace(wave(), units={}), tmp_path / "log.csv")
    assert [f.name for f in tmp_path.iterdir()] == ["log.csv"]


def test_an_older_sidecar_does_not_speak_of_the_new_log(tmp_path):
    (tmp_path / "log.toml").write_text('units.current = "mA"\n')
    log = replace(wave(), units={})
    write_log(log, tmp_path / "log.csv")
    assert np.array_equal(read(tmp_path / "log.csv").inputs, log.inputs)


def test_units_are_written_by_group(tmp_path):
    write_log(wave(), tmp_path / "log.csv")
    units = tomllib.loads((tmp_path / "log.toml").read_text())["units"]
    assert units == {"current": "A", "angle": "rad", "x": "m"}


def test_a_missing_folder_is_named(tmp_path, refusal):
    text = refusal(write_log, wave(), tmp_path / "nowhere" / "log.csv")
    assert str(tmp_path / "nowhere") in text
    assert list(tmp_path.iterdir()) == []


def test_only_csv_is_written(tmp_path, refusal):
    assert "log.mat" in refusal(write_log, wave(), tmp_path / "log.mat")
    assert "digits = 0" in refusal(write_log, wave(), tmp_path / "log.csv", digits=0)


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


def test_a_folder_in_the_way_is_refused(tmp_path, refusal):
    (tmp_path / "log.csv").mkdir()
    assert "log.csv" in refusal(write_log, wave(), tmp_path / "log.csv")
    assert [f.name for f in tmp_path.iterdir()] == ["log.csv"]


def test_a_folder_of_results_is_filled_whole_or_left_as_it_was(tmp_path):
    out = tmp_path / "deep" / "results"
    with whole_folder(out) as draft:
        (draft / "a.txt").write_text("first")
        assert not out.exists()
    assert {p.name: p.read_text() for p in out.glob("[!.]*")} == {"a.txt": "first"}

    def interrupted():
        with whole_folder(out) as draft:
            (draft / "a.txt").write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert {p.name: p.read_text() for p in out.glob("[!.]*")} == {"a.txt": "first"}


def test_a_folder_that_cannot_be_made_is_refused(tmp_path, refusal):
    (tmp_path / "file").write_text("")

    def fill(path):
        with whole_folder(path):
            raise AssertionError("never begins")

    assert "choose another" in refusal(fill, tmp_path / "file" / "out")


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
