"""A run of a twin with effects is saved and read again, whole."""

import json
from dataclasses import replace

import mujoco
import numpy as np
import pytest

from identification.errors import InputError
from inca_mj.effects.cable import CABLE_CREEP
from inca_mj.effects.motor import STRIBECK_FRICTION
from inca_mj.robot import law
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread
from inca_mj.twin.run import load_run, save_run, simulate
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.pulled import with_force

VALUES = {"stribeck_friction.f_s": 0.004, "cable_creep.c": 0.2, "R@3": 0.01, "exit_x@2": 1e-3}


@pytest.fixture(scope="module")
def run():
    robot = build_twin(
        with_spread(parameter_set("simulation", {"m": 0.2})),
        effects=(STRIBECK_FRICTION, CABLE_CREEP),
        timestep=5e-4,
        settled=True,
    )
    known = {n: v for n, v in VALUES.items() if n in robot.parameters.values()}
    assert len(known) == len(VALUES)
    pulled = with_force(robot.with_values(known), (0.1, 0.0, -0.2), (0.0, 0.01, 0.0))
    return simulate(pulled, make_input("step", 0.3))


def test_a_run_with_effects_comes_back_to_the_bit(run, tmp_path):
    again = load_run(save_run(run, tmp_path / "run.npz"))
    for name in ("time", "currents", "qpos", "qvel", "act", "tension", "length"):
        np.testing.assert_array_equal(getattr(again, name), getattr(run, name))
    assert again.twin.parameters.values() == run.twin.parameters.values()
    assert [e.name for e in again.twin.effects] == ["stribeck_friction", "cable_creep", "pull"]
    assert again.twin.settled
    replay = simulate(again.twin, run.currents)
    np.testing.assert_array_equal(replay.qpos, run.qpos)
    np.testing.assert_array_equal(replay.tension, run.tension)


def test_what_was_asked_comes_back_to_the_bit_and_a_run_without_it_too(run, tmp_path):
    assert load_run(save_run(run, tmp_path / "run.npz")).asked is None
    asked = run.position + np.random.default_rng(0).standard_normal(3) / 3
    again = load_run(save_run(replace(run, asked=asked), tmp_path / "asked.npz"))
    np.testing.assert_array_equal(again.asked, asked)
    np.testing.assert_array_equal(again.until(0.1).asked, asked[: len(again.until(0.1).time)])


def test_an_effect_of_which_the_law_is_not_at_hand_is_named(run, tmp_path):
    path = save_run(run, tmp_path / "run.npz")
    with pytest.raises(InputError, match=r"law is not at hand: cable_creep"):
        load_run(path, effects=(STRIBECK_FRICTION,))


def test_a_run_that_was_saved_before_effects_were_is_read(tmp_path):
    plain = simulate(build_twin(), make_input("step", 0.1))
    path = save_run(plain, tmp_path / "run.npz")
    with np.load(path) as file:
        content = dict(file)
    header = json.loads(str(content["header"]))
    old = {name: header[name] for name in ("values", "set", "geometry", "timestep")}
    np.savez(path, **{**content, "header": json.dumps(old)})
    again = load_run(path)
    np.testing.assert_array_equal(simulate(again.twin, plain.currents).qpos, plain.qpos)


def test_a_reset_gives_a_twin_with_effects_its_cables(run):
    """Also where d₀ is not the only activation of a drive."""
    robot = run.twin
    data, states = mujoco.MjData(robot.model), robot.layout.states
    assert states > 1
    mujoco.mj_forward(robot.model, data)
    wanted = data.ten_length / (1 + robot.start.balance / robot.model.tendon_user[:, law.LAMBDA])
    np.testing.assert_allclose(data.act[::states], wanted, rtol=1e-14)
