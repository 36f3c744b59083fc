"""The readings of an encoder, and what an amplifier hides of a current.

y = Δ round((φ + σ w)/Δ),  Δ = 2π/counts,  w white            rms √(σ² + Δ²/12)
e_k+1 = a e_k + √(1 − a²) e_rms w,  a = e^(−T_s/τ)            first-order low-pass, stationary
"""

from __future__ import annotations

import numpy as np


def encode(angles: np.ndarray, counts: int, noise: float, rng: np.random.Generator) -> np.ndarray:
    """Returns angles as encoders give them [rad], same shape.

    Args:
        angles: true angles [rad].
        counts: of an encoder a turn; 0 for one without steps.
        noise: rms of the white noise before the rounding [rad].
        rng: of the noise.
    """
    y = angles + noise * rng.normal(size=angles.shape)
    if counts == 0:
        return y
    Δ = 2 * np.pi / counts
    return Δ * np.round(y / Δ)


def noise_rms(counts: int, noise: float) -> float:
    """Returns the rms of the measurement noise [rad]."""
    Δ = 2 * np.pi / counts if counts else 0.0
    return float(np.sqrt(noise**2 + Δ**2 / 12))


def coloured(
    shape: tuple[int, int], sampling_time: float, rms: float, time: float, rng: np.random.Generator
) -> np.ndarray:
    """Returns an error of the currents, low-passed white noise, independent by column [A].

    Args:
        shape: samples and drives (n, 8).
        sampling_time: T_s [s].
        rms: e_rms [A].
        time: τ [s]; 0 for white noise.
        rng: of the noise.
    """
    w = rms * rng.normal(size=shape)
    a = float(np.exp(-sampling_time / time)) if time > 0 else 0.0
    e = np.empty(shape)
    e[0] = w[0]
    for k in range(1, shape[0]):
        e[k] = a * e[k - 1] + np.sqrt(1 - a**2) * w[k]
    return e
