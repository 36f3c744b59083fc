"""What encoders read: a change of the reading and none of the robot; and what changes with time."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from worlds_cases import plant, prbs

from identification.errors import InputError
from inca_mj.reference import layout as base
from inca_mj.studies.worlds import FAULTS, HiddenSetting, effect, simulate_world, world
from inca_mj.studies.worlds.sensor import (
    Motion,
    lagged,
    simulate_angles,
)

TIME = 0.01 * np.arange(101)
W = 2 * np.pi * 1.5  # of a sine [rad/s]


def sine():
    angles, rates = np.sin(W * TIME)[:, None], W * np.cos(W * TIME)[:, None]
    return Motion(TIME, angles, CubicHermiteSpline(TIME, angles, rates))


@pytest.mark.parametrize("name", FAULTS)
def test_the_robot_moves_as_if_its_encoders_were_right(name):
    u = prbs(0.7)
    true, seen = simulate_angles(plant(effect(name)), [effect(name)], u, 0.01)
    np.testing.assert_allclose(true, simulate_world(plant(), u)[:, base.ANGLES], atol=1e-9)
    assert (seen != true).any()
    true, seen = simulate_angles(plant(), [effect(name).scaled(0.0)], u, 0.01)
    np.testing.assert_allclose(seen, true, atol=1e-12)


@pytest.mark.parametrize("tau", [1e-3, 5e-3, 0.02])
def test_a_lag_of_a_sine_is_that_of_a_low_pass(tau):
    late = np.arctan(W * tau)
    settles = np.exp(-TIME / tau) * np.sin(late)
    expected = np.cos(late) * (np.sin(W * TIME - late) + settles)
    np.testing.assert_allclose(lagged(sine(), tau)[:, 0], expected, atol=2e-5)


def test_a_late_reading_is_the_angle_of_before():
    added = effect("encoder_lag", tau=7e-3, late=True).added(sine())[:, 0]
    expected = np.where(TIME < 7e-3, 0.0, np.sin(W * (TIME - 7e-3)))
    np.testing.assert_allclose(added + np.sin(W * TIME), expected, atol=2e-5)


def test_a_fault_of_one_encoder_is_in_its_reading_alone():
    faults = [
        effect("encoder_scale", drive=2, s=0.1),
        effect("encoder_eccentricity", drive=4, a=0.02, b=-0.01),
        effect("encoder_jump", drive=8, c=0.3, t_s=0.2),
    ]
    true, seen = simulate_angles(plant(*faults), faults, prbs(0.3), 0.01)
    φ = true[:, 3]
    np.testing.assert_array_equal(seen[:, 1], true[:, 1] + 0.1 * true[:, 1])
    np.testing.assert_array_equal(seen[:, 3], φ + (0.02 * np.cos(φ) - 0.01 * np.sin(φ)))
    np.testing.assert_array_equal(seen[:, 7], true[:, 7] + 0.3 * (np.arange(30) >= 20))
    np.testing.assert_array_equal(np.delete(seen, [1, 3, 7], 1), np.delete(true, [1, 3, 7], 1))


def test_the_truth_of_a_world_is_the_true_angle():
    setting = HiddenSetting(duration=0.5, noise=0.0, counts=0)
    log, truth = world(3, [effect("encoder_scale", drive=1, s=0.05)], setting=setting)
    _, without = world(3, setting=setting)
    np.testing.assert_array_equal(truth.angles, without.angles)
    np.testing.assert_allclose(log.outputs[:, 0], 1.05 * truth.angles[:, 0], rtol=1e-12)


def test_a_parameter_that_jumps_is_the_old_one_before_and_the_new_one_after():
    u = prbs(0.6)
    jumped = simulate_world(plant(effect("friction_jump", drive=3, delta=0.4, t_s=0.3)), u)
    np.testing.assert_array_equal(jumped[:30], simulate_world(plant(), u)[:30])
    always = simulate_world(plant(effect("friction_jump", drive=3, delta=0.4, t_s=0.0)), u)
    mismatch = effect("friction_mismatch", drive=3).scaled(4.0)
    np.testing.assert_allclose(always, simulate_world(plant(mismatch), u), atol=1e-9)
    assert (jumped[40:] != always[40:]).any()


def test_a_drift_grows_with_time_or_heat():
    u = np.ones((60, 8))  # 1 A, so that the heat is the time
    with_time = simulate_world(plant(effect("friction_drift", alpha=0.3)), u)
    with_heat = simulate_world(plant(effect("friction_drift", alpha=0.3, heat=True)), u)
    np.testing.assert_allclose(with_time, with_heat, atol=1e-9)
    assert abs(with_time - simulate_world(plant(), u))[:, base.ANGLES].max() > 1e-5


def test_one_parameter_of_a_drive_changes():
    with pytest.raises(InputError, match="another parameter of drive 2 changes already"):
        plant(effect("friction_jump", drive=2), effect("viscous_friction_jump", drive=2))
    plant(effect("friction_jump", drive=2), effect("viscous_friction_jump", drive=3))
