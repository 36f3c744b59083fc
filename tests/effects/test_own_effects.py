"""Effects of a user's own: any number of parameters, any robot, mistakes told in one sentence."""

from math import cos, exp, sin

import numpy as np
import pytest
from effect_cases import CATALOGUE
from joint_cases import DAMPING, MASS, SLIDER, run, slider, slider_log, steps
from numba import njit

from identification.effects.axes import Axis
from identification.effects.catalogue import joint_effects
from identification.effects.effect import Effect, places
from identification.effects.laws.inputs import Drive, input_effects
from identification.effects.plant.joint_plant import joint_plant
from identification.effects.sizes import Shape, Size
from identification.errors import InputError
from inca_mj.effects.hooks import DRIVES_EACH
from inca_mj.twin.twin import build_twin

AT_SLIDE = places("joint", ("slide",))


@njit
def seven(s, p):
    """A torque of seven numbers."""
    a, b, c, d, e, v, n = p
    peak = a * exp(-((s.omega / v) ** 2))
    return peak + b * cos(n * s.phi) + c * sin(n * s.phi) + d * s.omega + e * s.phi


@njit
def seven_of_a_joint(s, p):
    """Spring, its hardening, offset, cogging, drag: a sum of effects of the catalogue."""
    k, k_3, f_0, a, b, c, n = p
    wave = a * cos(n * s.q) + b * sin(n * s.q)
    return f_0 - k * s.q - k_3 * s.q**3 + wave - c * s.v * abs(s.v)


def named(name, sizes, shapes=(), where=AT_SLIDE, largest=1.0, **hooks):
    return Effect(
        name, name, tuple(Size(n, "", largest, 1e-3 * largest) for n in sizes),
        tuple(Shape(n, "", (1.0,), 0.1, 100.0) for n in shapes), places=where, hooks=hooks,
    )  # fmt: skip


def slider_with(*own):
    return joint_plant(SLIDER, (MASS, DAMPING), slider_log(steps(400)), effects=(), own_effects=own)


def test_an_effect_of_seven_parameters_on_a_slider_is_the_sum_of_its_parts():
    values = {"k": 2.0, "k_3": 0.5, "f_0": 0.3, "a": 0.2, "b": -0.1, "c": 0.4, "n": 5.0}
    own = named("seven", list(values)[:6], ["n"], largest=10.0, force=seven_of_a_joint)
    log, parts = slider_log(steps(400)), {}
    where = {"k": "stiffness", "k_3": "hardening", "f_0": "offset", "a": "cogging",
             "b": "cogging", "c": "quadratic_friction"}  # fmt: skip
    axis = Axis("slide", "slide", force=100.0, speed=1.0, travel=1.0)
    catalogue = joint_plant(SLIDER, (MASS, DAMPING), log, joints=(axis,))
    parts = {f"{name}.{n}@slide": values[n] for n, name in where.items()}
    expected = run(catalogue, log, **parts, **{"cogging.n": values["n"]})
    mine = {f"seven.{n}" + "@slide" * (n != "n"): v for n, v in values.items()}
    plant = slider_with(own)
    np.testing.assert_allclose(run(plant, log, **mine), expected, rtol=0, atol=1e-13)
    assert np.abs(expected - run(slider(), log)).max() > 0.05
    np.testing.assert_array_equal(run(plant, log), run(slider(), log))


def test_an_own_effect_of_an_input_joins_the_catalogues():
    @njit
    def dead_zone(s, p):
        (width,) = p
        return s.u - max(-width, min(width, s.u)), 0.0

    own = named("dead_zone", ["width"], (), places("input", ("force",)), input=dead_zone)
    u = np.sin(0.2 * np.arange(200))[:, None]
    axis = Axis("slide", "slide", force=5.0, speed=1.0, travel=1.0)
    catalogue = (*joint_effects((axis,)), *input_effects([Drive("force", 1.0)]))
    plant = joint_plant(SLIDER, (MASS, DAMPING), slider_log(u), joints=(axis,),
                        effects=catalogue, own_effects=(own,))  # fmt: skip
    smaller = slider_log(u - np.clip(u, -0.3, 0.3))
    found = run(plant, slider_log(u), **{"dead_zone.width@force": 0.3})
    np.testing.assert_array_equal(found, run(slider(), smaller))


def pair(s, p):
    return s.q, s.v


def nothing(s, p):
    pass


def misspelt(s, p):
    return s.velocity


def too_many(s, p):
    a, b, c = p
    return a + b + c


def single(s, p):
    return s.u


def three(s, p):
    return p[0], p[0], p[0]


WRONG = [
    ({"force": pair}, "'force' returns 2 numbers.*and return 1 number"),
    ({"force": nothing}, "'force' returns nothing.*Joint.*time, q, v"),
    ({"force": misspelt}, "cannot be compiled .*'velocity'.*Joint"),
    ({"force": too_many}, r"expected 3, got 2.*a tuple of 2 \(k, n\)"),
    ({"input": single}, "'input' returns one number.*return 2 numbers, mean"),
]


@pytest.mark.parametrize(("hooks", "said"), WRONG, ids=[w[1] for w in WRONG])
def test_a_function_that_is_not_what_its_hook_takes_is_refused_in_one_sentence(hooks, said):
    own = named("own", ["k"], ["n"], {"it": ""}, **{k: njit(f) for k, f in hooks.items()})
    with pytest.raises(InputError, match=said) as error:
        run(slider_with(own), slider_log(steps(10)), **{"own.k": 1.0})
    assert "\n" not in str(error.value)
    assert "'own'" in str(error.value)


def test_so_it_is_for_the_hooks_of_the_cables():
    with pytest.raises(InputError, match=r"effect 'own': .*hook 'torque'"):
        build_twin(effects=(named("own", ["k"], (), DRIVES_EACH, torque=njit(three)),))


def test_what_is_no_njit_function_of_two_is_refused_when_the_record_is_made():
    with pytest.raises(InputError, match=r"effect 'own'.*'force' is not compiled; write @njit"):
        named("own", ["k"], force=pair)
    with pytest.raises(InputError, match=r"'force' takes \(s\); it must take two arguments"):
        named("own", ["k"], force=njit(lambda s: s.q))


def test_a_hook_that_a_robot_has_not_is_refused():
    of_a_joint = named("own", ["k"], force=njit(lambda s, p: p[0]))
    with pytest.raises(
        InputError, match=r"the hooks torque.*joint: force, friction; .*input: input"
    ):
        slider_with(named("own", ["k"], torque=njit(lambda s, p: p[0])))
    with pytest.raises(InputError, match="'none' has no hook"):
        slider_with(named("none", ["k"]))
    both = named("own", ["k"], (), DRIVES_EACH, torque=seven, wrench=seven)
    with pytest.raises(InputError, match="the hooks torque, wrench; give it hooks of one"):
        build_twin(effects=(both,))
    with pytest.raises(InputError, match="two effects are called 'own'"):
        slider_with(of_a_joint, of_a_joint)
    with pytest.raises(InputError, match="two effects are called 'delay'"):
        build_twin(effects=(*CATALOGUE, *input_effects([Drive("1", 1.0)])))
