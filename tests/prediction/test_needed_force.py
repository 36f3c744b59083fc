"""The force that a joint would need: where it is missing, in which direction, how large."""

import numpy as np
import pytest
from bump_cases import AT, SIZE, WIDTH, push, record, rise, rub, searched

from identification.chances import mean_above_zero
from identification.prediction.verdict import needed_force
from identification.prediction.verdict.needed_force import _chance, fine_forces


def found(seed=1, model=None, **how):
    """The force on the rail that two records tell, beside how many were tried."""
    if model is None:
        _, model = searched([record(seed + k, seconds=12.0, **how) for k in range(3)])
    forces, tried = fine_forces(model.fit, tuple(model.scale.tolist()))
    (force,) = forces
    return force, tried


def top(force):
    """The direction and the place of the largest force that is known."""
    size = np.where(np.isfinite(force.std), np.abs(force.force), 0.0)
    way, k = np.unravel_index(np.argmax(size), size.shape)
    return way, k


@pytest.mark.parametrize(("law", "directions"), [(push, 1), (rub, 2), (rise, 2)])
def test_a_bump_that_is_narrower_than_the_nodes_of_a_curve_is_found(law, directions):
    force, tried = found(force=law)
    assert (force.joint, force.depends_on, tried) == ("rail", "position", 4)
    assert force.fall > 0.6
    assert force.chance < 1e-3
    way, k = top(force)
    assert abs(force.at[k] - AT) < WIDTH / 2
    assert 0.5 * SIZE < abs(force.force[way, k]) < 1.7 * SIZE
    far = np.abs(force.at - AT) > 3 * WIDTH
    assert np.all(np.abs(force.force[:, far]) < 0.2 * SIZE)
    assert len(force.force) == directions
    if directions == 2:
        rising, falling = force.force[:, k]
        assert rising < -0.5 * SIZE
        assert falling > 0.5 * SIZE if law is rub else abs(falling) < 0.3 * SIZE


def test_a_wide_force_is_smooth():
    force, _ = found(size=0.0, spring=6.0)
    assert (force.depends_on, len(force.force)) == ("position", 1)
    known = np.isfinite(force.std[0])
    x, f = force.at[known], force.force[0, known]
    k, f_0 = np.polyfit(x, f, 1)
    assert k == pytest.approx(-6.0, rel=0.15)
    assert np.sqrt(np.mean((f - np.polyval([k, f_0], x)) ** 2)) < 0.1 * np.std(f)


def test_of_what_lacks_nothing_no_force_is_told():
    force, _ = found(size=0.0)
    assert force.fall < 0.03 or force.chance > 0.01


def test_all_windows_of_a_long_record_are_not_needed(monkeypatch):
    _, model = searched([record(k, seconds=12.0) for k in (1, 2, 3)])
    whole, _ = found(model=model)
    fine_forces.cache_clear()
    samples = sum(p.cut.outputs[..., 0].size for p in model.fit.problem.parts)
    monkeypatch.setattr(needed_force, "MOST_SAMPLES", 2 * samples // 3)
    some, _ = found(model=model)
    fine_forces.cache_clear()
    assert abs(some.at[top(some)[1]] - AT) < WIDTH / 2
    assert not np.array_equal(some.force, whole.force)


def test_where_forces_have_no_linear_response_none_is_told(monkeypatch):
    _, model = searched([record(k, seconds=6.0) for k in (1, 2, 3)])
    monkeypatch.setattr(needed_force, "forces_of", lambda fit: (None,) * len(fit.moves))
    fine_forces.cache_clear()
    assert fine_forces(model.fit, (1.0,)) is None


def test_a_force_on_few_blocks_is_no_luck_though_the_others_have_nothing_to_explain():
    rng = np.random.default_rng(4)
    squares, share = np.full(40, 0.5), -10 * rng.uniform(size=40)  # of noise nothing is explained
    squares[::3], share[::3] = rng.uniform(20, 2000, 14), rng.uniform(0.9, 1.0, 14)
    assert _chance(share * squares, squares) < 0.01
    assert mean_above_zero(-np.log(1 - share))[1] > 0.1  # where each block counts by its own noise


def test_the_chance_of_luck_is_no_smaller_than_it_says():
    rng, squares = np.random.default_rng(5), np.full(40, 1.0)
    told = np.array([_chance(0.1 * rng.standard_normal(40), squares) for _ in range(2000)])
    assert np.mean(told < 0.05) < 0.05 + 3 * np.sqrt(0.05 * 0.95 / 2000)
