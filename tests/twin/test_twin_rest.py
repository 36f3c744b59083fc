"""The pretensioned start is a rest, and a run from it stays there."""

from dataclasses import fields

import numpy as np
import pytest
from effect_cases import full

from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import SETS, parameter_set
from inca_mj.twin.run import simulate
from inca_mj.twin.statics import start_from, starts_from
from inca_mj.twin.twin import build_twin

OFF = {"x": 0.04, "y": -0.03, "z": 1.5, "roll": 0.1, "pitch": -0.05, "yaw": 0.15}


@pytest.mark.parametrize("values", [{}, OFF], ids=["nominal", "off-nominal"])
@pytest.mark.parametrize("name", SETS)
def test_at_rest_it_stays_for_ten_seconds(name, values):
    robot = build_twin(parameter_set(name, values))
    run = simulate(robot, make_input("zero", 10.0))
    assert np.abs(run.position - run.position[0]).max() < 1e-9
    assert np.abs(run.motor_angle).max() < 1e-7
    np.testing.assert_allclose(run.tension, np.tile(robot.start.tension, (1001, 1)), atol=1e-7)


def test_the_pretension_is_near_four_newton_and_carries_the_weight():
    tension = build_twin().start.tension
    assert np.linalg.norm(tension - 4.0) < 1.0
    # The upper cables carry the platform: they pull more than the lower ones.
    assert tension[4:].min() > tension[:4].max()


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("settled", [False, True])
def test_starts_that_are_shared_are_those_of_each_value_set(settled, seed):
    robot = full(settled=settled)
    rng, own = np.random.default_rng(seed), robot.parameters.values()
    names = [*own]
    values = np.tile(list(own.values()), (1 + len(names), 1))
    values[1 + np.arange(len(names)), np.arange(len(names))] += rng.uniform(1e-5, 1e-4, len(names))
    shared = starts_from(own, names, values, robot.geometry, robot.layout)
    assert len({id(start) for start in shared}) < 0.7 * len(shared)
    for row, start in zip(values, shared, strict=True):
        alone = start_from(dict(zip(names, row, strict=True)), robot.geometry, robot.layout)
        for field in fields(start):
            np.testing.assert_array_equal(getattr(start, field.name), getattr(alone, field.name))
