"""How much of the torques' residual each candidate would explain, also on unseen blocks.

    S⊥ = S - Φ H⁻¹ Φᵀ S,   r = y - Φ θ̂                 Φ: columns of the fit, H with its priors
    η̂ = (S⊥ᵀ S⊥)⁻¹ S⊥ᵀ r                               the sizes
    g_b = ln ‖r_b‖² - ln ‖r_b - ...‖²                   of block b, both fits without its fold

The chance is that of a test by blocks (`identification.estimation.block_test`), times the number of
candidates that were asked (Bonferroni). The fall and its t are those of folds of neighbouring
blocks, each predicted by fits to all others. Few blocks of a record that confirms tell little:
where they make a candidate likely, those of the fitted records prove it too. Where a free parameter
is more than 3 std from what was known of it, it may stand for the missing effect, and hide it: then
t may also be that of fits in which these parameters are held at what was known, if these fits
predict better with it than the free ones without. A candidate is proven if chance and t say so; of
proven ones that predict alike, as t of their blocks' differences tells, the one with the fewest
numbers is taken, sizes and shapes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Literal

import numpy as np

from identification.chances import mean_above_zero
from identification.discovery.neighbour import falls_short
from identification.estimation.block_test import (
    Scatter,
    common_scatter,
    covariance,
    make_blocks,
    p_values,
    scatter_of,
)
from identification.torques.equations.consistency import nearest_body
from identification.torques.equations.equations import Equations, unit_inverse, unseen_squares
from identification.torques.laws import Missing
from identification.torques.moments import Base, Weighted, held_by, joined

Doubt = Literal["", "sign", "large", "body", "rise", "unseen", "chance"]
CHANCE = 0.05  # of any candidate by luck
PROOF = 3.0  # t of the fall on blocks that the fit did not see, or of a difference between two
LIKELY = 2.0  # t on blocks that confirm, from which blocks of fitted records may prove the rest
POSSIBLE = 2.0  # std of a load's sizes, from the nearest ones that a body may have
FAR = 3.0  # std of what was known, from which a free value may stand for something else
RISE = 0.05  # of a joint's mean square, that is no rise
HELD = 1e8  # times its precision, a prior holds a value
UNFELT = 1e-6  # share of a column that the fit's columns leave, below which they imitate it


@dataclass(frozen=True, kw_only=True)
class Score:
    """What a candidate would explain."""

    missing: Missing  # which
    size: np.ndarray  # η̂, shape (m,), in the units of its sizes
    std: np.ndarray  # by blocks, shape (m,)
    chance: float  # of as much by luck, for the best of all that were asked
    fall: float  # of the mean square on blocks that the fit did not see; negative where it rises
    t: float  # of the fall
    gains: np.ndarray  # g of each block that judges, by fits that did not see it, shape (B,)
    every: np.ndarray  # g of each block of all records, by such fits
    # share of the mean square, without it, of the joints on which it acts
    share: float = 1.0
    held_t: float = 0.0  # t with the free parameters at what was known; 0 where it is not asked for

    @property
    def reach(self) -> float:
        """How far it changes along the motion: a constant force is friction, which fits have."""
        f = self.missing.columns().values @ self.size
        return float(max(np.ptp(x[x != 0]) if x.any() else 0.0 for x in f.T))

    @property
    def confirmed_t(self) -> float:
        """T of the fall, of blocks of all records if those that confirm make it likely."""
        return self.t if self.t < LIKELY else max(self.t, t_of(self.every))

    @property
    def is_proven(self) -> bool:
        """Tells whether it is beyond chance and confirmed by blocks that the fit did not see."""
        return not self.doubt

    @property
    def doubt(self) -> Doubt:
        """Why it is not proven, in a word; "" where it is.

        "sign", "large" and "body": no robot has such a size, whatever it explains. "rise", "unseen"
        and "chance": blocks do not prove it.
        """
        if not self.is_plausible:
            return self._implausible()
        if not self.fall > 0:
            return "rise"
        if not max(self.confirmed_t, self.held_t) > PROOF:
            return "unseen"
        return "" if self.chance < CHANCE else "chance"

    def _implausible(self) -> Doubt:
        if any(s * sign < 0 for s, sign in zip(self.size, self.missing.signs, strict=True)):
            return "sign"
        sizes = zip(self.size, self.missing.most, strict=True)
        return "large" if any(abs(s) > most for s, most in sizes) else "body"

    def is_like(self, other: Score) -> bool:
        """Returns whether it predicts unseen blocks as well as another one, but for chance.

        A stop acts in few blocks, so that luck can always explain by how much a curve is better
        than a spring. So what falls far short of the other one does not predict as well either.
        """
        difference = other.every - self.every
        is_chance = not difference.any() or mean_above_zero(difference)[0] < PROOF
        return is_chance and not falls_short(self.fall / other.share, other.fall / other.share)

    @property
    def is_plausible(self) -> bool:
        """Tells whether its sizes are some that a robot may have."""
        pairs = zip(self.size, self.missing.signs, self.missing.most, strict=True)
        if not all(abs(s) <= most and s * sign >= 0 for s, sign, most in pairs):
            return False
        return bool((np.abs(self.possible - self.size) <= POSSIBLE * self.std).all())

    @cached_property
    def possible(self) -> np.ndarray:
        """The nearest sizes that a body may have, shape (m,): its pseudo-inertia is not negative.

        Those of a load; other sizes are as they are.
        """
        if self.missing.of_body is None or not (self.std > 0).all():
            return self.size
        return nearest_body(self.missing.of_body[0], self.size, self.std, self.missing.of_body[1])


def rank(
    equations: Equations, base: Base, candidates: Sequence[Missing], asked: int = 0
) -> tuple[Score, ...]:
    """Returns the score of each candidate with its best shape, the best on unseen blocks first.

    `base` is the fit without them, and `asked` the number of candidates of which they are the best.
    """
    unit, scale = unit_inverse(base.fit.H)
    values, vectors = np.linalg.eigh(unit)
    root = (vectors * np.sqrt(np.maximum(values, 0.0))).T * scale  # Λ^½: rootᵀ root = H⁻¹
    inverse = unit * np.outer(scale, scale)
    whole, seen = np.einsum("j,jbpq->bpq", base.fit.weights, base.M), ~equations.confirms
    has = equations.counts.sum(axis=0) > 0  # a block in which all joints rest has none
    judged = equations.judges & has
    told = judged[has]
    G = whole[seen]

    priors = [base.P]
    if (np.abs(base.far) > FAR).any():
        priors.append(np.where(np.arange(len(base.P)) < base.known, HELD * base.P, base.P))

    def squares_of(M: np.ndarray, held: np.ndarray) -> list[np.ndarray]:
        one, θ_0, confirms = np.ones(1), np.append(base.θ_0, 0 * held), equations.confirms
        left = (unseen_squares(M[None], one, np.append(P, held), θ_0, confirms) for P in priors)
        return [np.log(x[0, has]) for x in left]

    unseen = squares_of(whole, np.zeros(0))
    of_joints = base.fit.weights * base.unseen(equations.confirms)[:, judged].sum(axis=1)
    weighted = Weighted(equations, base)
    found: list[tuple[Missing, np.ndarray, Scatter, list[np.ndarray], float]] = []
    left_out: list[Missing] = []
    for missing in chain(candidates, left_out):  # these are scored with the sizes that are apart
        columns = missing.columns()
        if (of := weighted.moments(columns)) is None:
            continue
        both = joined(whole, *of)
        cross, own = of[0][seen], of[1][seen]  # (B, p + 1, m), (B, m, m)
        C = inverse @ cross[:, :-1].sum(axis=0)
        P_b = cross[:, :-1] - G[:, :-1, :-1] @ C
        G_b = own - C.T @ cross[:, :-1] - np.swapaxes(cross[:, :-1], 1, 2) @ C
        G_b = G_b + C.T @ G[:, :-1, :-1] @ C
        felt, left = np.diag(own.sum(axis=0)), np.diag(G_b.sum(axis=0))
        apart = left > UNFELT * felt
        if not apart.all():
            if apart.any() and len(apart) > 1:
                left_out.append(missing.only(apart))
            continue
        r_b = cross[:, -1] - np.einsum("bpm,p->bm", cross[:, :-1], base.fit.θ)
        r_b = r_b - (G[:, :-1, -1] - G[:, :-1, :-1] @ base.fit.θ) @ C
        prior = base.P * (base.θ_0 - base.fit.θ)
        below = -np.sqrt(base.P)[:, None] * C  # rows of the priors, a last block
        G_all = np.concatenate([G_b, (below.T @ below)[None]])
        a_all = np.concatenate([r_b, (-C.T @ prior)[None]])
        Z = np.concatenate([root @ P_b, (root @ (np.sqrt(base.P)[:, None] * below))[None]])
        blocks = make_blocks(G_all[:, None], Z[:, :, None])
        η = np.linalg.lstsq(G_all.sum(axis=0), a_all.sum(axis=0), rcond=1e-12)[0]
        scatter = scatter_of(blocks, a_all[:, None], np.ones(1), np.array([missing.signs]))
        acts = slice(None) if columns.joints is None else [*columns.joints]
        share = float(of_joints[acts].sum() / of_joints.sum())
        found.append((missing, η, scatter, squares_of(both, held_by(missing, own)), share))
    common = common_scatter([scatter for _, _, scatter, _, _ in found])
    scores = []
    for missing, η, scatter, squares, share in found:
        p = float(p_values(scatter, common)[0])
        every, *held = (a - b for a, b in zip(unseen, squares, strict=True))
        gains, held = every[told], [h[told] for h in held]
        every = every if equations.all_judge else gains
        std = np.sqrt(np.maximum(np.diag(covariance(scatter, common)[0]), 0.0))
        t, held_t = (t_of(g) for g in (gains, *held, 0 * gains)[:2])
        if held and not float((unseen[0] - squares[1])[told].sum()) > 0:
            held_t = 0.0  # it does not make up for what the free values do
        scores.append(Score(
            missing=missing, size=η, std=std, chance=min(1.0, p * max(asked, len(found))), t=t,
            fall=1 - float(np.exp(squares[0][told]).sum() / np.exp(unseen[0][told]).sum()),
            gains=gains, every=every, held_t=held_t, share=share,
        ))  # fmt: skip
    best: dict[tuple[str, str], Score] = {}
    for score in sorted(scores, key=lambda s: (-s.is_plausible, -float(s.gains.sum()))):
        best.setdefault(score.missing.key, score)
    return tuple(sorted(best.values(), key=lambda s: (-s.is_proven, -float(s.gains.sum()))))


def rises(equations: Equations, before: Base, after: Base) -> bool:
    """Returns whether a fit leaves more of a joint than another did, on blocks that none has seen.

    A fit is of all joints together, so that it may pay for one joint with another: then it is no
    law of the robot. What luck may do, or a small share, is no rise.
    """
    judged = equations.judges & (equations.counts.sum(axis=0) > 0)
    left = (b.unseen(equations.confirms)[:, judged] for b in (before, after))
    for old, new in zip(*left, strict=True):
        has = old > 0
        if new.sum() > (1 + RISE) * old.sum() and t_of(np.log(new[has] / old[has])) > PROOF:
            return True
    return False


def t_of(gains: np.ndarray) -> float:
    """Returns t of the mean of gains; 0 where there are none."""
    return float(mean_above_zero(gains)[0]) if gains.any() else 0.0


def choose(scores: Sequence[Score]) -> Score | None:
    """Returns the proven candidate to take: of those that predict alike that of fewest numbers."""
    proven = [s for s in scores if s.is_proven]
    if not proven:
        return None
    first = proven[0]
    alike = [s for s in proven if s.is_like(first)]
    return min(alike, key=lambda s: (s.missing.numbers, -float(s.every.sum())))
