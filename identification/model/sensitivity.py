"""Sensitivities of the predicted outputs, all columns in one batch of simulations.

    ∂ŷ/∂q_j ≈ (ŷ(q + h e_j) - ŷ(q - h e_j))/(2 h)       central, 2 p simulations
    ∂ŷ/∂q_j ≈ (ŷ(q + h e_j) - ŷ(q))/h                   forward, p simulations where ŷ(q) is known

The error of central differences is h² ŷ‴/6, and round-off divided by h: for a smooth simulation
both stay near 1e-8 at h = 1e-4. The error of forward differences is h ŷ″/2, which is 1e-6 at h =
1e-6. This is good enough for a search, whose next step corrects it, and costs half as much. What is
reported of a fit is computed from central differences.

A simulation need not be smooth: where friction is nearly a jump, ŷ itself is rough by some ε, and
the error of central differences is ε/(√2 h). A second computation at twice the step shows the
error:

    ∂ŷ/∂q_j|_2h - ∂ŷ/∂q_j|_h        3 times the error h² ŷ‴/6 of the shorter step, or
                                    1.1 times its error ε/(√2 h) where ŷ is rough
"""

from __future__ import annotations

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor

STEP = 1e-4  # of q: relative for a logarithmic coordinate, m or rad for another
FORWARD_STEP = 1e-6  # of q, as above
ROUND_OFF = 1e-9  # of an output: differences of two simulations, over the step, err by this


def sensitivity(
    predictor: Predictor,
    space: Coordinates,
    q: np.ndarray,
    samples: int | None = None,
    step: float = STEP,
) -> np.ndarray:
    """Returns ∂ŷ/∂q of the predicted outputs by central differences, from 2 p simulations.

    Args:
        predictor: predicts the outputs.
        space: coordinates of the p free parameters; see `coordinates`.
        q: the point, shape (p,), in these coordinates.
        samples: how many of the log's samples are predicted; all when None.
        step: h, the step of q.

    Returns:
        Shape (samples, ny, p), in the outputs' units per unit of q.

    Raises:
        InputError: the plant cannot start with the values of one of the simulations.
        DivergenceError: a simulation left the finite numbers.
    """
    return _central(predictor, space, q, (step,), samples)[0]


def two_sensitivities(
    predictor: Predictor, space: Coordinates, q: np.ndarray, step: float = STEP
) -> tuple[np.ndarray, np.ndarray]:
    """Returns ∂ŷ/∂q at a step and at twice the step, each (N, ny, p), from 4 p simulations at once.

    The first is the result of `sensitivity`, to the last bit. The difference between the second and
    the first estimates its error.
    """
    once, twice = _central(predictor, space, q, (step, 2 * step), None)
    return once, twice


def _central(
    predictor: Predictor,
    space: Coordinates,
    q: np.ndarray,
    steps: tuple[float, ...],
    samples: int | None,
) -> list[np.ndarray]:
    """Returns central differences at each of some steps, all in one batch."""
    moves = [step * np.eye(len(q)) for step in steps]
    values = space.decode(np.concatenate([q + sign * move for move in moves for sign in (1, -1)]))
    runs = np.split(predictor.predict(values, samples), 2 * len(steps))
    return [
        np.moveaxis((ahead - behind) / (2 * step), 0, -1)
        for step, ahead, behind in zip(steps, runs[::2], runs[1::2], strict=True)
    ]


def forward_sensitivity(
    predictor: Predictor,
    space: Coordinates,
    q: np.ndarray,
    predicted: np.ndarray,
) -> np.ndarray:
    """Returns ∂ŷ/∂q (samples, ny, p) at q (p,), from p simulations and ŷ(q), (samples, ny)."""
    values = space.decode(q + FORWARD_STEP * np.eye(len(q)))
    ahead = predictor.predict(values, len(predicted))
    return np.moveaxis((ahead - predicted) / FORWARD_STEP, 0, -1)


def without_effect(J: np.ndarray, outputs: np.ndarray) -> np.ndarray:
    """Returns which columns of J (samples, ny, p) are only round-off of the outputs, shape (p,)."""
    size = np.abs(outputs).max(axis=0)
    return (np.abs(J).max(axis=0) <= ROUND_OFF * size[:, None]).all(axis=0)


def refuse_without_effect(J: np.ndarray, names: tuple[str, ...], log: Log) -> None:
    """Refuse parameters whose sensitivities J (samples, ny, p) say that no output feels them.

    A fit of them would stop at once and report convergence.
    """
    dead = [n for n, idle in zip(names, without_effect(J, log.outputs), strict=True) if idle]
    first, *others = log.output_names
    seen = f"{first} … {others[-1]}" if others else first
    if dead:
        raise InputError(
            f"{', '.join(dead)} ha{'s' if len(dead) == 1 else 've'} no effect on"
            f" {seen}; leave it fixed, or check where it goes in the model"
        )
