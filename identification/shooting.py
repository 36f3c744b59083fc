"""Multiple shooting: the windows of a log, explained as well as their initial states can.

    r_w(q, d_w) = [ C (y_w - ŷ_w(q, x̄_w ⊕ d_w)) ; -d_w/s ]       what a window leaves, and its belief
    X_w = -∂r_w/∂d_w,   S_w = -∂r_w/∂q                            tangent, at the last accepted point
    d_w ← d_w + X_w⁺ (r_w - S_w Δq),   then d_w ← d_w + X_w⁺ r_w   states follow a move of q
    S_w ← (I - X_w X_w⁺) S_w                                      what the states cannot make up for

This is variable projection (Golub and Pereyra 1973, in Kaufman's form) with the belief of
`identification.windows`. A tangent costs 1 + nx + p simulations of the log, all in one batch, and
is taken at accepted points only; a trial of q costs a few simulations, with the tangent it has.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.coordinates import Coordinates
from identification.predictor import Predictor, output_columns
from identification.rollout import State, rollout
from identification.sensitivity import FORWARD_STEP
from identification.windows import FirstStates, Windows, moved

FELT = 1e-6  # of the strongest direction of a state, each entry scaled to its own effect
ROUNDS = 4  # of the states at one q, at most
SETTLED = 1e-3  # relative gain of a round that is the last


@dataclass(frozen=True)
class Shooting:
    """What does not change during a search over windows.

    Attributes:
        predictor: the plant, the log and the names of p free parameters.
        space: their coordinates.
        cut: the windows.
        first: where they are believed to begin.
        whitener: C, shape (ny, ny).
    """

    predictor: Predictor
    space: Coordinates
    cut: Windows
    first: FirstStates
    whitener: np.ndarray

    def states(self, d: np.ndarray) -> State:
        """x̄ ⊕ d, W rows."""
        return moved(self.predictor.plant.model, self.first.states, d)

    def residual(self, q: np.ndarray, d: np.ndarray) -> np.ndarray:
        """r of all windows at q and d (W, nx), shape (W, L ny + nx).

        Raises:
            DivergenceError: a window left the finite numbers.
        """
        return self._joined(self._outputs(q[None], [d])[0], d)

    def error(self, r: np.ndarray) -> np.ndarray:
        """y - ŷ, shape (W, L, ny), of a residual of `residual`."""
        outputs = self.cut.outputs
        whitened = r[:, : outputs[0].size].reshape(outputs.shape)
        return whitened @ np.linalg.inv(self.whitener).T

    def _joined(self, y: np.ndarray, d: np.ndarray) -> np.ndarray:
        left = (self.cut.outputs - y) @ self.whitener.T
        return np.hstack([left.reshape(len(d), -1), -d * self.first.weight])

    def _outputs(self, q: np.ndarray, moves: list[np.ndarray]) -> np.ndarray:
        """Outputs of k points q (k, p), each over all windows from its d: (k, W, L, ny)."""
        predictor, cut, W = self.predictor, self.cut, len(self.cut.starts)
        model = predictor.plant.model
        _, numbers = predictor.settings(self.space.decode(q))
        starts = [self.states(d) for d in moves]
        rows = (np.concatenate([getattr(s, f) for s in starts]) for f in ("qpos", "qvel", "act"))
        run = rollout(
            model, State(*rows), np.tile(cut.inputs, (len(q), 1, 1)),
            predictor.log.sampling_time,
            numbers=[(slot, np.repeat(column, W)) for slot, column in numbers],
            record=("qpos", "qvel"), hold_kind=predictor.log.hold,
        )  # fmt: skip
        columns = output_columns(model, predictor.log.output_names)
        y = np.stack([run[field][:, :, i] for field, i in columns], axis=-1)
        return y.reshape(len(q), W, *y.shape[1:])


@dataclass(frozen=True)
class Tangent:
    """All windows, linearised at a point.

    Attributes:
        q: where, shape (p,).
        d: where, shape (W, nx).
        r: residual there, shape (W, m), m = L ny + nx.
        S: -∂r/∂q, shape (W, m, p).
        U: orthonormal rows of what the states can make up for, zero where not felt, (W, m, nx).
        pull: X⁺, shape (W, nx, m).
    """

    q: np.ndarray
    d: np.ndarray
    r: np.ndarray
    S: np.ndarray
    U: np.ndarray
    pull: np.ndarray

    @property
    def projected(self) -> np.ndarray:
        """S without what the states can make up for, shape (W m, p)."""
        S = self.S - self.U @ (np.swapaxes(self.U, 1, 2) @ self.S)
        return S.reshape(-1, S.shape[2])

    @property
    def freedom(self) -> int:
        """Directions of all states that are felt."""
        return int((self.U != 0).any(axis=1).sum())


def tangent(shooting: Shooting, q: np.ndarray, d: np.ndarray) -> Tangent:
    """Linearise all windows at q and d, by forward differences in one batch.

    Raises:
        DivergenceError: a window left the finite numbers.
    """
    p, nx = len(q), d.shape[1]
    h = FORWARD_STEP
    points = np.concatenate([np.tile(q, (1 + nx, 1)), q + h * np.eye(p)])
    moves = [d, *(d + h * e for e in np.eye(nx)), *[d] * p]
    y = shooting._outputs(points, moves)
    r = np.stack([shooting._joined(*pair) for pair in zip(y, moves, strict=True)], axis=-1)
    slopes = (r[..., :1] - r[..., 1:]) / h  # (W, m, nx + p)
    X, S = slopes[..., :nx], slopes[..., nx:]
    size = np.linalg.norm(X, axis=1, keepdims=True)
    size = np.where(size > 0, size, 1.0)
    U, s, Vt = np.linalg.svd(X / size, full_matrices=False)
    keep = s > FELT * np.maximum(s[:, :1], np.finfo(float).tiny)
    U = U * keep[:, None]
    pull = np.einsum("wkx,wmk->wxm", Vt / np.where(keep, s, 1.0)[..., None], U)
    return Tangent(q, d, r[..., 0], S, U, pull / np.swapaxes(size, 1, 2))


def settle(shooting: Shooting, at: Tangent, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The states that explain the windows best at q: d (W, nx) and r (W, m), from a tangent near.

    Raises:
        DivergenceError: a window left the finite numbers.
    """
    expected = at.r - at.S @ (q - at.q)
    d = at.d + np.einsum("wxm,wm->wx", at.pull, expected)
    r = shooting.residual(q, d)
    for _ in range(ROUNDS):
        step = np.einsum("wxm,wm->wx", at.pull, r)
        after = shooting.residual(q, d + step)
        before, now = np.sum(r**2), np.sum(after**2)
        if now >= before:
            break
        d, r = d + step, after
        if now > (1 - SETTLED) * before:
            break
    return d, r
