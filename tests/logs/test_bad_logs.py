"""Each kind of bad file is refused in one sentence that names the bad thing and the way on."""

from __future__ import annotations

import os
import tomllib
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from example_logs import HEADER, ROWS, UNITS, lines, read, wave
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.io import savemat

from identification import InputError, Log, write_log
from identification.files import MAX_BYTES
from identification.logs.cures import how_to_turn


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", ["empty", "header"]),
        ("\n \n", ["empty"]),
        ("# only\n# comments\n", ["empty"]),
        (HEADER, ["no rows"]),
        (HEADER + ROWS[0], ["line 2", "at least 3 rows", "has 1"]),
        (HEADER + ROWS[0] + ROWS[1], ["at least 3 rows", "has 2"]),
        ("".join(ROWS), ["line 1", "numbers and not names", "header"]),
        ("#" + lines(), ["line 2", "numbers and not names", "without #"]),
        (lines().replace(",", ";"), ["semicolons", "commas"]),
        (lines().replace(",", "\t"), ["tabs", "commas"]),
        (lines().replace(",", "|"), ["bars", "commas"]),
        (lines().replace(",", " "), ["spaces", "commas"]),
        (lines((1, HEADER.replace("angle_2", "angel_2"))), ["angle_2", "its column angel_2"]),
        (
            lines((1, HEADER.replace("time", "t"))),
            ["lacks column time", "sampling_time", "log.toml"],
        ),
        (lines((1, HEADER.replace("angle_2", "angle_1"))), ["angle_1", "more than once"]),
        (
            lines((1, HEADER.replace("angle_2", "\x1b[31m"))),
            ["lacks column angle_2", r"'\x1b[31m'"],
        ),
        (lines((1, HEADER.replace("angle_2", ""))), ["lacks column angle_2", "''"]),
        (lines((7, "0.05,1,2,nan,5\n")), ["line 7", "angle_1", "nan", "finite"]),
        (lines((7, "0.05,1,2,-inf,5\n")), ["line 7", "angle_1", "-inf", "finite"]),
        (lines((7, "0.05,1,2,1e999,5\n")), ["line 7", "angle_1", "inf", "finite"]),
        (lines((7, "0.05,,2,3,5\n")), ["line 7", "current_1", "empty"]),
        (lines((7, "0.05,1,two,3,5\n")), ["line 7", "current_2", "two is not a number"]),
        (lines((7, "0.05,1,1_0,3,5\n")), ["line 7", "current_2", "1_0 is not a number"]),
        (lines((7, "0.05,1,'\x85',3,5\n")), ["line 7", "current_2", r"\x85"]),
        (lines((7, "0.05,1,2,3\n")), ["line 7", "4 cells", "5"]),
        (lines((7, "0.05,1,2,3,4,5\n")), ["line 7", "6 cells", "5"]),
        (lines((2, "0,1,2,3\n"), (3, "0.01,1,2,3,4,5\n")), ["line 2", "4 cells"]),
        ("".join(line[:-1] + ",\n" for line in ROWS).join([HEADER, ""]), ["line 2", "6 cells"]),
        ("# note\n\n" + lines((7, "x,1,2,3,4\n")), ["line 9", "time", "x is not a number"]),
        (lines((7, "0.04,1,2,3,5\n")), ["line 7", "does not increase", "0.04"]),
        (lines((7, "0.03,1,2,3,5\n")), ["line 7", "does not increase", "0.03 s follows 0.04"]),
        (lines((7, "\n")), ["line", "samples are missing", "cut the log there"]),
        (lines((7, "0.053,1,2,3,5\n")), ["line 7", "not even", "0.003 s, 30 %", "resample"]),
        (lines().encode().replace(b"3,7", b"3,\0"), ["binary", "zero"]),
        (lines().encode("utf-16"), ["UTF-8"]),
        (lines().replace("angle_2", "größe").encode("latin-1"), ["not UTF-8", "0xf6"]),
    ],
)
def test_bad_csv(csv, refusal, content, words):
    path = csv(content)
    text = refusal(read, path)
    for word in (*words, str(path)):
        assert word in text


def test_unknown_columns_list_the_good_ones(csv, refusal):
    text = refusal(read, csv(lines().replace("\n", ",9\n").replace("angle_2,9", "angle_2,Y", 1)))
    for word in ("unknown column Y", "angle_2", "ignore", "log.toml"):
        assert word in text


