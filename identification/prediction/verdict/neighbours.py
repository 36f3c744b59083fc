"""Laws that have the name of a neighbour of what is missing.

The right law leaves no more than luck to a curve of the data beside it. The law that lies nearest
to a force in no catalogue leaves a pattern: a spring that hardens explains most of what a soft stop
does, and a curve of the position still explains a third of the rest. So a law is not named where
the best curve at its joint, scored beside all that was found, explains more than `MOST_OF_BOTH` of
what law and curve explain together:

    (f + c)/(l + f + c)         l, c: mean squares that the law and the curves of the model took
                                away, over what the model with all that was found leaves,
                                f: fall by the curve beside it

All three are of the fitted windows, in units of the errors of the model without effects: of a
record that moves less, a law that grows with the cube of the position explains far less, whatever
is beside it. It must also be more likely than not that this is no luck: what acts in few windows,
as a stop does, has a large chance whatever it explains. No law is exact on a real robot, so that
less than this speaks against none. A law of a sensor is of the joint that this measures; one of an
input or a body has no joint of its own, and curves at all joints count. A curve counts, in the
model or beside it, where it may draw what the law misses: it depends on a variable of the law, and
beside one of inputs not on positions alone, because an input that is wrong acts as a force of the
rate, the drive or the time. A force of the position that is left beside a friction or a delay is
another thing that is missing.

A force of two variables leaves what no single curve draws. So the smooth force of the law's joint
is asked as well (`identification.prediction.verdict.yardstick`): all its curves at once, and where
the model leaves something, its surfaces over two variables. Its f and its chance are of blocks of
windows to which it was not fitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.effect_results import Neighbour
from identification.discovery.neighbour import MORE_LIKELY_THAN_NOT
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.effects.variables import POSITIONS, variables
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.trial import Contender
from identification.prediction.scoring.forced import acts_on_joints
from identification.prediction.scoring.screening import single_places
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.yardstick import Yardstick, may_draw

# Of what law and curve explain together: a judgement, because no law of a real robot is exact. The
# rates with it are in docs/robot/models.md.
MOST_OF_BOTH = 0.15
SMOOTH_FORCE = "smooth force"  # as it is called where a curve has its name


@dataclass(frozen=True)
class Explained:
    """What a law and the curves beside it took away, over what the model with all leaves."""

    law: float
    curves: float = 0.0  # those of the model at the law's joint
    chance: float = 1.0  # of as much as the surest of these by luck

    def of_both(self, beside: float) -> float:
        """Returns what curves explain of what they and the law do, with one more beside it.

        Args:
            beside: what that one takes away of what the model leaves.
        """
        curves = self.curves + beside
        return curves / (self.law + curves) if self.law + curves > 0 else 0.0


def explained_by(
    law: Contender, accepted: Sequence[Contender], model: WindowModel,
    doubtful: Sequence[Contender] = (),
) -> Explained:  # fmt: skip
    """Returns what an accepted law and what is beside it in the model explain.

    Args:
        law: one of those that were accepted.
        accepted: all of them; the curves among them may draw what the law misses.
        model: with all of them.
        doubtful: those among them that have no sure name, and may be what the law misses.
    """
    left, unsure = model.fitted_power, {d.candidate.key for d in doubtful}
    others = [a for a in accepted if a is not law]
    curves = [a for a in others if _is_beside(a.candidate, law.candidate)]
    known = {c.candidate.key for c in curves}
    parts = [
        a for a in others
        if a.candidate.key in unsure - known and _may_be_of(a.candidate, law.candidate)
    ]  # fmt: skip
    taken = [c.explained for c in curves] + [a.explained * _share_for(law, a) for a in parts]
    return Explained(
        law.explained / left, sum(taken) / left,
        min((c.prediction.chance for c in (*curves, *parts)), default=1.0),
    )  # fmt: skip


def _share_for(law: Contender, other: Contender) -> float:
    """Returns the share of what another effect explains that a law may have missed.

    It is of outputs that the law moves; of one at which the law explains less than at another, the
    same part counts less.
    """
    if not law.outputs or not other.outputs:
        return 1.0
    weight = np.array(law.outputs) / max(law.outputs)
    return float(weight @ np.array(other.outputs))


def neighbour_of(
    law: Contender, state: WindowSearch, stick: Yardstick | None,
    doubtful: Sequence[Contender] = (),
) -> Neighbour | None:  # fmt: skip
    """Returns what speaks most against the name of a law; None where nothing is beside it.

    Args:
        law: one of the accepted effects.
        state: whose model has them.
        stick: what smooth forces would still explain; None where it is not known.
        doubtful: accepted effects that have no sure name.
    """
    options = state.task.options
    explained = explained_by(law, state.accepted, state.model, doubtful)
    each = [find_neighbour(law.candidate, explained, stick)]
    if uses(options, "smooth_neighbours"):
        each.append(find_smooth_neighbour(law.candidate, explained, stick))
    return next((n for n in each if has_neighbours_name(n, options)), each[0])


def _may_be_of(other: Candidate, law: Candidate) -> bool:
    """Returns whether an effect without a sure name may be what a law misses, as a curve may.

    An effect of inputs acts as a force of the rate or of the drive, and one of a sensor or a body
    as one of positions.
    """
    if not acts_on_joints(law.effect):
        return True
    of_law = variables(law.effect)
    if acts_on_joints(other.effect):
        return share_a_joint(other, law) and may_draw(other.effect, law.effect)
    return not of_law or bool(of_law & ({"v", "f_u"} if _is_of_inputs(other) else {*POSITIONS}))


def _is_beside(curve: Candidate, law: Candidate) -> bool:
    """Returns whether a candidate is a curve that may draw what a law misses at its joint."""
    effect = curve.effect
    if not effect.is_curve or not share_a_joint(curve, law):
        return False
    if _is_of_inputs(law):
        return not variables(effect) <= {*POSITIONS}
    return may_draw(effect, law.effect)


def _is_of_inputs(c: Candidate) -> bool:
    """Returns whether an effect changes inputs and is no force at a joint."""
    return not acts_on_joints(c.effect) and "input" in c.where


def share_a_joint(a: Candidate, b: Candidate) -> bool:
    """Returns whether two effects may act at one joint.

    An effect at all joints acts at those where it has a place: gravity acts on no vertical axis.
    One of a sensor acts at the joint that it measures; one of an input or a body may act at any.
    """
    of_a, of_b = _joints_of(a), _joints_of(b)
    return not of_a or not of_b or bool(of_a & of_b)


def _joints_of(c: Candidate) -> set[str]:
    """Returns the joints at which an effect acts, in words; none where it may act at any."""
    if acts_on_joints(c.effect):
        return {*single_places(c)}
    return {c.effect.joints[where] for where in single_places(c) if where in c.effect.joints}


def find_neighbour(
    candidate: Candidate, explained: Explained, stick: Yardstick | None
) -> Neighbour | None:
    """Returns the curve that explains what a law leaves with the least chance of luck.

    Args:
        candidate: the law, or a curve.
        explained: what it and the curves of the model took away.
        stick: what smooth forces would still explain; None where it is not known.

    Returns:
        None for a curve, and where no curve has a score.
    """
    if candidate.effect.is_curve or stick is None:
        return None
    curves = [s for s in stick.curves if _is_beside(s.candidate, candidate)]
    if not curves:
        return None
    best = min(curves, key=lambda s: s.p_value)
    chance = min(explained.chance, len(curves) * best.p_value)
    c = best.candidate
    return Neighbour(c.effect.name, c.where, best.fall, chance, explained.of_both(best.fall))


def find_smooth_neighbour(
    candidate: Candidate, explained: Explained, stick: Yardstick | None
) -> Neighbour | None:
    """Returns the smooth force at a law's joint that explains what the law leaves.

    Args:
        candidate: the law, or a curve.
        explained: what it and the curves of the model took away.
        stick: what smooth forces would still explain; None where it is not known.

    Returns:
        None for a curve, and for what is no law of a joint.
    """
    left = stick.beyond.get(candidate.key) if stick else None
    if left is None:
        return None
    share, chance = max(0.0, left.share), min(explained.chance, left.chance)
    return Neighbour(SMOOTH_FORCE, left.joint, share, chance, explained.of_both(share))


def has_neighbours_name(neighbour: Neighbour | None, options: DiscoveryOptions) -> bool:
    """Returns whether a law has the name of a neighbour of what is missing.

    Args:
        neighbour: the curve beside it; None where there is none.
        options: what is beyond chance.
    """
    if neighbour is None or not uses(options, "neighbours_names"):
        return False
    return neighbour.of_both > MOST_OF_BOTH and neighbour.chance < MORE_LIKELY_THAN_NOT
