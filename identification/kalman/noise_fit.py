"""The level of the noise, by maximum likelihood.

    log L(ρ, τ) = -½ (n log(‖E - Φ c‖²/n) + log det S(ρ, τ)),     σ² = ‖E - Φ c‖²/n

E, Φ: whitened residual and sensitivities, c: the best small change of the parameters, held by
their priors. ρ is sought on a scale of the plant's own: at ρ₀ the inputs' error moves the outputs
by as much as the sensors' noise.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from identification.kalman.linear import LinearPlant
from identification.kalman.noise_model import Noise, Whitener, build_whitener

TIME = 0.03  # correlation time of the inputs' error at which a search begins [s]
LONGEST = (
    0.3  # what errs for longer is an effect: a noise of any length would explain a constant [s]
)
ALLOWED = 0.1  # error of the inputs, of their motion, that is still noise and no missing effect
FIRST, LAST = 1.6, 1.15  # factors of the pattern search
AROUND = (1.0, 0.3, 0.05, 0.0)  # times a noise that is near
ROUGH = (0.0, 0.1, 1.0)  # ρ/ρ₀ to try where none was seen
LEVELS = (0.0, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0)  # ρ/ρ₀ to try


@dataclass(frozen=True)
class NoiseLevel:
    """A noise and how likely it makes a residual.

    Attributes:
        noise: ρ and τ.
        sigma: σ of the sensors, in the outputs' unit.
        log_likelihood: of the residual, up to a constant of the log.
    """

    noise: Noise
    sigma: float
    log_likelihood: float

    @property
    def input_std(self) -> float:
        """ρ σ: std of the inputs' unlogged error, in their unit."""
        return self.noise.ratio * self.sigma


def compute_unit_ratio(plant: LinearPlant, sampling_time: float, time: float) -> float:
    """ρ₀ at a correlation time: where input errors move the outputs by σ (rms over the log)."""
    n, nx, nu = plant.B.shape
    a = np.exp(-sampling_time / time)
    A = np.zeros((n, nx + nu, nx + nu))
    A[:, :nx, :nx], A[:, :nx, nx:], A[:, nx:, nx:] = plant.A, plant.B, a * np.eye(nu)
    P, moved = np.zeros((nx + nu, nx + nu)), 0.0
    P[nx:, nx:] = np.eye(nu)
    for k in range(n):
        P = A[k] @ P @ A[k].T
        P[nx:, nx:] += (1 - a**2) * np.eye(nu)
        moved += np.einsum("ij,jk,ik->", plant.C, P[:nx, :nx], plant.C)
    return 1 / np.sqrt(moved / (n * len(plant.C)))


def evaluate_noise(
    filter_: Whitener, noise: Noise, e: np.ndarray, J: np.ndarray, prior: np.ndarray
) -> NoiseLevel:
    """How likely a noise makes a residual once the parameters have been adjusted.

    Args:
        filter_: the whitening filter of the noise.
        noise: ρ and τ.
        e: residual, shape (N, ny).
        J: sensitivities, shape (N, ny, p).
        prior: 1/std of each parameter's prior, shape (p,).
    """
    E, F = filter_(e).ravel(), filter_(J).reshape(e.size, -1)
    sigma = np.sqrt(E @ E / E.size)
    for _ in range(2):  # the prior weighs by σ
        H = F.T @ F + np.diag((prior * sigma) ** 2)
        c = np.linalg.solve(H, F.T @ E)
        sigma = np.sqrt(np.sum((E - F @ c) ** 2) / E.size)
    return NoiseLevel(
        noise, float(sigma), float(-0.5 * (2 * E.size * np.log(sigma) + filter_.log_determinant))
    )


def fit_noise(
    plant: LinearPlant,
    e: np.ndarray,
    J: np.ndarray,
    prior: np.ndarray,
    sampling_time: float,
    near: NoiseLevel | None = None,
    fine: bool = True,
    levels: Sequence[float] = LEVELS,
    largest: float = np.inf,
) -> NoiseLevel:
    """The most likely noise of a residual.

    Args:
        plant: the linearised plant.
        e: residual, shape (N, ny).
        J: sensitivities, shape (N, ny, p).
        prior: 1/std of each parameter's prior, shape (p,).
        sampling_time: [s].
        near: where one is known from a point nearby, to begin at.
        fine: whether ρ and τ are sharpened.
        levels: ρ/ρ₀ to try where no noise is known.
        largest: error of the inputs that is believed before it is sharpened, in their unit.
    """
    with threadpool_limits(1, "blas"):  # the matrices are small; threads only wait for each other

        def at(noise: Noise) -> NoiseLevel:
            return evaluate_noise(build_whitener(plant, noise, sampling_time), noise, e, J, prior)

        def believed(noise: Noise, factors: Sequence[float]) -> list[NoiseLevel]:
            tried = [at(noise.scaled(f)) for f in factors]
            return [level for level in tried if level.input_std <= largest]

        found: list[NoiseLevel] = []
        if near is not None and near.noise.ratio:
            found = believed(near.noise, AROUND)
        if len(found) < 2:  # nothing is near, or none of it but silence is believed
            unit = Noise(compute_unit_ratio(plant, sampling_time, TIME), TIME)
            silent = near is not None and not near.noise.ratio
            found = believed(unit, ROUGH if silent and not fine else levels)
        best = _best(found)
        return sharpen(best, at, sampling_time / 3) if fine and best.noise.ratio else best


def sharpen(best: NoiseLevel, at: Callable[[Noise], NoiseLevel], shortest: float) -> NoiseLevel:
    """The most likely noise near a level: a pattern search over ln ρ√τ and ln τ.

    What a slow plant feels is ρ²τ: the two directions are nearly independent.

    Args:
        best: where to begin.
        at: the level of a noise.
        shortest: correlation time, below which the error is white [s].
    """
    step, alone = FIRST, True  # ρ alone first: at a wrong ρ a wrong τ is likely
    while step > LAST:
        near = [(step, 1.0), (1 / step, 1.0)]
        near += [] if alone else [(1.0, step**2), (1.0, step**-2)]
        new = _best([best, *(at(_moved(best.noise, r, τ, shortest)) for r, τ in near)])
        if new is best:
            step, alone = (step, False) if alone else (step**0.5, False)
        best = new
    return best


def _moved(noise: Noise, felt: float, time: float, shortest: float) -> Noise:
    """A noise whose ρ√τ and τ are multiplied."""
    other = float(np.clip(noise.time * time, shortest, LONGEST))
    return noise.lasting(other).scaled(felt)


def _best(levels: list[NoiseLevel]) -> NoiseLevel:
    return max(levels, key=lambda level: level.log_likelihood)
