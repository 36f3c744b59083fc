"""Each kind of bad file is refused in one sentence that names the bad thing and the way on."""

import os
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from example_logs import HEADER, ROWS, UNITS, lines, read, wave
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.io import savemat

from identification import InputError, write_log


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", ["empty", "header"]),
        (HEADER, ["no rows"]),
        (HEADER + ROWS[0] + ROWS[1], ["at least 3 rows", "has 2"]),
        ("".join(ROWS), ["line 1", "numbers and not names", "header"]),
        (lines().replace(",", ";"), ["semicolons", "commas"]),
        (lines((1, HEADER.replace("angle_2", "angel_2"))), ["angle_2", "its column angel_2"]),
        (
            lines((1, HEADER.replace("time", "t"))),
            ["lacks column time", "sampling_time", "log.toml"],
        ),
        (lines((1, HEADER.replace("angle_2", "angle_1"))), ["angle_1", "more than once"]),
        (lines((1, HEADER.replace("angle_2", ""))), ["lacks column angle_2", "''"]),
        (lines((7, "0.05,1,2,nan,5\n")), ["line 7", "angle_1", "nan", "finite"]),
        (lines((7, "0.05,,2,3,5\n")), ["line 7", "current_1", "empty"]),
        (lines((7, "0.05,1,two,3,5\n")), ["line 7", "current_2", "two is not a number"]),
        (lines((7, "0.05,1,2,3\n")), ["line 7", "4 cells", "5"]),
        ("# note\n\n" + lines((7, "x,1,2,3,4\n")), ["line 9", "time", "x is not a number"]),
        (lines((7, "0.04,1,2,3,5\n")), ["line 7", "does not increase", "0.04"]),
        (lines((7, "0.03,1,2,3,5\n")), ["line 7", "does not increase", "0.03 s follows 0.04"]),
        (lines((7, "\n")), ["line", "samples are missing", "cut the log there"]),
        (lines((7, "0.053,1,2,3,5\n")), ["line 7", "not even", "0.003 s, 30 %", "resample"]),
        (lines().encode().replace(b"3,7", b"3,\0"), ["binary", "zero"]),
        (lines().encode("utf-16"), ["UTF-8"]),
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


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("units = ", ["not TOML", "end of document"]),
        ("unit.current = 'mA'", ["'unit'", "did you mean 'units'"]),
        ("units.current = 'mAh'", ["mAh", "mA"]),
        ("units.current = 'deg'", ["current_1 in deg", "rad", "A"]),
        ("factors.curent = -1", ["'curent'", "did you mean 'current'"]),
        ("factors.current = 0", ["factors", "other than zero"]),
        ("log.factors.current = inf", ["current under factors in [log] of", "must be a number"]),
        ("sampling_time = 0", ["sampling_time", "positive"]),
        ("sampling_time = 0.02", ["sampling_time", "line"]),
        ("hold = 'linear'", ["hold", "zoh", "foh"]),
        ("ignore = ['temp']", ["ignore", "'temp'", "angle_1"]),
        ("columns.angle_1 = 'angle_2'", ["angle_2", "more than once"]),
        ("splits.a = [0, 1, 2]", ["a under splits in", "two times"]),
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
        ({"u": U, "y": Y}, ["lacks column time", "sampling_time"]),
        ({"u": U, "y": Y, "Ts": [0.1, 0.2]}, ["Ts", "one positive"]),
        ({"u": np.zeros((9, 3)), "y": Y, "Ts": 0.1}, ["u is 9 x 3", "n x 2"]),
        ({"u": U[:8], "y": Y, "Ts": 0.1}, ["u is 8 x 2", "y is 9 x 2", "same n"]),
        ({"u": U + 1j, "y": Y, "Ts": 0.1}, ["u", "real"]),
        ({"u": U, "y": Y * np.nan, "Ts": 0.1}, ["row 1", "angle_1", "nan"]),
        ({"u": U, "y": Y, "Ts": 0.1, "x": np.zeros(8)}, ["x has 8", "9 samples"]),
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
    for name in ("run_1.csv", "fissile.csv"):
        (tmp_path / name).write_text(lines())
    (tmp_path / "run.xlsx").write_text(lines())
    os.mkfifo(tmp_path / "pipe.csv")
    for name, words in {
        "run_2.csv": ["no such file", "did you mean", "run_1.csv"],
        "zebra.csv": ["no such file", "check"],
        "missing.csv": ["no such file", "check its name"],  # only its ending is that of others
        "nowhere/run.csv": ["no such folder", "nowhere"],
        "logs.csv": ["is a folder"],
        "pipe.csv": ["not a regular file"],
        "run.xlsx": ["no log that can be read", ".csv, .mat, .npz"],
        "a" * 300 + ".csv": ["cannot read", "too long"],
        ".": ["is a folder"],
        "zero\0.csv": ["no such file"],
    }.items():
        text = refusal(read, tmp_path / name)
        for word in words:
            assert word in text


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


def test_degrees_taken_for_radians_move_too_fast(tmp_path, refusal):
    log = wave(n=300)
    path = tmp_path / "log.csv"
    content = np.column_stack([log.time, log.inputs, np.rad2deg(log.outputs)])
    np.savetxt(path, content, delimiter=",", header=HEADER.strip(), comments="")
    options = {"units": UNITS, "limits": {"angle": 400}, "rates": {"angle": 5}}
    text = refusal(read, path, **options)
    for word in ("angle_1 changes by", "plausible 5 rad/s", 'angle = "deg" under [units]'):
        assert word in text
    path.with_suffix(".toml").write_text('units.angle = "deg"')
    assert read(path, **options).outputs == pytest.approx(log.outputs)


def test_a_wrapped_angle_is_to_be_unwrapped(tmp_path, refusal):
    log, path = wave(n=300), tmp_path / "log.csv"
    turning = np.column_stack([np.linspace(0, 7, len(log)), log.outputs[:, 1:]])
    angles = (turning + np.pi) % (2 * np.pi) - np.pi
    content = np.column_stack([log.time, log.inputs, angles])
    np.savetxt(path, content, delimiter=",", header=HEADER.strip(), comments="")
    text = refusal(read, path, units=UNITS, rates={"angle": 50})
    for word in ("angle_1 changes by", "a jump of a whole turn", "unwrap it"):
        assert word in text


@pytest.mark.parametrize("lenient", [False, True])
def test_a_factor_that_leaves_the_numbers_is_refused(csv, refusal, lenient):
    factor = 1e308
    path = csv(lines())
    path.with_suffix(".toml").write_text(f"[factors]\nangle_2 = {factor}\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        said = refusal(read, path, lenient=lenient)
    where = f"under 'factors' in {path.with_suffix('.toml')}"
    assert f"the factor {factor:g} of angle_2 {where} makes numbers beyond 1e+15" in said
    assert "such as -1" in said
