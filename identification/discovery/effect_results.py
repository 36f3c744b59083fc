"""Results of a discovery on one effect: named, rejected, a rival, or the smallest that shows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from identification.effects.effect import Candidate


@dataclass(frozen=True, kw_only=True)
class Proof:
    """The gain of an effect on samples that no fit has seen.

    Attributes:
        gain: log likelihood of the unseen samples with it minus without, under one noise.
        t: Student's t of the gain, by blocks.
        chance: of a gain as large as this where blocks gain and lose alike, by flips of their
            signs.
        blocks: how many blocks there are.
        share: of the mean square above sensors' noise and input errors, the share that it closes.
        fall: relative fall of the mean square of the judged error.
        above: of the mean square above the sensors' noise, the share that it closes.
        agrees: names of the records whose unseen samples it makes likelier.
        disagrees: names of the records whose unseen samples it makes less likely, beyond chance.
    """

    gain: float
    t: float
    chance: float
    blocks: int
    share: float
    fall: float
    above: float
    agrees: tuple[str, ...] = ()
    disagrees: tuple[str, ...] = ()


@dataclass(frozen=True)
class Gap:
    """Error on the samples that no fit has seen.

    Attributes:
        rms: over all outputs, in their unit; over a horizon, where they have several, each counts
            in its own scale.
        fit_percent: of each output, shape (ny,) [%].
        rms_by_unit: rms by the outputs' units, each in it.
    """

    rms: float
    fit_percent: np.ndarray
    rms_by_unit: Mapping[str, float] = field(default_factory=dict)


class _HasCandidate(Protocol):
    @property
    def candidate(self) -> Candidate: ...


class OfCandidate:
    """A result on a candidate effect: it has the effect's name and its place."""

    @property
    def name(self: _HasCandidate) -> str:
        """Name of the effect."""
        return self.candidate.effect.name

    @property
    def where(self: _HasCandidate) -> str:
        """The place where it acts, in words."""
        return self.candidate.where


@dataclass(frozen=True)
class Rival(OfCandidate):
    """Another effect that may explain the same data.

    Attributes:
        candidate: the effect.
        confidence: probability that it is the right one of those considered.
        alike: cosine between its sensitivity and that of the named effect, with the nominal
            model's parameters projected out.
        values: of all parameters of the fit with it in the named effect's place, by name, in their
            units.
    """

    candidate: Candidate
    confidence: float
    alike: float
    values: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Retuned:
    """The move of the nominal model's parameters that would explain the same without an effect.

    Attributes:
        parameter: name of the one that would move the farthest from what was known of it.
        distance: how far it would move, in std of its prior.
        confidence: probability that this is right and the effect is not, of those considered.
    """

    parameter: str
    distance: float
    confidence: float


@dataclass(frozen=True)
class Outside:
    """A curve outside the catalogue, drawn from the data, that may explain the same.

    Attributes:
        along: what it follows: "rate", "position", "input" or "time".
        where: the joint on which it acts, or all actuated joints.
        confidence: probability that this is right and the effect is not, of those considered.
    """

    along: str
    where: str
    confidence: float


@dataclass(frozen=True)
class RejectedEffect(OfCandidate):
    """An effect that was refitted and not accepted.

    Attributes:
        candidate: the effect.
        parameters: its sizes and shapes by name: value, std, unit.
        gain: by how much it raises the negative BIC on the fitted samples.
        proof: what it does for unseen samples.
        outside: something like it that no catalogue lists and that is likelier, where it was.
    """

    candidate: Candidate
    parameters: Mapping[str, tuple[float, float, str]]
    gain: float
    proof: Proof
    outside: Outside | None = None


@dataclass(frozen=True, kw_only=True)
class NamedEffect(OfCandidate):
    """An effect that is missing from the nominal model.

    Attributes:
        candidate: effect, place, and shapes as estimated.
        parameters: its sizes and shapes by name: value, std, unit.
        confidence: probability that the name is right among its rivals, 0 to 1.
        rivals: other effects that were refitted in its place.
        one_of: whether the data cannot tell it from its first rival.
        gain: by how much it raises the negative BIC on the fitted samples.
        proof: what it does for unseen samples.
        retuned: the explanation without an effect.
        advice: the experiment that would tell it from its first rival, in a sentence.
        outside: something like it that no catalogue lists; None where no curve explains anything
            beside the named effects.
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
    outside: Outside | None = None

    @property
    def odds(self) -> float:
        """Probability that the name is right, or one of the set's names where it is one of them."""
        left = 1.0 - self.confidence
        others = sum(rival.confidence for rival in self.rivals) if self.one_of else 0.0
        return self.confidence + min(left, others)


@dataclass(frozen=True)
class Hidden:
    """An effect that is not named and that the fitted noise may hide.

    Attributes:
        candidate: the effect.
        sizes: estimate, largest magnitude that the log does not contradict (95 %), and unit, by
            name of the size.
        taken: share of the power of the unlogged error of the inputs that it would explain.
        gain: of twice the log likelihood, as its score says it.
    """

    candidate: Candidate
    sizes: Mapping[str, tuple[float, float, str]]
    taken: float
    gain: float


@dataclass(frozen=True)
class Detectable:
    """The smallest effect of a kind that a log would have shown.

    Attributes:
        candidate: the effect.
        size: name of one of its sizes.
        smallest: the magnitude that is found in 9 of 10 logs [unit]; inf when none is.
        unit: SI unit.
    """

    candidate: Candidate
    size: str
    smallest: float
    unit: str
