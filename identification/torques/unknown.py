"""Laws that have the name of a neighbour of what is missing, judged by smooth forces beside them.

    S⊥ = S - Φ H⁻¹ Φᵀ S,  r = y - Φ θ̂          Φ: columns of the fit, the law among them
    f = gain of S⊥ on blocks that it was not fitted to        l: squares that the law takes away
    no name where  f/(l + f) > MOST_OF_BOTH                   and it is likely to be no luck

S are the curves of a joint and, where a law acts at it, its surfaces over two variables, as windows
have them (`identification.prediction.yardstick`). What curves that cannot draw the law take by
themselves does not count: a force of the position beside a friction is another thing. A law without
a joint of its own, of a body or a drive, is judged by the curves at each joint.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.chances import mean_above_zero
from identification.discovery.neighbour import has_name_of_neighbour, of_both
from identification.discovery.smooth_force import find_smooth_force
from identification.effects.effect import Effect
from identification.effects.surfaces import X_NODES, Y_NODES
from identification.effects.variables import variables
from identification.torques.equations import Columns, Equations, left_over
from identification.torques.fits import Fitted
from identification.torques.laws import CURVES, Laws, Missing
from identification.torques.scores import Score, Weighted

SURFACES = (("v", "q"), ("f_u", "q"), ("f_u", "v"))


@dataclass(frozen=True, kw_only=True)
class Neighbour:
    """What a smooth force explains beside a law."""

    law: Score  # the law
    joint: int  # where the force acts
    share: float  # of what the fit leaves there, that it takes away on blocks it was not fitted to
    chance: float  # of as much by luck
    of_both: float  # what it explains of what law and force explain together

    @property
    def has_name(self) -> bool:
        """Tells whether the law has the name of a neighbour of what is missing."""
        return has_name_of_neighbour(self.of_both, self.chance)


def find_neighbour(
    equations: Equations, nominal: Fitted, final: Fitted, without: Fitted, law: Score,
    laws: Laws, curves: Sequence[Missing], effects: Mapping[str, Effect],
) -> Neighbour | None:  # fmt: skip
    """Returns the smooth force that speaks most against the name of a law.

    Args:
        equations: of the records.
        nominal: the model fit without effects, whose errors are the units.
        final: with all that was found.
        without: with all but the law.
        law: one of those that were found.
        laws: of the joints, whose states surfaces take.
        curves: candidates that are drawn from the data.
        effects: of the catalogue by name.
    """
    seen = ~equations.confirms
    weights = nominal.fit.weights
    left, before = (
        weights * left_over(f.base.M[:, seen].sum(axis=1), np.tile(f.fit.θ, (equations.joints, 1)))
        for f in (final, without)
    )
    acts = law.missing.columns().joints
    own = acts is not None and len(acts) == 1 and law.missing.name in effects
    of_law = variables(effects[law.missing.name]) if own else frozenset()
    places = acts if acts is not None else range(equations.joints)
    explained = max(0.0, float((before - left).sum()))
    weighted, out = Weighted(equations, final.base), []
    for j in places:
        some = [(c.columns(), _of_curve(c)) for c in curves if c.columns().joints == (j,)]
        if own:
            some += [(_surface(equations, laws, j, xy), {*xy}) for xy in SURFACES]
        some = [(c, x) for c, x in some if c.values.any()]
        others = [c for c, x in some if of_law and not x & of_law]
        every = _gains(equations, final, weighted, [c for c, _ in some])
        gains = every - _gains(equations, final, weighted, others)
        unit = weights[j] / max(final.fit.weights[j], 1e-300)
        force = max(0.0, float(gains.sum())) * unit
        chance = float(mean_above_zero(gains)[1]) if force > 0 else 1.0
        share = min(1.0, force / left[j]) if left[j] > 0 else 0.0
        out.append(Neighbour(
            law=law, joint=j, share=share, chance=chance, of_both=of_both(explained, force),
        ))  # fmt: skip
    return max(out, key=lambda n: (n.has_name, n.of_both), default=None)


def _of_curve(curve: Missing) -> set[str]:
    return {x for end, x in CURVES.items() if curve.name.endswith(end)}


def _surface(equations: Equations, laws: Laws, j: int, xy: tuple[str, str]) -> Columns:
    """Returns the columns of a surface at a joint (`identification.effects.surfaces`)."""
    s, used = laws.states[laws.names[j]], equations.stacked("used")[:, j]
    top = {"v": s.v_top, "f_u": s.f_top}
    x = np.asarray(getattr(s, xy[0])) / top[xy[0]]
    y = (s.q - s.q_mid) / s.q_far if xy[1] == "q" else np.asarray(s.v) / s.v_top
    half = X_NODES // 2
    of_x = np.delete(_hats(np.sign(x) * np.sqrt(np.abs(x)), np.linspace(-1, 1, 2 * half + 1)),
                     half, axis=1)  # fmt: skip
    of_y = _hats(np.asarray(y), np.linspace(-1, 1, Y_NODES))
    out = np.zeros((*equations.stacked("used").shape, X_NODES * Y_NODES))
    out[used, j] = -(of_x[:, :, None] * of_y[:, None, :]).reshape(len(x), -1)
    return Columns(out, (j,))


def _hats(x: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """Returns functions of x (n,) that are one at a node and straight between, (n, nodes)."""
    return np.stack([np.interp(x, nodes, e) for e in np.eye(len(nodes))], axis=1)


def _gains(
    equations: Equations, fitted: Fitted, weighted: Weighted, some: Sequence[Columns]
) -> np.ndarray:
    """Returns what the best smooth force of some columns takes of each fitted block, shape (B,)."""
    seen = ~equations.confirms
    felt = [c.values[:, :, np.abs(c.values).max(axis=(0, 1)) > 0] for c in some]
    if not felt:
        return np.zeros(int(seen.sum()))
    moments = weighted.moments(Columns(np.concatenate(felt, axis=2), some[0].joints))
    if moments is None:
        return np.zeros(int(seen.sum()))
    cross, own = (m[seen] for m in moments)
    whole = np.einsum("j,jbpq->bpq", fitted.fit.weights, fitted.base.M)[seen]
    A, a, θ = whole[:, :-1, :-1], whole[:, :-1, -1], fitted.fit.θ
    H = fitted.fit.H
    scale = 1 / np.sqrt(np.maximum(np.diag(H), 1e-300))
    inverse = np.linalg.pinv(H * np.outer(scale, scale), rcond=1e-14, hermitian=True)
    C = inverse * np.outer(scale, scale) @ cross[:, :-1].sum(axis=0)
    mixed = np.swapaxes(cross[:, :-1], 1, 2) @ C
    G = own - mixed - np.swapaxes(mixed, 1, 2) + C.T @ A @ C
    g = cross[:, -1] - np.einsum("bpm,p->bm", cross[:, :-1], θ) - (a - A @ θ) @ C
    return find_smooth_force(G, g, [x.shape[2] for x in felt]).gains
