"""Sensitivities by finite differences, and the error of each of their columns.

    S_h, d_j = max(‖(S_2h - S_h) e_j‖, round-off)       h = 1e-4, and 1e-2 if 1e-4 is not enough

A direction that is not felt at the short step (see `identification.estimation.identifiability`) has
one of two reasons. It may be a scaling symmetry; simulations prove it, and it is then removed from
S. Or the simulation is too rough for short differences; then each column is taken from the step at
which its error is smaller.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.estimation.identifiability import (
    Identifiability,
    column_errors,
    identifiability,
    unresolved_directions,
)
from identification.estimation.scaling_symmetry import ScalingSymmetry, Whiten, scaling_symmetries
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor
from identification.model.sensitivity import ROUND_OFF, STEP, two_sensitivities

# Of a second step of differences to the first, for what a simulation is too rough to tell.
LONG_STEP_RATIO = 100
RESOLVED_STEPS = (STEP, LONG_STEP_RATIO * STEP)

# at a step h: sensitivities at h and at 2 h, whitened, each of shape (n, p)
AtTwoSteps = Callable[[float], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class Resolved:
    """Whitened sensitivities and their errors."""

    names: tuple[str, ...]  # parameters, p of them
    S: np.ndarray  # shape (n, p), zero along the symmetries
    E: np.ndarray  # estimated errors of S, shape (n, p)
    least: float  # norm of the round-off error of a column
    symmetries: tuple[ScalingSymmetry, ...] = ()  # the proven symmetries

    @property
    def errors(self) -> np.ndarray:
        """Norms of the errors of the columns of S, shape (p,)."""
        return column_errors(self.E, self.least)

    @property
    def found(self) -> Identifiability:
        """The directions that the outputs feel, and those that they do not."""
        return identifiability(self.S, self.names, self.E, self.least, self.symmetries)

    @property
    def done(self) -> bool:
        """Tells whether every direction is felt or a symmetry."""
        return len(unresolved_directions(self.S, self.errors)) == len(self.symmetries)

    def better(self, S: np.ndarray, E: np.ndarray) -> Resolved:
        """Returns the same, but each column is the one with the smaller error."""
        less = np.linalg.norm(E, axis=0) < np.linalg.norm(self.E, axis=0)
        S, E = np.where(less, S, self.S), np.where(less, E, self.E)
        return Resolved(self.names, S, E, self.least).with_symmetries(self.symmetries)

    def with_symmetries(self, symmetries: tuple[ScalingSymmetry, ...]) -> Resolved:
        """Returns the same, but exactly zero along the proven symmetries."""
        if not symmetries:
            return self
        rows = np.linalg.qr(np.array([s.row(self.names) for s in symmetries]).T)[0].T
        S, E = (X - X @ rows.T @ rows for X in (self.S, self.E))
        return Resolved(self.names, S, E, self.least, symmetries)


def nothing_resolved(names: tuple[str, ...], n: int) -> Resolved:
    """Returns sensitivities that nobody computed: no direction is felt; S has the shape (n, p)."""
    S = np.zeros((n, len(names)))
    return Resolved(names, S, S, 1.0)


def resolve(
    predictor: Predictor, space: Coordinates, q: np.ndarray, y: np.ndarray, whiten: Whiten
) -> Resolved:
    """Returns the sensitivities, whitened, of a predictor's outputs at q (p,), and their errors.

    Args:
        predictor: predicts the outputs.
        space: coordinates of the parameters.
        q: the point, shape (p,).
        y: what is predicted there, shape (N, ny).
        whiten: see `Whiten`.

    Raises:
        DivergenceError: a simulation left the finite numbers.
    """

    def at(step: float) -> tuple[np.ndarray, np.ndarray]:
        once, twice = two_sensitivities(predictor, space, q, step)
        return whiten(once), whiten(twice)

    def symmetries(S: np.ndarray, errors: np.ndarray) -> tuple[ScalingSymmetry, ...]:
        return scaling_symmetries(predictor, space, q, whiten, S, errors)

    least = round_off(whiten(y[:, :, None]))
    return resolve_columns(space.names, at, least, RESOLVED_STEPS, symmetries)


def round_off(y: np.ndarray) -> float:
    """Returns the round-off error's norm in a column of the sensitivities of whitened outputs y."""
    return ROUND_OFF * (float(np.linalg.norm(y)) or 1.0)


def resolve_columns(
    names: tuple[str, ...],
    at: AtTwoSteps,
    least: float,
    steps: Sequence[float],
    symmetries: Callable[[np.ndarray, np.ndarray], tuple[ScalingSymmetry, ...]] | None = None,
) -> Resolved:
    """Returns sensitivities at the first step, or each column at the step of its smallest error.

    Args:
        names: parameters, p of them.
        at: computes the sensitivities at a step and at twice the step.
        least: norm of the round-off error of a column.
        steps: the steps to try, until each direction is felt or a symmetry.
        symmetries: finds the symmetries from sensitivities and the errors of their columns; None
            if they are not searched.

    Raises:
        DivergenceError: a simulation at the first step left the finite numbers.
    """
    once, twice = at(steps[0])
    known = Resolved(names, once, twice - once, least)
    for following in (*steps[1:], None):
        if known.done:
            return known
        if symmetries is not None:
            known = known.with_symmetries(symmetries(known.S, known.errors))
        if known.done or following is None:
            break
        try:
            once, twice = at(following)
        except (DivergenceError, InputError):  # no simulation or no start is possible so far away
            break
        known = known.better(once, twice - once)
    return known
