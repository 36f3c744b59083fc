"""An effect that was refitted over windows: its proof by unseen records, its rivals, and its twin.

It is proven where unseen records are predicted better beyond chance, over every length, in every
record, and by enough to matter; else a `Doubt` says what is against it. Its rivals are the effects
that were refitted in its place and explain little once it is there.

Its twin is the same force by another name, as an offset and a friction that differs by direction
are as long as both are smaller than the Coulomb level:

    a force f_0, a level f_c                 levels f_c + f_a and f_c - f_a by direction, f_a = -f_0

    moves    f_0 - f_c sign v                -(f_c + f_a sign v) sign v = f_0 - f_c sign v
    rests    |g + f_0| < f_c                 -(f_c - f_a) < g < f_c + f_a, g all other forces

No record tells them apart, whatever moves. Where f_0 is larger than f_c they differ: friction only
brakes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from identification.discovery.effect_results import Neighbour
from identification.discovery.fitted import BOUND_TOLERANCE
from identification.discovery.impossible import Impossible
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.effects.laws.joint_group import SLIDE
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.evidence import Gains, evidence
from identification.prediction.scoring.scores import WindowScore
from identification.windows.comparison import Prediction, compare
from identification.windows.unseen import Unseen

Doubt = (
    Literal[
        "numbers", "chance", "lengths", "record", "little", "size", "bound", "exchange",
        "smooth", "differ", "steps", "neighbour", "gap", "odds", "beside",
        "further",
    ]
    | Impossible
)  # fmt: skip
# Of what an effect explained: one that still explains as much beside another is missing too.
OWN_SHARE = 0.5
# Two tests of the gains of blocks, by their mean and by their ranks, pass by luck 1.1 to 1.3 times
# as often as one (normal gains of 8 to 40 blocks): most that pass one pass the other.
TESTS = 1.3
# By what was measured, by what is believed of its size, or by a smooth force that does more.
CONTRADICTED: tuple[Doubt, ...] = ("lengths", "record", "bound", "exchange", "differ", "smooth")
TWINS = {"offset": "asymmetric_friction", "asymmetric_friction": "offset"}
LEVEL = "coulomb_friction.f_c"


@dataclass(frozen=True, kw_only=True)
class Contender:
    """An effect that was refitted."""

    model: WindowModel  # with it
    prediction: Prediction  # of unseen records, over the model without it
    gains: Gains  # of fitted windows, then of unseen ones
    numbers: int  # that it adds to the model, those of each record counted
    criterion: float  # E, what speaks for it against the model without it (`evidence`)
    explained: float  # fall of the mean square of the fitted windows, in units of s²
    doubt: Doubt | None  # why it is not proven; None where it is
    luck: float = np.nan  # chance that one of all that were refitted gains as much by luck
    refits: int = 1  # how many effects were refitted, which chance has to pay for
    # what else was refitted in its place and may be meant, once it is accepted
    alternatives: tuple[Contender, ...] = ()
    # its share of `explained` by output; empty where it is not known
    outputs: tuple[float, ...] = ()
    # what is beside it, where it was judged beside effects that have left the model since
    neighbour: Neighbour | None = None

    @property
    def is_proven(self) -> bool:
        """Tells whether unseen records prove it."""
        return self.doubt is None

    @property
    def candidate(self) -> Candidate:
        """The effect, its shapes as they began."""
        return self.model.candidates[-1]


def evidences(contenders: Sequence[Contender]) -> np.ndarray:
    """Returns E of contenders for one place by resample, (k, R); the first is of all blocks."""
    return evidence(
        [c.gains for c in contenders], [c.numbers for c in contenders],
        len(contenders[0].model.scale),
    )  # fmt: skip


def compared(without: Unseen, with_it: Unseen, options: DiscoveryOptions) -> Prediction:
    """Returns what the second of two models predicts better on unseen windows.

    Args:
        without: errors of the first model.
        with_it: of the second one.
        options: whether each output counts by itself, and each record.
    """
    return compare(
        without, with_it, by_outputs=uses(options, "gains_of_outputs"),
        by_records=uses(options, "strata_of_records"),
    )  # fmt: skip


def find_doubt(found: Prediction, refits: int, options: DiscoveryOptions) -> Doubt | None:
    """Returns what is against an effect on unseen windows; None where they prove it.

    Args:
        found: what is predicted better with it.
        refits: how many effects were refitted, which chance has to pay for.
        options: what is beyond chance, and enough.

    Returns:
        "chance": the gain may be luck. "lengths": windows of some length are predicted worse.
        "record": a record is predicted worse, though physics is the same in all of them.
        "little": it takes away too little of the error of any output to matter, or of its noise.
    """
    luck = luck_of(found, refits, options)
    if not (found.t > options.min_proof_t and luck < options.significance):
        return "chance"
    if not found.is_everywhere:
        return "lengths"
    if contradicts_a_record(found, options):
        return "record"
    return None if _matters(found, options) else "little"


def _matters(found: Prediction, options: DiscoveryOptions) -> bool:
    """Returns whether an effect takes away enough of the error of an output.

    Where an output errs by its noise and less than a tenth more, the error is said to be noise
    (`identification.prediction.verdict.remaining`), and what takes away less than that is none
    that a log could be said to disagree by. So small an effect is also what the steps of a
    simulation make, which are no robot's.
    """
    most = 1 + options.min_gap_share if uses(options, "falls_within_noise") else 0.0
    return any(
        fall > (options.min_gap_share if times < most else options.min_fall)
        for fall, times in zip(found.output_falls, found.times_noise, strict=True)
    )


def luck_of(found: Prediction, refits: int, options: DiscoveryOptions) -> float:
    """Returns the chance that one of all effects that were refitted gains as much by luck."""
    return min(1.0, _chance(found, refits, options) * refits)


def _chance(found: Prediction, refits: int, options: DiscoveryOptions) -> float:
    """Returns the chance of as large gains by luck: by their mean, or by their ranks too.

    Ranks are not asked, nor paid for, where not even gains of all blocks would prove by them.
    """
    least = 0.5 ** sum(map(len, found.blocks))
    if not uses(options, "signed_ranks") or TESTS * least * refits >= options.significance:
        return found.chance
    return TESTS * min(found.chance, found.rank_chance)


def contradicts_a_record(found: Prediction, options: DiscoveryOptions) -> bool:
    """Returns whether a record is predicted worse: its mean square rises, and its blocks lose.

    One window that begins badly may raise the mean square of a record by half though nearly all
    of it is predicted better; the logarithms of its blocks tell. The sum of losses that are no
    more than luck would not do instead: a record in which an effect does nothing loses little.

    Args:
        found: what is predicted better with an effect.
        options: what is enough to matter.
    """
    is_asked = uses(options, "losing_blocks")
    return any(
        fall <= -options.min_gap_share and (gain < 0 or not is_asked)
        for fall, gain in zip(found.record_falls, found.records, strict=True)
    )


def has_size(model: WindowModel, options: DiscoveryOptions) -> bool:
    """Returns whether a free size of the last effect is beyond its own std, where it has one.

    The size must also be beyond the error of the simulation's steps. A curve is not asked: beside a
    free level or slope each of its nodes may be unknown although the curve is known, and the
    evidence, which pays for every node, judges the curve as a whole.
    """
    std, values, c = model.std, model.fit.values, model.candidates[-1]
    least = {n: s.smallest for n, s in zip(c.sizes, c.effect.sizes, strict=True)}
    own = [n for n in model.fit.problem.names if n.partition(" [")[0] in c.free]
    times = 0.0 if c.effect.is_curve else options.min_proof_t
    return not own or any(
        abs(values[n]) > max(times * std[n] if times else 0.0, least[n.partition(" [")[0]])
        for n in own
    )


def is_at_bound(model: WindowModel, are_shapes_asked: bool = True) -> bool:
    """Returns whether a size or a shape of the last effect ended on the bound of what is believed.

    The data then ask for more than the law allows: the effect stands for something else. A friction
    that jumps when the record begins, or a Stribeck peak that is as wide as all speeds, is a
    Coulomb friction. Zero as a bound is no effect, and no reason; nor is the bound of a shape that
    tells something of the log and nothing of the robot, or of a joint with a state: a spring whose
    damping is too small to be seen is still a spring.

    Args:
        model: with the effect, fitted.
        are_shapes_asked: whether shapes count as sizes do.
    """
    parameters, c = model.plant.parameters, model.candidates[-1]
    are_shapes_asked = are_shapes_asked and not c.effect.state
    asked = {
        *c.free,
        *(c.effect.parameter(s.name, c.where) for s in c.effect.shapes
          if are_shapes_asked and s.free and not s.of_log),
    }  # fmt: skip
    values = {n: v for n, v in model.fit.values.items() if n.partition(" [")[0] in asked}
    each = ((v, parameters[n.partition(" [")[0]]) for n, v in values.items())
    return any(
        bound != 0 and np.isfinite(bound) and abs(v - bound) <= BOUND_TOLERANCE * abs(bound)
        for v, p in each
        for bound in (p.lower, p.upper)
    )


def is_rival(other: Contender) -> bool:
    """Returns whether an effect that was refitted in the place of another makes its name doubtful.

    It need not be proven for that. But what some windows or a record contradict is no rival, nor
    what ends on the bound of its size, nor what predicts unseen records no better than the model
    without it.
    """
    return other.doubt not in CONTRADICTED and other.prediction.t > 0


def find_rivals(
    others: Sequence[Contender], before: WindowModel, scores: Sequence[WindowScore],
    after: WindowModel, then: Sequence[WindowScore],
) -> tuple[Contender, ...]:  # fmt: skip
    """Returns other contenders that explain less than half as much once the best one is there.

    What still explains as much is no rival of the best one: it is missing too.

    Args:
        others: refitted in the place of the best one.
        before: the model without it.
        scores: of all candidates on that model.
        after: the model with it.
        then: scores on this one.
    """
    was, still = (
        {s.candidate.key: s.fall * model.fitted_power for s in reversed(each)}
        for each, model in ((scores, before), (then, after))
    )
    return tuple(
        o for o in others
        if is_rival(o)
        and still.get(o.candidate.key, 0.0) < OWN_SHARE * was.get(o.candidate.key, 0.0)
    )  # fmt: skip


def find_twin(model: WindowModel, candidate: Candidate) -> str:
    """Returns the name of the effect that is the same force as a candidate; "" where there is none.

    Args:
        model: fitted, with the candidate.
        candidate: the effect at its place.
    """
    effect = candidate.effect
    prefix = SLIDE if effect.name.startswith(SLIDE) else ""
    name, level = effect.name.removeprefix(SLIDE), prefix + LEVEL
    values = {**model.plant.parameters.values(), **model.values}
    every = [s for s in effect.places.values() if s.startswith("@")]

    def is_small(size: str) -> bool:
        _, at, joint = size.partition("@")
        places = [at + joint] if joint else every
        levels = (values.get(level, 0.0) + values.get(level + p, 0.0) for p in places)
        return abs(values.get(size, 0.0)) < min(levels, default=0.0)

    small = name in TWINS and all(map(is_small, candidate.sizes))
    return prefix + TWINS[name] if small else ""
