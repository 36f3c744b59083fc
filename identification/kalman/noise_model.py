"""The noise model of sensors and unlogged input errors, its whitening filter and its smoother.

    δx_{k+1} = A_k δx_k + B_k w_k          w: unlogged error of each input
    w_{k+1}  = a w_k + √(1-a²) ρ ν_k        of std ρ σ, correlation time τ, a = exp(-T_s/τ)
    e_k      = C δx_k + σ s v_k             v, ν: white, of unit variance

The shares s of the sensors have the mean square 1, so that σ is the rms over all of them
(`noise_shares` estimates them).

The Kalman filter W of this model turns residuals into innovations, which are white where the model
is right (Kailath 1968). With the same filter applied to residuals and sensitivities, F = W Φ and
H = FᵀF, generalised least squares and likelihoods are as simple as with white noise. σ scales
everything and is estimated last. Innovations of every output come out of the filter with the std σ,
so that whoever divides by σ needs no s. The most likely w, given a whole log, is that of the
smoother:

    u = Wᵀ W e,    e - s² u = C ẑ,    r_k = (A_k - A_k K_k C)ᵀ r_{k+1} + Cᵀ S_k⁻¹ ε_k
    ŵ_{k+1} = a ŵ_k + q_k r_{k+1},    ŵ_0 = ρ² r_0      of r the part that belongs to w

z = (x, w) (Durbin and Koopman 2012, section 4.6). Nothing but vectors is propagated: the
covariances of the filter and of the smoother are not needed.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from identification.kalman.backwards import transpose_filter
from identification.kalman.linear import LinearPlant
from identification.kalman.recursion import filter_gains, filter_innovations
from identification.kalman.system import System

KEPT_POINTS = 2  # where a search is, and where it came from
_kept: deque[Whitened] = deque(maxlen=KEPT_POINTS)


@dataclass(frozen=True)
class Noise:
    """The numbers of the noise model beside σ."""

    ratio: float  # ρ, std of the inputs' error over σ [unit of the input per unit of the output]
    time: float  # τ, correlation time of the inputs' error [s]
    # s, std of the noise of each sensor over σ; none where all are alike
    outputs: tuple[float, ...] = ()

    def of_outputs(self, ny: int) -> np.ndarray:
        """Returns s, shape (ny,)."""
        return np.array(self.outputs or (1.0,) * ny)

    def of_inputs(self, nu: int) -> np.ndarray:
        """Returns ρ, std of the error of each input over σ, shape (nu,)."""
        return np.full(nu, self.ratio)

    def scaled(self, factor: float) -> Noise:
        """Returns the same noise with ρ multiplied by a factor."""
        return replace(self, ratio=self.ratio * factor)

    def lasting(self, time: float) -> Noise:
        """Returns a noise of another τ [s] and the same ρ²τ, to which a slow plant responds."""
        return replace(self, ratio=self.ratio * (self.time / time) ** 0.5, time=time)


@dataclass(frozen=True, eq=False)
class Whitener:
    """A whitening filter; residuals and sensitivities pass the same one."""

    system: System | None  # of plant and input errors; None where the inputs have no error
    s: np.ndarray  # std of the noise of each sensor over σ, shape (ny,)
    K: np.ndarray  # Kalman gains, shape (N, nz, ny); empty where the inputs have no error
    # inverted Cholesky factors of the innovations' covariances over σ², shape (N, ny, ny), or empty
    L: np.ndarray
    log_determinant: float  # Σ log det of the covariances over σ²

    def __call__(self, e: np.ndarray) -> np.ndarray:
        """Returns innovations of e, shape (n, ny) or (n, ny, p), n <= N samples, of std σ each."""
        if self.system is None:
            return np.asarray(e / self.s.reshape(-1, *(1,) * (e.ndim - 2)))
        columns = e.reshape(*e.shape[:2], -1)
        return filter_innovations(self.system, self.K, self.L, columns).reshape(e.shape)

    def transposed(self, E: np.ndarray) -> np.ndarray:
        """Returns x with x · e = E · (innovations of e) for any residual e; shape (n, ny) both."""
        if self.system is None:
            return np.asarray(E / self.s)
        return transpose_filter(self.system, self.K, self.L, E)[0]


def build_whitener(plant: LinearPlant, noise: Noise, sampling_time: float) -> Whitener:
    """Returns the whitening filter of a noise; its first state counts as known."""
    s = noise.of_outputs(len(plant.C))
    samples = len(plant.A) + 1
    log_determinant = 2 * samples * float(np.log(s).sum())
    if noise.ratio == 0:
        return Whitener(None, s, np.empty(0), np.empty(0), log_determinant)
    system = augment(plant, noise, sampling_time)
    K, L, of_scaled = filter_gains(system.with_outputs(plant.C / s[:, None]))
    K /= s
    L /= s
    return Whitener(system, s, K, L, of_scaled + log_determinant)


@dataclass(frozen=True, eq=False)
class Whitened:
    """Whitened sensitivities.

    The noise that is found at a point is that of its criterion, of its scores and of the std of
    its estimate, and after a short step the columns are those from before it. So the last ones
    are kept.
    """

    plant: LinearPlant  # the linearised plant of the filter
    J: np.ndarray  # the sensitivities, shape (N, ny, p)
    noise: Noise  # ρ and τ
    filter: Whitener  # the whitening filter
    F: np.ndarray  # the whitened sensitivities, shape (N ny, p)

    @cached_property
    def H(self) -> np.ndarray:
        """FᵀF, shape (p, p)."""
        return self.F.T @ self.F


def whiten(plant: LinearPlant, J: np.ndarray, noise: Noise, sampling_time: float) -> Whitened:
    """Whiten sensitivities (N, ny, p), or take them from those that were kept."""
    for known in (*_kept,):
        if known.plant is plant and known.J is J and known.noise == noise:
            return known
    filter_ = build_whitener(plant, noise, sampling_time)
    samples, outputs, p = J.shape
    F = filter_(J).reshape(samples * outputs, p)
    return Whitened(plant, J, noise, filter_, F)


def keep(whitened: Whitened) -> None:
    """Keep whitened sensitivities in place of the oldest ones that are kept."""
    if not any(known is whitened for known in _kept):
        _kept.append(whitened)


def smooth(
    plant: LinearPlant, noise: Noise, e: np.ndarray, sampling_time: float
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the most likely errors w of the inputs, and their part of a residual e (N, ny).

    w has the shape (N, nu) and the inputs' unit, its part the shape and the unit of e.
    """
    n, nu = len(e), plant.B.shape[2]
    filter_ = build_whitener(plant, noise, sampling_time)
    system, s = filter_.system, filter_.s
    if system is None:
        return np.zeros((n, nu)), np.zeros_like(e)
    u, r = transpose_filter(system, filter_.K, filter_.L, filter_(e))
    w = system.fresh * r[:, -nu:]
    for k in range(n - 1):
        w[k + 1] += system.a[k] * w[k]
    return w, e - s**2 * u


def augment(plant: LinearPlant, noise: Noise, sampling_time: float) -> System:
    """Returns the linear system of plant and input errors."""
    begins = ~plant.A.any(axis=(1, 2))
    # Of samples that are far apart the share rounds to zero, which would be another record.
    left = max(np.exp(-sampling_time / noise.time), np.finfo(float).tiny)
    a = np.where(begins, 0.0, left)
    A, B, C = (np.ascontiguousarray(x, float) for x in (plant.A, plant.B, plant.C))
    return System(A, B, C, a, noise.of_inputs(plant.B.shape[2]) ** 2)
