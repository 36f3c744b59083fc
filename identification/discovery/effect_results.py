"""Results of a discovery on one effect: named, rejected, a rival, or the smallest that shows.

    bic_gain    = 2 ln L(with) - 2 ln L(without) - k ln n       L: of the n fitted samples
    evidence    = n_y N mean_b g_b - k ln N        N: independent readings of all windows

k numbers are added by the effect. A search along a free run has the first, one over a horizon the
second (`identification.prediction.judging.evidence`); they compare effects of one search only.

An effect is proven by samples that no fit has seen, and told of others of which neither a fit nor
the search knows (`identification.logs.parts`). Along a free run flips of the signs of their
blocks must be as seldom as a t above `min_proof_t` is for normal gains (3 % with 20 blocks), paid
for by the number of tries where it is the last of several. Over a horizon Student's t of the blocks
must exceed `min_proof_t`, and its chance times the number of refits stay below `significance` (1 %
in all). Both also ask that the effect matters (`min_fall`). `Proof.test` names the test.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf, isfinite, nan
from typing import Literal, Protocol

import numpy as np

from identification.effects.effect import Candidate, Effect

Test = Literal["flips of signs", "Student's t"]


@dataclass(frozen=True, kw_only=True)
class Proof:
    """The gain of an effect on samples that no fit has seen."""

    test: Test = "flips of signs"  # the test that tells the chance
    t: float  # Student's t of the gain, by blocks
    chance: float  # of a gain as large as this by luck, by the test
    fall: float  # relative fall of the mean square of the judged error
    # log likelihood of the unseen samples with it minus without, under one noise; NaN where no
    # likelihood judges them
    gain: float = nan
    blocks: int  # how many blocks there are
    # of the mean square above sensors' noise and input errors, the share that it closes; NaN where
    # that is not known of it alone
    share: float = nan
    # of the mean square above the sensors' noise, the share that it closes; likewise
    above: float = nan
    # `fall` by the length of the predicted windows; empty for a free run
    falls: tuple[float, ...] = ()
    # mean gain of each unseen record, over its blocks; empty for a free run
    records: tuple[float, ...] = ()
    is_everywhere: bool = True  # whether windows of every length are predicted better
    agrees: tuple[str, ...] = ()  # names of the records whose unseen samples it makes likelier
    # names of the records whose unseen samples it makes less likely, beyond chance
    disagrees: tuple[str, ...] = ()
    # the same on samples on which the search has not decided, as it has on those of this proof
    # (`identification.logs.parts`); None where no such part is kept
    untouched: Proof | None = None

    @property
    def told(self) -> Proof:
        """The proof whose numbers are told: on untouched samples, where a part is kept."""
        return self.untouched or self


@dataclass(frozen=True)
class Gap:
    """Error on the samples that no fit has seen."""

    # over all outputs, in their unit; over a horizon, where they have several, each counts in its
    # own scale
    rms: float
    fit_percent: np.ndarray  # of each output, shape (ny,) [%]
    # rms by the outputs' units, each in it
    rms_by_unit: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class RecordError:
    """Errors of two models on one record; NaN and empty where no sample of it is judged."""

    name: str  # of the record
    role: str  # "fit" or "confirm"
    # rms of the model before (the nominal one, or the values with which a fit began), over all
    # outputs, in the outputs' unit where they have one, else in units of their scale
    before: float
    after: float  # rms of the model after (the final one, or the fitted one)
    before_by_unit: Mapping[str, float]  # rms of the model before by the outputs' units, each in it
    after_by_unit: Mapping[str, float]  # likewise of the model after


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


class Scored(Protocol):
    """A candidate with what it would explain, before it is fitted."""

    @property
    def candidate(self) -> Candidate:
        """Effect, place and shapes."""

    @property
    def size(self) -> np.ndarray:
        """Its likeliest sizes, shape (m,), in their units."""

    @property
    def std(self) -> np.ndarray:
        """Their std, shape (m,)."""

    @property
    def explains(self) -> float:
        """Returns how much it would explain, in the measure of `Discovery.scored_by`."""

    @property
    def p_value(self) -> float:
        """Chance of as much by luck."""


@dataclass(frozen=True)
class Rival(OfCandidate):
    """Another effect that may explain the same data."""

    candidate: Candidate  # the effect
    confidence: float  # probability that it is the right one of those considered
    # cosine between its sensitivity and that of the named effect, with the nominal model's
    # parameters projected out; None where it is not computed
    alike: float | None = None
    # of parameters of the fit with it in the named effect's place, by name, in their units; those
    # of the effect are among them
    values: Mapping[str, float] = field(default_factory=dict)
    # its sizes and shapes in this fit by name: value, std, unit; empty where they are not known
    parameters: Mapping[str, tuple[float, float, str]] = field(default_factory=dict)


@dataclass(frozen=True)
class Retuned:
    """The move of the nominal model's parameters that would explain the same without an effect."""

    parameter: str  # name of the one that would move the farthest from what was known of it
    distance: float  # how far it would move, in std of its prior
    confidence: float  # probability that this is right and the effect is not, of those considered


@dataclass(frozen=True)
class Outside:
    """A curve outside the catalogue, drawn from the data, that may explain the same."""

    along: str  # what it follows: "rate", "position", "input" or "time"
    where: str  # the joint on which it acts, or all actuated joints
    confidence: float  # probability that this is right and the effect is not, of those considered


