"""What is called with the wrong things says in one sentence what it takes."""

from pathlib import Path

import pytest
from joint_cases import DAMPING, MASS, SLIDER, slider, slider_log, steps
from numba import njit

from identification import (
    Effect,
    NominalModel,
    Size,
    discover,
    estimate,
    fit,
    joint_plant,
    places,
    read_robot,
)

LOG = slider_log(steps(400))
NOMINAL = NominalModel(slider(), ("mass",), [0.3])


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: read_robot(3, "log.csv"), "takes the path of a robot's TOML, not 3 of type int"),
        (lambda: read_robot("r.toml", 3), "log of read_robot takes paths of files or Logs"),
        (lambda: read_robot("r.toml", "a.csv", "b.csv"), r"write confirm=[...] around it"),
        (lambda: fit("robot.toml"), "fit takes a robot (read_robot), not 'robot.toml' of type str"),
        (lambda: discover(Path("r.toml")), "discover takes a robot (read_robot) or a NominalModel"),
        (lambda: discover(NOMINAL, "log.csv", []), "discover takes a Log (read_log)"),
        (lambda: estimate(slider(), "log.csv", ["mass"]), "estimate takes a Log (read_log)"),
    ],
)
def test_wrong_types_are_told(refusal, call, said):
    assert said in refusal(call)


def none_at_rest(s, p):
    return p[0] * s.v if s.v > 0 else None


def raises_behind(s, p):
    if s.q < 0:
        raise ValueError("no way back")
    return p[0] * s.v


def root(s, p):
    return p[0] * s.q**0.5


def inverse(s, p):
    return p[0] / s.v


@pytest.mark.parametrize(
    ("function", "said"),
    [
        (none_at_rest, "returns nothing in some branch; it must take a Joint"),
        (raises_behind, "raises ValueError: no way back at time = 0.5, q = -0.7"),
        (root, "of its hook 'force'"),
        (inverse, "raises ZeroDivisionError"),
    ],
)
def test_a_function_that_may_fail_is_refused_when_the_effect_is_compiled_in(
    refusal, function, said
):
    own = Effect("own", "f", (Size("k", "N", 1.0, 0.1),), places=places("joint", ("slide",)),
                 hooks={"force": njit(function)})  # fmt: skip
    text = refusal(joint_plant, SLIDER, (MASS, DAMPING), LOG, own_effects=[own])
    assert said in text
    assert "effect 'own'" in text


def test_a_place_that_is_not_there_is_refused(refusal):
    own = Effect("own", "k v", (Size("k", "N", 1.0, 0.1),), places=places("joint", ("slid",)),
                 hooks={"force": njit(lambda s, p: p[0] * s.v)})  # fmt: skip
    text = refusal(joint_plant, SLIDER, (MASS, DAMPING), LOG, own_effects=[own])
    assert "unknown joint of effect 'own': 'slid'; did you mean 'slide'? known: slide" in text
