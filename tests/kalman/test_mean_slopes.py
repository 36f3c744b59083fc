"""Slopes of the rates over intervals: secants in the velocities, both sides of the inputs."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from effect_cases import bare
from estimation_plants import SLIDER
from plain_logs import plain_log

from identification import ParameterSet, Predictor
from identification.kalman import linear
from identification.kalman.linear import input_derivatives, state_derivatives
from identification.kalman.sensitivity_equations import solve_sensitivities
from identification.kalman.trajectory import COARSE_POINTS, follow
from identification.model.plant import ModelPlant
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import ANGLES, CURRENTS

STEEP = {"b_c": 0.01, "beta": 3.0}


def log_of(u):
    return plain_log(u, np.zeros_like(u), CURRENTS, ANGLES)


def value(plant, name):
    return next(p.value for p in plant.parameters if p.name == name)


@pytest.fixture(scope="module")
def steep():
    """The cable robot with a friction that turns over within a fraction of an interval."""
    return Predictor(bare(), log_of(make_input("prbs", 4.0)), tuple(STEEP))


def test_a_friction_counts_with_the_mean_of_its_slope(steep):
    """Of b_c tanh(β ω) that is b_c (tanh(β ω_1) - tanh(β ω_0))/(ω_1 - ω_0)."""
    along = follow(steep, np.array([*STEEP.values()]), COARSE_POINTS)
    smooth = follow(steep, np.array([1e-9, STEEP["beta"]]), COARSE_POINTS)
    found = state_derivatives(along)[0] - state_derivatives(replace(along, model=smooth.model))[0]
    nv, motors, beta = along.model.nv, np.arange(6, 14), STEEP["beta"]
    found = found[:, nv + motors, nv + motors]
    first, last = ((along.qvel + s * along.moved / 2)[:, motors] for s in (-1, 1))
    J, far = along.model.dof_armature[motors], np.abs(last - first) > 1e-3
    slope = (np.tanh(beta * last) - np.tanh(beta * first)) / np.where(far, last - first, 1.0)
    assert far.mean() > 0.5
    np.testing.assert_allclose(found[far], (-STEEP["b_c"] / J * slope)[far], rtol=1e-3, atol=0.05)
    at_points = beta / np.cosh(beta * along.qvel[:, motors]) ** 2
    assert np.abs(at_points - slope)[far].max() > 0.3 * beta


def test_beside_it_columns_stay_right(steep, monkeypatch):
    """With the slopes at the points alone they miss the simulation by twice as much."""
    names = ("lambda", "b", "b_c", "beta", "K_t", "J", "R", "m")
    predictor = replace(steep, names=names)
    values = np.array([STEEP.get(name, value(steep.plant, name)) for name in names])
    moves = 1e-6 * values
    runs = predictor.predict(np.vstack([values, values + np.diag(100 * moves)]))
    expected = np.moveaxis((runs[1:] - runs[0]) / (100 * moves)[:, None, None], 0, -1)

    def miss():
        records = linear.linearise_records(predictor, values)
        S = solve_sensitivities(predictor, records, values, values + np.diag(moves), moves)
        size = np.linalg.norm(expected, axis=(0, 1))
        return float(np.median(np.linalg.norm(S - expected, axis=(0, 1)) / size))

    with_secants = miss()
    monkeypatch.setattr(
        linear, "state_derivatives",
        lambda along: state_derivatives(replace(along, moved=np.zeros_like(along.moved))),
    )  # fmt: skip
    assert with_secants < 0.5 * miss()


def test_an_input_at_its_limit_has_two_slopes():
    model = mujoco.MjModel.from_xml_string(SLIDER.replace('gear="5"', 'gear="5" ctrlrange="-1 1"'))
    assert model.actuator_ctrllimited[0]
    plant = ModelPlant(model, ParameterSet("limited", ()))
    u = np.array([1.0, 1.0, 0.3, 0.3, -1.0, -1.0, -1.0])[:, None]
    log = plain_log(u, np.zeros((7, 1)), "force", "position", 0.02)
    along = follow(Predictor(plant, log, ()), np.empty(0), COARSE_POINTS)
    up, down = (each[:, 0, 0] for each in input_derivatives(along))
    sent = along.inputs[:, 0]
    np.testing.assert_allclose(up, np.where(sent < 1, 2.5, 0), atol=1e-6)  # gear over mass
    np.testing.assert_allclose(down, np.where(sent > -1, 2.5, 0), atol=1e-6)
