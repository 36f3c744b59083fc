"""Fits by moments of blocks are those of all equations, and their std forget no correlation."""

import math

import numpy as np
import pytest
from numba import njit
from torque_cases import planar_record, planar_robot

from identification.torques.candidates import list_missing
from identification.torques.equations.base import find_base
from identification.torques.equations.equations import Equations, estimate, unseen_squares
from identification.torques.equations.others import Others
from identification.torques.equations.rows import make_rows
from identification.torques.fits import base_fit, model_fit
from identification.torques.laws import along
from identification.torques.scores import rank

NV, P, W = 2, 3, np.array([2.0, 0.5])


@pytest.fixture(scope="module")
def some():
    """Moments of random columns, with the columns."""
    rng = np.random.default_rng(0)
    X = rng.normal(size=(NV, 12, 30, P))  # joints, blocks, equations
    y = X @ np.array([1.0, -2.0, 0.5]) + rng.normal(size=X.shape[:3])
    both = np.concatenate([X, y[..., None]], axis=3)
    return X, y, np.swapaxes(both, 2, 3) @ both


PRIOR, MEAN = np.array([0.1, 5.0, 0.0]), np.array([1.0, 0.0, 3.0])
NONE = np.zeros(12, bool)


def ridge(X, y, keep, w=W):
    rows = (w[:, None, None, None] ** 0.5 * X)[:, keep].reshape(-1, P)
    right = (w[:, None, None] ** 0.5 * y)[:, keep].ravel()
    rows = np.vstack([rows, np.diag(np.sqrt(PRIOR))])
    return np.linalg.lstsq(rows, np.append(right, np.sqrt(PRIOR) * MEAN), rcond=None)[0]


def test_a_fit_is_least_squares_of_equations_and_priors(some):
    X, y, M = some
    found = estimate(M, np.full((NV, 12), 30.0), PRIOR, MEAN)
    np.testing.assert_allclose(found.θ, ridge(X, y, ~NONE, found.weights), rtol=1e-9)


@pytest.mark.parametrize("confirm", [0, 4])
def test_blocks_are_predicted_by_fits_that_did_not_see_them(some, confirm):
    X, y, M = some
    confirms = np.arange(12) >= 12 - confirm
    found = unseen_squares(M, W, PRIOR, MEAN, confirms)
    n = 12 - confirm
    folds = np.arange(n) * min(10, n) // n
    for b in range(12):
        keep = ~confirms & np.append(folds != (folds[b] if b < n else -1), NONE[n:])
        θ = ridge(X, y, keep)
        np.testing.assert_allclose(found[:, b], ((y - X @ θ)[:, b] ** 2).sum(axis=1), rtol=1e-8)


def test_equations_that_are_written_twice_are_worth_no_more(some):
    X, y, _ = some
    stds = []
    for times in (1, 4):
        both = np.repeat(np.concatenate([X, y[..., None]], axis=3), times, axis=2)
        M = np.swapaxes(both, 2, 3) @ both
        found = estimate(M, np.full((NV, 12), 30.0 * times), 0 * PRIOR, MEAN)
        stds.append(found.std)
    np.testing.assert_allclose(stds[0], stds[1], rtol=1e-6)


def test_units_of_a_column_do_not_matter(some):
    _, _, M = some
    scale = np.array([1e3, 1e-4, 1.0, 1.0])
    found = [estimate(m, np.full((NV, 12), 30.0), 0 * PRIOR, MEAN)
             for m in (M, M * scale[:, None] * scale)]  # fmt: skip
    np.testing.assert_allclose(found[0].θ, found[1].θ * scale[:3], rtol=1e-7)
    np.testing.assert_allclose(found[0].std, found[1].std * scale[:3], rtol=1e-6)


def _force(equations):
    return equations.stacked("drives").sum(axis=2)


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    return planar_robot(tmp_path_factory.mktemp("arm"), planar_record(1), planar_record(2))


@pytest.fixture(scope="module")
def equations(robot):
    return Equations.of(make_rows(robot.plant.model, (robot.log, *robot.others)))


@pytest.fixture(scope="module")
def candidates(robot, equations):
    return list_missing(
        robot.plant.model, equations, _force(equations), robot.candidates, robot.plant.bodies, []
    )


def test_laws_on_arrays_are_those_at_each_state(robot, equations):
    from identification.native.joints.joint_callback import Joint

    rng = np.random.default_rng(3)
    arrays = [rng.normal(size=8) for _ in range(5)]
    states = Joint(*arrays, np.sign(arrays[2]), 0.1, 0.5, 2.0, 3.0, 20.0)
    laws = [e for e in robot.candidates if {*e.hooks} & {"force", "friction"} and not e.is_curve]
    assert len(laws) > 15
    for effect in laws:
        (hook,) = effect.hooks
        p = (*(0.3 for _ in effect.sizes), *(s.at_first for s in effect.shapes))
        found = along(effect.hooks[hook], states, p)
        for k in range(8):
            one = Joint(*(x[k] for x in arrays), np.sign(arrays[2][k]), 0.1, 0.5, 2.0, 3.0, 20.0)
            assert found[k] == pytest.approx(effect.hooks[hook].py_func(one, p), rel=1e-12)


def rubbing(s, p):
    """A law as a user writes it, with a function that takes one number at a time."""
    return p[0] * math.tanh(s.v / 0.1) * math.exp(-s.q * s.q)


def test_laws_may_call_functions_of_single_numbers():
    from identification.native.joints.joint_callback import Joint

    q, v = np.random.default_rng(4).normal(size=(2, 8))
    rest = (0.0,) * 3 + (0.1, 0.5, 2.0, 3.0, 20.0)
    found = along(njit(rubbing), Joint(0.0, q, v, *rest), (0.4,))
    np.testing.assert_allclose(found, 0.4 * np.tanh(v / 0.1) * np.exp(-q * q), rtol=1e-12)


def others(equations):
    """No free parameters beside those of inertia."""
    return Others.of((), equations, ())


def test_a_size_is_that_of_a_fit_with_its_column(robot, equations, candidates):
    base = model_fit(robot.plant.model, equations, (), others(equations)).base
    scores = rank(equations, base, candidates)
    used = equations.stacked("used")
    w = np.where(used, np.sqrt(base.fit.weights), 0.0)
    for score in [s for s in scores if s.missing.name in ("payload", "gain", "stiffness")]:
        X = np.concatenate([base.Φ, score.missing.columns().values], axis=2)
        rows = np.vstack(
            [
                (X * w[..., None]).reshape(-1, X.shape[2]),
                np.eye(base.Φ.shape[2], X.shape[2]) * np.sqrt(base.P)[:, None],
            ]
        )
        right = np.append((base.y * w).ravel(), np.sqrt(base.P) * base.θ_0)
        θ = np.linalg.lstsq(rows, right, rcond=None)[0]
        np.testing.assert_allclose(score.size, θ[base.Φ.shape[2] :], rtol=1e-5)


def test_what_the_fit_has_is_no_candidate(robot, equations, candidates):
    base = model_fit(robot.plant.model, equations, (), others(equations)).base
    names = {s.missing.name for s in rank(equations, base, candidates)}
    assert {"coulomb_friction", "offset"} <= {c.name for c in candidates}
    assert not {"coulomb_friction", "offset"} & names
    model = robot.plant.model
    whole = base_fit(model, equations, find_base(model), others(equations)).base
    assert "payload" not in {s.missing.name for s in rank(equations, whole, candidates)}
