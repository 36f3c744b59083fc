"""What is known of the free parameters before a log speaks, and the scatter of alike parts.

    r = [ ... ; W (q̄ - q) ],    W = diag(1/s)             the last rows of the residual of a fit

Parts of a robot that are alike, such as its drives, share one std s_g. It is found from the data:

    x = q - q̄,   x_j ~ N(0, s_g²) for the n values j of a group g,   p(s_g) ∝ s_g
    V = (FᵀF + S⁻²)⁻¹,   x̂ = V Fᵀ y,   s_g² ← sum over j of (x̂_j² + V_jj) / (n - 1)     (EM)

F and y are the whitened sensitivities and the residual about a fit. The s that this ends at is the
most probable one where x is integrated out (type-II maximum likelihood: MacKay 1992; Tipping 2001).
The prior p(s) ∝ s makes n - 1 of n. Without it the best s is often almost zero though the data tell
little of it, and then the std of every x_j is far too small (Chung, Rabe-Hesketh, Dorie, Gelman,
Liu 2013, Psychometrika 78). With it s falls only where the data say so, by more than one unit of
log likelihood.

The s before is the largest that is believed: what deviates farther is an effect, and no scatter.
Where the parts are alike s falls to a fraction of what the data can tell of one part, and the
deviations are almost free of charge.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from identification.logs.log import Log
from identification.model.coordinates import NOTHING, Coordinates, coordinates
from identification.model.predictor import Plant, Predictor

MAX_EM_ROUNDS = 200  # each costs one inverse of FᵀF
EM_TOLERANCE = 1e-3  # relative change of every s below which EM ends
MIN_STD_SHARE = 1e-2  # of the s before: below it a deviation moves nothing that a log would show


@dataclass(frozen=True)
class Priors:
    """Free parameters, and what is known of each before a log speaks."""

    space: Coordinates = NOTHING  # their coordinates and bounds, p of them
    mean: np.ndarray = field(default_factory=lambda: np.zeros(0))  # q̄, shape (p,)
    # 1/s in coordinates, zero where nothing is known, shape (p,)
    weight: np.ndarray = field(default_factory=lambda: np.zeros(0))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return self.space.names

    @classmethod
    def of(cls, space: Coordinates, mean: np.ndarray, std: Mapping[str, float]) -> Priors:
        """Returns priors with the std s of some parameters, by name."""
        return cls(space, mean, np.array([1 / std.get(name, np.inf) for name in space.names]))

    @property
    def rows(self) -> np.ndarray:
        """W, the last rows of the sensitivities, shape (p, p)."""
        return np.diag(self.weight)

    def against(self, q: np.ndarray) -> np.ndarray:
        """Returns W (q̄ - q), the last rows of the residual, shape (p,)."""
        return self.weight * (self.mean - q)

    def plus(self, other: Priors) -> Priors:
        """Returns the prior of these parameters, then of others."""
        a, b = self.space, other.space
        space = Coordinates(
            (*a.names, *b.names), np.concatenate([a.logarithmic, b.logarithmic]).astype(bool),
            np.concatenate([a.lower, b.lower]), np.concatenate([a.upper, b.upper]),
            np.concatenate([a.scale, b.scale]),
        )  # fmt: skip
        mean, weight = (np.concatenate([getattr(self, f), getattr(other, f)])
                        for f in ("mean", "weight"))  # fmt: skip
        return Priors(space, mean, weight)

    def taken(self, places: np.ndarray, names: Sequence[str] | None = None) -> Priors:
        """Returns the prior of some of the entries, under other names where they are given."""
        s, at = self.space, np.asarray(places, int)
        names = [s.names[k] for k in at] if names is None else names
        space = Coordinates(tuple(names), s.logarithmic[at], s.lower[at], s.upper[at], s.scale[at])
        return Priors(space, self.mean[at], self.weight[at])

    def only(self, names: Sequence[str]) -> Priors:
        """Returns the prior of the parameters that have one of these names."""
        return self.taken(np.array([k for k, n in enumerate(self.names) if n in names], int))


def free_parameters(
    plant: Plant, log: Log, names: Sequence[str], start: Mapping[str, float]
) -> tuple[Predictor, Coordinates, np.ndarray]:
    """Returns the predictor, the coordinates and the starting values (p,) of named parameters.

    Raises:
        InputError: a name is unknown, or a start is out of bounds.
    """
    for name in (*names, *start):
        plant.parameters[name]
    values = {**plant.parameters.values(), **start}
    first = np.array([values[name] for name in names])
    space = coordinates(plant.parameters, names, first)
    return Predictor(plant, log, tuple(names), dict(start)), space, first


def estimate_scatter(
    priors: Priors, q: np.ndarray, F: np.ndarray, y: np.ndarray, groups: Mapping[str, Sequence[str]]
) -> dict[str, float]:
    """Returns the most probable std of each group's prior, given the data, by group.

    Args:
        priors: under which the data were fitted.
        q: the estimate, shape (p,).
        F: whitened sensitivities there, shape (n, p).
        y: whitened residual there, shape (n,).
        groups: names of free parameters that share one std; that of a single one stays.
    """
    places = {g: [priors.names.index(n) for n in names] for g, names in groups.items()}
    before = {g: 1 / priors.weight[at[0]] for g, at in places.items()}
    x = q - priors.mean
    H, b = F.T @ F, F.T @ (y + F @ x)
    weight, s = priors.weight.copy(), dict(before)
    for _ in range(MAX_EM_ROUNDS):
        V = np.linalg.inv(H + np.diag(weight**2))
        power = (V @ b) ** 2 + np.diag(V)
        new = {
            g: float(np.clip(_most_probable(power[at]), MIN_STD_SHARE * before[g], before[g]))
            for g, at in places.items()
        }
        moved = max((abs(new[g] / s[g] - 1) for g in new), default=0.0)
        s = new
        for g, at in places.items():
            weight[at] = 1 / s[g]
        if moved < EM_TOLERANCE:
            break
    return s


def _most_probable(power: np.ndarray) -> float:
    """Returns the s of a group from x̂² + V of its n values; infinite where it has only one."""
    n = len(power)
    return float(np.sqrt(power.sum() / (n - 1))) if n > 1 else np.inf
