"""A fitted and validated model with some effects: what it may lack, and when it is proven."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.discovery.attempts import attempt, refuse_infinite
from identification.discovery.effect_results import Proof
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.innovations.fit import MAX_FIT_STEPS, fit_with_effects
from identification.innovations.proof import Validation, allowed_chance, validate
from identification.innovations.scoring.scores import Score, score
from identification.innovations.scoring.sensitivities import Sensitivity
from identification.innovations.task import DiscoveryTask
from identification.kalman.refit import Refit

ROUGH_FIT_STEPS = 5  # steps of a fit that only says how far a model is from the data
# Of a logarithm: a parameter this near to the end of its range is at its limit.
LIMIT_DISTANCE = 0.02
# Of an effect's gain to what BIC asks for its sizes, above which it is needed.
NEEDED_BIC_RATIO = 10.0


@dataclass(frozen=True)
class FittedModel:
    """A model with some effects, fitted on a part of a log and validated on the rest."""

    candidates: tuple[Candidate, ...]  # its effects
    refit: Refit  # the fit on the fitted samples
    validation: Validation  # its prediction of the whole log

    @property
    def negative_bic(self) -> float:
        """2 ln L - p ln n: Schwarz' criterion, negated, so that a larger value is better."""
        free = len(self.refit.point.q)
        return 2 * self.refit.log_posterior - free * float(np.log(len(self.refit.point.log)))

    def log_posterior_of_equal(self, free: int) -> float:
        """Returns the log posterior at which a model with so many free parameters has this BIC."""
        return (self.negative_bic + free * float(np.log(len(self.refit.point.log)))) / 2

    def with_fitted_shape(self, candidate: Candidate) -> Candidate:
        """Returns one of its effects with the shape that was fitted."""
        values, effect = self.refit.point.values, candidate.effect
        names = [s.name for s in effect.shapes]
        shape = {name: values[effect.parameter(name, candidate.where)] for name in names}
        return replace(candidate, shape=shape)

    @property
    def innovations(self) -> np.ndarray:
        """Innovations of the fitted samples, in units of σ, shape (n, ny)."""
        return self.validation.innovations[self.validation.seen]


@dataclass(frozen=True)
class AcceptedEffect:
    """An effect that was added to a model."""

    model: FittedModel  # the model with it; the effect is the last of its candidates
    proof: Proof  # what it does for unseen samples
    gain: float  # of twice the log likelihood over the model without it, less what BIC asks
    # models with another effect that was refitted in its place
    alternatives: tuple[FittedModel, ...]

    @property
    def candidate(self) -> Candidate:
        """The effect."""
        return self.model.candidates[-1]


def fit_model(
    task: DiscoveryTask,
    candidates: tuple[Candidate, ...],
    start: Mapping[str, float],
    near: FittedModel | None = None,
    steps: int = MAX_FIT_STEPS,
    least: float = -np.inf,
) -> FittedModel:
    """Fit the nominal model with some effects, and validate it.

    Args:
        task: the nominal model, the log and the options.
        candidates: the effects.
        start: values to begin at by name.
        near: a model whose linearisation and noise are good enough to begin with.
        steps: largest number of steps.
        least: log posterior that the fit must come to, to matter; one that does not ends early.

    Raises:
        DivergenceError: the start cannot be simulated.
        InputError: the robot cannot rest at its start.
    """
    model, log, options = task.nominal_model, task.log, task.options
    nearby = None if near is None else near.refit
    part = log.part("estimation")
    fit = fit_with_effects(model, part, candidates, start, options, steps, nearby, least=least)
    return FittedModel(candidates, fit, validate(fit, log, task.parts))


