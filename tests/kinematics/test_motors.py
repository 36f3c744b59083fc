"""The pose from motor angles: at rest and along logs of the twin, whose pose is known."""

from dataclasses import replace

import numpy as np
import pytest
from kinematics_cases import measured_angles, moving_run, settled_run

from identification.errors import InputError
from inca_mj import log_poses, parameter_set, pose_at_rest, run_to_log
from inca_mj.kinematics.along import measure
from inca_mj.kinematics.balance import drum_tension, no_load_along, no_load_at_rest
from inca_mj.kinematics.resting import at_rest
from inca_mj.robot.elastic import robot_of
from inca_mj.robot.geometry import INCA


@pytest.fixture(scope="module")
def settled():
    return settled_run()


@pytest.fixture(scope="module")
def moving():
    return moving_run("prbs", 1.5)


def robot_that(run):
    begin = run.twin.start
    values = run.twin.parameters.values()
    return robot_of(values, INCA, begin.tension, begin.no_load_length)


def poses_of(run):
    return np.hstack([run.position, run.angles])


def noisy_log(run, seed=0):
    return replace(run_to_log(run), outputs=measured_angles(run, seed))


def test_the_drums_balance_gives_the_tension_of_a_twin_at_rest(settled):
    T = drum_tension(robot_that(settled), at_rest(settled.motor_angle[-1], settled.currents[-1]))
    assert np.ptp(T) > 1
    np.testing.assert_allclose(T[0], settled.tension[-1], atol=2e-3)


def test_the_no_load_length_along_a_log_is_that_of_the_twin(moving):
    robot, φ = robot_that(moving), moving.motor_angle
    along = no_load_along(robot, φ, moving.tension)
    # the trapezoidal rule at 100 Hz errs by (h²/12) d(ε φ̇)/dt R, some hundredths of a micrometre
    np.testing.assert_allclose(along, moving.act, atol=1e-6)
    alone, slope = no_load_at_rest(φ, robot, moving.tension)
    ε = moving.tension / robot.lambda_
    bound = np.ptp(ε, axis=0) * np.abs(np.diff(robot.R * φ, axis=0)).sum(axis=0)
    assert (np.abs(alone - moving.act) <= bound).all()
    h = 1e-3
    ahead, _ = no_load_at_rest(φ, robot, moving.tension + h)
    np.testing.assert_allclose((ahead - alone) / h, slope, atol=1e-9)


def test_the_pose_of_a_twin_at_rest_comes_from_its_angles(settled):
    truth = poses_of(settled)[-1]
    found = pose_at_rest(
        settled.motor_angle[-1], settled.currents[-1], settled.twin.parameters, encoder=1e-5
    )
    assert np.linalg.norm(truth[:3] - settled.position[0]) > 0.05
    # what is left is the path of d₀, whose error is at most the spread of the strain times R φ
    ε = settled.tension / settled.twin.parameters["lambda"].value
    bound = (np.ptp(ε, axis=0) * np.abs(0.0175 * settled.motor_angle[-1])).max()
    np.testing.assert_allclose(found.pose[:3], truth[:3], atol=bound)
    np.testing.assert_allclose(found.pose[3:], truth[3:], atol=bound / 0.05)
    np.testing.assert_allclose(found.tension, settled.tension[-1], atol=0.02)
    np.testing.assert_allclose(found.no_load_length, settled.act[-1], atol=bound)


def test_noise_of_encoders_and_friction_scatters_the_pose_as_its_std_says(settled):
    φ, i, rng = settled.motor_angle[-1], settled.currents[-1], np.random.default_rng(0)
    nominal = pose_at_rest(φ, i)  # Table 3.2: dry friction holds a drum by up to b_c = 5 mN m
    held = 0.005 / np.sqrt(3) / 0.08  # as a current [A]
    noisy = [
        pose_at_rest(
            φ + rng.normal(0, 6.7e-4, 8), i + rng.uniform(-1, 1, 8) * np.sqrt(3) * held
        ).pose
        for _ in range(40)
    ]
    np.testing.assert_allclose(np.std(noisy, axis=0), nominal.noise_std, rtol=0.35)


