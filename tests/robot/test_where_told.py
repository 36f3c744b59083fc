"""Whatever is wrong in a robot's TOML, the message says in which file and under which key."""

import warnings

import pytest
from joint_cases import DAMPING, SLIDER, slider_log, steps
from joint_cases import MASS as MASS_TYPES
from numba import njit
from robot_cases import TOML, simulated

from identification import (
    Effect,
    InputError,
    Size,
    joint_plant,
    places,
    read_robot,
    write_log,
)

FREE, MASS = '"joint/slide.damping"', 'unit = "kg"'


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
        ((FREE, "'qpos[9]'"), "free in DIR/bad.toml", "has 1 entries"),
        (
            (FREE, "'coulmb_friction.f_c@slide'"),
            "free in DIR/bad.toml",
            "'coulomb_friction.f_c@slide'?",
        ),
        ((FREE, "'stribeck_friction.f_s@slide'"), "free in DIR/bad.toml", "give it a value"),
        ((MASS, "value = -3"), "parameters.mass in DIR/bad.toml", "outside its range [0, inf]"),
        ((MASS, "prior = -1"), "parameters.mass in DIR/bad.toml", "its prior is -1"),
        (("free", "outputs = ['y']\nfree"), "outputs in DIR/bad.toml", "known: position"),
        (under("fixed", "'cogging.m' = 1.0"), "fixed in DIR/bad.toml", "cogging.n"),
        (under("start", "'qpos[7]' = 0.1"), "start in DIR/bad.toml", "qpos has 1 entries"),
        (
            under("spread.two", "of = ['joint/slid.damping', 'body/cart.inertia[0]']\nstd = 0.1"),
            "spread.two in DIR/bad.toml",
            "did you mean 'slide'",
        ),
        (under("log", "units = {x = 'metre'}"), "units of x in DIR/bad.toml", "known: s, ms"),
        (under("log", "factors = {x = 1e308}"), "'factors' in DIR/bad.toml", "beyond 1e+15"),
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


LOG = slider_log(steps(400))


def none_at_rest(s, p):
    return p[0] * s.v if s.v > 0 else None


def root(s, p):
    return p[0] * s.q**0.5


@pytest.mark.parametrize(
    ("function", "said"),
    [
        (none_at_rest, "returns nothing in some branch; it must take a Joint"),
        (root, "of its hook 'force'"),
    ],
)
def test_a_function_that_may_fail_is_refused_when_the_effect_is_compiled_in(
    refusal, function, said
):
    own = Effect("own", "f", (Size("k", "N", 1.0, 0.1),), places=places("joint", ("slide",)),
                 hooks={"force": njit(function)})  # fmt: skip
    text = refusal(joint_plant, SLIDER, (MASS_TYPES, DAMPING), LOG, own_effects=[own])
    assert said in text
    assert "effect 'own'" in text


def test_a_place_that_is_not_there_is_refused(refusal):
    own = Effect("own", "k v", (Size("k", "N", 1.0, 0.1),), places=places("joint", ("slid",)),
                 hooks={"force": njit(lambda s, p: p[0] * s.v)})  # fmt: skip
    text = refusal(joint_plant, SLIDER, (MASS_TYPES, DAMPING), LOG, own_effects=[own])
    assert "unknown joint of effect 'own': 'slid'; did you mean 'slide'? known: slide" in text
