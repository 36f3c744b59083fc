"""Fisher information against paper and against the scatter of fits."""

from dataclasses import replace

import numpy as np
import pytest
from excitation_cases import SIGMA, STEP, pushed, slider, step_sensitivity

from identification import InputError
from identification.estimation.estimation import Options, estimate
from identification.estimation.experiment import information
from identification.estimation.information import determinable

NAMES = ("mass", "damping")


def rough(seed):
    return np.random.default_rng(seed).normal(0, 5, (101, 1))


def test_the_information_is_the_one_on_paper():
    found = information(pushed(), NAMES)
    S = step_sensitivity(np.arange(101) * STEP) / SIGMA
    assert found.std == pytest.approx(np.sqrt(np.diag(np.linalg.inv(S.T @ S))), rel=1e-5)
    assert found.conditional == pytest.approx(1 / np.linalg.norm(S, axis=0), rel=1e-6)
    values = np.linalg.eigvalsh(S.T @ S)
    assert found.e_value == pytest.approx(values[0], rel=1e-5)
    assert found.d_value == pytest.approx(np.log(values).sum(), rel=1e-6)
    assert found.a_value == pytest.approx((1 / values).sum(), rel=1e-5)
    assert found.condition == pytest.approx(np.sqrt(values[1] / values[0]), rel=1e-5)


def test_a_nuisance_costs_what_the_inverse_says():
    S = step_sensitivity(np.arange(101) * STEP) / SIGMA
    found = information(pushed(), ("mass",), ("damping",))
    assert found.e_value == pytest.approx(1 / np.linalg.inv(S.T @ S)[0, 0], rel=1e-5)
    assert found.std == pytest.approx(information(pushed(), NAMES).std[:1], rel=1e-6)


def test_the_scatter_of_fits_is_the_bound():
    trial = pushed(rough(3))
    found = information(trial, NAMES)
    clean = trial.log()
    from identification.model.predictor import Predictor

    exact = Predictor(trial.plant, clean, NAMES).predict(np.array([[2.0, 3.0]]))[0]
    rng, fits = np.random.default_rng(0), []
    for _ in range(24):
        log = replace(clean, outputs=exact + rng.normal(0, SIGMA, exact.shape))
        fit = estimate(slider(), log, NAMES, options=Options(horizons=(1.0,)))
        fits.append(np.log(list(fit.values.values())))
    scatter = np.std(fits, axis=0, ddof=1)
    # The std of 24 draws is itself uncertain by 15 %.
    assert scatter == pytest.approx(found.std, rel=0.45)
    assert np.abs(np.mean(fits, axis=0) - np.log([2.0, 3.0])).max() < 4 * found.std.max() / 24**0.5


def test_what_cannot_be_told_apart_is_said_and_held():
    found = information(pushed(), ("mass", "damping", "gain"))
    assert found.e_value == 0
    assert found.d_value == -np.inf
    assert np.isinf(found.a_value)
    assert np.isinf(found.std).all()
    assert found.condition == np.inf
    kept, held = determinable(found)
    assert len(kept) == 2
    assert len(held) == 1
    assert found.about(kept).e_value > 0
    assert determinable(found.about(kept)) == (kept, ())


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: pushed(sigma=0.0), "positive"),
        (lambda: information(pushed(), ("mas",)), "did you mean"),
    ],
)
def test_bad_input_is_one_sentence(call, word):
    with pytest.raises(InputError, match=word) as caught:
        call()
    assert len(str(caught.value).splitlines()) == 1
