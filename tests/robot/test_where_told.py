"""Whatever is wrong in a robot's TOML, the message says in which file and under which key."""

import warnings

import pytest
from joint_cases import SLIDER
from robot_cases import TOML, simulated

from identification import InputError, read_robot, write_log
from identification.errors import DivergenceError, told_of

FREE, PATH, MASS = '"joint/slide.damping"', '"body/cart.mass"', 'unit = "kg"'


@pytest.fixture
def told(tmp_path):
    """What is said of a robot's file with one change, without a warning."""
    (tmp_path / "slider.xml").write_text(SLIDER)
    write_log(simulated({}, samples=120), tmp_path / "plain.csv")

    def said(old, new, **options):
        text = TOML.replace(old, new, 1)
        assert text != TOML
        (tmp_path / "bad.toml").write_text(text)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with pytest.raises(InputError) as caught:
                read_robot(tmp_path / "bad.toml", tmp_path / "plain.csv", **options)
        return str(caught.value).replace(str(tmp_path), "DIR")

    return said


def under(table, line):
    """A table before that of the columns."""
    return "[columns]", f"[{table}]\n{line}\n[columns]"


@pytest.mark.parametrize(
    ("change", "where", "what"),
    [
        ((FREE, "'joint/slid.damping'"), "free in DIR/bad.toml", "did you mean 'slide'"),
        ((FREE, "'damping'"), "free in DIR/bad.toml", "write kind/name.attribute"),
        ((FREE, "'qpos[9]'"), "free in DIR/bad.toml", "has 1 entries"),
        ((FREE, "'body/cart.mass'"), "free in DIR/bad.toml", "all go to 'body/cart.mass'"),
        (
            (FREE, "'coulmb_friction.f_c@slide'"),
            "free in DIR/bad.toml",
            "'coulomb_friction.f_c@slide'?",
        ),
        ((FREE, "'stribeck_friction.v_s'"), "free in DIR/bad.toml", "how an effect looks"),
        ((FREE, "'stribeck_friction.f_s@slide'"), "free in DIR/bad.toml", "give it a value"),
        ((PATH, "'body/car.mass'"), "parameters.mass in DIR/bad.toml", "did you mean 'cart'"),
        ((MASS, "value = -3"), "parameters.mass in DIR/bad.toml", "outside its range [0, inf]"),
        ((MASS, "lower = 5"), "parameters.mass in DIR/bad.toml", "outside its range [5, inf]"),
        ((MASS, "prior = -1"), "parameters.mass in DIR/bad.toml", "its prior is -1"),
        ((MASS, "unit = 'N'"), "parameters.mass in DIR/bad.toml", "it has the unit 'N'"),
        (("free", "outputs = ['y']\nfree"), "outputs in DIR/bad.toml", "known: position"),
        (
            under("effects", "only = ['cuogging']"),
            "under effects.only in DIR/bad.toml",
            "'cogging'",
        ),
        (under("fixed", "'cogging.m' = 1.0"), "fixed in DIR/bad.toml", "cogging.n"),
        (under("fixed", "'joint/slide.armature' = 1"), "fixed in DIR/bad.toml", "DIR/slider.xml"),
        (under("start", "'qpos[7]' = 0.1"), "start in DIR/bad.toml", "qpos has 1 entries"),
        (under("start", "slide = 0.1"), "start in DIR/bad.toml", "such as qpos[0] or qvel[0]"),
        (
            under("spread.two", "of = ['joint/slid.damping', 'body/cart.inertia[0]']\nstd = 0.1"),
            "spread.two in DIR/bad.toml",
            "did you mean 'slide'",
        ),
        (under("log", "units = {y = 'm'}"), "under 'units' in DIR/bad.toml", "known: force"),
        (under("log", "units = {x = 'metre'}"), "units of x in DIR/bad.toml", "known: s, ms"),
        (under("log", "units = {x = 'A'}"), "DIR/bad.toml gives x in A", "not m"),
        (under("log", "factors = {x = 1e308}"), "'factors' in DIR/bad.toml", "beyond 1e+15"),
        (under("log", "ignore = ['y']"), "under 'ignore' in DIR/bad.toml", "known: force"),
    ],
)
def test_file_and_key_are_told(told, change, where, what):
    said = told(*change)
    assert where in said
    assert what in said
    assert said.count("bad.toml") == 1


def test_a_spread_of_its_own_file_is_told_by_that_file(told, tmp_path):
    other = tmp_path / "spread.toml"
    other.write_text("[spread.two]\nof = ['body/car.mass', 'body/cart.inertia[0]']\nstd = 0.1\n")
    said = told(MASS, f"{MASS}\nknown = 0.1", spread=str(other))
    assert "spread.two in DIR/spread.toml: unknown body 'car'" in said


def test_a_key_of_the_logs_own_file_is_told_by_that_file(told, tmp_path):
    """The log's own TOML stands above the robot's [log]."""
    (tmp_path / "plain.toml").write_text("factors = {x = -1, y = 2}\n")
    said = told(*under("log", "factors = {x = -1}"))
    assert "under 'factors' in DIR/plain.toml" in said


@pytest.mark.parametrize("kind", [InputError, DivergenceError])
def test_a_place_keeps_the_kind_of_the_error(kind):
    with pytest.raises(kind, match=r"free in robot\.toml: no such"), told_of("free in robot.toml"):
        raise kind("no such joint")
