"""How a search behaves: criteria, losses, horizons, interrupts."""

from dataclasses import replace

import numpy as np
import pytest
from estimation_plants import measured, record, slider

from identification import DivergenceError, InputError
from identification.estimation.estimation import Options, estimate
from identification.estimation.fit import assess
from identification.estimation.search import Search
from identification.logs.noise import whitener_of

NAMES = ("damping", "stiffness")
START = {"damping": 2.3, "stiffness": 25.0}
DET = Options(criterion="det", horizons=(1.0,), tolerance=1e-6)


def uneven(seed, scale=1.0, levels=(1e-3, 1e-1), n=80):
    """Position and rate with noise of different size; the second output in another unit."""
    log = record(slider(), ("position", "rate"), n=n)
    noise = np.random.default_rng(seed).standard_normal(log.outputs.shape) * levels
    return measured(log, log.outputs + noise)


def values(log, options):
    return np.array(list(estimate(slider(**START), log, NAMES, options=options).values.values()))


def test_det_does_not_care_about_the_unit_of_an_output():
    """V = log det Λ: Λ -> D Λ D changes the starting whitener, and not where det ends."""
    log = uneven(1)
    plain = estimate(slider(**START), log, NAMES, options=DET)
    C = np.linalg.inv(np.diag([1.0, 100.0]))  # the whitener of the same data with rate in cm/s
    error = log.outputs - plain.predictor.predict(plain.space.decode(plain.q))[0]
    one = error @ whitener_of(error).T
    other = error @ np.linalg.inv(C) @ whitener_of(error @ np.linalg.inv(C)).T
    np.testing.assert_allclose((one**2).sum(), (other**2).sum(), rtol=1e-6)
    np.testing.assert_allclose(plain.whitener, whitener_of(error), rtol=1e-4, atol=1e-2)


def test_det_equals_trace_for_noise_of_one_size():
    """Noise made exactly isotropic: then Λ ∝ I at the optimum, up to its p fitted directions."""
    log = record(slider(), ("position", "rate"), n=400)
    noise = np.random.default_rng(2).standard_normal(log.outputs.shape)
    noise = noise @ np.linalg.inv(np.linalg.cholesky(noise.T @ noise / len(noise))).T
    log = measured(log, log.outputs + 1e-3 * noise)
    trace, det = (values(log, replace(DET, criterion=c)) for c in ("trace", "det"))
    std = assess(estimate(slider(**START), log, NAMES, options=DET)).std
    assert (np.abs(trace - det) < 0.1 * std).all()


def test_trace_is_worse_than_det_where_noise_is_uneven():
    found = {
        c: np.array([values(uneven(s), replace(DET, criterion=c)) for s in range(8)])
        for c in ("trace", "det")
    }
    spread = {c: ((v - [3.0, 20.0]) ** 2).mean(axis=0) for c, v in found.items()}
    assert (spread["trace"] > 4 * spread["det"]).all(), spread


def test_a_robust_loss_survives_outliers():
    log = record(slider(), ("position",), noise=1e-3)
    y = log.outputs.copy()
    y[::17] += 0.3
    robust, plain = (values(measured(log, y), Options(loss=loss)) for loss in ("cauchy", "linear"))
    np.testing.assert_allclose(robust, [3.0, 20.0], rtol=0.02)
    assert np.abs(plain - [3.0, 20.0]).max() > 5 * np.abs(robust - [3.0, 20.0]).max()


def test_an_interrupt_keeps_the_best_so_far():
    told = []

    def interrupt(line):
        told.append(line)
        if len(told) == 4:
            raise KeyboardInterrupt

    log = record(slider(), ("position",), noise=1e-3)
    found = estimate(slider(**START), log, NAMES, options=DET, progress=interrupt)
    assert found.status == "stopped"

    def cost(v):
        return np.sum((log.outputs - found.predictor.predict(np.array([v]))[0]) ** 2)

    assert cost(list(found.values.values())) < 0.1 * cost(list(START.values()))
    assert np.isinf(assess(found).std).all()  # sensitivities were not asked


def test_a_growing_horizon_escapes_where_a_free_run_is_caught():
    """An oscillator whose frequency is far off slips whole periods: a local minimum each."""
    u = np.zeros((250, 1))
    truth = slider(x0=1.0, damping=0.05, stiffness=200.0)
    log = record(truth, ("position",), inputs=u)
    far = slider(x0=1.0, damping=0.05, stiffness=120.0)
    caught = estimate(far, log, ("stiffness",), options=Options(horizons=(1.0,)))
    grown = estimate(far, log, ("stiffness",), options=Options(horizons=(0.02, 0.1, 0.4, 1.0)))
    assert abs(caught.values["stiffness"] / 200 - 1) > 0.05
    assert grown.values["stiffness"] == pytest.approx(200.0, rel=1e-6)


@pytest.mark.parametrize("horizons", [(0.5,), (1.0, 0.5, 1.0)])
def test_horizons_that_do_not_grow_to_one_are_refused(horizons):
    with pytest.raises(InputError, match="must grow to 1"):
        Options(horizons=horizons)


def test_the_search_lives_through_values_that_cannot_be_simulated():
    """A first step of `lm` may overshoot into stiffness that no step can follow."""
    log = record(slider(stiffness=3000.0), ("position",), noise=1e-4)
    for method in ("trf", "dogbox", "lm"):
        found = estimate(
            slider(stiffness=2000.0), log, ("stiffness",), options=Options(method=method)
        )
        assert found.values["stiffness"] == pytest.approx(3000.0, rel=0.02)


HORIZONS = Options(horizons=(0.2, 1.0))


def lost_beyond(monkeypatch, stride):
    """Make a start diverge on a horizon more than `stride` samples longer than the one before."""
    solve, reached = Search.solve, [0]

    def brittle(self, samples, tolerance):
        if reached[-1] and samples > reached[-1] + stride:
            raise DivergenceError("the simulation diverged")
        status = solve(self, samples, tolerance)
        reached.append(samples)
        return status

    monkeypatch.setattr(Search, "solve", brittle)
    return reached


def test_a_late_divergence_is_walked_around(monkeypatch):
    log = record(slider(), ("position",), n=200)
    reached = lost_beyond(monkeypatch, 80)
    found = estimate(slider(), log, ("stiffness",), {"stiffness": 25.0}, HORIZONS)
    assert found.values["stiffness"] == pytest.approx(20.0, rel=1e-6)
    assert reached == [0, 40, 80, 120, 200] or np.all(np.diff(reached) > 0)
    assert len(reached) > 3
