"""A model on disk is the model in memory: the shipped one, and any that is exported."""

import re
from dataclasses import replace
from itertools import permutations
from pathlib import Path

import mujoco
import numpy as np
import pytest
from effect_cases import BY_NAME
from hypothesis import given, settings
from twin_cases import arrays, differing, laws, seeds

from identification.model.export import to_xml
from inca_mj.files import model_path
from inca_mj.refusals.agreement import assigned
from inca_mj.robot import law
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread
from inca_mj.twin.mjcf import build
from inca_mj.twin.plain import build_plain
from inca_mj.twin.run import load_run, save_run, simulate
from inca_mj.twin.twin import Twin, build_twin
from inca_mj.workflows.pulled import with_force

SHIPPED = Path(__file__).parents[2] / "models" / "inca6d.xml"
START = {"x": 0.02, "y": 0.03, "z": 1.41, "roll": 0.04, "pitch": -0.06, "yaw": 0.1}


def short(text):
    """A text with numbers of 12 digits: T(0) is solved for, its last ones are the processor's."""
    return re.sub(r"-?\d+\.\d+(e-?\d+)?", lambda number: f"{float(number[0]):.12g}", text)


def test_the_shipped_model_is_the_builders():
    text = SHIPPED.read_text(encoding="utf-8")
    fresh = to_xml(build(parameter_set(), INCA))
    assert short(text) == short(fresh), "write it anew: build_twin().save(...)"
    shipped, built = mujoco.MjModel.from_xml_path(str(SHIPPED)), build_twin().model
    ours, theirs = arrays(shipped), arrays(built)
    for name in differing(shipped, built):
        np.testing.assert_allclose(ours[name], theirs[name], rtol=1e-12, atol=1e-15, err_msg=name)


@settings(deadline=None, max_examples=10)
@given(laws, seeds)
def test_an_exported_model_reloads_to_the_bit(values, seed):
    shift = np.random.default_rng(seed).uniform(-0.01, 0.01, (2, 8, 3))
    geometry = replace(
        INCA,
        exits=tuple(map(tuple, INCA.A + shift[0])),
        connectors=tuple(map(tuple, INCA.B + 0.1 * shift[1])),
        source="moved",
    )
    p = parameter_set("trial", values | START)
    model = mujoco.MjModel.from_xml_string(to_xml(build(p, geometry)))
    assert differing(model, build_twin(p, geometry).model) == set()


def test_a_saved_twin_runs_the_same(tmp_path):
    robot = build_twin(parameter_set("simulation", START), timestep=5e-4)
    path = robot.save(tmp_path / "robot.xml")
    again = Twin(robot.parameters, robot.geometry, mujoco.MjModel.from_xml_path(str(path)))
    assert again.model.opt.timestep == 5e-4
    currents = np.full((21, 8), 0.7)
    np.testing.assert_array_equal(simulate(again, currents).qpos, simulate(robot, currents).qpos)


FILES = ("inca6d.xml", "inca6d_plain.xml")
MOVED = {"x": 0.02, "y": 0.03, "z": 1.41, "roll": 0.04, "pitch": -0.06, "yaw": 0.1}


@pytest.mark.parametrize("start", [{}, MOVED])
def test_the_default_reset_is_the_start_and_rests(tmp_path, start):
    robot = build_twin(parameter_set("trial", start))
    model = mujoco.MjModel.from_xml_path(str(robot.save(tmp_path / "robot.xml")))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.act, model.key("start").act, rtol=1e-14)
    np.testing.assert_allclose(data.qpos, model.key("start").qpos, rtol=1e-14)
    for _ in range(1000):
        mujoco.mj_step(model, data)
    assert np.abs(data.qpos - model.qpos0).max() < 1e-10
    mujoco.mj_resetData(model, data)  # as in the viewer, in the middle of a simulation
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.act, model.key("start").act, rtol=1e-14)
    assert np.abs(data.qacc).max() < 1e-6  # rounding of the tensions, over inertias of 1e-4


def test_the_plain_file_is_the_builders():
    built, read = build_plain().compile(), mujoco.MjModel.from_xml_path(str(model_path(FILES[1])))
    for name in ("tendon_lengthspring", "tendon_stiffness", "tendon_damping", "wrap_prm",
                 "actuator_gear", "jnt_stiffness", "qpos_spring", "dof_damping", "body_mass",
                 "dof_frictionloss", "dof_solref", "dof_solimp", "site_pos"):  # fmt: skip
        ours, theirs = getattr(built, name), getattr(read, name)
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-15, err_msg=name)


VALUES = {"stribeck_friction.f_s": 0.004, "cable_creep.c": 0.2, "R@3": 0.01, "exit_x@2": 1e-3}


@pytest.fixture(scope="module")
def run():
    robot = build_twin(
        with_spread(parameter_set("simulation", {"m": 0.2})),
        effects=(BY_NAME["stribeck_friction"], BY_NAME["cable_creep"]),
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
    early = again.between(0.0, 0.1)
    np.testing.assert_array_equal(early.asked, asked[: len(early.time)])


def test_a_reset_gives_a_twin_with_effects_its_cables(run):
    """Also where d₀ is not the only activation of a drive."""
    robot = run.twin
    data, states = mujoco.MjData(robot.model), robot.layout.states
    assert states > 1
    mujoco.mj_forward(robot.model, data)
    wanted = data.ten_length / (1 + robot.start.balance / robot.model.tendon_user[:, law.LAMBDA])
    np.testing.assert_allclose(data.act[::states], wanted, rtol=1e-14)


@pytest.mark.parametrize("seed", range(8))
def test_no_other_assignment_adds_up_to_more(seed):
    rng = np.random.default_rng(seed)
    likeness = rng.uniform(size=(5, 5)) + (seed % 2) * 2 * rng.permutation(np.eye(5))
    at = assigned(likeness)
    assert sorted(at) == [0, 1, 2, 3, 4]
    best = max(sum(likeness[range(5), list(p)]) for p in permutations(range(5)))
    assert likeness[range(5), at].sum() == pytest.approx(best, rel=1e-12)
