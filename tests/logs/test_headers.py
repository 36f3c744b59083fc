"""A column whose header says nearly what is asked is read so, in the unit that it says."""

import numpy as np
import pytest

from identification.errors import InputError
from identification.logs.read import read_log

TIME = 0.01 * np.arange(200)


def read(folder, head, toml="", scale=(1.0, 1.0, 1.0), lenient=True):
    rows = np.column_stack([TIME, np.sin(TIME), np.cos(TIME)]) * scale
    np.savetxt(folder / "log.csv", rows, "%.12g", ",", header=head, comments="")
    if toml:
        (folder / "log.toml").write_text(toml)
    return read_log(folder / "log.csv", ["u"], ["q"], lenient=lenient, units={"q": "rad"})


@pytest.mark.parametrize(("head", "scale"), [
    ("time [s],u [V],q [rad]", (1, 1, 1)),
    ("time (ms),u,q [deg]", (1e3, 1, 180 / np.pi)),
    ("time[s],u(V),q (rev)", (1, 1, 0.5 / np.pi)),
    ('"time [ns]","u [mA]","q [mrad]"', (1e9, 1e3, 1e3)),
    ("time_ms,u_mV,q_deg", (1e3, 1e3, 180 / np.pi)),
    ("t_s,U,Q [deg]", (1, 1, 180 / np.pi)),
    ("t,u,q (degrees)", (1, 1, 180 / np.pi)),
    ("Time [sec],u,Q_mrad", (1, 1, 1e3)),
    ("T,U,Q", (1, 1, 1)),
])  # fmt: skip
def test_the_log_is_the_same_as_in_si(tmp_path, head, scale):
    log = read(tmp_path, head, scale=scale)
    np.testing.assert_allclose(log.time, TIME, atol=1e-9)
    np.testing.assert_allclose(log.inputs[:, 0], np.sin(TIME), atol=1e-9)
    np.testing.assert_allclose(log.outputs[:, 0], np.cos(TIME), atol=1e-9)
    (told,) = log.remarks
    assert told.endswith(("as their headers say.", "as its header says."))


def test_what_the_toml_says_of_units_comes_before(tmp_path):
    log = read(tmp_path, "time [s],u,q [rad]", '[units]\nq = "deg"\n')
    np.testing.assert_allclose(log.outputs[:, 0], np.cos(TIME) * np.pi / 180, atol=1e-9)
    assert log.said_units == {"time": "s", "q": "deg"}


@pytest.mark.parametrize(("units", "scale"), [("", np.pi / 180), ('[units]\nq = "mrad"\n', 1e-3)])
def test_a_column_that_the_toml_names_otherwise_has_its_unit_too(tmp_path, units, scale):
    log = read(tmp_path, "time [s],u,pos [deg]", f'[columns]\n"pos [deg]" = "q"\n{units}')
    np.testing.assert_allclose(log.outputs[:, 0], np.cos(TIME) * scale, atol=1e-9)


@pytest.mark.parametrize(("column", "scale"), [
    ("pos_deg", np.pi / 180), ("pos [mrad]", 1e-3), ("pos (°)", np.pi / 180), ("pos", 1.0),
    ("pos_motor", 1.0), ("pos_m", 1.0),
])  # fmt: skip
@pytest.mark.parametrize("where", ["log", "robot"])
def test_a_column_that_a_user_maps_has_the_unit_of_its_header(tmp_path, column, scale, where):
    """The log's TOML says which column of the robot it is, or the robot's file asks for it."""
    rows = np.column_stack([TIME, np.sin(TIME), np.cos(TIME)])
    np.savetxt(tmp_path / "log.csv", rows, "%.12g", ",", header=f"time,u,{column}", comments="")
    name = "q" if where == "log" else column
    if where == "log":
        (tmp_path / "log.toml").write_text(f'[columns]\n"{column}" = "q"\n')
    mapped = () if where == "log" else (column,)
    log = read_log(
        tmp_path / "log.csv", ["u"], [name], lenient=True, units={name: "rad"}, mapped=mapped
    )
    np.testing.assert_allclose(log.outputs[:, 0], np.cos(TIME) * scale, atol=1e-9)
    assert len(log.remarks) == (scale != 1.0)


