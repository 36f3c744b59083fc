import numpy as np
import pytest

pytest.importorskip("dm_control", reason="dm_control runs on neither MuJoCo 4 nor Python 3.13")

from dm_control.rl.control import PhysicsError

from identification.errors import InputError
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.control import (
    CONTROL_TIMESTEP,
    HIGHEST_CURRENT,
    LOWEST_CURRENT,
    REACH,
    START_SPREAD,
    TASKS,
    load_environment,
)
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

POSE = ("x", "y", "z", "roll", "pitch", "yaw")


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
        "motor_rate": run.motor_rate,
        "position": run.position,
        "orientation": run.qpos[:, 3:7],
        "tension": run.tension,
    }.items():
        found = np.array([observation[name] for observation in seen])
        np.testing.assert_allclose(found, expected[1:], rtol=0, atol=1e-9, err_msg=name)


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
            [s.observation["position"] for s in drive(load_environment(task, seed), currents)]
        )

    np.testing.assert_array_equal(positions(5), positions(5))
    assert np.abs(positions(5) - positions(6)).max() > 1e-4


@pytest.mark.parametrize("seed", range(5))
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
        env.physics.data.qpos[:7] = [*(env.physics.target() + [shift, 0, 0]), 1, 0, 0, 0]
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


def test_an_episode_ends_at_its_time_limit():
    env = load_environment("reach", random=0, time_limit=0.05)
    steps = drive(env, np.zeros((5, 8)))
    assert [s.last() for s in steps] == [False] * 4 + [True]


def test_a_current_that_is_no_number_is_refused_and_does_no_harm(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    env = load_environment("hold", random=0)
    env.reset()
    with pytest.raises(PhysicsError, match="finite"):
        env.step(np.full(8, np.nan))
    assert np.isfinite(env.step(np.zeros(8)).observation["position"]).all()
    assert not list(tmp_path.iterdir()), "no MUJOCO_LOG.TXT"


def test_an_unknown_task_names_the_known():
    with pytest.raises(InputError, match=r"did you mean 'hold'.*hold, reach"):
        load_environment("hodl")
