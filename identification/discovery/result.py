"""What a discovery found, and what it rests on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from identification.discovery.missing_forces import MissingForce
from identification.discovery.scoring.scores import Score
from identification.effects.effect import Candidate
from identification.kalman.refit import Refit
from identification.logs.log import Log

Verdict = Literal["named", "nothing missing", "unknown effect"]


@dataclass(frozen=True)
class Rival:
    """Another explanation of the same data.

    Attributes:
        candidate: which.
        confidence: probability that it is the right one of those considered.
        alike: cosine between its sensitivity and the named one's, the base projected out.
    """

    candidate: Candidate
    confidence: float
    alike: float


@dataclass(frozen=True)
class Retuned:
    """What the base parameters would have to be, to explain the same without an effect.

    Attributes:
        parameter: the one that would leave what was known of it the farthest.
        distance: of it from there, in std of what was known.
        confidence: probability that it is this and no effect, of those considered.
    """

    parameter: str
    distance: float
    confidence: float


@dataclass(frozen=True)
class Proof:
    """What an effect does for data that the fit has not seen.

    Attributes:
        gain: log likelihood of the unseen samples, with it minus without, under one noise.
        t: of the gain, by blocks.
        share: of what was above noise and input errors in the free run, how much it takes away.
        fall: of the mean square of the free run, relative.
        above: of the mean square above the sensors' noise, how much it takes away.
    """

    gain: float
    t: float
    share: float
    fall: float
    above: float


@dataclass(frozen=True)
class Tried:
    """An effect that was refitted and not believed.

    Attributes:
        candidate: which.
        parameters: its sizes and shapes by name: value, std, unit.
        gain: twice the log likelihood that it would add, less what BIC asks for its parameters.
        proof: what it would do for unseen data.
    """

    candidate: Candidate
    parameters: Mapping[str, tuple[float, float, str]]
    gain: float
    proof: Proof


@dataclass(frozen=True)
class Named:
    """An effect that is missing from the model.

    Attributes:
        candidate: effect, place, and shapes as estimated.
        parameters: its sizes and shapes by name: value, std, unit.
        confidence: how sure the name is among its rivals, 0 to 1; see `confidence`.
        rivals: explanations that are not much worse; a look-alike set when `one_of`.
        one_of: whether the data cannot tell it from its first rival.
        gain: twice the log likelihood that it adds on the fitted samples.
        proof: what it does for unseen data.
        retuned: the explanation without any effect.
        advice: the experiment that would tell it from its rival, in a sentence.
    """

    candidate: Candidate
    parameters: Mapping[str, tuple[float, float, str]]
    confidence: float
    rivals: tuple[Rival, ...]
    one_of: bool
    gain: float
    proof: Proof
    retuned: Retuned
    advice: str = ""


@dataclass(frozen=True)
class Gap:
    """Free-run error on the samples that the fit has not seen.

    Attributes:
        rms: over all outputs, in their unit.
        fit_percent: per output, shape (ny,).
    """

    rms: float
    fit_percent: np.ndarray


@dataclass(frozen=True)
class Detectable:
    """The smallest effect of a kind that this log would have shown.

    Attributes:
        candidate: which.
        size: name of the size.
        smallest: its magnitude that is found in 9 of 10 logs [unit]; inf when never.
        unit: SI unit.
    """

    candidate: Candidate
    size: str
    smallest: float
    unit: str


@dataclass(frozen=True)
class Discovery:
    """The outcome.

    Attributes:
        log: the whole log; its part `estimation` was fitted, the rest is unseen.
        verdict: what it comes to.
        named: the missing effects, the most telling first.
        unexplained: whether something is left that no named effect explains.
        noise_rms: of the sensors, estimated from the data.
        disturbance_rms: what unlogged input errors do to the free run, by the noise model; zero
            where they are not random.
        before: the gap of the nominal model, fitted.
        after: the gap of the model with the named effects.
        nominal: the fit without effects.
        final: the fit with the named effects.
        predicted_before: free run of the nominal fit over the whole log, shape (N, ny), in the
            outputs' units.
        predicted_after: of the final fit, shape (N, ny), in the outputs' units.
        scores: of all candidates on the nominal fit, the best first.
        remaining: of all candidates on the final fit, the best first.
        detectable: what could have been seen.
        located: where the nominal model fails, in sentences.
        left: where the final model still fails, in sentences; empty when it does not.
        missing: the forces that the nominal model lacks, by where they act.
        seconds: wall time by stage [s].
        horizon: over which gaps and proofs are judged [s]; None for a free run.
        rejected: what was refitted beside the named effects, and not believed, the best first.
    """

    log: Log
    verdict: Verdict
    named: tuple[Named, ...]
    unexplained: bool
    noise_rms: float
    disturbance_rms: float
    before: Gap
    after: Gap
    nominal: Refit
    final: Refit
    predicted_before: np.ndarray
    predicted_after: np.ndarray
    scores: tuple[Score, ...]
    remaining: tuple[Score, ...]
    detectable: tuple[Detectable, ...]
    located: tuple[str, ...]
    left: tuple[str, ...]
    missing: tuple[MissingForce, ...]
    seconds: Mapping[str, float]
    horizon: float | None = None
    rejected: tuple[Tried, ...] = ()
