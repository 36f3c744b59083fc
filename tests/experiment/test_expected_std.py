"""What an experiment is expected to tell is what simulated records of it tell."""

from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest
from records_cases import FREE, HORIZON, KNOWN, NOISE, pendulum, record

from identification.discovery.nominal_model import NominalModel
from identification.experiment.design import design
from identification.experiment.hypotheses import fitted, separations, shares_after
from identification.experiment.limits import limits_of
from identification.experiment.playing import stage_of
from identification.windows.fit import solve
from identification.windows.problem import no_moves

SECONDS, RUNS = 3.0, 16


@cache
def known():
    """The pendulum, fitted to a short record, and the log."""
    log = record(seed=1, samples=120, values={"J": 2e-3}, plant=pendulum())
    return fitted("the model", 1.0, NominalModel(pendulum(), FREE, KNOWN, HORIZON), [log]), log


@cache
def stage(form="auto"):
    h, log = known()
    return stage_of(h.plant, log, partial(limits_of, h.plant.model, h.plant.axes, [log], widen=0.5),
                    SECONDS, form)  # fmt: skip


@cache
def designed(form="auto"):
    return design(stage(form), [known()[0]], budget=10, seed=1)


def test_records_of_the_design_scatter_as_expected():
    h = known()[0]
    found = designed()
    log, rng, q = found.best.played.log, np.random.default_rng(0), []
    noisy = h.scale / NOISE  # the fit's error, of which the std are, over the noise that is added
    for _ in range(RUNS):
        y = log.outputs + NOISE * noisy * rng.standard_normal(log.outputs.shape)
        task = h.task(replace(log, outputs=y), found.stage.plant)
        q.append(solve(task, h.fit.q, no_moves(task), most=4).q)
    alone = np.linalg.inv(found.best.seen[0].information + np.diag(1 / KNOWN**2))
    ratio = np.std(q, axis=0, ddof=1) / np.sqrt(np.diag(alone))
    assert np.all((ratio > 0.6) & (ratio < 1.6))  # of 16 runs the std is known to 18 %


def test_the_design_beats_a_random_input_of_the_same_limits_and_what_was_known():
    found = designed()
    assert found.best.value > found.random.value
    assert np.all(found.best.std < found.before)


@pytest.mark.parametrize("form", ["inputs", "reference"])
def test_the_simulated_experiment_keeps_every_limit(form):
    played, limits = designed(form).best.played, stage(form).limits
    q, u = played.qpos[:, 0], played.log.inputs[:, 0]
    assert limits.positions[0].low <= q.min() < q.max() <= limits.positions[0].high
    assert np.abs(played.qvel).max() <= limits.speeds[0].high
    assert limits.inputs[0].low <= u.min() < u.max() <= limits.inputs[0].high
    assert played.margins[0].share == min(m.share for m in played.margins)
    if form == "reference":
        q_d = played.aim[0][:, 0]
        assert np.abs(q - q_d).max() < 0.1 * np.ptp(q_d)  # the controller follows


def test_the_std_is_that_of_states_and_values_together():
    """A lockstep with one large least-squares problem, without a projection."""
    h, found = known()[0], designed()
    seen, task = found.best.seen[0], h.task(found.best.played.log, found.stage.plant)
    (t,) = task.tangents(h.fit.q, no_moves(task))
    W, m, p = t.S.shape
    X = np.einsum("wmk,wk,wkx->wmx", t.U, t.s, t.Vt)
    A = np.zeros((W * m, p + W * X.shape[2]))
    A[:, :p] = t.S.reshape(-1, p)
    for w in range(W):
        A[w * m : (w + 1) * m, p + w * X.shape[2] : p + (w + 1) * X.shape[2]] = X[w]
    dense = np.linalg.pinv(A.T @ A, rcond=1e-14)[:p, :p]
    assert np.allclose(np.linalg.inv(seen.information), dense, rtol=1e-4)


@cache
def rivals():
    """The pendulum with one more friction or another, either fitted to the same record."""
    log, scale, out = known()[1], known()[0].scale, []
    for name in ("coulomb_friction.f_c@hinge", "quadratic_friction.c@hinge"):
        plant = pendulum().with_values({name: 1e-3})
        model = NominalModel(plant, (*FREE, name), np.append(KNOWN, 1.0), HORIZON)
        out.append(fitted(name, 0.5, model, [log], scale))
    return out


def test_what_a_rival_cannot_imitate_is_the_rest_of_one_large_fit():
    log = designed().best.played.log
    right, wrong = (h.seen(log, stage().plant.with_values(h.values)) for h in rivals())
    λ = separations([right, wrong])
    n, p = wrong.readings, wrong.S.shape[2]
    r = np.zeros_like(wrong.r)
    r[:, :n] = wrong.r[:, :n] - right.r[:, :n]
    W, m, k = wrong.U.shape
    A = np.zeros((W * m + p, p + W * k))
    A[: W * m, :p] = wrong.S.reshape(-1, p)
    for w in range(W):
        A[w * m : (w + 1) * m, p + w * k : p + (w + 1) * k] = wrong.U[w]
    A[W * m :, :p] = np.linalg.cholesky(wrong.of.known).T
    y = np.append(r.ravel(), np.zeros(p))
    x = np.linalg.lstsq(A, y, rcond=None)[0]
    assert λ[0, 1] == pytest.approx(float(np.sum((y - A @ x) ** 2)), rel=1e-4)
    assert right.against(right) == 0
    assert λ[1, 0] > 0


def test_a_design_for_rivals_separates_them_better_than_a_random_one():
    found = design(stage(), rivals(), budget=8, seed=0)
    assert found.best.value >= found.random.value > 0
    assert np.all(found.shares_after >= found.shares)


def test_expected_shares_of_two_are_those_of_their_odds():
    λ = np.array([[np.inf, 6.0], [2.0, np.inf]])
    after = shares_after((0.7, 0.3), λ)
    assert after == pytest.approx([1 / (1 + 3 / 7 * np.exp(-3.0)), 1 / (1 + 7 / 3 * np.exp(-1.0))])
