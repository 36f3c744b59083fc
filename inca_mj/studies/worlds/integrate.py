"""Integrate a world: Dormand and Prince's formula of order 5, with a fixed step.

Currents are a zero-order hold, and delayed ones change inside a sample: the steps end at every
change, so no step sees a jump. Where the current loop lags, its current is exact,
i_m(t) = i_c + (i_m(t₀) − i_c) e^(−(t − t₀)/τ), and a lag of any τ costs nothing in stability.

Inside a step a rotor may meet the edge of its play, where ψ̇ jumps. After each step the play is made
exact, ψ ← clip(ψ before, φ − h, φ + h), and the cable that this winds is taken off d₀.

The formula is that of J. R. Dormand and P. J. Prince, J. Comp. Appl. Math. 6 (1980).
"""

from __future__ import annotations

from math import ceil, exp, tanh

import numpy as np

from inca_mj.reference import layout as base
from inca_mj.reference.equations import compiled, rotation, times, vector
from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.equations import path, radius, world_rate

STEP = 5e-4  # [s]; at half of it no angle of 20 s changes by 1e-8 rad
PLAY_STEP = 1.25e-4  # the same for a robot whose drums play: 5e-5 rad rms at ±0.015 rad [s]
C = np.array([0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1])
A = np.array(
    [
        [0, 0, 0, 0, 0],
        [1 / 5, 0, 0, 0, 0],
        [3 / 40, 9 / 40, 0, 0, 0],
        [44 / 45, -56 / 15, 32 / 9, 0, 0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
    ]
)
B = np.array([35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84])


@compiled
def limited(i: float, D: np.ndarray) -> float:
    """Returns a current after the amplifier's limit [A]."""
    i_max = D[at.CURRENT_LIMIT]
    if i_max == np.inf:
        return i
    if D[at.CURRENT_SOFT] != 0.0:
        return i_max * tanh(i / i_max)
    return min(max(i, -i_max), i_max)


@compiled
def close_play(x: np.ndarray, before: np.ndarray, q: np.ndarray, D: np.ndarray) -> None:
    """Put every drum where the play operator has it, with the cable that it winds."""
    A, B = q[base.EXITS], q[base.CONNECTORS]
    for k in range(8):
        h, φ, ψ = D[k, at.PLAY], x[12 + k], x[36 + k]
        if h == 0.0:
            continue
        inside = min(max(before[k], φ - h), φ + h)
        if inside != ψ:
            Rb = times(rotation(vector(x[6:])), vector(B[3 * k :]))
            ds = (x[0] + Rb[0] - A[3 * k], x[1] + Rb[1] - A[3 * k + 1],
                  x[2] + Rb[2] - A[3 * k + 2])  # fmt: skip
            d, _ = path(ds, D[k, at.PULLEY], D[k, at.PULLEY_SIDE])
            x[28 + k] -= radius(ψ, q[base.ROW * k + base.R], D[k]) * (inside - ψ) * x[28 + k] / d
            x[36 + k] = inside


@compiled
def advance(t_0: float, span: float, x: np.ndarray, i_c: np.ndarray, i_m: np.ndarray,
            q: np.ndarray, D: np.ndarray, P: np.ndarray, step: float) -> None:  # fmt: skip
    """Advance x and i_m in place over `span` seconds of constant commands i_c."""
    n = max(1, ceil(span / step - 1e-9))
    h = span / n
    K, y, i = np.empty((6, at.STATES)), np.empty(at.STATES), np.empty(8)
    start = i_m.copy()
    for j in range(n):
        t = t_0 + j * h
        for stage in range(6):
            for k in range(8):
                τ = D[k, at.LAG]
                i[k] = i_c[k]
                if τ > 0.0:
                    i[k] += (start[k] - i_c[k]) * exp(-(j + C[stage]) * h / τ)
            for n_x in range(at.STATES):
                change = 0.0
                for before in range(stage):
                    change += A[stage, before] * K[before, n_x]
                y[n_x] = x[n_x] + h * change
            world_rate(t + C[stage] * h, y, i, q, D, P, K[stage])
        before_step = x[at.DRUM].copy()
        for n_x in range(at.STATES):
            change = 0.0
            for stage in range(6):
                change += B[stage] * K[stage, n_x]
            x[n_x] += h * change
        close_play(x, before_step, q, D)
    for k in range(8):
        i_m[k] = i_c[k]
        if D[k, at.LAG] > 0.0:
            i_m[k] += (start[k] - i_c[k]) * exp(-span / D[k, at.LAG])


@compiled
def trajectory(x_0: np.ndarray, currents: np.ndarray, T_s: float, q: np.ndarray, D: np.ndarray,
               P: np.ndarray, step: float) -> np.ndarray:  # fmt: skip
    """Returns states at the samples, shape (n, 60); NaN from the sample on where it diverges.

    Row k of the currents (n, 8) [A] is commanded from t_k to t_k+1; `step` is the largest one [s].
    """
    n = len(currents)
    X = np.full((n, at.STATES), np.nan)
    x, commanded, i_m = x_0.copy(), np.zeros((n + 1, 8)), np.empty(8)
    for j in range(n):  # row 0 is what comes out before the first sample arrives
        for k in range(8):
            commanded[j + 1, k] = limited(currents[j, k], D[k])
    whole = int(P[at.DELAY] / T_s + 1e-9)
    rest = max(0.0, P[at.DELAY] - whole * T_s)
    if rest < 1e-9:
        rest = 0.0
    i_m[:] = commanded[1]
    X[0] = x
    for j in range(n - 1):
        t, new = j * T_s, max(0, j + 1 - whole)
        if rest > 0.0:
            advance(t, rest, x, commanded[max(0, new - 1)], i_m, q, D, P, step)
        advance(t + rest, T_s - rest, x, commanded[new], i_m, q, D, P, step)
        if not np.isfinite(x).all():
            break
        X[j + 1] = x
    return X
