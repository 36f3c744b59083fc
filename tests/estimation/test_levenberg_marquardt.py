"""One descent for all: it falls at every step, ends at the minimum, and runs many as one by one."""

from dataclasses import dataclass
from itertools import islice

import numpy as np
import pytest

from identification.estimation.levenberg_marquardt import Criterion, Damping, levenberg_marquardt

PLAIN = Damping(first=0.0, raised=10.0, least=1e-4)
CAREFUL = Damping(first=1e-2, raised=5.0, least=1e-12)


@dataclass(frozen=True)
class Rosenbrock(Criterion):
    """r = (10 (b - a²), 1 - a): a curved valley to (1, 1), W of them at points (W, 2)."""

    q: np.ndarray
    bends: bool = False

    @staticmethod
    def residual(q):
        a, b = q.T
        return np.stack([10 * (b - a**2), 1 - a], axis=-1)

    @property
    def jacobian(self):
        a = self.q[:, 0]
        rows = [np.stack([-20 * a, np.full_like(a, 10.0)], -1), np.tile([-1.0, 0.0], (len(a), 1))]
        return np.stack(rows, axis=1)

    @property
    def cost(self):
        return np.sum(self.residual(self.q) ** 2, axis=-1)

    def step(self, μ):
        return self.solved(-self.residual(self.q), μ)

    def solved(self, target, μ):
        J = self.jacobian
        D = np.linalg.norm(J, axis=1)
        H = np.einsum("wij,wik->wjk", J, J)
        H = H + np.asarray(μ)[:, None, None] * np.einsum("wj,jk->wjk", D**2, np.eye(2))
        return np.linalg.solve(H, np.einsum("wij,wi->wj", J, target)[..., None])[..., 0]

    def cost_after(self, step):
        return np.sum(self.residual(self.q + step) ** 2, axis=-1)

    def bend(self, step, after, μ):
        if not self.bends:
            return None
        curve = np.stack([-20 * step[:, 0] ** 2, np.zeros(len(step))], axis=-1)
        return step + self.solved(-curve / 2, μ)

    def moved(self, step, taken):
        return Rosenbrock(np.where(taken[:, None], self.q + step, self.q), self.bends)


def run(start, damping, n, bends=False):
    begun = Rosenbrock(np.array(start, float), bends)
    return list(islice(levenberg_marquardt(begun, damping), n))


@pytest.mark.parametrize("damping", [PLAIN, CAREFUL])
@pytest.mark.parametrize("start", [(-1.2, 1.0), (3.0, -4.0), (0.0, 0.0)])
def test_it_falls_until_it_is_at_the_minimum(damping, start):
    trials = run([start], damping, 60)
    costs = [t.criterion.cost[0] for t in trials]
    assert (np.diff(costs) <= 0).all()
    np.testing.assert_allclose(trials[-1].criterion.q[0], [1.0, 1.0], atol=1e-6)
    for t in trials:
        assert t.taken[0] == (t.after[0] < t.before[0])
        assert t.criterion.cost[0] == (t.after[0] if t.taken[0] else t.before[0])


def test_many_descend_together_as_each_alone():
    starts = np.random.default_rng(0).uniform(-2, 2, (7, 2))
    together = run(starts, CAREFUL, 12)
    for i, start in enumerate(starts):
        for t, alone in zip(together, run([start], CAREFUL, 12), strict=True):
            np.testing.assert_allclose(t.criterion.q[i], alone.criterion.q[0], rtol=1e-12)
            assert t.μ[i] == alone.μ[0]
            assert t.taken[i] == alone.taken[0]


def test_a_bent_step_is_taken_only_where_it_leads_lower_and_saves_steps():
    def needed(bends):
        trials = run([(-1.2, 1.0)], CAREFUL, 60, bends)
        return next(k for k, t in enumerate(trials) if t.criterion.cost[0] < 1e-12)

    assert needed(True) < needed(False)
    begun = Rosenbrock(np.array([[-1.2, 1.0]]), True)
    (trial,) = islice(levenberg_marquardt(begun, CAREFUL), 1)
    straight = begun.step(trial.μ)
    bent = begun.bend(straight, None, trial.μ)
    better = min((straight, bent), key=lambda s: begun.cost_after(s)[0])
    np.testing.assert_array_equal(trial.step, better)


def test_where_nothing_can_be_simulated_it_does_not_go():
    @dataclass(frozen=True)
    class Walled(Rosenbrock):
        def cost_after(self, step):
            there = super().cost_after(step)
            return np.where(self.q[:, 0] + step[:, 0] > 0.5, np.inf, there)

        def moved(self, step, taken):
            return Walled(np.where(taken[:, None], self.q + step, self.q))

    begun = Walled(np.array([[-1.2, 1.0]]))
    trials = list(islice(levenberg_marquardt(begun, CAREFUL), 80))
    assert all(t.criterion.q[0, 0] <= 0.5 for t in trials)
    assert trials[-1].criterion.q[0, 0] > 0.4
