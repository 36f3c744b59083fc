"""Sensitivities are derivatives, and one batch of them is as good as one at a time."""

import numpy as np
from estimation_plants import STEP, record, slider
from scipy.linalg import expm

from identification.model.coordinates import coordinates
from identification.model.predictor import Predictor
from identification.model.sensitivity import sensitivity

NAMES = ("mass", "damping", "stiffness", "gear", "x0", "v0")
VALUES = np.array([2.0, 3.0, 20.0, 5.0, 0.1, 0.0])


def exact(values, u):
    """Position of m ẍ + b ẋ + k x = g u under a held input: x_{k+1} = e^{Ah} x_k + … ."""
    m, b, k, g, x0, v0 = values
    block = np.zeros((3, 3), dtype=complex)
    block[:2] = [[0, 1, 0], [-k / m, -b / m, g / m]]
    step = expm(block * STEP)
    states = [np.array([x0, v0], dtype=complex)]
    for now in u[:-1, 0]:
        states.append(step[:2, :2] @ states[-1] + step[:2, 2] * now)
    return np.array(states)[:, 0]


def test_the_slider_predicts_and_feels_as_its_equation_says():
    """The derivative of the exact solution by complex step, which has no cancellation."""
    log = record(slider(), ("position",), n=120)
    np.testing.assert_allclose(log.outputs[:, 0], exact(VALUES, log.inputs).real, atol=1e-8)
    space = coordinates(slider().parameters, NAMES, VALUES)
    q = space.encode(VALUES)
    J = sensitivity(Predictor(slider(), log, NAMES), space, q)[:, 0]
    for j in range(len(q)):
        moved = VALUES + 1j * 1e-30 * np.eye(len(q))[j] * space.slope(q)
        analytic = exact(moved, log.inputs).imag / 1e-30
        np.testing.assert_allclose(J[:, j], analytic, atol=1e-7 * np.abs(analytic).max() + 1e-9)


def test_one_batch_equals_one_by_one_to_the_last_bit():
    log = record(slider(), ("position", "rate"), n=100)
    predictor = Predictor(slider(), log, NAMES)
    sets = VALUES * np.random.default_rng(3).uniform(0.7, 1.3, (9, len(VALUES)))
    together = predictor.predict(sets)
    one_by_one = np.stack([predictor.predict(row[None])[0] for row in sets])
    np.testing.assert_array_equal(together, one_by_one)
