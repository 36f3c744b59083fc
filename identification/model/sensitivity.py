"""Sensitivities of the predicted outputs, all columns in one batch of simulations.

    ∂ŷ/∂q_j ≈ (ŷ(q + h e_j) - ŷ(q - h e_j))/(2 h)       central, 2 p simulations
    ∂ŷ/∂q_j ≈ (ŷ(q + h e_j) - ŷ(q))/h                   forward, p simulations where ŷ(q) is known

Central differences err by h² ŷ‴/6 and by round-off over h: for a smooth simulation both stay near
1e-8 at h = 1e-4. Forward ones err by h ŷ″/2 instead: at h = 1e-6 by 1e-6, which turns a search by
nothing that its next step does not correct, for half the price. What is reported of a fit rests on
central ones.

A simulation need not be smooth: where friction is nearly a jump, ŷ itself is rough by some ε, and
central differences err by ε/(√2 h). How much they do is seen at twice the step:

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
    """∂ŷ/∂q of the predicted outputs by central differences, from 2 p simulations.

    Args:
        predictor: of the outputs.
        space: coordinates of the p free parameters; see `coordinates`.
        q: where, shape (p,), in these coordinates.
        samples: how many of the log's samples are predicted; all when None.
        step: h, of q.

    Returns:
        Shape (samples, ny, p), in the outputs' units per unit of q.

    Raises:
        InputError: a start of one of the simulations is none that the plant can have.
        DivergenceError: a simulation left the finite numbers.
    """
    return _central(predictor, space, q, (step,), samples)[0]


def two_sensitivities(
    predictor: Predictor, space: Coordinates, q: np.ndarray, step: float = STEP
) -> tuple[np.ndarray, np.ndarray]:
    """∂ŷ/∂q at a step and at twice the step, each (N, ny, p), from 4 p simulations in one batch.

    The first is that of `sensitivity` to the last bit; the second less the first estimates its
    error.
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
    """Central differences at each of some steps, all in one batch."""
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
    step: float = FORWARD_STEP,
) -> np.ndarray:
    """∂ŷ/∂q, shape (samples, ny, p), from p simulations and what is `predicted` at q already.

    Args:
        predictor: of the outputs.
        space: coordinates of the parameters.
        q: where, shape (p,).
        predicted: ŷ(q), shape (samples, ny).
        step: h, of q.
    """
    values = space.decode(q + step * np.eye(len(q)))
    ahead = predictor.predict(values, len(predicted))
    return np.moveaxis((ahead - predicted) / step, 0, -1)


def without_effect(J: np.ndarray, outputs: np.ndarray) -> np.ndarray:
    """Which columns of J (samples, ny, p) are nothing but round-off of the outputs, shape (p,)."""
    size = np.abs(outputs).max(axis=0)
    return (np.abs(J).max(axis=0) <= ROUND_OFF * size[:, None]).all(axis=0)


def refuse_without_effect(J: np.ndarray, names: tuple[str, ...], log: Log) -> None:
    """Refuse parameters that no output feels: a fit would stop at once and say it converged.

    Args:
        J: sensitivities, shape (samples, ny, p).
        names: the parameters.
        log: what was measured.

    Raises:
        InputError: a column is zero but for round-off.
    """
    dead = [n for n, idle in zip(names, without_effect(J, log.outputs), strict=True) if idle]
    first, *others = log.output_names
    seen = f"{first} … {others[-1]}" if others else first
    if dead:
        raise InputError(
            f"{', '.join(dead)} ha{'s' if len(dead) == 1 else 've'} no effect on"
            f" {seen}; leave it fixed, or check where it goes in the model"
        )
