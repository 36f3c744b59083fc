"""What share of all that smooth forces could explain the effects of a model explain.

The smooth forces are the curves of rate, position, drive and time of each joint, all at once
(`identification.discovery.smooth_force`). What they would explain beside a model is a moment of its
linearisation over the fitted windows; blocks of windows judge it that it was not fitted to.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.candidates import list_common
from identification.discovery.smooth_force import SmoothForce, explained_share, find_smooth_force
from identification.effects.curves import OF_JOINT
from identification.effects.effect import Candidate, Effect
from identification.prediction.model import WindowModel
from identification.prediction.scores import condensed
from identification.prediction.screening import MAX_SCORED, places_of, some_windows

ON_JOINTS = {"force", "friction"}  # hooks of laws that a smooth force of a joint may imitate


@dataclass(frozen=True)
class Yardstick:
    """What smooth forces would still explain beside a model, over what the model leaves."""

    every: float  # share of the sum of squares that forces at all joints would take
    of_joint: Mapping[str, float]  # share that forces at one joint would take, by its name

    def share(self, before: float, after: float) -> float | None:
        """Returns what a model explains of what it and smooth forces at all joints could.

        Args:
            before: sum of squares without its effects.
            after: with them.
        """
        return explained_share(before, after, self.every * after)

    def share_of(self, candidate: Candidate, fall: float) -> float | None:
        """Returns what an effect explains of what it and smooth forces at its joints could.

        Args:
            candidate: the effect at its place.
            fall: share of the sum of squares that it took away.

        Returns:
            None for what is no law of a joint.
        """
        joints = [j for j in places_of(candidate.where) if j in self.of_joint]
        if not acts_on_joints(candidate.effect) or not joints:
            return None
        most = max(self.of_joint[j] for j in joints)
        return explained_share(1.0, 1.0 - fall, most * (1.0 - fall))


def acts_on_joints(effect: Effect) -> bool:
    """Returns whether an effect is a force at joints and nothing else, as a curve there may be."""
    return bool(effect.hooks) and {*effect.hooks} <= ON_JOINTS


def measure(model: WindowModel, effects: Sequence[Effect]) -> Yardstick | None:
    """Returns what smooth forces would still explain beside a model; None where there are none.

    Args:
        model: fitted.
        effects: of the catalogue, of which the curves of a joint make the smooth forces.

    Raises:
        DivergenceError: the model cannot be simulated beside its values.
    """
    has = {c.key for c in model.candidates}
    curves = [e for e in effects if e.is_curve and e.name.endswith(OF_JOINT)]
    each = [c for c in list_common(curves) if c.key not in has and c.effect.places[c.where]]
    if not each:
        return None
    columns = [len(c.sizes) for c in each]
    fit = some_windows(model.fit) if sum(columns) > MAX_SCORED else model.fit
    known = condensed(fit, each)
    G, a, squares = known.G, known.a, known.squares
    ends = np.cumsum(columns)
    of_curves = [np.arange(end - k, end) for end, k in zip(ends, columns, strict=True)]

    def force(some: Sequence[int]) -> SmoothForce:
        here = np.concatenate([of_curves[k] for k in some])
        nodes = [len(of_curves[k]) for k in some]
        return find_smooth_force(G[:, here][:, :, here], a[:, here], nodes)

    def left(some: Sequence[int]) -> float:
        return min(1.0, force(some).gain / float(squares.sum()))

    joints = dict.fromkeys(c.where for c in each)
    of_joint = {j: left([k for k, c in enumerate(each) if c.where == j]) for j in joints}
    every = of_joint[next(iter(joints))] if len(joints) == 1 else left(range(len(each)))
    return Yardstick(every, of_joint)
