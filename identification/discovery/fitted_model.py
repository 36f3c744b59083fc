"""What the steps of a discovery are made of: a model with some effects, and when one is worth it.

An effect is worth a name when unseen data confirm it beyond chance, and by enough to matter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.nominal_model import NominalModel, fit_with_effects
from identification.discovery.proof import Validation, validate
from identification.discovery.result import Proof
from identification.discovery.scoring.scores import Score, score
from identification.discovery.scoring.sensitivities import Sensitivity
from identification.effects.effect import Candidate
from identification.errors import DivergenceError, InputError
from identification.kalman.innovations import MATTERS
from identification.kalman.refit import Refit
from identification.logs.log import Log

T = 2.0  # t of the proof: 2.5 % one-sided
END = 0.02  # of a logarithm: this near to its limit a parameter is at it
FALL, SHARE = MATTERS, 0.1  # of the free run's mean square, and of what is above the sensors' noise


@dataclass(frozen=True)
class FittedModel:
    """A model with some effects, fitted and seen on the whole log.

    Attributes:
        candidates: its effects.
        refit: the fit on the fitted samples.
        validation: the same over the whole log.
    """

    candidates: tuple[Candidate, ...]
    refit: Refit
    validation: Validation

    @property
    def criterion(self) -> float:
        """BIC, negated and in units of twice the log likelihood."""
        free = len(self.refit.point.q)
        return 2 * self.refit.log_posterior - free * float(np.log(len(self.refit.point.log)))

    @property
    def innovations(self) -> np.ndarray:
        """Of the fitted samples, in units of σ, shape (n, ny).

        On others an error of the parameters, however small, would look like a line.
        """
        return self.validation.innovations[: len(self.refit.point.log)]

    @property
    def stretched(self) -> tuple[str, ...]:
        """Base parameters that end where they stop to be plausible."""
        point = self.refit.point
        room = np.minimum(point.q - point.space.lower, point.space.upper - point.q)
        own = {n for c in self.candidates for n in c.sizes}
        own |= {
            c.effect.parameter(shape.name, c.where)
            for c in self.candidates
            for shape in c.effect.shapes
        }
        ends = point.space.logarithmic & (room < END)
        return tuple(n for n, e in zip(point.space.names, ends, strict=True) if e and n not in own)


@dataclass(frozen=True)
class AcceptedEffect:
    """An effect that was added.

    Attributes:
        step: the model with it.
        proof: on unseen data.
        gain: of twice the log likelihood over the model without it.
        others: what else was refitted in its place.
    """

    step: FittedModel
    proof: Proof
    gain: float
    others: tuple[FittedModel, ...]


def collect_parameters(
    base: NominalModel, step: FittedModel, candidate: Candidate
) -> dict[str, tuple[float, float, str]]:
    """Sizes of an effect in a fitted model by their symbols: value, std, unit."""
    point = step.refit.point
    std = dict(zip(point.space.names, step.refit.std * point.space.slope(point.q), strict=True))
    out = {}
    for name in (*candidate.sizes, *candidate.fixed):
        record = base.plant.parameters[name]
        out[record.symbol or record.name] = (
            point.values[name], float(std.get(name, 0.0)), record.unit,
        )  # fmt: skip
    return out


def fit_model(
    base: NominalModel,
    whole: Log,
    candidates: tuple[Candidate, ...],
    start: Mapping[str, float],
    near: FittedModel | None = None,
) -> FittedModel:
    """A model with some effects, fitted on the estimation part of a log.

    Args:
        base: the nominal model.
        whole: the log.
        candidates: the effects.
        start: values to begin at.
        near: a model whose linearisation and noise are good enough to begin with.
    """
    nearby = None if near is None else near.refit
    fit = fit_with_effects(base, whole.part("estimation"), candidates, start, near=nearby)
    return FittedModel(candidates, fit, validate(fit, whole, base.horizon))


def try_fit(
    base: NominalModel,
    whole: Log,
    candidates: tuple[Candidate, ...],
    start: Mapping[str, float],
    near: FittedModel | None = None,
) -> FittedModel | None:
    """As `fitted`; None where the model cannot be simulated or cannot stand at its start."""
    try:
        return fit_model(base, whole, candidates, start, near)
    except (DivergenceError, InputError):
        return None


def score_candidates(step: FittedModel, columns: Sequence[Sensitivity]) -> tuple[Score, ...]:
    """Scores of all candidates that a model does not have yet."""
    has = {(c.effect.name, c.where) for c in step.candidates}
    effects = {c.effect.name for c in step.candidates if not c.effect.places[c.where]}
    others = [
        c for c in columns
        if (c.candidate.effect.name, c.candidate.where) not in has
        and c.candidate.effect.name not in effects
    ]  # fmt: skip
    return score(step.refit, others)


def is_relevant(proof: Proof) -> bool:
    """Whether an effect explains enough of the unseen data."""
    return proof.fall > FALL and proof.above > SHARE


def is_proven(proof: Proof) -> bool:
    """Whether unseen data confirm an effect beyond chance."""
    return proof.t > T


def is_confirmed(proof: Proof) -> bool:
    """Whether unseen data confirm an effect: beyond chance, and by enough to matter."""
    return is_proven(proof) and is_relevant(proof)
