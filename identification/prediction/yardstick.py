"""What share of all that smooth forces could explain the effects of a model explain.

The smooth forces are the curves of rate, position, drive and time of each joint, all at once
(`identification.discovery.smooth_force`). What they would explain beside a model is a moment of its
linearisation over the fitted windows; blocks of windows judge it that it was not fitted to.

A law has a neighbour's name where a smooth force of what the law itself depends on explains much of
what is left beside it, beyond chance. No law is right to the last per mille, and in a long record
the least misfit is beyond chance; but the right law does not leave `MOST_LEFT` to a force of its
own kind. The law depends on the one of rate, position, drive and time over which a curve comes
closest to it:

    y = S_l η                                  what the law does in the outputs
    R_x² = max_c 1 - ‖y - S_x c‖²/‖y‖²         share of it that a curve over x can do

    T = (-(S_lᵀS_l)⁺S_lᵀS_x; 1)                the size of the law makes room for a curve beside it
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.chances import mean_above_zero
from identification.discovery.candidates import list_common
from identification.discovery.effect_results import Neighbour
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.discovery.smooth_force import SmoothForce, explained_share, find_smooth_force
from identification.effects.curves import OF_JOINT
from identification.effects.effect import Candidate, Effect
from identification.prediction.model import WindowModel
from identification.prediction.scores import condensed
from identification.prediction.screening import MAX_SCORED, places_of, some_windows
from identification.prediction.set_choice import with_fitted_shapes

ON_JOINTS = {"force", "friction"}  # hooks of laws that a smooth force of a joint may imitate
# Of what a model leaves, all that a force of what its law depends on may explain beside it. Right
# laws left less in hidden worlds, and neighbours beyond chance far more (docs/discovery.md).
MOST_LEFT = 0.1


@dataclass(frozen=True)
class Yardstick:
    """What smooth forces would still explain beside a model, over what the model leaves.

    Attributes:
        every: share of the sum of squares that forces at all joints would take.
        of_joint: share that forces at one joint would take, by its name.
        beside: what a force of what a law at joints depends on would take, by the law's key.
    """

    every: float
    of_joint: Mapping[str, float]
    beside: Mapping[tuple[str, str], Neighbour]

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


def has_neighbours_name(neighbour: Neighbour | None, options: DiscoveryOptions) -> bool:
    """Returns whether a law has the name of a neighbour of what is missing.

    Args:
        neighbour: what a smooth force would explain beside it; None where that is not known.
        options: what is beyond chance.
    """
    if neighbour is None or not uses(options, "neighbours_names"):
        return False
    is_beyond_chance = neighbour.chance < options.significance
    return is_beyond_chance and neighbour.share > MOST_LEFT


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
    laws = [c for c in with_fitted_shapes(model, model.candidates) if _is_law(c)]
    columns = [len(c.sizes) for c in (*laws, *each)]
    fit = some_windows(model.fit) if sum(columns) > MAX_SCORED else model.fit
    known = condensed(fit, [*laws, *each], {n for c in laws for n in c.sizes})
    squares, H = known.squares, known.G.sum(axis=0)
    ends = np.cumsum(columns)
    at = [np.arange(end - k, end) for end, k in zip(ends, columns, strict=True)]
    of_laws, of_curves = at[: len(laws)], at[len(laws) :]
    T = np.eye(len(H))
    if laws:
        held = np.concatenate(of_laws)
        T[held] = 0.0
        T[np.ix_(held, np.concatenate(of_curves))] = -_solved(H, held, np.concatenate(of_curves))
    G, a = T.T @ known.G @ T, known.a @ T

    def force(some: Sequence[int]) -> SmoothForce:
        here = np.concatenate([of_curves[k] for k in some])
        nodes = [len(of_curves[k]) for k in some]
        return find_smooth_force(G[:, here][:, :, here], a[:, here], nodes)

    def left(some: Sequence[int]) -> float:
        return min(1.0, force(some).gain / float(squares.sum()))

    joints = dict.fromkeys(c.where for c in each)
    of_joint = {j: left([k for k, c in enumerate(each) if c.where == j]) for j in joints}
    every = of_joint[next(iter(joints))] if len(joints) == 1 else left(range(len(each)))
    values = {**model.plant.parameters.values(), **model.fit.of_record(0)}
    # The noise of a block; the last one are the priors, which no force explains.
    samples = sum(p.cut.outputs.size for p in fit.problem.parts)
    noise = model.unseen.floor * samples / (len(squares) - 1)
    beside = {}
    for law, mine in zip(laws, of_laws, strict=True):
        places = [*joints] if not law.effect.places.get(law.where, "@") else places_of(law.where)
        η = np.array([values[n] for n in law.sizes])
        own: dict[str, list[int]] = {}
        for k, c in enumerate(each):
            if c.where in places:
                own.setdefault(c.effect.name, []).append(k)
        alike = {
            name: _done_alike(known.H, mine, η, np.concatenate([of_curves[k] for k in some]))
            for name, some in own.items()
        }
        axis = max(alike, key=lambda name: alike[name], default=None)
        if axis is None:
            continue
        gains = force(own[axis]).gains[:-1]
        logs = np.log(squares[:-1] + noise) - np.log(squares[:-1] - gains + noise)
        # Its scale has no price: a force that is not there loses on blocks it was not fitted to.
        chance = mean_above_zero(logs)[1] if logs.any() else 1.0
        left_to_it = float(np.clip(gains.sum() / squares.sum(), 0.0, 1.0))
        beside[law.key] = Neighbour(axis, left_to_it, chance)
    return Yardstick(every, of_joint, beside)


def _is_law(c: Candidate) -> bool:
    """Returns whether a candidate is a law of a force at joints, whose size holds for all records.

    Its size must be free: it makes room for the curve beside it.
    """
    is_free = len(c.free) == len(c.sizes) and not c.effect.own
    return acts_on_joints(c.effect) and not c.effect.is_curve and is_free


def _solved(H: np.ndarray, of: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Returns (S_ofᵀS_of)⁺ S_ofᵀS_by."""
    scale = np.sqrt(np.maximum(np.diag(H)[of], np.finfo(float).tiny))
    scaled = H[np.ix_(of, of)] / np.outer(scale, scale)
    right = H[np.ix_(of, by)] / scale[:, None]
    return np.asarray(np.linalg.lstsq(scaled, right, rcond=1e-9)[0] / scale[:, None])


def _done_alike(H: np.ndarray, law: np.ndarray, η: np.ndarray, curve: np.ndarray) -> float:
    """Returns the share of what a law does that a curve can do, 0 to 1."""
    whole = float(η @ H[np.ix_(law, law)] @ η)
    if not whole > 0:
        return 0.0
    return float(η @ H[np.ix_(law, curve)] @ _solved(H, curve, law) @ η) / whole
