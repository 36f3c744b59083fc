"""The proof of an effect by unseen records, and what is against it where they do not prove it."""

from __future__ import annotations

from typing import Literal

import numpy as np

from identification.discovery.fitted import BOUND_TOLERANCE
from identification.discovery.options import DiscoveryOptions
from identification.prediction.model import WindowModel
from identification.prediction.unseen import Prediction

Doubt = Literal[
    "numbers", "chance", "lengths", "record", "little", "size", "bound", "exchange", "curve",
    "drawn",
]  # fmt: skip


def find_doubt(found: Prediction, refits: int, options: DiscoveryOptions) -> Doubt | None:
    """Returns what is against an effect on unseen windows; None where they prove it.

    Args:
        found: what is predicted better with it.
        refits: how many effects were refitted, which chance has to pay for.
        options: what is beyond chance, and enough.

    Returns:
        "chance": the gain may be luck. "lengths": windows of some length are predicted worse.
        "record": a record is predicted worse, though physics is the same in all of them.
        "little": it takes away too little to matter.
    """
    if not (found.t > options.min_proof_t and found.chance * refits < options.significance):
        return "chance"
    if not found.is_everywhere:
        return "lengths"
    if min(found.record_falls) <= -options.min_gap_share:
        return "record"
    return None if min(found.typical_falls) > options.min_fall else "little"


def has_size(model: WindowModel, options: DiscoveryOptions) -> bool:
    """Returns whether a free size of the last effect is beyond its own std, where it has one.

    It must be beyond what steps of the simulation err by too. The nodes of a curve go together, and
    with a free level or slope beside it each of them may be unknown where the curve is not: of it
    the evidence speaks, which pays for every node.
    """
    std, values, c = model.std, model.fit.values, model.candidates[-1]
    least = {n: s.smallest for n, s in zip(c.sizes, c.effect.sizes, strict=True)}
    own = [n for n in model.fit.problem.names if n.partition(" [")[0] in c.free]
    times = 0.0 if c.effect.is_curve else options.min_proof_t
    return not own or any(
        abs(values[n]) > max(times * std[n] if times else 0.0, least[n.partition(" [")[0]])
        for n in own
    )


def is_at_bound(model: WindowModel) -> bool:
    """Returns whether a size of the last effect ended on the bound of what is believed.

    The data then ask for more than physics allows: the effect stands for something else. Zero as a
    bound of a size is no effect, and no reason.
    """
    parameters, sizes = model.plant.parameters, model.candidates[-1].free
    values = {n: v for n, v in model.fit.values.items() if n.partition(" [")[0] in sizes}
    each = ((v, parameters[n.partition(" [")[0]]) for n, v in values.items())
    return any(
        bound != 0 and np.isfinite(bound) and abs(v - bound) <= BOUND_TOLERANCE * abs(bound)
        for v, p in each
        for bound in (p.lower, p.upper)
    )
