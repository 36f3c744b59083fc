"""The modes of a linear system.

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

KEPT = 1e-9  # of the fastest rate: an eigenvalue below is zero


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
        """Whether the mode is a pair of conjugate eigenvalues."""
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
