"""References that a robot is told to follow: sums of sines, steps, moves from point to point."""

from __future__ import annotations

import numpy as np

KINDS = ("sines", "steps", "moves")
SINES, SLOWEST, FASTEST = 6, 0.1, 1.5  # how many, [Hz]
REST = (0.2, 1.0)  # [s] between moves


def reference(
    kind: str, travel: np.ndarray, speed: np.ndarray, h: float, count: int, rng: np.random.Generator
) -> np.ndarray:
    """Positions, rates and accelerations of a reference that begins at rest at zero.

    Args:
        kind: one of `KINDS`.
        travel: how far to either side [rad or m], shape (n,).
        speed: top speed [rad/s or m/s], shape (n,).
        h: sampling time [s].
        count: samples.
        rng: of random numbers.

    Returns:
        Shape (3, count, n).
    """
    make = _sines if kind == "sines" else _moves
    each = [make(L, V, h, count, kind, rng) for L, V in zip(travel, speed, strict=True)]
    return np.stack(each, axis=-1)


def _sines(
    L: float, V: float, h: float, count: int, _: str, rng: np.random.Generator
) -> np.ndarray:
    """Sines of random frequencies, faded in over two seconds."""
    t = h * np.arange(count)
    w = 2 * np.pi * np.exp(rng.uniform(np.log(SLOWEST), np.log(FASTEST), SINES))
    phase, share = rng.uniform(0, 2 * np.pi, SINES), rng.uniform(0.3, 1.0, SINES) / w**0.5
    angle = w * t[:, None] + phase
    q, v, a = (share * np.sin(angle)).sum(1), (share * w * np.cos(angle)).sum(1), 0.0
    a = -(share * w**2 * np.sin(angle)).sum(1)
    s = np.clip(t / 2.0, 0, 1)
    fade = s**3 * (10 - 15 * s + 6 * s**2)
    d1 = 30 * s**2 * (1 - s) ** 2 / 2.0
    d2 = 60 * s * (1 - s) * (1 - 2 * s) / 4.0
    out = np.stack([fade * q, fade * v + d1 * q, fade * a + 2 * d1 * v + d2 * q])
    return out * min(L / np.abs(out[0]).max(), V / np.abs(out[1]).max())


def _moves(
    L: float, V: float, h: float, count: int, kind: str, rng: np.random.Generator
) -> np.ndarray:
    """Polynomials of fifth order between random points, with rests; steps are short ones."""
    out, k, here = np.zeros((3, count)), int(rng.uniform(*REST) / h), 0.0
    while k < count:
        there = rng.uniform(-L, L)
        fastest = 1.875 * abs(there - here) / V  # such a polynomial's top speed is 1.875 the mean
        T = max(fastest if kind == "steps" else fastest * rng.uniform(1.2, 3.0), 0.15)
        s = np.clip(h * np.arange(int(np.ceil(T / h)) + 1) / T, 0, 1)
        way = there - here
        piece = np.stack([
            here + way * s**3 * (10 - 15 * s + 6 * s**2),
            way * 30 * s**2 * (1 - s) ** 2 / T,
            way * 60 * s * (1 - s) * (1 - 2 * s) / T**2,
        ])  # fmt: skip
        end = min(count, k + piece.shape[1])
        out[:, k:end] = piece[:, : end - k]
        out[0, end:], here = there, there
        k = end + int(rng.uniform(*REST) / h)
    return out
