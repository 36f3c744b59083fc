"""Numbers too large to be true are refused with the unit, or the turn, that would explain them."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from example_logs import HEADER, UNITS, lines, read, wave


def test_milliamperes_taken_for_amperes(csv, refusal):
    text = refusal(read, csv(lines((7, "0.05,1,1000,3,5\n"))), units=UNITS, limits={"current": 20})
    for word in (
        "line 7",
        "current_2 is 1000 A",
        "20 A",
        'current_2 = "mA" under [units]',
        "log.toml",
    ):
        assert word in text


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


def test_one_column_in_degrees_is_told_by_its_name(tmp_path, refusal):
    log, path = wave(n=300), tmp_path / "log.csv"
    outputs = log.outputs * np.where(np.array(log.output_names) == "angle_2", 180 / np.pi, 1.0)
    content = np.column_stack([log.time, log.inputs, outputs])
    np.savetxt(path, content, delimiter=",", header=HEADER.strip(), comments="")
    options = {"units": UNITS, "limits": {"angle": 400}, "rates": {"angle": 5}}
    text = refusal(read, path, **options)
    assert "if angle_2 is in deg" in text
    assert 'write angle_2 = "deg" under [units]' in text
    path.with_suffix(".toml").write_text('[units]\nangle_2 = "deg"')
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


def test_a_size_that_no_unit_explains_is_a_bad_row(csv, refusal):
    text = refusal(read, csv(lines((7, "0.05,1,1e9,3,5\n"))), units=UNITS, limits={"current": 20})
    assert "line 7" in text
    assert "repair" in text


@pytest.mark.parametrize("factor", [1e308, -1e308, 1e60])
@pytest.mark.parametrize("lenient", [False, True])
def test_a_factor_that_leaves_the_numbers_is_refused(csv, refusal, factor, lenient):
    path = csv(lines())
    path.with_suffix(".toml").write_text(f"[factors]\nangle_2 = {factor}\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        said = refusal(read, path, lenient=lenient)
    where = f"under 'factors' in {path.with_suffix('.toml')}"
    assert f"the factor {factor:g} of angle_2 {where} makes numbers beyond 1e+15" in said
    assert "such as -1" in said


def test_a_factor_that_overflows_with_its_unit_is_refused_also_of_zeros(csv, refusal):
    path = csv(lines().replace(",3,", ",0,"))
    path.with_suffix(".toml").write_text("[units]\nangle = 'rev'\n[factors]\nangle_1 = 1e308\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert "the factor 1e+308 of angle_1" in refusal(read, path, units=UNITS)


def test_a_factor_of_a_group_that_makes_finite_numbers_is_taken(csv):
    path = csv(lines())
    path.with_suffix(".toml").write_text("[factors]\nangle = -1e-300\n")
    assert (read(path).outputs <= 0).all()
