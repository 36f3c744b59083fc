"""Sets of effects: as an exhaustive search finds them, by blocks that no size was fitted to."""

from itertools import combinations

import numpy as np
import pytest

from identification.discovery.set_selection import folded, select_set

BLOCKS, SAMPLES = 20, 30


def problem(S, e, counts=None, signs=None, alike=None):
    """Columns of a residual e (N,) and sensitivities S (N, k), each a candidate unless told."""
    k = S.shape[1]
    parts = np.array_split(np.arange(len(e)), BLOCKS)
    G = np.array([S[p].T @ S[p] for p in parts])
    a = np.array([S[p].T @ e[p] for p in parts])
    counts = counts or [1] * k
    words = alike or [str(j) for j in range(len(counts))]
    free = np.zeros(k) if signs is None else np.asarray(signs, float)
    return folded(G, a, counts, words, free, np.full(k, 1e6))


def columns(rng, k):
    return rng.standard_normal((BLOCKS * SAMPLES, k))


def test_gains_are_those_of_fits_to_the_other_folds():
    rng = np.random.default_rng(1)
    S, e = columns(rng, 3), rng.standard_normal(BLOCKS * SAMPLES)
    found = problem(S, e).gains([(0, 2)])[0]
    blocks = np.array_split(np.arange(len(e)), BLOCKS)
    folds = [np.concatenate([blocks[b] for b in f]) for f in np.array_split(np.arange(BLOCKS), 10)]
    A = S[:, [0, 2]]
    for gain, f in zip(found, folds, strict=True):
        others = np.setdiff1d(np.arange(len(e)), f)
        size = np.linalg.lstsq(A[others], e[others], rcond=None)[0]
        assert gain == pytest.approx(e[f] @ e[f] - np.sum((e[f] - A[f] @ size) ** 2), rel=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_the_set_is_the_one_that_an_exhaustive_search_finds(seed):
    rng = np.random.default_rng(seed)
    k = 8
    S = columns(rng, k) @ (np.eye(k) + 0.4 * rng.standard_normal((k, k)))  # alike by chance
    true = rng.choice(k, 3, replace=False)
    e = S[:, true] @ rng.uniform(0.5, 1.5, 3) + 0.5 * rng.standard_normal(len(S))
    known = problem(S, e)
    best = max(combinations(range(k), 3), key=lambda some: known.gains([some]).sum())
    assert set(select_set(known, 3)) == set(best) == set(true)


def test_two_effects_that_hide_each_other_are_found_together():
    """Their sum explains nearly nothing of what either does: alone each gains little."""
    rng = np.random.default_rng(3)
    common = rng.standard_normal(BLOCKS * SAMPLES)
    own = 0.2 * columns(rng, 2)
    S = np.column_stack([common + own[:, 0], common + own[:, 1], columns(rng, 4)])
    e = S[:, 0] - S[:, 1] + 0.05 * rng.standard_normal(len(S))
    known = problem(S, e)
    both = known.gains([(0, 1)]).sum()
    assert max(known.gains([(j,)]).sum() for j in range(6)) < 0.1 * both
    assert set(select_set(known, 2)) == {0, 1}


@pytest.mark.parametrize("seed", range(5))
def test_each_member_gains_on_blocks_that_it_was_not_fitted_to_and_no_other_gains_more(seed):
    """Also of noise alone, and of a set that begins with what explains nothing."""
    rng = np.random.default_rng(seed)
    known = problem(columns(rng, 10), rng.standard_normal(BLOCKS * SAMPLES))

    def gain(some):
        return known.gains([some]).sum() if some else 0.0

    chosen = select_set(known, 3, members=(0, 4))
    for k in range(len(chosen)):
        rest = (*chosen[:k], *chosen[k + 1 :])
        assert gain(rest) < gain(chosen)
        assert max(gain((*rest, j)) for j in range(10)) <= gain(chosen) + 1e-9


def test_what_the_set_began_with_gives_way_to_one_of_two_names_of_what_acts():
    rng = np.random.default_rng(4)
    S = columns(rng, 5)
    S[:, 4] = S[:, 1] + 0.01 * S[:, 4]  # another name of the one that acts
    e = S[:, 1] + 0.3 * rng.standard_normal(len(S))
    assert len({1, 4} & {*select_set(problem(S, e), 2, members=(0, 3))}) == 1


def test_a_size_has_the_sign_that_physics_gives_it():
    rng = np.random.default_rng(6)
    S = columns(rng, 3)
    e = -S[:, 0] + 0.3 * S[:, 1] + 0.1 * rng.standard_normal(len(S))
    assert 0 in select_set(problem(S, e), 2)
    assert select_set(problem(S, e, signs=[1, 0, 0]), 2) == (1,)


def test_of_shapes_of_one_effect_a_set_has_one():
    rng = np.random.default_rng(7)
    S = columns(rng, 3)
    e = S[:, 0] + S[:, 1] + 0.1 * rng.standard_normal(len(S))
    assert len(select_set(problem(S, e, alike=["friction", "friction", "other"]), 3)) < 3


def test_an_effect_of_two_sizes_is_one_member():
    rng = np.random.default_rng(8)
    S = columns(rng, 4)
    e = S[:, 0] + S[:, 1] + S[:, 3] + 0.1 * rng.standard_normal(len(S))
    assert set(select_set(problem(S, e, counts=[2, 1, 1]), 2)) == {0, 2}
