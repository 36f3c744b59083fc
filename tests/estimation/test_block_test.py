"""The test by blocks holds for candidates that act in few blocks, and for many sizes."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from identification.estimation.block_test import (
    Common,
    common_scatter,
    covariance,
    make_blocks,
    p_values,
    scatter_of,
)

OWN = Common(0.0, 1.0)  # nothing is borrowed
B, LENGTH, P = 40, 25, 8


class Case:
    """Columns of candidates that act in some blocks each, beside slow free parameters."""

    def __init__(self, seed, active, m=1, blocks=B):
        rng = np.random.default_rng(seed)
        N = blocks * LENGTH
        t = np.arange(N)
        Φ = np.cos(t[:, None] * rng.uniform(0, 0.05, P) + rng.uniform(0, 6, P))
        phases = rng.uniform(0, 6, (len(active), m))
        X = np.cos(t[:, None, None] * rng.uniform(0, 0.3, (len(active), m)) + phases)
        for j, some in enumerate(active):
            on = np.isin(np.arange(blocks), rng.choice(blocks, some, replace=False))
            X[:, j] *= np.repeat(on, LENGTH)[:, None]
        self.Q, self.m = np.linalg.qr(Φ)[0], m
        X = X.reshape(N, -1)
        self.X = X - self.Q @ (self.Q.T @ X)
        rows = [slice(k, k + LENGTH) for k in range(0, N, LENGTH)]
        own = [self.X[r].reshape(LENGTH, -1, m) for r in rows]
        G = np.stack([np.einsum("njp,njq->jpq", x, x) for x in own])
        Z = np.stack([self.Q[r].T @ self.X[r] for r in rows]).reshape(blocks, P, -1, m)
        self.blocks, self.rows, self.G = make_blocks(G, Z), rows, G

    def scatter(self, e, sign=0):
        e = e - self.Q @ (self.Q.T @ e)
        a = np.stack([e[r] @ self.X[r] for r in self.rows]).reshape(len(self.rows), -1, self.m)
        b = a.sum(axis=0)
        size = np.linalg.solve(self.G.sum(axis=0), b[..., None])[..., 0]
        variance = (e @ e - np.einsum("jp,jp->j", b, size)) / (len(e) - P - self.m)
        return scatter_of(self.blocks, a, variance, np.full(b.shape, sign))


def drawn(case, draws, seed, memory=1, common=None):
    """p-values of draws of noise that is white, or a mean of so many white samples, (draws, J)."""
    rng, N = np.random.default_rng(seed), len(case.X)
    out = []
    for _ in range(draws):
        s = case.scatter(np.convolve(rng.standard_normal(N), np.ones(memory), "same"))
        out.append(p_values(s, common or common_scatter([s])))
    return np.array(out)


ACTIVE = np.repeat([1, 2, 3, 5, 10, 20, 40], 6)


def is_within(p, level, factor):
    """Whether the share of p-values below a level is it within a factor, by more than chance."""
    low, high = stats.binom.ppf([1e-4, 1 - 1e-4], p.size, [level / factor, level * factor])
    return low <= np.sum(p < level) <= high


@pytest.mark.parametrize("m", [1, 3])
def test_white_noise_is_beyond_chance_as_often_as_it_says_in_any_number_of_blocks(m):
    p = np.concatenate([drawn(Case(k, ACTIVE, m), 40, k) for k in range(5)])
    for active in np.unique(ACTIVE):
        some = p[:, active == ACTIVE]
        for level in (0.05, 0.01):
            assert is_within(some, level, 1.6), (active, level, np.mean(some < level))
    assert is_within(p, 1e-3, 2)
    assert np.sum(p < 1e-5) <= 3  # of 8400


def test_without_others_few_blocks_are_no_more_often_beyond_chance():
    """With B - 1 degrees of freedom one block of white noise is beyond 1 % in 9 cases of 10."""
    p = np.concatenate([drawn(Case(k, ACTIVE), 40, k, common=OWN) for k in range(5)])
    for active in np.unique(ACTIVE):
        some = p[:, active == ACTIVE]
        assert np.mean(some < 0.01) < 0.015, active
    assert is_within(p[:, ACTIVE >= 20], 0.01, 1.6)


def test_what_acts_in_one_block_alone_is_known_only_by_what_it_borrows():
    G, a = np.zeros((B, 1, 1, 1)), np.zeros((B, 1, 1))
    G[7], a[7] = 25.0, 60.0  # 12 std of a noise of 1
    blocks = make_blocks(G, np.zeros((B, P, 1, 1)))
    s = scatter_of(blocks, a, np.ones(1), np.zeros((1, 1)))
    assert blocks.freedom[0] == 0
    assert p_values(s, OWN)[0] == 1
    d = 30.0
    t = 2 * stats.t.sf(12.0 / np.sqrt(2.0), d)
    assert p_values(s, Common(d, 2.0))[0] == pytest.approx(t, rel=1e-9)


def test_equal_blocks_make_a_test_of_student():
    rng = np.random.default_rng(3)
    k, x = 7, rng.standard_normal(7)
    blocks = make_blocks(np.ones((k, 1, 1, 1)), np.zeros((k, 0, 1, 1)))
    assert blocks.freedom[0] == pytest.approx(k - 1)
    (p,) = p_values(scatter_of(blocks, x.reshape(k, 1, 1), np.ones(1), np.zeros((1, 1))), OWN)
    assert p == pytest.approx(stats.ttest_1samp(x, 0).pvalue, rel=1e-9)


def test_equal_blocks_make_a_test_of_hotelling():
    k, m = 12, 3
    x = np.random.default_rng(4).standard_normal((k, m))
    G = np.broadcast_to(np.eye(m), (k, 1, m, m))
    s = scatter_of(make_blocks(G, np.zeros((k, 0, 1, m))), x[:, None], np.ones(1), np.zeros((1, m)))
    mean, cov = x.mean(axis=0), np.cov(x.T) / k
    T2 = mean @ np.linalg.solve(cov, mean)
    expected = stats.f.sf(T2 * (k - m) / ((k - 1) * m), m, k - m)
    assert p_values(s, OWN)[0] == pytest.approx(expected, rel=1e-9)


def test_the_scatter_of_white_noise_is_one_on_average():
    """Whatever the free parameters take, and however unequal blocks are (CR2)."""
    case = Case(5, ACTIVE[12:], 2)
    rng = np.random.default_rng(6)
    each = [case.scatter(rng.standard_normal(len(case.X))) for _ in range(300)]
    D = np.mean([s.D for s in each], axis=0)
    std = np.std([s.D for s in each], axis=0) / np.sqrt(len(each))
    assert np.all(np.abs(D - np.eye(2)) < 4.5 * std + 0.01)
    trace = np.array([np.trace(s.D, axis1=1, axis2=2) / 2 for s in each])
    f = each[0].blocks.trace_freedom
    np.testing.assert_allclose(2 / trace.var(axis=0), f, rtol=0.5)


def test_what_candidates_have_in_common_is_found():
    rng = np.random.default_rng(7)
    case = Case(8, np.full(200, 20))
    s = case.scatter(rng.standard_normal(len(case.X)))
    f = s.blocks.trace_freedom
    d, s2 = 9.0, 3.0
    D = s2 * stats.f.rvs(f, d, random_state=9)
    found = common_scatter([replace(s, D=D[:, None, None])])
    assert found.square == pytest.approx(s2, rel=0.3)
    assert 5 < found.freedom < 18
    same = common_scatter([replace(s, D=(stats.chi2.rvs(f, random_state=1) / f)[:, None, None])])
    assert same.freedom > 100


def test_a_noise_with_memory_is_taken_for_no_effect():
    """It is shorter than a block; a noise model that took it for white would be far too sure."""
    cases = [Case(k, ACTIVE) for k in range(5)]
    p = np.concatenate([drawn(c, 40, k, memory=6) for k, c in enumerate(cases)])
    assert np.mean(p < 0.01) < 0.02
    assert np.mean(p < 1e-4) < 1e-3
    sure = np.concatenate([drawn(c, 10, k, 6, Common(1e9, 1.0)) for k, c in enumerate(cases)])
    assert np.mean(sure < 0.01) > 0.1


def test_scaling_and_mixing_sizes_changes_no_chance_and_carries_the_covariance():
    rng = np.random.default_rng(10)
    case = Case(11, [10, 40], 2)
    e = rng.standard_normal(len(case.X))
    s = case.scatter(e)
    M = np.array([[2.0, 0.3], [0.0, -1e3]])
    G = np.swapaxes(M, 0, 1) @ case.G @ M
    own = case.X.reshape(len(case.X), -1, 2) @ M
    Z = np.stack([np.einsum("np,njm->pjm", case.Q[r], own[r]) for r in case.rows])
    a = np.stack(
        [np.einsum("n,njm->jm", (e - case.Q @ (case.Q.T @ e))[r], own[r]) for r in case.rows]
    )
    mixed = scatter_of(make_blocks(G, Z), a, s.variance, s.signs)
    common = Common(12.0, 2.0)
    np.testing.assert_allclose(p_values(mixed, common), p_values(s, common), rtol=1e-6)
    back = M @ covariance(mixed, common) @ M.T
    np.testing.assert_allclose(back, covariance(s, common), rtol=1e-6, atol=1e-12)


def test_a_size_with_one_sign_is_tested_on_that_side():
    case = Case(12, [40])
    e = np.random.default_rng(13).standard_normal(len(case.X)) + 0.1 * case.X[:, 0]
    both, right, wrong = (p_values(case.scatter(e, sign), OWN)[0] for sign in (0, 1, -1))
    assert right == pytest.approx(both / 2)
    assert wrong == 1


def test_a_size_that_no_sample_feels_has_no_chance_to_be_named():
    G, Z = np.zeros((B, 1, 1, 1)), np.zeros((B, P, 1, 1))
    s = scatter_of(make_blocks(G, Z), np.zeros((B, 1, 1)), np.ones(1), np.zeros((1, 1)))
    assert p_values(s, Common(1e4, 1.0))[0] == 1
