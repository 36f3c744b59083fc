"""Effects by rule are a change of the model's own parameter, in motion and in time."""

from functools import cache

import numpy as np
import pytest
from effect_cases import CATALOGUE, full, simulate

from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread
from inca_mj.twin.twin import build_twin


@cache
def spread():
    return build_twin(with_spread(parameter_set()))


@cache
def settled():
    return build_twin(effects=CATALOGUE, settled=True)


PARAMETERS = {
    "cable_elasticity": "lambda", "cable_damping": "b", "viscous_friction": "b_v",
    "friction": "b_c", "drum_radius": "R", "torque_constant": "K_t",
}  # fmt: skip


@pytest.mark.parametrize("name", PARAMETERS)
def test_a_mismatch_is_a_deviation_of_that_drive(name):
    """On a robot that has settled with it, so that it changes the rest as a deviation does."""
    names, values = [f"{name}_mismatch.delta@3"], [[0.0], [0.05]]
    none, ours = simulate(settled(), names, values, 0.5)
    _, theirs = simulate(spread(), [f"{PARAMETERS[name]}@3"], values, 0.5)
    moved = np.abs(ours - none).max()
    assert moved > 1e-7
    assert np.abs(ours - theirs).max() < 1e-6 * moved


def test_a_drum_spring_of_another_stiffness_is_one_of_another_radius():
    """The torque depends on k_s R_s² alone, but for the pretension, which R_s does not change."""
    none, ours = simulate(full(), ["drum_spring_mismatch.delta@3"], [[0.0], [0.05]], 0.5)
    _, theirs = simulate(spread(), ["k_s@3"], [[0.0], [0.05]], 0.5)
    _, radius = simulate(spread(), ["R_s@3"], [[0.0], [np.sqrt(1.05) - 1]], 0.5)
    moved = np.abs(ours - none).max()
    assert np.abs(ours - theirs).max() < 1e-6 * moved
    assert np.abs(theirs - radius).max() < 1e-6 * moved


@pytest.mark.parametrize("name", [*(n for n in PARAMETERS if n != "drum_radius"), "drum_spring"])
def test_a_second_at_one_ampere_warms_as_much_as_a_second_passes(name):
    """With currents of ±1 A the two kinds of every drift are the same, one heat for all of them."""
    currents = np.where(np.random.default_rng(5).integers(0, 2, (100, 8)), 1.0, -1.0)
    names, values = [f"{name}_drift.kind", f"{name}_drift.alpha"], [[0, 0], [0, 0.01], [1, 0.01]]
    none, aged, heated = simulate(full(), names, values, currents=currents)
    moved = np.abs(aged - none).max()
    assert moved > 1e-8
    assert np.abs(heated - aged).max() < 1e-9 * moved + 1e-13


def test_a_crosstalk_is_a_share_of_the_currents_beside_it():
    """It is what the drive would do with that share added to its own logged current."""
    rng = np.random.default_rng(6)
    currents = rng.normal(0, 0.3, (40, 8))
    a, b = 0.05, 0.02
    added = currents.copy()
    added[:, 1:] += a * currents[:, :-1]
    added[:, :-1] += b * currents[:, 1:]
    names = ["current_crosstalk.a", "current_crosstalk.b"]
    _, ours = simulate(full(), names, [[0.0, 0.0], [a, b]], currents=currents)
    (theirs,) = simulate(full(), currents=added)
    np.testing.assert_allclose(ours, theirs, atol=1e-13)
    one = currents.copy()
    one[:, 2] += a * currents[:, 1]
    _, ours = simulate(full(), ["current_crosstalk.a@3"], [[0.0], [a]], currents=currents)
    np.testing.assert_allclose(ours, simulate(full(), currents=one)[0], atol=1e-13)


def test_readings_of_encoders_follow_their_laws_and_leave_the_motion_alone():
    none, scaled = simulate(full(), ["encoder_scale.s@2"], [[0.0], [0.01]], 0.5)
    np.testing.assert_allclose(scaled[:, 1], 1.01 * none[:, 1], rtol=1e-12)
    np.testing.assert_array_equal(np.delete(scaled, 1, axis=1), np.delete(none, 1, axis=1))
    names = ["encoder_eccentricity.a", "encoder_eccentricity.b"]
    none, waved = simulate(full(), names, [[0.0, 0.0], [0.01, 0.02]], 0.5)
    np.testing.assert_allclose(waved, none + 0.01 * np.cos(none) + 0.02 * np.sin(none), atol=1e-12)
    jump = ["encoder_jump.c@6", "encoder_jump.t_s", "encoder_jump.w"]
    for w in (0.1, 1e-3):  # the second one takes less than a sample
        none, jumped = simulate(full(), jump, [[0.0, 0.303, w], [0.02, 0.303, w]], 0.5)
        moved = np.zeros_like(none)
        moved[:, 5] = 0.02 * np.clip(0.5 + (0.01 * np.arange(len(none)) - 0.303) / w, 0, 1)
        np.testing.assert_allclose(jumped, none + moved, atol=1e-12)
    delay = ["encoder_lag.kind", "encoder_lag.tau@5"]
    none, late = simulate(full(), delay, [[1.0, 0.0], [1.0, 0.01]], 0.5)
    np.testing.assert_array_equal(np.delete(late, 4, axis=1), np.delete(none, 4, axis=1))
    np.testing.assert_allclose(late[1:, 4], none[:-1, 4], atol=1e-12)  # one sample late
    assert np.abs(late - none)[:, 4].max() > 0.01


@pytest.mark.parametrize("name", [*PARAMETERS, "drum_spring"])
def test_a_jump_is_nothing_before_its_time_and_a_mismatch_when_it_comes_first(name):
    jump = [f"{name}_jump.delta@3", f"{name}_jump.t_s"]
    none, late, first = simulate(full(), jump, [[0.0, 1.0], [0.05, 0.5], [0.05, 0.1]], 0.8)
    np.testing.assert_array_equal(late[:45], none[:45])
    assert np.abs(late[60:] - none[60:]).max() > 1e-7
    differs = simulate(full(), [f"{name}_mismatch.delta@3"], [[0.0], [0.05]], 0.8)[1]
    moved = np.abs(differs - none)[40:].max()
    # What was missed in the first tenth of a second fades, as the drum springs bring it back.
    assert np.abs(first - differs)[40:].max() < moved
