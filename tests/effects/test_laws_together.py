"""Several laws in one process: each acts on the models that carry its key, and on no others."""

import copy

import mujoco
import numpy as np
import pytest
from effect_cases import CATALOGUE, bare, full, simulate
from joint_cases import DAMPING, MASS, SLIDER, arm, arm_log, reached, run, slider, slider_log, steps
from numba import njit
from numpy.testing import assert_allclose
from scipy.interpolate import CubicSpline

from identification.effects.effect import Effect, places
from identification.effects.plant.joint_plant import joint_plant
from identification.effects.sizes import Size
from identification.native.table import uninstall
from inca_mj.effects.hooks import KEY
from inca_mj.twin import native
from inca_mj.twin.twin import build_twin

FEW = tuple(e for e in CATALOGUE if e.name in ("cogging", "cable_creep", "air_drag"))


def own(function, name="own"):
    return Effect(
        name, "the same words", (Size("k", "N", 1.0, 1e-3),),
        places=places("joint", ("slide",)), hooks={"force": njit(function)},
    )  # fmt: skip


def slider_with(effect):
    return joint_plant(
        SLIDER, (MASS, DAMPING), slider_log(steps(400)), effects=(), own_effects=(effect,)
    )


def worlds():
    """Robots with laws of their own, each as a function that simulates it."""
    few = build_twin(effects=FEW).with_values({"cogging.a": 2e-3, "cable_creep.c": 0.1})
    whole = full().with_values({"cogging.a": 2e-3, "cable_creep.c": 0.1})
    pushed = slider_with(own(lambda s, p: p[0]))
    return {
        "bare": lambda: simulate(bare()),
        "few": lambda: simulate(few),
        "whole": lambda: simulate(whole),
        "slider": lambda: run(slider(), slider_log(steps(60)), **{"offset.f_0@slide": 0.2}),
        "pushed": lambda: run(pushed, slider_log(steps(60)), **{"own.k@slide": 0.2}),
        "arm": lambda: run(arm(), arm_log(steps(60, 2)), **{"stiffness.k": 0.5}),
    }


def test_laws_work_side_by_side_as_each_does_alone():
    alone = {name: go() for name, go in worlds().items()}
    again = worlds()
    for name in (*again, *reversed(again)):
        np.testing.assert_array_equal(again[name](), alone[name], err_msg=name)
    np.testing.assert_array_equal(alone["few"], alone["whole"])
    np.testing.assert_array_equal(alone["slider"], alone["pushed"])
    assert not np.array_equal(alone["few"], alone["bare"])


def passive_forces(model):
    """At the model's start."""
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return np.array(data.qfrc_passive)


def test_a_set_of_effects_that_is_not_compiled_makes_nan_and_no_other_law():
    twin, plant = full(), slider()
    twin.state()
    run(plant, slider_log(steps(10)))
    for model, row, key in ((twin.model, "actuator_user", KEY), (plant.model, "jnt_user", -2)):
        changed = copy.copy(model)
        getattr(changed, row)[0, key] += 1.0
        assert np.isnan(passive_forces(changed)).any()
        assert np.isfinite(passive_forces(model)).all()


def test_of_two_laws_with_one_key_the_newer_counts():
    """As when the function of an effect is written anew in a notebook."""
    log, values = slider_log(steps(60)), {"own.k@slide": 0.2}
    old, new = slider_with(own(lambda s, p: p[0])), slider_with(own(lambda s, p: -p[0]))
    one, other = run(old, log, **values), run(new, log, **values)
    assert not np.array_equal(one, other)
    np.testing.assert_array_equal(run(old, log, **values), one)
    np.testing.assert_array_equal(run(new, log, **values), other)


def test_a_released_law_is_installed_again_when_it_is_needed():
    before = run(slider(), slider_log(steps(30)), **{"offset.f_0@slide": 0.2})
    uninstall()
    assert mujoco.get_mjcb_passive() is None
    again = run(slider(), slider_log(steps(30)), **{"offset.f_0@slide": 0.2})
    np.testing.assert_array_equal(before, again)


@pytest.mark.parametrize("kind", ["passive", "act_dyn", "act_bias", "sensor"])
def test_releasing_leaves_a_callback_of_another_library(kind):
    def foreign(*_):
        return 0.0

    uninstall()
    getattr(mujoco, f"set_mjcb_{kind}")(foreign)
    uninstall()
    assert getattr(mujoco, f"get_mjcb_{kind}")() is foreign
    getattr(mujoco, f"set_mjcb_{kind}")(None)
    native.install()


C = (0.1, -0.2, 0.3, -0.25, 0.2, -0.15, 0.1, -0.05)
OTHER = {"shoulder": "elbow", "elbow": "shoulder"}
CURVES = [
    (name, joint)
    for joint, side in (("shoulder", "behind"), ("elbow", "before"))
    for name in (f"curve_{side}", f"curve_speed_{side}")
]


def forward(values, q, v):
    """Passive forces of the arm at positions and velocities, shape (2,)."""
    model = arm().with_values(values).model
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = q, v
    mujoco.mj_forward(model, data)
    return np.array(data.qfrc_passive)


@pytest.mark.parametrize(("name", "joint"), CURVES)
def test_it_is_a_function_of_the_neighbour_alone(name, joint):
    run(arm(), arm_log(steps(10, 2)))  # the law is compiled
    (effect,) = (e for e in arm().effects if e.name == name)
    where = f"joint {joint}"
    values = {effect.parameter(s.name, where): c for s, c in zip(effect.sizes, C, strict=True)}
    mine, other = (arm().model.joint(j).id for j in (joint, OTHER[joint]))
    middle, far, top = reached(arm(), OTHER[joint])[:3]
    for x in np.linspace(-1.3, 1.3, 27):
        q, v = np.array([0.2, -0.3]), np.array([0.5, -0.7])
        if "speed" in name:
            v[other] = np.sign(x) * x**2 * top
            drawn = np.interp(x, np.arange(-4, 5) / 4, [*C[3::-1], 0.0, *C[4:]])
        else:
            q[other] = middle + x * far
            drawn = CubicSpline(np.linspace(-1, 1, 8), C, bc_type="natural")(np.clip(x, -1, 1))
        more = forward(values, q, v) - forward({}, q, v)
        expected = np.zeros(2)
        expected[mine] = drawn
        assert_allclose(more, expected, rtol=0, atol=1e-12)