@pytest.mark.parametrize(("name", "σ"), [("R", 1e-4), ("exit_x@3", 1e-3)])
def test_a_parameter_moves_the_pose_by_its_share_of_the_std(settled, name, σ):
    from inca_mj.robot.spread import with_spread

    φ, i, parameters = settled.motor_angle[-1], settled.currents[-1], settled.twin.parameters
    found = pose_at_rest(φ, i, parameters, std={name: σ})
    every = with_spread(parameters)
    value = every[name].value
    moved = [
        pose_at_rest(φ, i, every.with_values({name: value + sign * 0.1 * σ})).pose
        for sign in (1, -1)
    ]
    share = np.abs(moved[0] - moved[1]) / 0.2
    # friction, and so the weights, change with R a little; the derivative neglects this
    scale = np.array([1, 1, 1, 0.05, 0.05, 0.05])
    both = np.sqrt(found.std**2 - found.noise_std**2)
    np.testing.assert_allclose(both * scale, share * scale, atol=0.01 * (share * scale).max())


def test_slack_and_impossible_angles_are_refused():
    with pytest.raises(InputError, match="cable 5 is slack"):
        pose_at_rest(np.zeros(8), np.array([0, 0, 0, 0, -3.0, 0, 0, 0]))
    with pytest.raises(InputError, match="whole cable"):
        pose_at_rest(np.array([200.0, 0, 0, 0, 0, 0, 0, 0]))
    with pytest.raises(InputError, match="sign of the"):
        pose_at_rest(np.full(8, 20.0), np.full(8, 4.0))
    with pytest.raises(InputError, match="8 finite numbers"):
        pose_at_rest(np.zeros(7))
    with pytest.raises(InputError, match="did you mean 'lambda'"):
        pose_at_rest(np.zeros(8), std={"lamda": 1.0})
    with pytest.raises(InputError, match="std of R"):
        pose_at_rest(np.zeros(8), std={"R": -1.0})


def test_the_pose_along_a_log_is_that_of_the_twin_within_its_std():
    run = moving_run("prbs", 3.0)
    found = log_poses(noisy_log(run))
    error = found.pose - poses_of(run)
    inside = np.abs(error) < 1.96 * found.std
    assert 0.9 < inside.mean() <= 1
    assert (np.mean((error / found.std) ** 2, axis=0) < 1.5).all()
    assert np.abs(error[:, :3]).max() < 2e-4
    assert found.length_error == 0
    np.testing.assert_array_equal(found.std, found.noise_std)


def test_a_robot_that_is_not_the_nominal_one_is_noticed_and_its_std_covers():
    run = moving_run("prbs", 1.5, {"R": 0.0178, "x": 0.002})
    log = noisy_log(run)
    nominal = parameter_set()
    bare, told = log_poses(log, nominal), log_poses(log, nominal, std={"R": 3e-4, "x": 2e-3})
    assert told.length_error > 1e-5
    error = told.pose - poses_of(run)
    assert (np.abs(error) < 1.96 * told.std).mean() > 0.95
    assert (np.abs(error) < 1.96 * bare.std).mean() < 0.9
    assert (told.std >= bare.std).all()


def test_angles_that_turn_the_wrong_way_and_short_logs_are_refused(moving):
    log = noisy_log(moving)
    with pytest.raises(InputError, match="too few"):
        measure(log.outputs[:4], log.inputs[:4], 0.01)
    with pytest.raises(InputError, match="above zero"):
        log_poses(log, encoder=0.0)
    far = replace(log, outputs=log.outputs + np.linspace(0, 12, len(log))[:, None])
    with pytest.raises(InputError, match="no pose has the cable lengths of sample"):
        log_poses(far)
