"""Motions and inputs as Fourier series that begin and end at rest.

    x_i(t) = c_i + w(t) s_i (o_i + Σ_k (a_ik sin ω_k t + b_ik cos ω_k t)/n_k)      ω_k = 2π m_k/T

c: where it begins and ends, s: the room to either side, o, a, b: the numbers of a search, n_k:
√(ω_k/ω_1), by which fast motions are smaller. w rises from 0 to 1 and falls again, a polynomial of
fifth order, so that position, rate and acceleration are at rest at both ends. Slow motions show
friction, fast ones inertia and damping; the whole numbers m_k are drawn with them.
Source: Swevers, Ganseman, Tükel, De Schutter, Van Brussel (1997), IEEE T. Robotics Autom. 13(5).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

TONES = 5  # of a joint or an input
RISE = 0.1  # share of the duration in which a series rises, and falls
MAX_RISE = 1.0  # [s]
CHANGES = ((0.3, 0.3), (0.1, 0.3), (0.1, 1.0), (0.03, 1.0))  # size of a change, share of numbers


@dataclass(frozen=True)
class Series:
    """The numbers of n series."""

    waves: np.ndarray  # m_k, how many periods each tone has in the duration, shape (TONES,)
    numbers: np.ndarray  # o, then a and b, shape (n, 1 + 2 TONES)
    scale: float = 1.0  # of all deviations from c

    def at(
        self, time: np.ndarray, center: np.ndarray, room: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns values and two derivatives, each (N, n), at even times (N,) from zero [s].

        The center is c, (n,), the room to either side s, (n,).
        """
        ω = 2 * np.pi * self.waves / time[-1]
        sin, cos = np.sin(np.outer(time, ω)), np.cos(np.outer(time, ω))
        offset, a, b = np.split(self.numbers, [1, 1 + len(ω)], axis=1)
        a, b = (x / np.sqrt(ω / ω[0]) for x in (a, b))
        x = offset.T + sin @ a.T + cos @ b.T
        v = (cos * ω) @ a.T - (sin * ω) @ b.T
        acc = -(sin * ω**2) @ a.T - (cos * ω**2) @ b.T
        w, dw, ddw = (each[:, None] for each in _taper(time))
        far = self.scale * room
        return (center + w * x * far, (w * v + dw * x) * far,
                (w * acc + 2 * dw * v + ddw * x) * far)  # fmt: skip

    def scaled(self, factor: float) -> Series:
        """Returns the series with deviations that are so many times as large."""
        return replace(self, scale=self.scale * factor)


def draw(n: int, most: int, rng: np.random.Generator) -> Series:
    """Returns n random series whose fastest tone has at most so many periods in the duration."""
    waves = np.exp(rng.uniform(0, np.log(max(most, 1)), TONES)).round()
    numbers = rng.standard_normal((n, 1 + 2 * TONES)) / np.sqrt(TONES)
    return Series(np.maximum(np.sort(waves), 1), numbers)


def changed(series: Series, rng: np.random.Generator) -> Series:
    """Returns series of which some numbers are changed a little, and seldom a tone."""
    size, share = CHANGES[int(rng.integers(len(CHANGES)))]
    moved = rng.random(series.numbers.shape) < share
    numbers = series.numbers + size * moved * rng.standard_normal(series.numbers.shape)
    waves = series.waves.copy()
    if rng.random() < share / 2:
        k = int(rng.integers(len(waves)))
        waves[k] = max(1.0, round(waves[k] * np.exp(0.3 * rng.standard_normal())))
    return Series(waves, numbers)


def _taper(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns w and its first two derivatives, each of shape (N,)."""
    T = float(time[-1])
    rise = min(RISE * T, MAX_RISE)
    s = np.clip(np.minimum(time, T - time) / rise, 0.0, 1.0)
    sign = np.where(time < T / 2, 1.0, -1.0)
    w = s**3 * (10 - 15 * s + 6 * s**2)
    dw = 30 * s**2 * (1 - s) ** 2 / rise * sign
    ddw = 60 * s * (1 - s) * (1 - 2 * s) / rise**2
    return w, dw, ddw
