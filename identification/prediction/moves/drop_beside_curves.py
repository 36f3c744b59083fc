"""Laws that were found beside a curve of the data are not named.

A curve has eight nodes. What its cause does between them is left, and the law that imitates that
best is proven like any other: a torque along the position of a neighbour, drawn as a curve, left a
fifth of the error to a cogging that was not there. Only laws that were found before the curve, or
that made it needless, are names; and laws of other joints than the curve's, which are another
thing that is missing.
"""

from __future__ import annotations

from dataclasses import replace

from identification.prediction.judging.extension import refitted
from identification.prediction.judging.trial import Contender
from identification.prediction.task import Change, WindowSearch
from identification.prediction.verdict.neighbours import share_a_joint
from identification.runtime.progress import Progress


def drop_beside_curves(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state's model without laws that were accepted after a curve at their joint.

    All are kept where the model without them cannot be simulated.
    """
    model, accepted, task = state.model, state.accepted, state.task
    kept: list[Contender] = []
    lost: list[Contender] = []
    for old in accepted:
        curves = (k.candidate for k in kept if k.candidate.effect.is_curve)
        is_beside = any(share_a_joint(c, old.candidate) for c in curves)
        is_law = not old.candidate.effect.is_curve
        (lost if is_law and is_beside else kept).append(old)
    keys = {old.candidate.key for old in lost}
    rest = [c for c in model.candidates if c.key not in keys]
    without = refitted(model, rest, task.nominal_model, task.confirm) if lost else None
    if without is None:
        return model, accepted, ()
    for old in lost:
        progress(f"{old.candidate.effect.name}, {old.candidate.where}: found beside a curve only")
    return without, tuple(kept), tuple(replace(old, doubt="curve") for old in lost)
