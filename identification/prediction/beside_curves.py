"""Laws that were found beside a curve of the data are not named.

A curve has eight nodes. What its cause does between them is left, and the law that imitates that
best is proven like any other: a torque along the position of a neighbour, drawn as a curve, left a
fifth of the error to a cogging that was not there. Only laws that were found before the curve, or
that made it needless, are names.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from identification.discovery.nominal_model import NominalModel
from identification.estimation.options import Progress
from identification.prediction.extension import refitted
from identification.prediction.model import WindowModel
from identification.prediction.records import Record
from identification.prediction.selection import Contender


def without_laws_beside_curves(
    model: WindowModel, accepted: Sequence[Contender], nominal_model: NominalModel,
    confirm: Sequence[Record], progress: Progress,
) -> tuple[WindowModel, tuple[Contender, ...], tuple[Contender, ...]]:  # fmt: skip
    """Returns the model without laws that were accepted after a curve which is still there.

    Args:
        model: with all of the accepted effects.
        accepted: in their order.
        nominal_model: the other free parameters, and the horizon.
        confirm: records that no fit may see.
        progress: is told which laws are left out.

    Returns:
        The model, the effects that it keeps, and those that it lost, which are in doubt. All are
        kept where the model without them cannot be simulated.
    """
    kept: list[Contender] = []
    lost: list[Contender] = []
    for old in accepted:
        is_beside = any(k.candidate.effect.is_curve for k in kept)
        is_law = not old.candidate.effect.is_curve
        (lost if is_law and is_beside else kept).append(old)
    keys = {old.candidate.key for old in lost}
    rest = [c for c in model.candidates if c.key not in keys]
    without = refitted(model, rest, nominal_model, confirm) if lost else None
    if without is None:
        return model, tuple(accepted), ()
    for old in lost:
        progress(f"{old.candidate.effect.name}, {old.candidate.where}: found beside a curve only")
    return without, tuple(kept), tuple(replace(old, doubt="curve") for old in lost)
