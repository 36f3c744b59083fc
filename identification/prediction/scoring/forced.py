"""The forces on joints of candidates along a trajectory, each by its own compiled function.

    f = force(s, p),    b^± = max(0, Σ friction(s^±, p))            s: the `Joint` state of a joint
    δτ = Π (f - max(-δb⁻, min(δb⁺, g))),    Π = I - E (E'R E)⁻¹ E'R,    R = M⁻¹

p has one size at its probe. g is what is left of the force to stop the joint when friction has
resisted (`identification.native.step_slopes`): a joint that friction holds does not feel more of
it, and one that is nearly at rest feels as much of a probe as stops it. The columns of E are unit
vectors of the joints that friction holds: it answers every force so that they stay.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.effects.effect import Candidate, Effect
from identification.effects.values import numbers_at
from identification.native.joints.hook_values import hook_values
from identification.native.joints.joint_callback import Joint
from identification.prediction.scoring.directions import Directions

ON_JOINTS = {"force", "friction"}  # hooks of laws that are forces at joints
SIGN = Joint._fields.index("sign")
HELD = 1e-6  # g of a joint that friction holds at most, of the largest friction
Values = Mapping[str, float]


def acts_on_joints(effect: Effect) -> bool:
    """Returns whether an effect is a force at joints and nothing else, as a curve there may be."""
    return bool(effect.hooks) and {*effect.hooks} <= ON_JOINTS


class Forces:
    """The forces of candidates along the windows of a record.

    Args:
        along: the windows, linearised.
        values: of all parameters of the plant there.
    """

    def __init__(self, along: Directions, values: Values) -> None:
        self.along, self.values = along, values
        self.effects = {e.name: e for e in along.plant.effects}
        g = along.slopes.g
        slipping = np.array(along.slopes.joints)
        slipping[..., SIGN] = np.where(g > 0, 1.0, -1.0)
        self._seen = {"force": along.slopes.joints, "friction": slipping}
        self._friction = np.zeros(g.shape)
        for effect in along.plant.effects:
            if "friction" in effect.hooks and any(values[n] for n in effect.every_size):
                for k, joint in enumerate(along.plant.joints):
                    self._friction[:, k] += self._at(effect, "friction", joint, k, values)

        largest = np.abs(self._friction).max(axis=1, initial=0.0)[:, None]
        is_held = (self._friction > 0) & (np.abs(g) < HELD * largest)
        self._holding = np.flatnonzero(is_held.any(axis=1))
        E, R = is_held[self._holding], along.slopes.R[self._holding]
        ends = E[:, :, None] & E[:, None]
        eye = np.eye(g.shape[1])
        answer = np.linalg.solve(np.where(ends, R, eye * ~E[:, None]), np.where(E[..., None], R, 0))
        self._passed = eye - answer  # Π where a joint is held

    def of_size(self, candidate: Candidate, size: str, probe: float) -> np.ndarray:
        """Returns δτ of a size at its probe, shape (P, J) [N m or N]."""
        effect, g = self.effects[candidate.effect.name], self.along.slopes.g
        changed = {**self.values, **candidate.fixed}
        changed[size] += probe
        τ, more = np.zeros(g.shape), np.zeros(g.shape)
        for k, joint in enumerate(self.along.plant.joints):
            for hook, to in (("force", τ), ("friction", more)):
                if hook in effect.hooks:
                    to[:, k] = self._at(effect, hook, joint, k, changed)
                    to[:, k] -= self._at(effect, hook, joint, k, self.values)
        if "friction" in effect.hooks:
            δb = np.maximum(0.0, self._friction + more) - np.maximum(0.0, self._friction)
            τ -= np.sign(g) * np.minimum(δb, np.abs(g))
        return self.passed(τ)

    def passed(self, τ: np.ndarray) -> np.ndarray:
        """Returns forces at the points, shape (..., P, J), with what held joints answer to them."""
        at, out = self._holding, np.array(τ)
        out[..., at, :] = np.einsum("pij,...pj->...pi", self._passed, out[..., at, :])
        return out

    def _at(self, effect: Effect, hook: str, joint: str, k: int, values: Values) -> np.ndarray:
        """Returns what a hook of an effect adds at a joint, shape (P,)."""
        numbers = [float(x) for x in numbers_at(effect, joint, values)]
        if not any(numbers[: len(effect.sizes)]):
            return np.zeros(len(self.along.slopes.g))
        return hook_values(effect.hooks[hook], self._seen[hook][:, k], numbers)