def try_fit(
    task: DiscoveryTask,
    candidates: tuple[Candidate, ...],
    start: Mapping[str, float],
    near: FittedModel | None = None,
    steps: int = MAX_FIT_STEPS,
    least: float = -np.inf,
    tried: Candidate | None = None,
) -> FittedModel | None:
    """Returns what `fit_model` returns; None where that fails.

    Args:
        task: as of `fit_model`.
        candidates: as of `fit_model`.
        start: as of `fit_model`.
        near: as of `fit_model`.
        steps: as of `fit_model`.
        least: as of `fit_model`.
        tried: which of the candidates is on trial; a failure is told of it. None where none is: a
            model without an effect is tried.
    """

    def evaluate() -> FittedModel:
        model = fit_model(task, candidates, start, near, steps, least)
        refuse_infinite(model.negative_bic, model.validation.rms("select"), model.innovations)
        return model

    return attempt(tried, evaluate)


def score_candidates(model: FittedModel, sensitivities: Sequence[Sensitivity],
                     options: DiscoveryOptions) -> tuple[Score, ...]:  # fmt: skip
    """Returns the scores of all candidates that a model does not have yet, the best first."""
    others = [s for s in sensitivities if not has_candidate(model, s.candidate)]
    return score(model.refit, others, options)


def has_candidate(model: FittedModel, candidate: Candidate) -> bool:
    """Returns whether a model has an effect at the place of a candidate, or at all places."""
    return any(
        c.effect.name == candidate.effect.name
        and (c.where == candidate.where or not c.effect.places[c.where])
        for c in model.candidates
    )


def collect_parameters(
    task: DiscoveryTask, model: FittedModel, candidate: Candidate
) -> dict[str, tuple[float, float, str]]:
    """Returns the sizes and shapes of an effect in a fitted model, by symbol: value, std, unit.

    The std is zero of what is not estimated, and of what a bound holds.
    """
    point = model.refit.point
    own = np.where(
        point.space.on_bound(point.q), 0.0, model.refit.std * point.space.slope(point.q)
    )  # fmt: skip
    std = dict(zip(point.space.names, own, strict=True))
    out = {}
    for name in (*candidate.sizes, *candidate.fixed):
        record = task.nominal_model.plant.parameters[name]
        out[record.letter] = (
            point.values[name], float(std.get(name, 0.0)), record.unit,
        )  # fmt: skip
    return out


def list_parameters_at_limit(model: FittedModel) -> tuple[str, ...]:
    """Returns positive parameters of the nominal model that end at a limit of plausible values."""
    point = model.refit.point
    room = np.minimum(point.q - point.space.lower, point.space.upper - point.q)
    of_effects = {n for c in model.candidates for n in c.sizes}
    of_effects |= {
        c.effect.parameter(shape.name, c.where)
        for c in model.candidates
        for shape in c.effect.shapes
    }
    at_limit = point.space.logarithmic & (room < LIMIT_DISTANCE)
    return tuple(
        n for n, at in zip(point.space.names, at_limit, strict=True) if at and n not in of_effects
    )


def is_proven(proof: Proof, options: DiscoveryOptions, tried: int = 1) -> bool:
    """Returns whether unseen samples confirm an effect beyond chance, as one of so many tried."""
    return tried * proof.chance < allowed_chance(proof.blocks, options)


def is_relevant(proof: Proof, options: DiscoveryOptions) -> bool:
    """Returns whether an effect explains enough of the unseen samples to matter."""
    return proof.fall > options.min_fall and proof.above > options.min_gap_share


def is_far_likelier(candidate: Candidate, gain: float, samples: int) -> bool:
    """Returns whether the fitted samples want an effect far more than BIC asks.

    Args:
        candidate: the effect.
        gain: of twice the log likelihood with it, less what BIC asks.
        samples: that were fitted.
    """
    return gain > NEEDED_BIC_RATIO * len(candidate.estimated) * np.log(samples)


def is_confirmed(proof: Proof, options: DiscoveryOptions, tried: int = 1) -> bool:
    """Returns whether unseen samples confirm an effect, beyond chance and by enough to matter."""
    return is_proven(proof, options, tried) and is_relevant(proof, options)
