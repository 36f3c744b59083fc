"""The smooth force is a yardstick: it finds what is there, and little where nothing is."""

import numpy as np
import pytest

from identification.discovery.forces.smooth_force import (
    FOLDS,
    explained_share,
    find_smooth_force,
)

N, NODES, BLOCKS = 2000, 8, 40


def columns(seed):
    """Hats over a rate and over a position of a motion."""
    rng = np.random.default_rng(seed)
    t = np.arange(N) / 100
    q = sum(np.sin(t * w + p) for w, p in rng.uniform(0.3, 6, (4, 2)))
    out = []
    for x in (np.gradient(q, t), q):
        at = np.quantile(x, np.linspace(0, 1, NODES))
        out.append(np.array([np.interp(x, at, row) for row in np.eye(NODES)]).T)
    return np.gradient(q, t), q, np.hstack(out)


def condensed(S, e):
    rows = np.array_split(np.arange(N), BLOCKS)
    return np.array([S[r].T @ S[r] for r in rows]), np.array([S[r].T @ e[r] for r in rows])


@pytest.mark.parametrize("seed", range(4))
def test_a_force_of_the_rate_is_found_as_one(seed):
    v, _, S = columns(seed)
    rng = np.random.default_rng(seed)
    force = np.tanh(v) + 0.3 * v
    e = force + 0.5 * rng.standard_normal(N)
    found = find_smooth_force(*condensed(S, e), (NODES, NODES))
    power = float(force @ force)
    assert found.gain == pytest.approx(power, rel=0.1)
    np.testing.assert_allclose(S @ found.c, force, atol=0.35)


def test_white_noise_gives_nothing_to_explain():
    """Sixteen free numbers take sixteen squares of the noise of samples they are fitted to."""
    gains = []
    for seed in range(30):
        _, _, S = columns(seed)
        e = np.random.default_rng(seed).standard_normal(N)
        gains.append(find_smooth_force(*condensed(S, e), (NODES, NODES)).gain)
    assert min(gains) >= 0
    assert np.mean(gains) < 2.5


def test_it_explains_what_it_says_of_samples_it_has_not_seen():
    """The gain is that of ridge regressions over all folds but one, each made from the samples."""
    v, _, S = columns(5)
    e = 0.5 * v + np.random.default_rng(5).standard_normal(N)
    found = find_smooth_force(*condensed(S, e), (NODES, NODES))
    rows = np.array_split(np.arange(N), BLOCKS)
    folds = [np.concatenate([rows[b] for b in f]) for f in np.array_split(np.arange(BLOCKS), FOLDS)]
    has = np.repeat(np.isfinite(found.ridges), NODES)
    h = np.repeat([np.mean(np.sum(own**2, axis=0)) for own in np.hsplit(S, 2)], NODES)
    R = np.diag(np.sqrt((np.repeat(found.ridges, NODES) * h)[has]))
    X, left = S[:, has], 0.0
    for f in folds:
        rest = np.delete(np.arange(N), f)
        A, y = np.vstack([X[rest], R]), np.append(e[rest], np.zeros(len(R)))
        left += np.sum((e[f] - X[f] @ np.linalg.lstsq(A, y, rcond=None)[0]) ** 2)
    assert found.gain == pytest.approx(float(e @ e) - left, rel=1e-6)


def test_units_of_forces_and_of_errors_change_no_share():
    v, _, S = columns(6)
    e = v + np.random.default_rng(6).standard_normal(N)
    one = find_smooth_force(*condensed(S, e), (NODES, NODES))
    scale = np.repeat([1e-3, 50.0], NODES)
    two = find_smooth_force(*condensed(S * scale, 7 * e), (NODES, NODES))
    assert two.gain == pytest.approx(49 * one.gain, rel=1e-6)
    np.testing.assert_allclose(two.c * scale, 7 * one.c, rtol=1e-3, atol=1e-9)


def test_nodes_that_no_sample_feels_have_no_force():
    v, _, S = columns(7)
    S = np.hstack([S, np.zeros((N, NODES))])
    found = find_smooth_force(*condensed(S, v), (NODES, NODES, NODES))
    assert not found.c[-NODES:].any()
    assert found.gain == pytest.approx(float(v @ v), rel=1e-2)


def test_a_law_that_is_right_leaves_nothing_to_a_force_and_a_neighbour_does():
    """Of Coulomb friction a viscous one explains a part, and a curve of the rate the rest."""
    v, _, S = columns(8)
    e = np.sign(v) + 0.1 * np.random.default_rng(8).standard_normal(N)
    shares = []
    for law in (np.sign(v), v):
        left = e - law * (law @ e) / (law @ law)
        gain = find_smooth_force(*condensed(S, left), (NODES, NODES)).gain
        shares.append(explained_share(float(e @ e), float(left @ left), gain))
    assert shares[0] > 0.99
    assert shares[1] < 0.9
