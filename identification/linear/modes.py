"""The minimal realisation and the modes of a linear system.

States that no input reaches or no output feels are dropped by the staircase of Rosenbrock and Van
Dooren (IEEE Trans. Automatic Control 26, 1981) with orthogonal matrices Q, which needs neither a
stable system nor Gramians:

    Qᵀ B = [B₁; 0],   Qᵀ A Q = [A₁₁ A₁₂; A₂₁ A₂₂],   then the same of (A₂₂, A₂₁), until A₂₁ = 0

What is left beside the stairs is reached by no input. The dual, (Aᵀ, Cᵀ), gives what no output
feels. A rank counts singular values above `tolerance` times the norm of A, or of B, once the states
are scaled so that rows and columns of A are alike; each input and output is scaled to one.

    A v = λ v,   wᴴ A = λ wᴴ,   wᴴ v = 1
    f = |λ|/2π,   ζ = -Re λ/|λ|                    frequency and damping ratio
    δx(t) = Re(v e^{λ t})                          the motion of one mode, v its shape
    p_i = |v_i w_i|/Σ_j |v_j w_j|                  participation of state i, without units

An eigenvalue of zero keeps what it is given, such as where a slider without a spring stands.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.linear.system import LinearSystem, balancing

TOLERANCE = 1e-8  # central differences of a stiff law are exact to about 1e-9 of its norm
KEPT = 1e-9  # of the fastest rate: an eigenvalue below is zero


@dataclass(frozen=True, kw_only=True)
class Minimal:
    """A minimal realisation."""

    # the realisation; its states z are called z1, z2, …, zero at the operating point
    system: LinearSystem
    unreached: int  # how many states no input reaches
    unfelt: int  # how many of the others no output feels
    # δx = V δz for what inputs reach, V of shape (nx, nz), in the units of the states
    to_states: np.ndarray
    tolerance: float  # of the ranks


def minimal(system: LinearSystem, tolerance: float = TOLERANCE) -> Minimal:
    """Drop what no input reaches and no output feels.

    Args:
        system: continuous or discrete.
        tolerance: below which share of the norm a singular value counts as zero.

    Raises:
        InputError: the tolerance is not between 0 and 1.
    """
    if not 0 < tolerance < 1:
        raise InputError(f"a tolerance of {tolerance:g} is not between 0 and 1; try {TOLERANCE:g}")
    scale = balancing(system.A)
    A, B, C = system.A * scale / scale[:, None], system.B / scale[:, None], system.C * scale
    V = stairs(A, _alike(B), tolerance)
    A, B, C = V.T @ A @ V, V.T @ B, C @ V
    W = stairs(A.T, _alike(C.T), tolerance)
    A, B, C = W.T @ A @ W, W.T @ B, C @ W
    n, r, m = len(system.A), V.shape[1], W.shape[1]
    small = LinearSystem(
        A=A, B=B, C=C, D=system.D, states=tuple(f"z{k + 1}" for k in range(m)),
        inputs=system.inputs, outputs=system.outputs, x=np.zeros(m), u=system.u, y=system.y,
        rate=W.T @ (V.T @ (system.rate / scale)), sampling_time=system.sampling_time,
    )  # fmt: skip
    return Minimal(
        system=small, unreached=n - r, unfelt=r - m, to_states=scale[:, None] * (V @ W),
        tolerance=tolerance,
    )  # fmt: skip


def stairs(A: np.ndarray, B: np.ndarray, tolerance: float) -> np.ndarray:
    """Returns an orthonormal basis of the states that inputs reach, shape (nx, reached)."""
    Q, done = np.eye(len(A)), 0
    size = float(np.linalg.norm(A, 2))
    below, limit = B, tolerance * max(float(np.linalg.norm(B, 2)), np.finfo(float).tiny)
    while done < len(A) and below.size:
        U, s, _ = np.linalg.svd(below)
        rank = int((s > limit).sum())
        if rank == 0:
            break
        Q[:, done:] = Q[:, done:] @ U
        moved = Q.T @ A @ Q
        below = moved[done + rank :, done : done + rank]
        done, limit = done + rank, tolerance * size
    return Q[:, :done]


def _alike(B: np.ndarray) -> np.ndarray:
    """Returns the columns scaled to length one, but for those that are zero."""
    length = np.linalg.norm(B, axis=0)
    return np.asarray(B / np.where(length > 0, length, 1.0))


@dataclass(frozen=True, kw_only=True)
class Mode:
    """One mode; a pair of conjugate eigenvalues is one.

    Attributes:
        eigenvalue: λ, of a pair the one above the real axis [1/s].
        frequency: |λ|/2π [Hz].
        damping: ζ; 1 for a decay without swinging, -1 for a growth, None where λ = 0.
        shape: v, complex, shape (nx,), in the units of the states; its state of the largest
            participation is real and positive.
        participation: of each state, shape (nx,), without unit; their sum is 1.
    """

    eigenvalue: complex
    frequency: float
    damping: float | None
    shape: np.ndarray
    participation: np.ndarray

    @property
    def swings(self) -> bool:
        """Tells whether the mode is a pair of conjugate eigenvalues."""
        return self.eigenvalue.imag > 0


def modes(system: LinearSystem) -> tuple[Mode, ...]:
    """Returns the modes of a continuous system, the slowest first.

    Args:
        system: continuous.

    Raises:
        InputError: the system is discrete.
    """
    if system.sampling_time is not None:
        raise InputError("modes are those of a continuous system; take it before discrete(rate)")
    from scipy.linalg import eig

    scale = balancing(system.A)
    λ, W, V = eig(system.A * scale / scale[:, None], left=True, right=True)
    λ = np.where(np.abs(λ) <= KEPT * np.abs(λ).max(initial=0.0), 0, λ)
    λ = np.where(np.abs(λ.imag) <= KEPT * np.abs(λ), λ.real, λ)
    order = [k for k in np.argsort(np.abs(λ), kind="stable") if λ[k].imag >= 0]
    return tuple(_mode(complex(λ[k]), V[:, k], W[:, k], scale) for k in order)


def _mode(λ: complex, v: np.ndarray, w: np.ndarray, scale: np.ndarray) -> Mode:
    share = np.abs(v * w.conj())
    share = share / share.sum()
    shape = scale * v
    lead = shape[share.argmax()]
    return Mode(
        eigenvalue=λ,
        frequency=abs(λ) / (2 * np.pi),
        damping=None if λ == 0 else -λ.real / abs(λ),
        shape=shape * (np.abs(lead) / lead / np.linalg.norm(shape)),
        participation=share,
    )
