"""Rivals of an accepted effect, and accepted effects that later ones made needless."""

from __future__ import annotations

from collections.abc import Sequence

from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.estimation.options import Progress
from identification.prediction.crossing import at_their_best
from identification.prediction.extension import refitted
from identification.prediction.model import WindowModel
from identification.prediction.proof import Doubt, find_doubt
from identification.prediction.records import Record
from identification.prediction.scores import WindowScore
from identification.prediction.selection import Contender
from identification.prediction.unseen import compare

# Of what an effect explained: one that still explains as much beside another is missing too.
OWN_SHARE = 0.5
# By what was measured, or by what is believed of its size.
CONTRADICTED: tuple[Doubt, ...] = ("lengths", "record", "bound", "exchange")
NEEDLESS: tuple[Doubt, ...] = ("chance", "little")  # others make up for it


def find_rivals(
    others: Sequence[Contender], before: WindowModel, scores: Sequence[WindowScore],
    after: WindowModel, then: Sequence[WindowScore],
) -> tuple[Contender, ...]:  # fmt: skip
    """Returns other contenders that explain less than half as much once the best one is there.

    What still explains as much is no rival of the best one: it is missing too. A rival need not be
    proven to make a name doubtful; but what some windows or a record contradict is none, nor what
    ends on the bound of its size, nor what
    predicts unseen records no better than the model without it.

    Args:
        others: refitted in the place of the best one.
        before: the model without it.
        scores: of all candidates on that model.
        after: the model with it.
        then: scores on this one.
    """
    was, still = (
        {s.candidate.key: s.fall * model.fit.cost for s in reversed(each)}
        for each, model in ((scores, before), (then, after))
    )
    return tuple(
        o for o in others
        if o.doubt not in CONTRADICTED and o.prediction.t > 0
        and still.get(o.candidate.key, 0.0) < OWN_SHARE * was.get(o.candidate.key, 0.0)
    )  # fmt: skip


def prune(
    model: WindowModel, accepted: Sequence[Contender], nominal_model: NominalModel,
    confirm: Sequence[Record], options: DiscoveryOptions, progress: Progress,
) -> tuple[WindowModel, tuple[Contender, ...], tuple[Contender, ...]]:  # fmt: skip
    """Returns the model without needless effects, those that stay, and none that are in doubt.

    An effect is needless where unseen records are predicted as well without it, by chance or but
    for too little to matter. The last one was just proven.

    Args:
        model: with all of them.
        accepted: in their order.
        nominal_model: the other free parameters, and the horizon.
        confirm: records that no fit may see.
        options: what is beyond chance, and matters.
        progress: is told what is no longer needed.
    """
    kept = [*accepted]
    for old in accepted[:-1]:
        rest = [c for c in model.candidates if c.key != old.candidate.key]
        without = as_good_without(model, rest, nominal_model, confirm, options)
        if without is not None:
            progress(f"{old.candidate.effect.name}, {old.candidate.where}: no longer needed")
            model = without
            kept = [k for k in kept if k is not old]
    return model, tuple(kept), ()


def as_good_without(
    model: WindowModel, candidates: Sequence[Candidate], nominal_model: NominalModel,
    confirm: Sequence[Record], options: DiscoveryOptions,
) -> WindowModel | None:  # fmt: skip
    """Returns the refit of fewer effects or places; None where it predicts unseen records worse.

    Args:
        model: with all of them.
        candidates: those that it keeps.
        nominal_model: the other free parameters, and the horizon.
        confirm: records that no fit may see.
        options: what is beyond chance, and matters.

    Returns:
        None also where it cannot be simulated.
    """
    without = refitted(model, candidates, nominal_model, confirm)
    if without is None:
        return None
    horizon = float(nominal_model.horizon or 0.0)
    best = model
    if uses(options, "states_of_others"):
        without, (best,) = at_their_best(without, [model], horizon, confirm)
    doubt = find_doubt(compare(without.unseen, best.unseen), 1, options)
    return without if doubt in NEEDLESS else None
