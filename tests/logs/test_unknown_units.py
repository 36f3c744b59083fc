"""A mapped column whose header gives a unit that nobody knows is told, with how to give it."""

import numpy as np
import pytest

from identification import inspect_log
from identification.inspection.beginning import write_beginning
from identification.logs.read import read_log

TIME = 0.01 * np.arange(200)
PENDULUM = """<mujoco><worldbody><body><joint name="hinge" axis="0 1 0" damping="0.1"/>
<inertial pos="0 0 -0.2" mass="1" diaginertia="0.01 0.01 0.001"/></body></worldbody></mujoco>"""


def write(folder, *names, toml=""):
    rows = np.column_stack([TIME, np.sin(TIME), np.cos(TIME)])
    np.savetxt(folder / "log.csv", rows, "%.12g", ",", header=",".join(names), comments="")
    (folder / "log.toml").write_text(toml)
    return folder / "log.csv"


def told(folder, unit, toml="", where="log", input_unit=""):
    """What is told of a log whose output is the column pos with such a unit."""
    column, name = f"pos [{unit}]", "q" if where == "log" else f"pos [{unit}]"
    mapped = f'[columns]\n"{column}" = "q"\n' if where == "log" else ""
    u = f"u [{input_unit}]" if input_unit else "u"
    path = write(folder, "time", u, column, toml=mapped + toml)
    log = read_log(path, [u], [name], lenient=True, units={name: "rad"},
                   mapped=() if where == "log" else (column, u))  # fmt: skip
    return " ".join(log.remarks).replace(f"{folder}/", ""), log


@pytest.mark.parametrize("unit", ["counts", "kgcm", "rpm?", "enc. steps"])
@pytest.mark.parametrize(("where", "key"), [("log", "q"), ("robot", '"pos [{}]"')])
def test_an_unknown_unit_is_told_with_the_known_ones(tmp_path, unit, where, key):
    said, log = told(tmp_path, unit, where=where)
    key = key.format(unit)
    assert said == (
        f"{unit} in the header of pos [{unit}] of log 'log' is no known unit, and the column is"
        f' read in rad. If {unit} is one, write {key} = "UNIT" under [units] in log.toml, with one'
        f" of rad, deg, mrad, rev; or write what 1 {unit} is in rad under [factors] there, such as"
        f" {key} = 0.001."
    )
    np.testing.assert_allclose(log.outputs[:, 0], np.cos(TIME), atol=1e-9)


def test_an_input_may_have_any_unit(tmp_path):
    said, _ = told(tmp_path, "rad", where="robot", input_unit="kgf cm")
    assert "with one of s, ms, us, ns, A, mA" in said
    assert "N m, mN m, 1, %; or write what 1 kgf cm is in its SI unit under [factors]" in said
    assert said.count('such as "u [kgf cm]" = 0.0980665.') == 1


def test_a_unit_that_is_only_not_listed_comes_with_its_size(tmp_path):
    assert told(tmp_path, "urad")[0].endswith("under [factors] there, such as q = 1e-06.")


@pytest.mark.parametrize(("unit", "toml"), [
    ("rad", ""), ("°", ""), ("0", ""), ("1/2", ""), ("counts", '[units]\nq = "deg"\n'),
    ("counts", "[factors]\nq = 1e-3\n"),
])  # fmt: skip
def test_what_is_known_or_given_or_a_number_is_not_told(tmp_path, unit, toml):
    assert "no known unit" not in told(tmp_path, unit, toml)[0]


def test_columns_of_one_unknown_unit_are_told_together(tmp_path):
    path = write(tmp_path, "time", "a [counts]", "b [counts]")
    log = read_log(path, [], ["a [counts]", "b [counts]"], lenient=True,
                   mapped=("a [counts]", "b [counts]"))  # fmt: skip
    (said,) = log.remarks
    assert "in the headers of a [counts], b [counts] of log 'log' is no known unit, and the" in said
    assert "(a line for each)" in said


def test_the_unit_of_time_is_told_too(tmp_path):
    path = write(tmp_path, "Time [ticks]", "u", "q", toml='[columns]\n"Time [ticks]" = "time"\n')
    (said,) = read_log(path, ["u"], ["q"], lenient=True).remarks
    assert "the column is read in s. If ticks is one, write time" in said
    assert "with one of s, ms, us, ns;" in said


def test_inspect_guesses_no_unit_where_the_header_has_an_unknown_one(tmp_path):
    found = inspect_log(write(tmp_path, "time", "torque [kgcm]", "angle [counts]"))
    assert [c.unit for c in found.columns] == ["", ""]
    assert len([s for s in found.remarks if "is no known unit; known: s, ms" in s]) == 2
    (tmp_path / "arm.xml").write_text(PENDULUM)
    begun = write_beginning(found, tmp_path / "arm.xml", tmp_path / "robot.toml")
    assert "motors of gear 1, hinge_torque" in begun.found[0]  # it is a torque all the same
    known = inspect_log(write(tmp_path, "time", "torque [Nm]", "angle [°]"))
    assert [c.unit for c in known.columns] == ["N m", "deg"]
