"""Twin and reference agree on a robot whose drives differ and whose points are displaced."""

from dataclasses import replace

import numpy as np
import pytest
from reference_cases import differing

from inca_mj.reference import rest
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import deviations, displacements, with_spread
from inca_mj.twin.twin import build_twin
from inca_mj.verification import compare_derivatives, crosscheck
from inca_mj.verification.derivatives import _compare

NAMES = [p.name for p in (*deviations(), *displacements())]


@pytest.mark.parametrize("seed", [1, 2])
def test_accelerations_agree_at_random_states(seed):
    p = differing(seed)
    assert all(p[name].value for name in NAMES)
    assert compare_derivatives(2000, seed, p).largest < 1e-9


def test_the_start_is_the_same():
    p = differing(3)
    theirs, ours = build_twin(p).start, rest(p, INCA)
    np.testing.assert_allclose(theirs.tension, ours.tension, rtol=1e-11)
    np.testing.assert_allclose(theirs.no_load_length, ours.no_load, rtol=1e-14)


def test_trajectories_agree_to_the_limits_of_equal_drives():
    steps = (2e-3, 1e-3, 5e-4, 2.5e-4)
    result = crosscheck(differing(4), duration=3.0, steps=steps, cases=("prbs",), states=9)
    assert result.passed, result.sentences
    # Tensions show RK4's order at all steps, angles the quaternion's second order at short ones.
    assert result.tension_orders["prbs"] == pytest.approx(4, abs=0.3)


@pytest.fixture(scope="module")
def robot():
    return build_twin(with_spread(parameter_set()))


@pytest.mark.parametrize("name", NAMES)
def test_every_deviation_moves_both_models_alike(robot, name):
    moved = robot.with_values({name: 1e-3})
    lacking = replace(moved, parameters=robot.parameters)  # what the reference is told
    alike, apart = (max(_compare(r, 30, np.random.default_rng(0))[0]) for r in (moved, lacking))
    assert alike < 1e-9
    assert apart > 1e-8  # a smoothness β shows only where a motor is slow
