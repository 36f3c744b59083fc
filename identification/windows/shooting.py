"""Multiple shooting: windows of a log, each predicted from an initial state that is fitted too.

    r_w(q, d_w) = [ C (y_w - ŷ_w(q, x̄_w ⊕ d_w)) ; -d_w/s ]   residual of w, prior of d_w
    X_w = -∂r_w/∂d_w = U s Vᵀ,  S_w = -∂r_w/∂q                    the tangent at a point

    (X_wᵀX_w + μ) Δd_w + X_wᵀS_w Δq = X_wᵀ r_w                    Levenberg-Marquardt, all at once
    Σ_w S_wᵀX_w Δd_w + (Σ_w S_wᵀS_w + μ) Δq = Σ_w S_wᵀ r_w

Each Δd_w is eliminated separately, so that one more window costs only its simulations (condensing;
Bock 1983). A tangent takes 1 + nx + p simulations of the log, all in one batch; a trial step takes
one. The simulations whose differences make the slopes may be those of a smooth model (see
`JointPlant.smooth`) that takes one evaluation of the dynamics a step where RK4 takes four: slopes
then err by a few per cent, which they may, because the residual that the steps make small is exact
(inexact Gauss-Newton; Dembo, Eisenstat, Steihaug 1982). The information on q is that of S_w after
the initial states are projected out. A direction of them that a window hardly feels is not moved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor, settings_of
from identification.model.rollout import State, hold, substeps
from identification.model.sensitivity import FORWARD_STEP
from identification.windows.batches import Points, simulated
from identification.windows.windows import FirstStates, Windows, moved

MIN_FELT_SHARE = 1e-6  # of the strongest direction of a state; weaker ones are not felt


@dataclass(frozen=True)
class Shooting:
    """The data that do not change during a search over windows."""

    predictor: Predictor  # the plant, the log and the names of p free parameters
    space: Coordinates  # their coordinates
    cut: Windows  # the windows
    first: FirstStates  # the prior of their initial states
    whitener: np.ndarray  # C, shape (ny, ny)
    # whether simulations whose differences make slopes are those of a smooth model, with one
    # evaluation of the dynamics a step
    has_rough_slopes: bool = False

    def rows(self, keep: np.ndarray) -> Shooting:
        """Returns some of the windows, by mask or by index."""
        return replace(self, cut=self.cut.rows(keep), first=self.first.rows(keep))

    @property
    def times(self) -> np.ndarray:
        """The time at which each window begins in its record, shape (W,) [s]."""
        log = self.predictor.log
        return log.begun + log.sampling_time * self.cut.starts

    def states(self, d: np.ndarray) -> State:
        """Returns x̄ ⊕ d, W rows."""
        return moved(self.predictor.plant.model, self.first.states, d)

    def residual(self, q: np.ndarray, d: np.ndarray) -> np.ndarray:
        """Returns r (W, L ny + nx) of all windows at q (p,) and d (W, nx).

        Raises:
            DivergenceError: a window left the finite numbers.
        """
        return self.joined(self.outputs(q[None], [d])[0], d)

    def error(self, r: np.ndarray) -> np.ndarray:
        """Returns y - ŷ, shape (W, L, ny), of a residual of `residual`."""
        outputs = self.cut.outputs
        whitened = r[:, : outputs[0].size].reshape(outputs.shape)
        return whitened @ np.linalg.inv(self.whitener).T

    def joined(self, y: np.ndarray, d: np.ndarray) -> np.ndarray:
        """Returns r, shape (W, L ny + nx), of outputs (W, L, ny) and d (W, nx)."""
        error = (self.cut.outputs - y) @ self.whitener.T
        return np.hstack([error.reshape(len(d), -1), -d * self.first.weight])

    def outputs(
        self, q: np.ndarray, moves: Sequence[np.ndarray], is_rough: bool = False
    ) -> np.ndarray:
        """Returns outputs of k points q (k, p) over all windows, each from its d: (k, W, L, ny).

        Rough ones are for slopes, where only differences matter.
        """
        return simulated(points_of([self], [q], [moves]), is_rough)[0]

    def held_inputs(self, values: np.ndarray) -> tuple[np.ndarray, int, str]:
        """Returns inputs of all windows for some value sets, their number per sample, and hold."""
        predictor, cut, log = self.predictor, self.cut, self.predictor.log
        every = substeps(log.sampling_time, predictor.plant.model.opt.timestep)
        held = hold(log.inputs, every, log.hold)
        made = predictor.inputs(values)(held)
        if made is held:
            return np.tile(cut.inputs, (len(values), 1, 1)), 1, log.hold
        last = np.zeros((*made.shape[:-2], 1, made.shape[-1]))  # a step that is never simulated
        made = np.broadcast_to(np.concatenate([made, last], axis=-2),
                               (len(values), len(held) + 1, held.shape[1]))  # fmt: skip
        steps = np.arange((cut.inputs.shape[1] - 1) * every + 1)
        rows = every * cut.starts[:, None] + steps
        each = made[:, rows].reshape(len(values) * len(rows), len(steps), held.shape[1])
        return each, every, "zoh"


def points_of(
    parts: Sequence[Shooting], q: Sequence[np.ndarray], moves: Sequence[Sequence[np.ndarray]]
) -> list[Points]:
    """Returns the windows of some records at k points q (k, p), each from its d; see `simulated`.

    Args:
        parts: the windows, one a record.
        q: of each.
        moves: of the states of each, k arrays (W, nx).
    """
    values = [part.space.decode(points) for part, points in zip(parts, q, strict=True)]
    predictors = [part.predictor for part in parts]
    out = []
    for part, v, d, (_, numbers) in zip(
        parts, values, moves, settings_of(predictors, values), strict=True
    ):
        inputs, every, hold_kind = part.held_inputs(v)
        out.append(Points(
            predictor=part.predictor, values=v, numbers=numbers, times=part.times,
            start=part.predictor.begun(v, State.stacked([part.states(one) for one in d])),
            inputs=inputs, every=every, hold_kind=hold_kind,
        ))  # fmt: skip
    return out


def tangent(
    shooting: Shooting, q: np.ndarray, d: np.ndarray, step: float = FORWARD_STEP,
    known: np.ndarray | None = None,
) -> Tangent:  # fmt: skip
    """Linearise all windows of one record; see `tangents`."""
    return tangents([shooting], [q], [d], [known], step)[0]


def tangents(
    parts: Sequence[Shooting], q: Sequence[np.ndarray], d: Sequence[np.ndarray],
    known: Sequence[np.ndarray | None], step: float = FORWARD_STEP,
) -> list[Tangent]:  # fmt: skip
    """Linearise all windows of some records, by forward differences in one batch.

    Args:
        parts: the windows, one a record.
        q: the point of each, shape (p,).
        d: of each, shape (W, nx).
        known: r there, shape (W, m) each; it is computed where None.
        step: of the differences.

    Raises:
        DivergenceError: a window left the finite numbers.
    """
    points = [
        np.concatenate([np.tile(at, (1 + d_k.shape[1], 1)), at + step * np.eye(len(at))])
        for at, d_k in zip(q, d, strict=True)
    ]
    moves = [
        [d_k, *(d_k + step * e for e in np.eye(d_k.shape[1])), *[d_k] * len(at)]
        for at, d_k in zip(q, d, strict=True)
    ]
    is_rough = [part.has_rough_slopes for part in parts]
    every = points_of(parts, points, moves)
    y = simulated(every, all(is_rough))
    out = []
    for k, part in enumerate(parts):
        r = np.stack([part.joined(*pair) for pair in zip(y[k], moves[k], strict=True)], axis=-1)
        here = known[k]
        if here is None:
            here = part.residual(q[k], d[k]) if is_rough[k] else r[..., 0]
        nx, slopes = d[k].shape[1], (r[..., :1] - r[..., 1:]) / step  # (W, m, nx + p)
        out.append(decomposed(here, slopes[..., :nx], slopes[..., nx:]))
    return out


@dataclass(frozen=True, kw_only=True)
class Tangent:
    """All windows, linearised at a point; X = U s Vᵀ, its columns scaled to the norm 1."""

    r: np.ndarray  # residual at the point, shape (W, m), m = L ny + nx
    S: np.ndarray  # -∂r/∂q, shape (W, m, p)
    U: np.ndarray  # shape (W, m, nx)
    s: np.ndarray  # singular values, 0 for directions that are not felt, shape (W, nx)
    Vt: np.ndarray  # shape (W, nx, nx)
    size: np.ndarray  # norms of the columns of X before the scaling, shape (W, nx)

    def rows(self, keep: np.ndarray) -> Tangent:
        """Returns some of the windows, by mask or by index."""
        return Tangent(**{f.name: getattr(self, f.name)[keep] for f in fields(self)})

    def with_rows(self, at: np.ndarray, other: Tangent) -> Tangent:
        """Returns the tangent with other values of the windows `at`, a mask or indices."""
        changed = {}
        for f in fields(self):
            changed[f.name] = np.array(getattr(self, f.name))
            changed[f.name][at] = getattr(other, f.name)
        return Tangent(**changed)

    def weighed(self, weights: np.ndarray) -> Tangent:
        """Returns the tangent of residuals whose rows count by other weights, shape (m,)."""
        X = self.U * self.s[:, None] @ self.Vt * self.size[:, None]
        w = weights[:, None]
        return decomposed(self.r * weights, X * w, self.S * w)

    @property
    def freedom(self) -> int:
        """Number of directions of the initial states that are felt, over all windows."""
        return int((self.s > 0).sum())

    @property
    def projected(self) -> tuple[np.ndarray, np.ndarray]:
        """S and r without what the initial states make up for, shapes (W, m, p) and (W, m)."""
        U = self.U * (self.s > 0)[:, None]
        S = self.S - U @ (np.swapaxes(U, 1, 2) @ self.S)
        return S, self.r - np.einsum("wmk,wk->wm", U, np.einsum("wmk,wm->wk", U, self.r))

    def eliminated(self, damping: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns UᵀS (W, nx, p), Uᵀr (W, nx) and s²/(s² + μ) (W, nx), which eliminate states."""
        against = np.swapaxes(self.U, 1, 2) @ self.S
        rest = np.einsum("wmk,wm->wk", self.U, self.r)
        return against, rest, self.s**2 / (self.s**2 + damping)

    def states_step(
        self, dq: np.ndarray, damping: float, against: np.ndarray, left: np.ndarray
    ) -> np.ndarray:
        """Returns Δd (W, nx) beside a step Δq (p,), with UᵀS and Uᵀr of `eliminated`."""
        along = self.s / (self.s**2 + damping) * (left - against @ dq)
        return np.einsum("wkx,wk->wx", self.Vt, along) / self.size

    def step(self, damping: float) -> tuple[np.ndarray, np.ndarray]:
        """Returns the damped step: Δq (p,) and Δd (W, nx)."""
        against, rest, share = self.eliminated(damping)
        H = np.einsum("wmp,wmq->pq", self.S, self.S)
        g = np.einsum("wmp,wm->p", self.S, self.r)
        H_q = H - np.einsum("wkp,wk,wkq->pq", against, share, against)
        g_q = g - np.einsum("wkp,wk,wk->p", against, share, rest)
        size = np.sqrt(np.diag(H))
        size = np.where(size > 0, size, 1.0)  # one that a search drove to nothing stays there
        scaled = H_q / np.outer(size, size) + damping * np.eye(len(g))
        dq = np.linalg.lstsq(scaled, g_q / size, rcond=None)[0] / size
        return dq, self.states_step(dq, damping, against, rest)


def decomposed(r: np.ndarray, X: np.ndarray, S: np.ndarray) -> Tangent:
    """Returns the tangent of a residual r (W, m) with slopes X (W, m, nx) and S (W, m, p)."""
    size = np.linalg.norm(X, axis=1)
    size = np.where(size > 0, size, 1.0)
    U, s, Vt = np.linalg.svd(X / size[:, None], full_matrices=False)
    s = np.where(s > MIN_FELT_SHARE * s[:, :1], s, 0.0)
    return Tangent(r=r, S=S, U=U, s=s, Vt=Vt, size=size)


def along_states(t: Tangent, moves: np.ndarray) -> np.ndarray:
    """Returns X Δd of each window, shape (W, m)."""
    along = t.s * np.einsum("wkx,wx->wk", t.Vt, moves * t.size)
    return np.einsum("wmk,wk->wm", t.U, along)
