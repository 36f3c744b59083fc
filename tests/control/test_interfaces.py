"""dm_control's and Gymnasium's own checks, and that both say the same."""

import warnings

import numpy as np
import pytest

pytest.importorskip("dm_control", reason="dm_control runs on neither MuJoCo 4 nor Python 3.13")
pytest.importorskip("gymnasium")

from absl.testing import absltest
from dm_env import test_utils
from gymnasium.utils.env_checker import check_env

from inca_mj.control.environment import load_environment
from inca_mj.control.gymnasium_env import load_gymnasium
from inca_mj.control.tasks import TASKS


class TestHold(test_utils.EnvironmentTestMixin, absltest.TestCase):
    task = "hold"

    def make_object_under_test(self):
        return load_environment(self.task, random=0, time_limit=0.2)

    def make_action_sequence(self):
        spec, rng = self.environment.action_spec(), np.random.default_rng(0)
        for _ in range(50):
            yield rng.uniform(spec.minimum, spec.maximum)


class TestReach(TestHold):
    task = "reach"


class TestTrack(TestHold):
    task = "track"


@pytest.mark.parametrize("task", TASKS)
def test_the_checker_of_gymnasium_passes(task):
    with warnings.catch_warnings():
        # Its advice of bounded observations: an angle of a motor has no bound.
        warnings.filterwarnings("ignore", ".*Box observation space.*infinity.*")
        warnings.filterwarnings("ignore", ".*not within the observation space.*")
        # Its advice for networks: actions in [-1, 1]. These are currents [A].
        warnings.filterwarnings("ignore", ".*action space.*symmetric and normalized.*")
        check_env(load_gymnasium(task, seed=0), skip_render_check=True)


@pytest.mark.parametrize("task", TASKS)
def test_both_interfaces_give_the_same_numbers(task):
    ours, theirs = (
        load_environment(task, random=7, time_limit=0.3),
        load_gymnasium(task, 7, time_limit=0.3),
    )
    rng = np.random.default_rng(1)
    for _ in range(2):  # episodes
        a, (b, _) = ours.reset(), theirs.reset()
        done = False
        while not done:
            assert all(np.array_equal(a.observation[name], b[name]) for name in b)
            currents = rng.uniform(0, 2, 8)
            a = ours.step(currents)
            b, reward, terminated, done, _ = theirs.step(currents)
            assert reward == a.reward
            assert not terminated
            assert done == a.last()
