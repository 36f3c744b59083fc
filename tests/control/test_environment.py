import runpy
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("dm_control", reason="dm_control runs on neither MuJoCo 4 nor Python 3.13")

from dm_control.rl.control import PhysicsError
from effect_cases import full

from inca_mj.control.controller import CONTROL_TIMESTEP, Controller, Gains
from inca_mj.control.environment import load_environment as load
from inca_mj.control.inverse import HIGHEST_CURRENT, LOWEST_CURRENT
from inca_mj.control.paths import Point
from inca_mj.control.tasks import REACH, START_SPREAD, TASKS
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

EXAMPLE = Path(__file__).parents[2] / "examples" / "hold_the_handle.py"
POSE = ("x", "y", "z", "roll", "pitch", "yaw")


def load_environment(task="hold", random=None, **options):
    """As a test sees it: with what the real robot cannot measure."""
    return load(task, random, privileged=True, **options)


def drive(env, currents):
    env.reset()
    return [env.step(row) for row in currents]


def test_it_moves_in_lockstep_with_the_twin():
    seed, steps = 3, 100
    currents = np.random.default_rng(0).uniform(LOWEST_CURRENT, HIGHEST_CURRENT, (steps, 8))
    currents[: steps // 2] = 0.7
    env = load_environment("reach", random=seed)
    seen = [step.observation for step in drive(env, currents)]

    spread = np.random.default_rng(seed).uniform(-START_SPREAD, START_SPREAD)
    nominal = parameter_set().values()
    robot = build_twin().with_values({n: nominal[n] + s for n, s in zip(POSE, spread, strict=True)})
    run = simulate(robot, np.vstack([currents, currents[-1:]]), CONTROL_TIMESTEP)

    for name, expected in {
        "motor_angle": run.motor_angle,
        "position": run.position,
        "orientation": run.qpos[:, 3:7],
        "tension": run.tension,
    }.items():
        found = np.array([observation[name] for observation in seen])
        np.testing.assert_allclose(found, expected[1:], rtol=0, atol=1e-9, err_msg=name)
    rates = np.array([observation["motor_rate"] for observation in seen])
    np.testing.assert_allclose(
        rates, np.diff(run.motor_angle, axis=0) / CONTROL_TIMESTEP, atol=1e-6
    )


@pytest.mark.parametrize("task", TASKS)
def test_specs_describe_what_is_taken_and_given(task):
    env = load_environment(task, random=0)
    action = env.action_spec()
    assert action.shape == (8,)
    assert (action.minimum, action.maximum) == (LOWEST_CURRENT, HIGHEST_CURRENT)
    step = env.reset()
    for name, spec in env.observation_spec().items():
        spec.validate(step.observation[name])
    for _ in range(20):
        step = env.step(np.full(8, HIGHEST_CURRENT))
        assert 0 <= step.reward <= 1
        assert (step.observation["tension"] > 0).all()


@pytest.mark.parametrize("task", TASKS)
def test_a_seed_decides_everything(task):
    currents = np.full((30, 8), 0.5)

    def positions(seed):
        return np.array(
            [
                np.concatenate([s.observation["position"], s.observation["target"]])
                for s in drive(load_environment(task, seed), currents)
            ]
        )

    np.testing.assert_array_equal(positions(5), positions(5))
    assert np.abs(positions(5) - positions(6)).max() > 1e-4


@pytest.mark.parametrize("seed", range(2))
def test_it_starts_at_rest_whatever_the_pose(seed):
    env = load_environment("reach", random=seed)  # no hand pulls
    begin = env.reset().observation
    step = [env.step(np.zeros(8)) for _ in range(100)][-1]
    np.testing.assert_allclose(step.observation["position"], begin["position"], atol=1e-9)
    np.testing.assert_allclose(step.observation["tension"], begin["tension"], atol=1e-6)


def test_the_hand_pulls_in_hold_only_and_anew_each_episode():
    env = load_environment("hold", random=1)
    forces = []
    for _ in range(2):
        env.reset()
        forces.append(env.physics.named.data.xfrc_applied["platform"].copy())
    assert not np.array_equal(*forces)
    assert all(0.5 <= np.linalg.norm(f[:3]) <= 2.0 and not f[3:].any() for f in forces)

    env = load_environment("reach", random=1)
    env.reset()
    assert not env.physics.data.xfrc_applied.any()


def test_targets_are_the_start_or_within_reach():
    begin = load_environment("hold", random=0).reset().observation
    np.testing.assert_allclose(begin["target"], begin["position"], atol=1e-12)
    env = load_environment("reach", random=0)
    targets = np.array([env.reset().observation["target"] for _ in range(50)])
    assert (np.abs(targets - [0, 0, 1.43]) <= REACH).all()
    assert np.ptp(targets, axis=0).min() > 0.2


def test_the_reward_is_one_at_the_target_and_falls_with_distance():
    env = load_environment("hold", random=0)
    env.reset()
    rewards = []
    for shift in (0.0, 0.02, 0.05, 0.1):
        env.physics.data.qpos[:7] = [
            *(env.task.asked(env.physics).position + [shift, 0, 0]),
            1,
            0,
            0,
            0,
        ]
        env.physics.forward()
        rewards.append(env.task.get_reward(env.physics))
    assert rewards[0] == 1
    assert sorted(rewards, reverse=True) == rewards
    assert rewards[-1] < 0.2


def test_currents_are_cut_to_the_range_of_the_amplifiers():
    two = [
        drive(load_environment("reach", 0), np.full((10, 8), level))[-1].observation["motor_angle"]
        for level in (HIGHEST_CURRENT, 50.0)
    ]
    np.testing.assert_array_equal(*two)


def test_a_current_that_is_no_number_is_refused_and_does_no_harm(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    env = load_environment("hold", random=0)
    env.reset()
    with pytest.raises(PhysicsError, match="finite"):
        env.step(np.full(8, np.nan))
    assert np.isfinite(env.step(np.zeros(8)).observation["position"]).all()
    assert not list(tmp_path.iterdir()), "no MUJOCO_LOG.TXT"


def test_track_asks_for_a_circle_at_one_radian_a_second():
    env = load("track", random=3)
    env.reset()
    asked = [env.step(np.zeros(8)).observation for _ in range(700)][450:]
    radius = [np.linalg.norm(o["target"] - [0, 0, 1.43]) for o in asked]
    speed = [np.linalg.norm(o["target_velocity"]) for o in asked]
    np.testing.assert_allclose(radius, 0.3, rtol=1e-9)
    np.testing.assert_allclose(speed, 0.3, rtol=1e-9)


def test_noise_of_the_encoders_is_observed_and_moves_nothing():
    quiet, noisy = (
        drive(load("reach", 5, privileged=True, encoder_noise=n), np.full((40, 8), 0.6))
        for n in (0.0, 1e-3)
    )
    error = np.array(
        [
            a.observation["motor_angle"] - b.observation["motor_angle"]
            for a, b in zip(quiet, noisy, strict=True)
        ]
    )
    assert 0.8e-3 < error.std() < 1.2e-3  # 320 draws: within 4 of its std of 4 %
    for a, b in zip(quiet, noisy, strict=True):
        np.testing.assert_array_equal(a.observation["position"], b.observation["position"])


@pytest.mark.parametrize(("task", "miss"), [("hold", 1e-3), ("track", 1e-4)])
def test_the_baseline_controller_does_the_task_from_what_the_robot_measures(task, miss):
    env = load(task, random=4, time_limit=6.0)
    seen = env.reset().observation
    robot = build_twin().with_values(dict(zip(POSE, seen["start"], strict=True)))
    path = env.task.path if task == "track" else Point(tuple(seen["target"]))
    controller = Controller(robot, path, gains=Gains(integral=0.5))
    for _ in range(500):
        seen = env.step(controller.currents(seen["motor_angle"])).observation
    error = env.physics.handle_position() - env.task.asked(env.physics).position
    assert np.linalg.norm(error) < miss


def test_a_robot_with_an_effect_moves_as_its_twin_does():
    robot = full().with_values({"load_dependent_friction.mu": 0.1})
    currents = np.random.default_rng(2).uniform(0.4, 1.0, (50, 8))
    env = load("track", 0, robot=robot)
    seen = np.array([step.observation["motor_angle"] for step in drive(env, currents)])
    run = simulate(robot, np.vstack([currents, currents[-1:]]), CONTROL_TIMESTEP)
    np.testing.assert_allclose(seen, run.motor_angle[1:], atol=1e-9)


def test_the_example_brings_the_handle_to_its_target():
    miss, reward = runpy.run_path(str(EXAMPLE))["hold"](seconds=3.0, seed=4, task="hold")
    assert miss[-1] < 1e-3
    assert reward[-1] > 0.99
    assert np.max(miss) < 0.01
