"""Whether unseen records prove an effect, and what is against it where they do not."""

from __future__ import annotations

from typing import Literal

from identification.discovery.options import DiscoveryOptions
from identification.prediction.model import WindowModel
from identification.prediction.unseen import Prediction

Doubt = Literal["numbers", "chance", "lengths", "record", "little", "size", "exchange"]


def find_doubt(found: Prediction, refits: int, options: DiscoveryOptions) -> Doubt | None:
    """What is against an effect on unseen windows; None where they prove it.

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
    """Whether a free size of the last effect is beyond its own std, where it has one.

    It must be beyond what steps of the simulation err by too.
    """
    std, values, c = model.std, model.fit.values, model.candidates[-1]
    least = {n: s.smallest for n, s in zip(c.sizes, c.effect.sizes, strict=True)}
    own = [n for n in model.fit.problem.names if n.partition(" [")[0] in c.free]
    return not own or any(
        abs(values[n]) > max(options.min_proof_t * std[n], least[n.partition(" [")[0]]) for n in own
    )
