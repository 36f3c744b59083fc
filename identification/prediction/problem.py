"""Windows of all records at once: their residuals, and the tangent of a step.

    V(q, d) = Σ_r Σ_w ‖(y_rw - ŷ_rw(q, x̄_rw ⊕ d_rw))/s‖² + ‖d_rw/s_x‖²  +  Σ_j ((q_j - q̄_j)/σ_j)²

r: record, w: window of it, d_rw: its state at the start, s: rms of each output's error under the
nominal model, q̄, σ: what was known of a parameter before the records spoke. The states of a window
are eliminated by themselves (`identification.windows.shooting`), so that records add up.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.model.coordinates import Coordinates
from identification.model.predictor import Plant, Predictor
from identification.model.rollout import State
from identification.prediction.records import Record
from identification.windows.shooting import Shooting, Tangent, tangent
from identification.windows.windows import apart, first_states, windows


@dataclass(frozen=True)
class Problem:
    """What does not change while parameters and states of windows are sought.

    Attributes:
        parts: the windows of each record that is fitted.
        space: coordinates of the p free parameters.
        mean: q̄ of the priors, shape (p,).
        weight: 1/σ of the priors, zero where there is none, shape (p,).
    """

    parts: tuple[Shooting, ...]
    space: Coordinates
    mean: np.ndarray
    weight: np.ndarray

    @property
    def names(self) -> tuple[str, ...]:
        """The free parameters."""
        return self.space.names

    def against(self, q: np.ndarray) -> np.ndarray:
        """What the priors hold against q, in their std, shape (p,)."""
        return self.weight * (self.mean - q)

    def cost(self, q: np.ndarray, d: Sequence[np.ndarray]) -> float:
        """V at q and at the moves of the windows' states, one array (W, nx) a record.

        Raises:
            DivergenceError: a window left the finite numbers.
        """
        data = sum(
            float(np.sum(p.residual(q, own) ** 2)) for p, own in zip(self.parts, d, strict=True)
        )
        return data + float(np.sum(self.against(q) ** 2))

    def tangents(self, q: np.ndarray, d: Sequence[np.ndarray]) -> tuple[Tangent, ...]:
        """All windows linearised, one tangent a record."""
        return tuple(tangent(p, q, own) for p, own in zip(self.parts, d, strict=True))


def problem(
    plant: Plant,
    records: Sequence[Record],
    space: Coordinates,
    length: float,
    values: Mapping[str, float],
    mean: np.ndarray,
    weight: np.ndarray,
    scale: np.ndarray,
) -> Problem:
    """Cut records into windows, each of which begins where the robot was measured.

    Args:
        plant: the model.
        records: to be fitted.
        space: coordinates of the free parameters.
        length: of a window [s].
        values: of all parameters that are not the plant's own; they say where unmeasured states
            begin.
        mean: see `Problem`.
        weight: see `Problem`.
        scale: s of each output, shape (ny,), in its unit.

    Raises:
        InputError: windows do not fit a record.
    """
    parts = []
    for record in records:
        fixed = {n: v for n, v in {**values, **record.values}.items() if n not in space.names}
        predictor = Predictor(plant, record.log, space.names, fixed)
        cut = windows(record.log, length)
        first = first_states(predictor, np.array([values[n] for n in space.names]), cut)
        parts.append(Shooting(predictor, space, cut, first, np.diag(1 / scale)))
    return Problem(tuple(parts), space, mean, weight)


def no_moves(problem_: Problem) -> tuple[np.ndarray, ...]:
    """States that begin where they are believed to begin, one array (W, nx) a record."""
    out = []
    for part in problem_.parts:
        model = part.predictor.plant.model
        out.append(np.zeros((len(part.cut.starts), 2 * model.nv + model.na)))
    return tuple(out)


def moves_from(problem_: Problem, states: Sequence[State]) -> tuple[np.ndarray, ...]:
    """The moves that lead to states found earlier for the same windows."""
    return tuple(
        apart(part.predictor.plant.model, part.first.states, own)
        for part, own in zip(problem_.parts, states, strict=True)
    )


def with_space(
    problem_: Problem,
    space: Coordinates,
    fixed: Mapping[str, float],
    mean: np.ndarray,
    weight: np.ndarray,
) -> Problem:
    """The same windows with other free parameters, and other values of those that are not free."""
    parts = []
    for part in problem_.parts:
        own = {**part.predictor.fixed, **fixed}
        rest = {n: v for n, v in own.items() if n not in space.names}
        predictor = replace(part.predictor, names=space.names, fixed=rest)
        parts.append(replace(part, space=space, predictor=predictor))
    return Problem(tuple(parts), space, mean, weight)