@dataclass(frozen=True)
class RejectedEffect(OfCandidate):
    """An effect that was refitted and not accepted."""

    candidate: Candidate  # the effect
    # its sizes and shapes by name: value, std, unit
    parameters: Mapping[str, tuple[float, float, str]]
    # by how much it raises the negative BIC on the fitted samples; NaN over a horizon
    bic_gain: float
    proof: Proof  # what it does for unseen samples, which decided, and for those that are told of
    # something like it that no catalogue lists and that is likelier, where it was
    outside: Outside | None = None
    evidence: float = nan  # what speaks for it over all windows; NaN for a free run
    # why it is not proven, a word of `identification.prediction.judging.trial.Doubt`; None where it
    # is, or where no reason is told
    doubt: str | None = None
    confidence: float = 0.0  # that its name would have had
    # chance that one of all that were refitted gains as much by luck on samples that decide; NaN
    # where nobody asks
    luck: float = nan


@dataclass(frozen=True)
class RecordDifference(OfCandidate):
    """Something that differs between records, counted for each by itself: it is no effect."""

    candidate: Candidate  # what it is, with a size of each record
    values: Mapping[str, tuple[float, float]]  # value and std by name, `size [record]` [unit]
    unit: str  # of them

    @property
    def spread(self) -> float:
        """How far the values of two records are apart at most [unit]."""
        each: dict[str, list[float]] = {}
        for name, (value, _) in self.values.items():
            each.setdefault(name.partition(" [")[0], []).append(value)
        return max(max(values) - min(values) for values in each.values())


@dataclass(frozen=True)
class Neighbour:
    """The curve of the data that explains what a law leaves with the least chance of luck."""

    curve: str  # its name
    where: str  # its place
    share: float  # of the fitted error that it would take away beside the law, 0 to 1
    chance: float  # of as much by luck, paid for by the number of curves
    of_both: float  # what the curve explains of what law and curve explain together, 0 to 1


@dataclass(frozen=True, kw_only=True)
class NamedEffect(OfCandidate):
    """An effect that is missing from the nominal model."""

    candidate: Candidate  # effect, place, and shapes as estimated
    # its sizes and shapes by name: value, std, unit
    parameters: Mapping[str, tuple[float, float, str]]
    confidence: float  # probability that the name is right among its rivals, 0 to 1
    rivals: tuple[Rival, ...]  # other effects that were refitted in its place
    compared: int  # how many others were refitted in its place; some may be no rivals any more
    one_of: bool  # whether the data cannot tell it from its first rival
    # by how much it raises the negative BIC on the fitted samples; NaN over a horizon
    bic_gain: float = nan
    evidence: float = nan  # what speaks for it over all windows; NaN for a free run
    proof: Proof  # what it does for unseen samples, which decided, and for those that are told of
    # the explanation without an effect; None where it was not computed
    retuned: Retuned | None = None
    advice: str = ""  # the experiment that would tell it from its first rival, in a sentence
    # something like it that no catalogue lists; None where no curve explains anything beside the
    # named effects
    outside: Outside | None = None
    # the effect that is the same force by another name, so that no record tells which it is
    # (`identification.prediction.judging.trial`); None where there is none
    same_as: Effect | None = None
    # this effect as it was fitted, with the same probability; None where it was not
    twin: Rival | None = None
    # of what it and smooth forces of its joint could explain, the share that it explains
    # (`identification.discovery.forces.smooth_force`); None where that is not known
    smooth_share: float | None = None
    # what a smooth force of what it depends on would explain beside it; None where that is not
    # known
    neighbour: Neighbour | None = None

    @property
    def odds(self) -> float:
        """Probability that the name is right, or one of the set's names where it is one of them."""
        left = 1.0 - self.confidence
        others = sum(rival.confidence for rival in self.rivals) if self.one_of else 0.0
        return self.confidence + min(left, others)


@dataclass(frozen=True)
class Unlogged:
    """The unlogged error of the inputs that a fitted noise model has."""

    rms: float  # of each input, in `unit`
    unit: str  # of the inputs; "" where they have none
    time: float  # for how long it keeps its value [s]
    is_of_inputs: bool  # whether inputs move that could err; else it is a force on the joints


@dataclass(frozen=True)
class Hidden(OfCandidate):
    """An effect that is not named and that the fitted noise may hide."""

    candidate: Candidate  # the effect
    # estimate, largest magnitude that the log does not contradict (95 %), and unit, by name of the
    # size
    sizes: Mapping[str, tuple[float, float, str]]
    taken: float  # share of the power of the unlogged error of the inputs that it would explain
    gain: float  # of twice the log likelihood, as its score says it


@dataclass(frozen=True)
class Detectable(OfCandidate):
    """The smallest effect of a kind that a log would have shown."""

    candidate: Candidate  # the effect
    size: str  # name of one of its sizes
    smallest: float  # the magnitude that is found in 9 of 10 logs [unit]; inf when none is
    unit: str  # SI unit

    @property
    def largest(self) -> float:
        """The largest plausible magnitude of the size [unit]; inf where none is known."""
        return next((s.largest for s in self.candidate.effect.sizes if s.name == self.size), inf)

    @property
    def is_plausible(self) -> bool:
        """Tells whether a plausible size would have shown."""
        return isfinite(self.smallest) and self.smallest <= self.largest
