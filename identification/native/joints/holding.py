"""Friction that holds joints which pull at each other.

    w = M⁻¹ (g - f),      g = M v/T + F - c
    f_i = -b⁻_i  where w_i < 0,      f_i = b⁺_i  where w_i > 0,      between them where w_i = 0

g: force that would have to be resisted to stop all joints within T, of the mass matrix M, the
velocities v, all other forces F and the bias c (Coriolis, centrifugal, gravity). f is the friction
of each joint, at most b⁻ and b⁺ by direction: a joint that friction holds has w = 0, whatever the
others do, and one that it cannot hold is braked with all of it. This is the complementarity problem
of Coulomb's law (Moreau 1988), solved by projected Gauss-Seidel:

    f_i ← min(max(f_i + w_i/A_ii, -b⁻_i), b⁺_i),      w ← w - A_i Δf_i,      A = M⁻¹

For a single joint it is f = min(max(g, -b⁻), b⁺). Where friction gives before it slips, its spring
carries p, and the share r of it that a step h resolves is not held (see `native.gear`):

    f_i ← min(max((1 - r_i) (f_i + w_i/A_ii) + r_i p_i, -b⁻_i), b⁺_i)
    r_i = min(1, c_i (X/h)²/A_ii)

which is Gauss-Seidel of w_i = r_i/(1 - r_i) A_ii (f_i - p_i). 1/A_ii is the inertia that swings on
the spring of a joint while all others are free, the least that it can be.
"""

from __future__ import annotations

import numpy as np

from identification.native.memory import inlined, internal

MOST = 24  # degrees of freedom up to which joints are held together; beyond, each by itself
SWEEPS = 1000  # at most; mass matrices of arms take some ten
ENOUGH = 1e-11  # change of a friction in a sweep that ends them, of the largest one
RESOLVED = 1.0  # X: RK4 then damps a swing by 7e-3 a step; semi-implicit Euler is stable up to 2


@inlined
def resolved(c, inertia, h):
    """Returns r, the share that a step resolves of friction that gives, c being its compliance."""
    return min(1.0, c * inertia * (RESOLVED / h) ** 2)


@internal
def invert(M, A, n):
    """Computes A = M⁻¹ (n x n) from the lower triangle of a positive M, which is overwritten.

    M = L Lᵀ (Cholesky), A = L⁻ᵀ L⁻¹.
    """
    for j in range(n):
        for i in range(j, n):
            s = M[i, j]
            for k in range(j):
                s -= M[i, k] * M[j, k]
            M[i, j] = np.sqrt(s) if i == j else s / M[j, j]
    for j in range(n):  # L⁻¹ in place
        M[j, j] = 1.0 / M[j, j]
        for i in range(j + 1, n):
            s = 0.0
            for k in range(j, i):
                s -= M[i, k] * M[k, j]
            M[i, j] = s / M[i, i]
    for i in range(n):
        for j in range(i + 1):
            s = 0.0
            for k in range(i, n):
                s += M[k, i] * M[k, j]
            A[i, j] = s
            A[j, i] = s


@internal
def hold(A, w, low, high, f, n, r, p):
    """Computes friction into f, which comes as zeros; w comes as M⁻¹ g and is overwritten."""
    largest = 0.0
    for i in range(n):
        largest = max(largest, low[i], high[i])
    for _ in range(SWEEPS):
        change = 0.0
        for i in range(n):
            if low[i] <= 0.0 and high[i] <= 0.0:
                continue
            new = (1.0 - r[i]) * (f[i] + w[i] / A[i, i]) + r[i] * p[i]
            new = min(max(new, -low[i]), high[i])
            more = new - f[i]
            if more != 0.0:
                f[i] = new
                change = max(change, abs(more))
                for k in range(n):
                    w[k] -= A[k, i] * more
        if change <= ENOUGH * largest:
            break
