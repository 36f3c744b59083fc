"""Several laws in one process: each acts on the models that carry its key, and on no others."""

import copy

import mujoco
import numpy as np
import pytest
from effect_cases import CATALOGUE, bare, full, simulate
from joint_cases import ARM, DAMPING, MASS, SLIDER, arm, arm_log, run, slider, slider_log, steps
from numba import njit

from identification.effects.axes import Axis
from identification.effects.effect import Effect, Size, places
from identification.effects.joint_plant import joint_plant
from identification.logs.log import Log
from identification.native import table
from identification.native.installer import uninstall
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


def test_a_model_keeps_its_law_while_others_are_installed():
    """No call into Python between two steps is needed: the laws stay where they are."""
    twin, plant = full().with_values({"cogging.a": 2e-3}), slider()

    def steps_of(model, at=None):
        data = mujoco.MjData(model)
        if at is not None:
            data.qpos[:], data.act[:] = at.qpos, at.act
        data.ctrl[:] = 0.5
        mujoco.mj_step(model, data, nstep=50)
        return np.array(data.qpos)

    run(plant, slider_log(steps(10)))
    at = twin.state()
    first = steps_of(twin.model, at), steps_of(plant.model)
    native.install()
    run(slider_with(own(lambda s, p: p[0])), slider_log(steps(10)))
    np.testing.assert_array_equal(steps_of(twin.model, at), first[0])
    np.testing.assert_array_equal(steps_of(plant.model), first[1])


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
    for model, row, key in (
        (twin.model, "actuator_user", KEY),
        (plant.model, "jnt_user", -2),
    ):
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


def test_a_process_holds_so_many_laws_and_says_when_it_is_full(monkeypatch):
    monkeypatch.setattr(table, "CAPACITY", 0)
    with pytest.raises(RuntimeError, match="0 sets of effects were compiled; start a new process"):
        table.enter("sensor", -1.0, 0)


def test_what_all_slides_have_no_hinge_has():
    text = ARM.replace('name="elbow" axis="0 1 0"', 'name="elbow" type="slide" axis="1 0 0"')
    text = text.replace(
        "</body></body></worldbody>",
        """
      </body></body><body name="cart"><joint name="rail" type="slide" axis="1 0 0" damping="1"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody>""",
    )
    known = [Axis(n, k, 1.0, 1.0, 1.0) for n, k in
             (("shoulder", "hinge"), ("elbow", "slide"), ("rail", "slide"))]  # fmt: skip
    t = 0.01 * np.arange(60)
    log = Log(
        time=t,
        inputs=steps(60, 2),
        outputs=np.sin(t)[:, None],
        input_names=("up", "low"),
        output_names=("a",),
    )
    plant = joint_plant(text, (), log, joints=known)
    names = ("slide_offset.f_0", "offset.f_0@shoulder")
    _, numbers = plant.settings(names, np.array([[0.3, 0.7]]))
    rows = np.array(plant.model.jnt_user)
    for slot, values in numbers:
        rows[slot.index()] = values[0]
    changed = rows - plant.model.jnt_user
    assert sorted(changed[0][changed[0] != 0]) == [0.7]
    assert [sorted(row[row != 0]) for row in changed[1:]] == [[0.3], [0.3]]


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
