"""What candidate effects change of the start: the cables' ways, the load, the elasticity.

The robot starts at rest, effects and all: the pretension balances what they do to the ways of the
cables and to the platform's load, and d₀(0) follows from the cable's own law.

    T(0) = λ ε + ΔT(ε)        solved for ε by secant steps
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from inca_mj.effects.hooks import Drive, DriveEffect, Platform
from inca_mj.effects.values import drive_values, present
from inca_mj.geometry import DRIVES, Geometry
from inca_mj.kinematics import rotation
from inca_mj.parameters import GRAVITY

SECANTS = 12  # more than enough: each adds half as many digits again
UNKNOWN = dict.fromkeys(Drive._fields, np.nan)


@dataclass(frozen=True)
class Change:
    """What the effects that are there change at rest.

    Attributes:
        longer: Δd of each cable, shape (8,) [m].
        turned: ∂Δd/∂r of each cable, in O, shape (8, 3).
        load: added to the wrench to carry, in O, about the platform's frame, shape (6,) [N, N m].
        values: of all parameters, in SI units.
        stiffening: effects that add to the tension.
    """

    longer: np.ndarray
    turned: np.ndarray
    load: np.ndarray
    values: Mapping[str, float]
    stiffening: tuple[DriveEffect, ...]

    def strain(self, T: np.ndarray) -> np.ndarray:
        """ε(0) at tensions T, shape (8,)."""
        lambda_ = self.values["lambda"]
        one = np.ones(DRIVES)
        strain, last, error = T / lambda_, 0 * one, -T
        for _ in range(SECANTS if self.stiffening else 0):
            wrong = lambda_ * strain + self._added(strain) - T
            moved = (strain != last) & (wrong != error)
            slope = np.divide(wrong - error, strain - last, where=moved, out=lambda_ * one)
            last, error, strain = strain, wrong, strain - wrong / slope
        return strain

    def _added(self, strain: np.ndarray) -> np.ndarray:
        out = np.zeros(DRIVES)
        for effect in self.stiffening:
            p = drive_values(effect, self.values)
            for k in range(DRIVES):
                s = Drive(**{**UNKNOWN, "strain": strain[k], "lambda_": self.values["lambda"],
                             "x": strain[k], "strain_rate": 0.0})  # fmt: skip
                if effect.tension is not None:
                    out[k] += effect.tension(s, tuple(p[:, k]))
        return out


def change_at_rest(
    values: Mapping[str, float], pose: np.ndarray, geometry: Geometry,
    effects: Sequence[DriveEffect],
) -> Change | None:  # fmt: skip
    """What the effects present in `values` change at a pose; None when nothing does."""
    there = [e for e in effects if _touches(e) and present(e, values)]
    if not there:
        return None
    R = rotation(*pose[3:])
    r = pose[:3] + geometry.B @ R.T - geometry.A
    way, load = np.zeros((DRIVES, 4)), np.zeros(6)
    for effect in there:
        p = drive_values(effect, values)
        for k in range(DRIVES):
            own: dict[str, Any] = {
                **UNKNOWN,
                **dict(zip(("rx", "ry", "rz"), r[k], strict=True)),
                "d": np.linalg.norm(r[k]),
            }
            s = Drive(**own)
            if effect.path is not None:
                way[k] += effect.path(s, tuple(p[:, k]))
            if effect.force is not None:
                F = np.array(effect.force(s, tuple(p[:, k])))
                load -= np.concatenate([F, np.cross(geometry.B[k] @ R.T, F)])
        if effect.wrench is not None:
            still = Platform(0.0, *pose[:3], *np.zeros(6))
            load -= np.array(effect.wrench(still, tuple(p[:, 0])))
        if effect.entries:  # the centre of mass lies elsewhere in the platform
            F = np.array([0, 0, -values["m"] * GRAVITY])
            load -= np.concatenate([np.zeros(3), np.cross(R @ p[:, 0], F)])
    stiffening = tuple(e for e in there if e.tension is not None)
    return Change(way[:, 0], way[:, 1:], load, values, stiffening)


def _touches(effect: DriveEffect) -> bool:
    """Whether an effect can change anything at rest."""
    return any((effect.path, effect.force, effect.tension, effect.wrench, effect.entries))