def test_jitter_below_what_matters_passes(csv, refusal):
    rng = np.random.default_rng(1)
    noise = rng.uniform(-1, 1, 20)

    def jittered(size: float) -> str:
        return HEADER + "".join(
            f"{0.01 * k + 0.01 * size * noise[k]:.9f},1,2,3,4\n" for k in range(20)
        )

    assert len(read(csv(jittered(2e-4)))) == 20
    assert "not even" in refusal(read, csv(jittered(5e-3)))


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("units = ", ["not TOML", "end of document"]),
        ("hold = 'zoh'\nnotes once more = 3", ["not TOML", "line 2"]),
        ("a = " + "[" * 5000, ["not TOML"]),
        ("unit.current = 'mA'", ["'unit'", "did you mean 'units'"]),
        ("units.curent = 'mA'", ["'curent'", "did you mean 'current'"]),
        ("units.current = 'mAh'", ["mAh", "mA"]),
        ("units.current = 'deg'", ["current_1 in deg", "rad", "A"]),
        ("units.current = 3", ["current under units in", "must be a unit in quotes"]),
        ("units = 'mA'", ["units", "must be a table"]),
        ("factors.curent = -1", ["'curent'", "did you mean 'current'"]),
        ("factors.current = 0", ["factors", "other than zero"]),
        ("factors.current = '-1'", ["current under factors in", "must be a number other than"]),
        ("log.factors.current = inf", ["current under factors in [log] of", "must be a number"]),
        ("log.colums = ['q']", ["key in [log] of", "'colums'", "did you mean 'columns'"]),
        ("sampling_time = 0", ["sampling_time", "positive"]),
        ("sampling_time = true", ["sampling_time", "positive"]),
        ("sampling_time = nan", ["sampling_time", "positive"]),
        ("sampling_time = 1" + "0" * 400, ["not TOML", "64 bits"]),
        ("sampling_time = 0.02", ["sampling_time", "line"]),
        ("hold = 'linear'", ["hold", "zoh", "foh"]),
        ("notes = 3", ["notes", "text"]),
        ("ignore = 'x'", ["ignore", "list"]),
        ("ignore = ['temp']", ["ignore", "'temp'", "angle_1"]),
        ("columns.q1 = 'angle_1'", ["'q1'", "angle_1"]),
        ("columns.angle_1 = 'angle_2'", ["angle_2", "more than once"]),
        ("splits = [0, 1]", ["splits", "table"]),
        ("splits.a = [0, 1, 2]", ["a under splits in", "two times"]),
        ("splits.a = [0, 'end']", ["a under splits in", "two times"]),
        ("splits.late = [50, 60]", ["late", "[50, 60)", "[0, 0.19]"]),
    ],
)
def test_bad_sidecars(csv, refusal, content, words):
    path = csv(lines())
    path.with_suffix(".toml").write_text(content)
    text = refusal(read, path, units=UNITS)
    for word in words:
        assert word in text


U, Y = np.zeros((9, 2)), np.ones((9, 2))


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ({"u": U, "Ts": 0.1}, ["lacks y", "u, Ts"]),
        ({"U": U, "y": Y, "Ts": 0.1}, ["lacks u", "U, y"]),
        ({"u": U, "y": Y}, ["lacks column time", "sampling_time"]),
        ({"u": U, "y": Y, "Ts": [0.1, 0.2]}, ["Ts", "one positive"]),
        ({"u": U, "y": Y, "Ts": -1}, ["Ts", "positive"]),
        ({"u": np.zeros((9, 3)), "y": Y, "Ts": 0.1}, ["u is 9 x 3", "n x 2"]),
        ({"u": U[:8], "y": Y, "Ts": 0.1}, ["u is 8 x 2", "y is 9 x 2", "same n"]),
        ({"u": U + 1j, "y": Y, "Ts": 0.1}, ["u", "real"]),
        ({"u": "text", "y": Y, "Ts": 0.1}, ["u", "real"]),
        ({"u": U, "y": Y * np.nan, "Ts": 0.1}, ["row 1", "angle_1", "nan"]),
        ({"u": U, "y": Y, "Ts": 0.1, "x": np.zeros(8)}, ["x has 8", "9 samples"]),
        ({"u": U[:2], "y": Y[:2], "Ts": 0.1}, ["at least 3"]),
    ],
)
def test_bad_matlab(tmp_path, refusal, content, words):
    path = tmp_path / "log.mat"
    savemat(path, content)
    text = refusal(read, path)
    for word in (*words, str(path)):
        assert word in text


def test_matlab_7_3_says_how_to_save_it(tmp_path, refusal):
    path = tmp_path / "log.mat"
    start = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, HDF5 schema 1.00 .".ljust(116)
    path.write_bytes(start + bytes(8) + b"\x00\x02IM" + b"\x89HDF\r\n\x1a\n" + bytes(500))
    text = refusal(read, path)
    assert "7.3" in text
    assert "-v7" in text


def test_bad_paths(tmp_path, refusal):
    (tmp_path / "logs.csv").mkdir()
    (tmp_path / "run_1.csv").write_text(lines())
    (tmp_path / "run.xlsx").write_text(lines())
    os.mkfifo(tmp_path / "pipe.csv")
    for name, words in {
        "run_2.csv": ["no such file", "did you mean", "run_1.csv"],
        "zebra.csv": ["no such file", "check"],
        "nowhere/run.csv": ["no such folder", "nowhere"],
        "logs.csv": ["is a folder"],
        "pipe.csv": ["not a regular file"],
        "run.xlsx": ["neither .csv nor .mat"],
        "a" * 300 + ".csv": ["cannot read", "too long"],
        ".": ["is a folder"],
        "zero\0.csv": ["no such file"],
    }.items():
        text = refusal(read, tmp_path / name)
        for word in words:
            assert word in text


