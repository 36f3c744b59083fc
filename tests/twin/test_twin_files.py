"""A model on disk is the model in memory: the shipped one, and any that is exported."""

import re
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from twin_cases import arrays, differing, laws, seeds

from identification.model.export import to_xml
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.mjcf import build
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import Twin, build_twin

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


def test_the_shipped_model_looks_like_the_builders():
    ours, theirs = arrays(mujoco.MjModel.from_xml_path(str(SHIPPED))), arrays(build_twin().model)
    for name in ours:
        if name.startswith(("cam_", "geom_", "light_", "mat_")):
            np.testing.assert_allclose(ours[name], theirs[name], atol=1e-5, err_msg=name)


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


def test_a_text_that_does_not_change_is_not_changed_by_a_round_trip():
    text = to_xml(build(parameter_set(), INCA))
    assert to_xml(mujoco.MjSpec.from_string(text)) == pytest.approx(text)
