"""The shapes of laws, fitted where grids only try a few of their values.

    max over s of  a(s)ᵀ G(s)⁻¹ a(s)        a = S⊥(s)ᵀ r,   G = S⊥(s)ᵀ S⊥(s)

S⊥(s) are the columns of a law with the shapes s (a Stribeck velocity, a wave number) without what
the fit's columns explain, and r is what the fit leaves. The sizes are the least squares ones for
each s (Golub, Pereyra 1973), so that the search is over one or two numbers, from the best value of
the grid. A law whose shape is only near the right one leaves a pattern, which a curve then draws
better than the law.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy import optimize

from identification.effects.sizes import Shape
from identification.torques.equations.equations import Equations
from identification.torques.laws import Missing
from identification.torques.moments import Base, Weighted
from identification.torques.scores import CHANCE, Score, rank

MOST_REFINED = 8  # laws whose shapes are fitted, the best ones
PRECISION = 1e-3  # of a shape, in units of its bounds
MOST_TRIES = 60  # of shapes of one law


def explained_by(equations: Equations, base: Base) -> Callable[[Missing], float]:
    """Returns what tells how much a law explains of the fitted blocks beside a fit."""
    weighted, seen, H, θ = Weighted(equations, base), ~equations.confirms, base.fit.H, base.fit.θ

    def explained(missing: Missing) -> float:
        """Returns the fall of the weighted sum of squares by a law with its best sizes."""
        if (of := weighted.moments(missing.columns())) is None:
            return 0.0
        cross, own = (m[seen].sum(axis=0) for m in of)
        G = own - cross[:-1].T @ np.linalg.solve(H, cross[:-1])
        a = cross[-1] - cross[:-1].T @ θ
        η = np.linalg.lstsq(G, a, rcond=1e-9)[0]
        if any(s * sign < 0 for s, sign in zip(η, missing.signs, strict=True)):
            return 0.0
        return float(a @ η)

    return explained


def refined(explained: Callable[[Missing], float], missing: Missing) -> Missing:
    """Returns a law with the shapes that explain most."""
    if missing.reshaped is None:
        return missing
    bounds = [_bounds(s) for s in missing.shapes]
    logs = np.array([low > 0 for low, _ in bounds])
    low, high = (np.where(logs, np.log(np.where(logs, b, 1.0)), b) for b in np.array(bounds).T)
    wide = np.where(high > low, high - low, 1.0)

    def shapes(u: np.ndarray) -> list[float]:
        x = low + wide * np.clip(u, 0.0, 1.0)
        x = np.where(logs, np.exp(x), x)
        return [float(v if s.free else round(v)) for v, s in zip(x, missing.shapes, strict=True)]

    def left(u: np.ndarray) -> float:
        return -explained(missing.reshaped(shapes(u)))  # type: ignore[misc]

    at = np.array([value for _, value, _ in missing.shape])
    u = (np.where(logs, np.log(np.where(logs, at, 1.0)), at) - low) / wide
    first = np.vstack([u, u + np.diag(np.where(u < 0.5, 0.1, -0.1))])
    best = optimize.minimize(
        left, u, method="Nelder-Mead",
        options={"initial_simplex": first, "xatol": PRECISION, "fatol": 0.0, "maxfev": MOST_TRIES},
    )  # fmt: skip
    return missing.reshaped(shapes(best.x)) if best.fun < left(u) else missing


def _bounds(shape: Shape) -> tuple[float, float]:
    """Returns where a shape is searched: the grid's reach, and what is admissible of a power."""
    return max(shape.lower, min(shape.grid) / 2), min(shape.upper, 2 * max(shape.grid))


def with_shapes(
    equations: Equations, base: Base, scores: Sequence[Score], asked: int
) -> tuple[Score, ...]:
    """Returns scores in which the best laws have the shapes that explain most, the best first.

    `scores` have the best shapes of the grids, and `asked` counts each of these shapes.
    """
    explained = explained_by(equations, base)
    likely = [s for s in scores if s.chance < CHANCE and s.is_plausible]
    some = [s.missing for s in likely if s.missing.reshaped][:MOST_REFINED]
    if not some:
        return tuple(scores)
    better = {m.key: refined(explained, m) for m in some}
    return rank(equations, base, [better.get(s.missing.key, s.missing) for s in scores], asked)