def test_a_file_that_may_not_be_read(csv, refusal, monkeypatch):
    def forbidden(*_):
        raise PermissionError(13, "Permission denied")

    path = csv(lines())
    monkeypatch.setattr("identification.files.os.open", forbidden)
    assert "Permission denied" in refusal(read, path)


@pytest.mark.parametrize("name", ["log.csv", "log.mat"])
def test_a_huge_file_is_refused_before_it_is_read(tmp_path, refusal, monkeypatch, name):
    path = tmp_path / name
    with path.open("wb") as file:
        file.truncate(4 * MAX_BYTES)
    monkeypatch.setattr("identification.files.os.open", None)
    text = refusal(read, path)
    for word in ("2048 MB", "512 MB", "cut it"):
        assert word in text


def test_misspelt_options_are_refused(csv, refusal):
    path = csv(lines())
    assert "did you mean 'current'" in refusal(read, path, limits={"curent": 1})
    assert "did you mean 'angle'" in refusal(read, path, rates={"angel": 1})
    assert "mA" in refusal(read, path, units={"current": "mA"})


ALPHABET = st.sampled_from([*',;\n\r\t "#.-+0123456789einfa_\0\x85\ufeff', "time", "nan"])


BYTES = st.one_of(
    st.binary(max_size=200),
    st.lists(ALPHABET, max_size=60).map(lambda p: "".join(p).encode()),
    st.lists(ALPHABET, max_size=60).map(lambda p: (HEADER + "".join(p)).encode()),
    st.lists(st.tuples(*[st.floats()] * 5), max_size=8).map(
        lambda rows: (HEADER + "".join(",".join(map(repr, r)) + "\n" for r in rows)).encode()
    ),
)


def sentence_of(content, suffix):
    """What is said of bytes in a file with this suffix, nothing where they can be read."""
    with TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        path = Path(folder) / f"log.{suffix}"
        if suffix == "toml":
            write_log(wave(), path.with_suffix(".csv"))
        path.write_bytes(content)
        source = path if suffix == "mat" else path.with_suffix(".csv")
        try:
            read(source, units=UNITS, limits={"angle": 1e300}, rates={"angle": 300})
        except InputError as error:
            return str(error)
    return ""


@given(content=BYTES, suffix=st.sampled_from(["csv", "toml"]))
@example(content=(HEADER + "-1e308,1,2,3,4\n0,1,2,3,4\n1e308,1,2,3,4\n").encode(), suffix="csv")
@example(content=(HEADER + "0,1,2,1e308,4\n1,1,2,-1e308,4\n2,1,2,3,4\n").encode(), suffix="csv")
@example(content=(HEADER + "0,1,2,3,4\n5e-324,1,2,3,4\n1e-323,1,2,3,5\n").encode(), suffix="csv")
def test_no_bytes_raise_anything_but_input_error(content, suffix):
    assert len(sentence_of(content, suffix).splitlines()) <= 1


@given(content=BYTES)
@settings(max_examples=2)  # each begins a process that reads it; `make fuzz` tries thousands
@example(content=b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM" + bytes(60))
def test_no_bytes_of_a_matlab_file_raise_anything_but_input_error(content):
    assert len(sentence_of(content, "mat").splitlines()) <= 1


def test_a_gap_in_an_even_log_is_found_where_it_is(refusal):
    time = 0.01 * np.arange(200)
    time[120:] += 0.53
    u = np.zeros((200, 1))
    named = {"input_names": ("u",), "output_names": ("y",)}
    text = refusal(Log, time=time, inputs=u, outputs=u, **named)
    assert "time jumps from 1.19 s to 1.73 s where the step is 0.01 s" in text
    assert "cut the log there" in text


@pytest.mark.parametrize("columns", [["angle_2"], ["angle_2", "q.1", "elbow angle"]])
def test_the_advice_to_turn_signs_is_toml(columns):
    told = how_to_turn(columns).partition(": write ")[2].partition(" under [factors]")[0]
    lines = told.removesuffix(" (a line each)").split(" and ")
    said = tomllib.loads("\n".join(["[factors]", *lines]))
    assert said == {"factors": dict.fromkeys(columns, -1)}


def test_a_factor_that_stands_in_the_toml_is_turned_and_not_written_again():
    assert how_to_turn(["phi"], {"phi": -1.0, "x": 2.0}) == (
        "turn the sign of the factor -1 of phi that the log's TOML gives"
    )
    assert how_to_turn(["x", "phi"], {"phi": -1.0}, ", or of force") == (
        "turn the sign of x, phi, or of force: turn the sign of the factor -1 of phi that the"
        " log's TOML gives, and write x = -1 under [factors] of the log's TOML"
    )