def test_a_name_of_the_model_says_no_unit(tmp_path):
    """A sensor body_cm is one of a centre of mass."""
    rows = np.column_stack([TIME, np.sin(TIME), np.cos(TIME)])
    np.savetxt(tmp_path / "log.csv", rows, delimiter=",", header="time,u,body_cm", comments="")
    log = read_log(tmp_path / "log.csv", ["u"], ["body_cm"], lenient=True, units={"body_cm": "m"})
    np.testing.assert_allclose(log.outputs[:, 0], np.cos(TIME), atol=1e-9)


def test_of_two_columns_of_one_name_none_is_guessed(tmp_path):
    rows = np.column_stack([TIME, np.sin(TIME), np.cos(TIME), 7 + TIME])
    head = "time,u,q [rad],q [deg]"
    np.savetxt(tmp_path / "log.csv", rows, delimiter=",", header=head, comments="")
    with pytest.raises(InputError, match=r"q in several columns: q \[rad\], q \[deg\]; write"):
        read_log(tmp_path / "log.csv", ["u"], ["q"], lenient=True)
    for cure in ('[columns]\n"q [rad]" = "q"\n', 'ignore = ["q [deg]"]\n'):
        (tmp_path / "log.toml").write_text(cure)
        log = read_log(tmp_path / "log.csv", ["u"], ["q"], lenient=True)
        np.testing.assert_allclose(log.outputs[:, 0], np.cos(TIME), atol=1e-9)


def test_a_column_that_the_toml_names_without_its_unit_is_found(tmp_path):
    log = read(tmp_path, "t [s],u,pos [deg]", '[columns]\nt = "time"\npos = "q"\n')
    np.testing.assert_allclose(log.outputs[:, 0], np.cos(TIME) * np.pi / 180, atol=1e-9)


@pytest.mark.parametrize("head", [
    "time,u,q [counts]",  # nobody knows this unit
    "time,u,joint q [rad]",
    "time,u,q [rad] filtered",
    "time,u,q_m",  # the motor's, or metres
    "time,u,q_motor",
])  # fmt: skip
def test_any_other_name_is_refused_as_before(tmp_path, head):
    with pytest.raises(InputError, match="lacks column q"):
        read(tmp_path, head)


def test_a_column_of_the_very_name_is_taken(tmp_path):
    rows = np.column_stack([TIME, np.sin(TIME), np.cos(TIME), 7 + TIME])
    np.savetxt(tmp_path / "log.csv", rows, delimiter=",", header="time,u,q,q [deg]", comments="")
    log = read_log(tmp_path / "log.csv", ["u"], ["q"], lenient=True)
    np.testing.assert_allclose(log.outputs[:, 0], np.cos(TIME), atol=1e-9)
    assert not log.remarks


@pytest.mark.parametrize("head", ["time,u,q [deg],Q", "time,u,q_deg,Q_rad", "TIME,u,q [deg],t"])
def test_the_nearest_header_is_taken(tmp_path, head):
    rows = np.column_stack([TIME, np.sin(TIME), np.cos(TIME), 7 + TIME])
    np.savetxt(tmp_path / "log.csv", rows, delimiter=",", header=head, comments="")
    log = read_log(tmp_path / "log.csv", ["u"], ["q"], lenient=True)
    np.testing.assert_allclose(log.time, TIME)
    np.testing.assert_allclose(log.outputs[:, 0], np.cos(TIME) * np.pi / 180, atol=1e-9)


def test_names_that_differ_by_capitals_alone_are_asked_by_the_letter(tmp_path):
    rows = np.column_stack([TIME, np.sin(TIME), np.cos(TIME), 7 + TIME])
    np.savetxt(tmp_path / "log.csv", rows, delimiter=",", header="time,u,Q,other", comments="")
    with pytest.raises(InputError, match="lacks column"):
        read_log(tmp_path / "log.csv", ["u"], ["q", "Q"], lenient=True)


def test_a_strict_reader_keeps_to_the_letter(tmp_path):
    with pytest.raises(InputError, match="lacks columns time"):
        read(tmp_path, "time [s],u [V],q [rad]", lenient=False)
