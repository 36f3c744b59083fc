"""What the steps of a discovery are made of: a model with some effects, and when one is worth it.

An effect is worth a name when unseen data confirm it beyond chance, and by enough to matter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.columns import Column
from identification.discovery.extend import Base, fit_with
from identification.discovery.proof import Unseen, unseen
from identification.discovery.result import Proof
from identification.discovery.score import Score, score
from identification.effects.effect import Candidate
from identification.errors import DivergenceError, InputError
from identification.kalman.innovations import MATTERS
from identification.kalman.refit import Refit
from identification.logs.log import Log

T = 2.0  # t of the proof: 2.5 % one-sided
END = 0.02  # of a logarithm: this near to its limit a parameter is at it
FALL, SHARE = MATTERS, 0.1  # of the free run's mean square, and of what is above the sensors' noise


@dataclass(frozen=True)
class Step:
    """A model with some effects, fitted and seen on the whole log.

    Attributes:
        candidates: its effects.
        refit: the fit on the fitted samples.
        unseen: the same over the whole log.
    """

    candidates: tuple[Candidate, ...]
    refit: Refit
    unseen: Unseen

    @property
    def criterion(self) -> float:
        """BIC, negated and in units of twice the log likelihood."""
        free = len(self.refit.at.q)
        return 2 * self.refit.log_posterior - free * float(np.log(len(self.refit.at.log)))

    @property
    def innovations(self) -> np.ndarray:
        """Of the fitted samples, in units of σ, shape (n, ny).

        On others an error of the parameters, however small, would look like a line.
        """
        return self.unseen.innovations[: len(self.refit.at.log)]

    @property
    def stretched(self) -> tuple[str, ...]:
        """Base parameters that end where they stop to be plausible."""
        at = self.refit.at
        room = np.minimum(at.q - at.space.lower, at.space.upper - at.q)
        own = {n for c in self.candidates for n in c.sizes}
        own |= {
            c.effect.parameter(shape.name, c.where)
            for c in self.candidates
            for shape in c.effect.shapes
        }
        ends = at.space.logarithmic & (room < END)
        return tuple(n for n, e in zip(at.space.names, ends, strict=True) if e and n not in own)


@dataclass(frozen=True)
class Accepted:
    """An effect that was added.

    Attributes:
        step: the model with it.
        proof: on unseen data.
        gain: of twice the log likelihood over the model without it.
        others: what else was refitted in its place.
    """

    step: Step
    proof: Proof
    gain: float
    others: tuple[Step, ...]


def parameters_of(
    base: Base, step: Step, candidate: Candidate
) -> dict[str, tuple[float, float, str]]:
    """Sizes of an effect in a fitted model by their symbols: value, std, unit."""
    at = step.refit.at
    std = dict(zip(at.space.names, step.refit.std * at.space.slope(at.q), strict=True))
    out = {}
    for name in (*candidate.sizes, *candidate.fixed):
        record = base.plant.parameters[name]
        out[record.symbol or record.name] = (
            at.values[name], float(std.get(name, 0.0)), record.unit,
        )  # fmt: skip
    return out


def fitted(
    base: Base,
    whole: Log,
    candidates: tuple[Candidate, ...],
    start: Mapping[str, float],
    near: Step | None = None,
) -> Step:
    """A model with some effects, fitted on the estimation part of a log.

    Args:
        base: the nominal model.
        whole: the log.
        candidates: the effects.
        start: values to begin at.
        near: a model whose linearisation and noise are good enough to begin with.
    """
    nearby = None if near is None else near.refit
    fit = fit_with(base, whole.part("estimation"), candidates, start, near=nearby)
    return Step(candidates, fit, unseen(fit, whole, base.horizon))


def fitted_if_any(
    base: Base,
    whole: Log,
    candidates: tuple[Candidate, ...],
    start: Mapping[str, float],
    near: Step | None = None,
) -> Step | None:
    """As `fitted`; None where the model cannot be simulated or cannot stand at its start."""
    try:
        return fitted(base, whole, candidates, start, near)
    except (DivergenceError, InputError):
        return None


def scores_of(step: Step, columns: Sequence[Column]) -> tuple[Score, ...]:
    """Scores of all candidates that a model does not have yet."""
    has = {(c.effect.name, c.where) for c in step.candidates}
    effects = {c.effect.name for c in step.candidates if not c.effect.places[c.where]}
    others = [
        c for c in columns
        if (c.candidate.effect.name, c.candidate.where) not in has
        and c.candidate.effect.name not in effects
    ]  # fmt: skip
    return score(step.refit, others)


def matters(proof: Proof) -> bool:
    """Whether an effect explains enough of the unseen data."""
    return proof.fall > FALL and proof.above > SHARE


def proven(proof: Proof) -> bool:
    """Whether unseen data confirm an effect beyond chance."""
    return proof.t > T


def holds(proof: Proof) -> bool:
    """Whether unseen data confirm an effect: beyond chance, and by enough to matter."""
    return proven(proof) and matters(proof)
