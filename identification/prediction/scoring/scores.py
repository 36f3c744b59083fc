"""The part of the windows' residual that each candidate would explain, before it is refitted.

    r⊥, S_j⊥       residual and sensitivities without what states and base parameters make up for
    η̂_j = (S⊥ᵀS⊥)⁻¹ S⊥ᵀ r⊥                    the size, at once
    fall_j = 1 - ‖r⊥ - S⊥ η̂_j‖²/‖r⊥‖²          share of the residual's square that it takes away
    Δq_j = -(FᵀF)⁻¹ FᵀS_j η̂_j                  how the free parameters go along, F: their columns

The chance of a score and the std of its size are those of a test by blocks of windows, which needs
no noise model (`identification.estimation.block_test`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
from scipy.linalg import block_diag

from identification.discovery.attempts import attempt
from identification.effects.effect import Candidate
from identification.estimation.block_test import (
    Common,
    Scatter,
    common_scatter,
    covariance,
    make_blocks,
    p_values,
    scatter_of,
)
from identification.prediction.scoring.columns import columns
from identification.prediction.scoring.forced import acts_on_joints
from identification.runtime.progress import counted
from identification.windows.fit import STD_BLOCKS, WindowFit

# Of an effect's part in the outputs: with less left by the free parameters it is one of them by
# another name.
MIN_UNIMITATED_SHARE = 0.01
# Of a probe, by which a size is moved to see whether free parameters imitate it.
IMITATION_STEP = 1e-4
MAX_GROUP_COLUMNS = 24  # of candidates scored at once: bounds the memory of their trajectories


@dataclass(frozen=True, kw_only=True)
class WindowScore:
    """The score of a candidate: what it would explain."""

    candidate: Candidate  # which
    # η̂, shape (m,), in the units of its sizes; where they are each record's own, those of the
    # first record come first
    size: np.ndarray
    std: np.ndarray  # of η̂ by blocks, shape (m,)
    fall: float  # share of the residual's square that it takes away, 0 to 1
    p_value: float  # chance of as much by luck, by blocks
    along: np.ndarray  # Δq of the model's free parameters, which make room for it, shape (p,)

    @property
    def explains(self) -> float:
        """The measure by which candidates are told: the fall."""
        return self.fall

    @property
    def gain(self) -> float:
        """-ln(1 - fall): of two candidates that leave little, one may leave half as much."""
        return float(-np.log(max(1e-12, 1 - self.fall)))


def window_scores(fit: WindowFit, candidates: Sequence[Candidate]) -> tuple[WindowScore, ...]:
    """Score candidates on a fitted model, the best first; one that diverges is left out.

    Args:
        fit: the model without them.
        candidates: which; their sizes are zero in the fit.
    """
    base = _Base(fit)
    out: list[tuple[WindowScore, Scatter]] = []
    groups = [*_groups(candidates)]
    for group in counted(groups, "groups of candidates", len(groups)):
        found = attempt(None, partial(base.scores, group))
        if found is None:  # one of them: the others are scored without it
            each = (attempt(None, partial(base.scores, [one])) for one in group)
            found = [s for scores in each if scores for s in scores]
        out += found
    common = common_scatter([scatter for _, scatter in out])
    judged = (_judged(score, scatter, common) for score, scatter in out)
    return tuple(sorted(judged, key=lambda s: -s.fall))


def _judged(score: WindowScore, scatter: Scatter, common: Common) -> WindowScore:
    """Returns a score with its chance and std, which depend on how all candidates scatter."""
    std = np.sqrt(np.maximum(np.diag(covariance(scatter, common)[0]), 0.0))
    return replace(score, std=std, p_value=float(p_values(scatter, common)[0]))


@dataclass(frozen=True)
class Condensed:
    """What blocks of windows tell of k sizes; the last block are the priors of the parameters."""

    G: np.ndarray  # S⊥ᵀS⊥ of each block, shape (B, k, k)
    a: np.ndarray  # S⊥ᵀr⊥ of each, shape (B, k)
    squares: np.ndarray  # ‖r⊥‖² of each, shape (B,)


def condensed(
    fit: WindowFit, candidates: Sequence[Candidate], held: Collection[str] = ()
) -> Condensed:
    """Returns what blocks of windows tell of many sizes at once.

    Args:
        fit: the model without them.
        candidates: which, with k sizes in all; none has a size of each record where there are
            several.
        held: free parameters of the fit that do not make room for them.

    Raises:
        DivergenceError: one of them cannot be simulated.
    """
    every = np.hstack([np.vstack(columns(fit, group)) for group in _groups(candidates)])
    return next(each_condensed(fit, [every], held))


def each_condensed(
    fit: WindowFit, each: Iterable[np.ndarray], held: Collection[str] = ()
) -> Iterator[Condensed]:
    """Yields what blocks of windows tell of the sizes of some columns, for each set of them.

    Args:
        fit: the model without them.
        each: columns without what states make up for, record after record, shape (N, k) a set.
        held: free parameters of the fit that do not make room for them.
    """
    base = _Base(fit, held)
    squares = np.array([base.r[rows] @ base.r[rows] for rows in base.blocks])
    for X in each:
        S = base.without_base(np.vstack([X, np.zeros((len(fit.q), X.shape[1]))]))
        G = np.array([S[rows].T @ S[rows] for rows in base.blocks])
        yield Condensed(G, np.array([S[rows].T @ base.r[rows] for rows in base.blocks]), squares)


def find_imitated(fit: WindowFit, scores: Sequence[WindowScore]) -> set[tuple[str, str]]:
    """Returns effects, with their places, that free parameters imitate: the same by another name.

    Args:
        fit: the model without them.
        scores: of those that are asked for, the best first.
    """
    base, asked = _Base(fit), {s.candidate.key: s.candidate for s in reversed(scores)}
    imitated: list[Candidate] = []
    for group in _groups([*asked.values()]):
        found = attempt(None, partial(base.imitated, group, MIN_UNIMITATED_SHARE))
        if found is None:  # one of them: the others are asked for without it
            each = (attempt(c, partial(base.imitated, [c], MIN_UNIMITATED_SHARE)) for c in group)
            found = [c for some in each if some for c in some]
        imitated += found
    return {c.key for c in imitated}


def _groups(candidates: Sequence[Candidate]) -> Iterator[list[Candidate]]:
    group: list[Candidate] = []
    for candidate in candidates:
        others = group and _kind(group[-1]) != _kind(candidate)
        if others or (group and sum(len(c.sizes) for c in (*group, candidate)) > MAX_GROUP_COLUMNS):
            yield group
            group = []
        group.append(candidate)
    if group:
        yield group


def _kind(candidate: Candidate) -> tuple[str, bool]:
    """Returns what candidates share whose columns are computed at once: plant, and way."""
    return candidate.effect.state, acts_on_joints(candidate.effect)


class _Base:
    """The residual of all windows with states and base parameters projected out."""

    def __init__(self, fit: WindowFit, held: Collection[str] = ()) -> None:
        self.fit = fit
        each = [t.projected for t in fit.tangents]
        p = len(fit.q)
        F = np.vstack(
            [S.reshape(S.shape[0] * S.shape[1], p) for S, _ in each] + [fit.problem.prior.rows]
        )
        F = F[:, [name.partition(" [")[0] not in held for name in fit.problem.names]]
        scale = np.linalg.norm(F, axis=0)
        self.scale = np.where(scale > 0, scale, 1.0)
        self.Q, self.R = np.linalg.qr(F / self.scale)
        self.free = np.linalg.qr(F[: len(F) - p] / self.scale)[0]
        below = fit.problem.prior.against(fit.q)[:, None]
        r = np.vstack([r.reshape(-1, 1) for _, r in each] + [below])
        self.r = self.without_base(r)[:, 0]
        # Rows of neighbouring windows, and those of the priors.
        windows = np.concatenate([np.full(W, m) for W, m in (r.shape for _, r in each)])
        some = np.array_split(windows, min(STD_BLOCKS, len(windows)))
        edges = np.cumsum([0, *(int(n.sum()) for n in some), len(below)])
        self.blocks = [slice(*pair) for pair in pairwise(edges.tolist())]

    def without_base(self, columns: np.ndarray) -> np.ndarray:
        return np.asarray(columns - self.Q @ (self.Q.T @ columns))

    def scores(self, group: Sequence[Candidate]) -> list[tuple[WindowScore, Scatter]]:
        """Returns candidates with what they explain and its scatter, without chance and std."""
        found = columns(self.fit, group)
        ends = np.cumsum([len(c.sizes) for c in group])
        out = []
        for c, end in zip(group, ends, strict=True):
            own = [S[:, end - len(c.sizes) : end] for S in found]
            S = block_diag(*own) if c.effect.own else np.vstack(own)
            below = np.zeros((len(self.fit.q), S.shape[1]))
            out.append(self._score(c, np.vstack([S, below])))
        return out

    def imitated(self, group: Sequence[Candidate], share: float) -> list[Candidate]:
        """Returns candidates of which free parameters imitate every column, whatever priors say.

        Their steps are as small as those of the free parameters: where joints stick, a large one
        shows something else.
        """
        found, out, end = columns(self.fit, group, IMITATION_STEP), [], 0
        for c in group:
            each = [S[:, end : end + len(c.sizes)] for S in found]
            S, end = block_diag(*each) if c.effect.own else np.vstack(each), end + len(c.sizes)
            left = np.linalg.norm(S - self.free @ (self.free.T @ S), axis=0)
            if np.all(left < share * np.linalg.norm(S, axis=0)):
                out.append(c)
        return out

    def _score(self, candidate: Candidate, every: np.ndarray) -> tuple[WindowScore, Scatter]:
        S = self.without_base(every)
        norm = np.linalg.norm(S, axis=0)
        back = np.where(norm > 0, 1 / np.where(norm > 0, norm, 1.0), 0.0)
        H = (S * back).T @ (S * back)
        unit = np.linalg.lstsq(H, (S * back).T @ self.r, rcond=1e-12)[0]
        size = unit * back
        left = self.r - S @ size
        fall = 1 - float(left @ left) / max(float(self.r @ self.r), 1e-300)
        along = np.linalg.lstsq(self.R, self.Q.T @ (every @ size), rcond=1e-8)[0]
        score = WindowScore(
            candidate=candidate, size=size, std=np.full(len(size), np.nan), fall=fall, p_value=1.0,
            along=-along / self.scale,
        )  # fmt: skip
        variance = max(float(left @ left), 1e-300) / len(left)
        return score, self._scatter(candidate, S, variance)

    def _scatter(self, candidate: Candidate, S: np.ndarray, variance: float) -> Scatter:
        """Returns the scatter of a candidate's sizes over blocks of windows."""
        parts = [(S[rows], self.Q[rows], self.r[rows]) for rows in self.blocks]
        G = np.array([X.T @ X for X, _, _ in parts])[:, None]
        Z = np.array([Q.T @ X for X, Q, _ in parts])[:, :, None]
        a = np.array([X.T @ r for X, _, r in parts])[:, None]
        signs = [size.sign for size in candidate.effect.sizes]
        signs *= S.shape[1] // len(signs)  # of each record where they are its own
        blocks = make_blocks(G, Z)
        return scatter_of(blocks, a, np.array([variance]), np.array([signs]))
