"""Scores are those of the slow way: every candidate under every noise, one after the other.

The whitener with which both work is that of the dense covariance (`tests/kalman`).
"""

import numpy as np
import pytest
from discovery_cases import OPTIONS, STEP, covariance, linear_plant, point_of, scored, sensitivity
from scipy.stats import kstest

from identification.estimation.block_test import (
    common_scatter,
    make_blocks,
    p_values,
    scatter_of,
)
from identification.innovations.scoring import scores as module
from identification.innovations.scoring.scores import MIN_SCORE_SAMPLES, RATIO_FACTORS
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise, build_whitener

N, NY, P = 90, 2, 4
SIGMA, PRIOR, MEAN = 1.3, np.array([0.0, 2.0, 5.0, 0.0]), np.array([7.0, 0.4, -0.3, 0.0])


def candidates(rng, J):
    """With one to three sizes and signs; some that change nothing or that the base imitates."""
    S = [(rng.standard_normal((N, NY, m)), sign) for m in (1, 2, 3) for sign in (0, 0, 1, -1)]
    S += [(np.zeros((N, NY, 1)), 0), ((J @ np.arange(P))[..., None], 0)]
    slow = np.cumsum(rng.standard_normal((N, NY, 5)), axis=0)
    S += [(slow[..., k : k + 1], 0) for k in range(5)]
    S += [(np.concatenate([slow[..., :1], 2 * slow[..., :1]], axis=2), 0)]  # twice the same
    return [sensitivity(s, sign, f"e{k}") for k, (s, sign) in enumerate(S)]


def slow_score(plant, noise, e, J, s):
    """Gain, size, std, identifiable share and noise of one candidate, and its scatter by blocks."""
    m, signs = s.S.shape[2], [size.sign for size in s.candidate.effect.sizes]
    n, found = e.size, []
    for share in RATIO_FACTORS if noise.ratio else (1.0,):
        filter_ = build_whitener(plant, noise.scaled(share), STEP)
        W = filter_(np.concatenate([e[..., None], J, s.S], axis=2)).reshape(n, -1)
        ridge = PRIOR * SIGMA
        below = np.zeros((P, 1 + P + m))
        below[:, 0], below[:, 1 : 1 + P] = ridge * MEAN, np.diag(ridge)
        W, raw = np.vstack([W, below]), np.sum(W[:, 1 + P :] ** 2)
        F, X = W[:, 1 : 1 + P], np.delete(W, np.s_[1 : 1 + P], axis=1)
        X = X - F @ np.linalg.lstsq(F.T @ F, F.T @ X, rcond=1e-14)[0]
        r, S = X[:, 0], X[:, 1:]
        H = S.T @ S
        size = np.linalg.lstsq(H, S.T @ r, rcond=1e-12)[0]
        refused = m == 1 and signs[0] * size[0] < 0
        squares = r @ r - (0.0 if refused else r @ S @ size)

        def likely(q, filter_=filter_):
            return -0.5 * (n * np.log(q / n) + filter_.log_determinant)

        found.append((likely(squares), likely(r @ r), squares, size, H, (r, S, F), raw))
    k, null = (max(range(len(found)), key=lambda i, of=of: found[i][of]) for of in (0, 1))
    likely, _, squares, size, H, *_ = found[k]
    of_null, (r, S, F) = found[null][2], found[null][5]  # chances are those under its noise
    B = min(OPTIONS.score_blocks, N // MIN_SCORE_SAMPLES)
    block = np.repeat(
        np.searchsorted(np.linspace(0, N, B, endpoint=False), np.arange(N), "right"), NY
    )
    block = np.append(block, np.full(P, B + 1))  # the priors
    Q = np.linalg.svd(F, full_matrices=False)[0]
    parts = [(r[block == b], S[block == b], Q[block == b]) for b in range(1, B + 2)]
    G = np.array([X.T @ X for _, X, _ in parts])[:, None]
    Z = np.array([q.T @ X for _, X, q in parts])[:, :, None]
    a = np.array([X.T @ e for e, X, _ in parts])[:, None]
    scatter = scatter_of(make_blocks(G, Z), a, np.array([of_null / n]), np.array([signs]))
    H = np.linalg.pinv(H, rcond=1e-12, hermitian=True)
    return {
        "gain": 2 * (likely - found[null][1]),
        "size": size,
        "std": np.sqrt(np.diag(H) * squares / n),
        "identifiable": np.trace(found[null][4]) / max(found[null][6], 1e-300),
        "ratio": noise.ratio * RATIO_FACTORS[k],
    }, scatter


@pytest.mark.parametrize("together", [2, 128])
@pytest.mark.parametrize(
    ("seed", "ratio", "missing"), [(1, 0.0, 1.0), (3, 0.5, 0.3), (5, 2.0, 10.0)]
)
def test_every_score_is_that_of_the_slow_way(seed, ratio, missing, together, monkeypatch):
    monkeypatch.setattr(module, "MAX_COLUMNS", together)
    rng = np.random.default_rng(seed)
    plant, noise = linear_plant(rng, N), Noise(ratio, 0.1)
    J = rng.standard_normal((N, NY, P))
    every = candidates(rng, J)
    e = rng.standard_normal((N, NY)) + missing * every[-3].S[..., 0]
    found = scored(point_of(plant, e, J), NoiseLevel(noise, SIGMA, 0.0), PRIOR, every, MEAN)
    assert [s.gain for s in found] == sorted((s.gain for s in found), reverse=True)
    of = {s.candidate.effect.name: s for s in found}
    slowly = [slow_score(plant, noise, e, J, one) for one in every]
    common = common_scatter([scatter for _, scatter in slowly], least=1.0)
    for one, (slow, scatter) in zip(every, slowly, strict=True):
        s = of[one.candidate.effect.name]
        slow["p_value"] = p_values(scatter, common)[0]
        if slow["identifiable"] < 1e-9 and one.S.any():  # what is left of it is rounding
            assert s.identifiable < 1e-9
            continue
        assert s.level.noise.ratio == pytest.approx(slow.pop("ratio"))
        for name, value in slow.items():
            # a difference of log likelihoods, each some hundreds, cannot be known better
            atol = 1e-9 if name == "gain" else 1e-12
            np.testing.assert_allclose(getattr(s, name), value, rtol=1e-6, atol=atol, err_msg=name)


@pytest.mark.parametrize("ratio", [0.0, 1.0])
def test_chances_are_uniform_where_nothing_is_missing(ratio):
    """Effects enter as slow forces, as missing physics does, so that colour matters."""
    rng = np.random.default_rng(8)
    samples = 160
    plant = linear_plant(rng, samples)
    noise = Noise(ratio, 0.1)
    factor = np.linalg.cholesky(covariance(plant, noise))
    t = np.arange(samples)[:, None, None]
    J = np.cos(t * rng.uniform(0, 0.3, (NY, 3)) + rng.uniform(0, 6, (NY, 3)))
    S = np.cos(t * rng.uniform(0, 0.6, (NY, 12)) + rng.uniform(0, 6, (NY, 12)))
    six = [sensitivity(S[..., k : k + 2], name=f"e{k}") for k in range(0, 12, 2)]
    p = []
    for _ in range(40):
        e = (factor @ rng.standard_normal(samples * NY)).reshape(samples, NY)
        found = scored(point_of(plant, e, J), NoiseLevel(noise, 1.0, 0.0), np.zeros(3), six)
        p += [s.p_value for s in found]
    assert kstest(p, "uniform").pvalue > 0.01
