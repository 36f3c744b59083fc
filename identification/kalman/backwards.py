"""The recursions of a Kalman filter that run back over the samples of a log, compiled.

    r_k = A_kᵀ r_{k+1} + Cᵀ x_k,    x_k = L_kᵀ E_k - K_kᵀ A_kᵀ r_{k+1},    r_N = 0

    Q_k = A_kᵀ N_{k+1} A_k,    N_k = (1 - K_k C)ᵀ Q_k (1 - K_k C) + Cᵀ L_kᵀ L_k C,    N_N = 0
    V_k = L_kᵀ L_k + K_kᵀ Q_k K_k

The first is the transposed filter: x · e = E · (innovations of e). V_k is a block of the diagonal
of the inverse covariance of all residuals. The letters are those of
`identification.kalman.recursion`, whose A_k is the transition of the whole state too.
"""

from __future__ import annotations

import numpy as np
from numba import carray

from identification.kalman.compiled import call
from identification.kalman.recursion import join_rows
from identification.kalman.system import System
from identification.native.memory import internal
from identification.runtime.pool import run_parts


def transpose_filter(
    system: System, K: np.ndarray, L: np.ndarray, E: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns x, shape (n, ny), and r, shape (n, nz), of E (n, ny) for n <= N samples."""
    n, ny = E.shape
    out, r = np.empty((n, ny)), np.empty((n, K.shape[1]))
    given = (system.A, system.B, system.C, system.a, K, L, np.ascontiguousarray(E, float), out, r)
    call(_transposed, (len(system.A) + 1, *system.sizes, n), given)
    return out, r


def information(system: System, K: np.ndarray, L: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the diagonals of V_k, shape (N, ny), and of N_k, shape (N, nz).

    N_k is the covariance over σ² of the r_k of `transpose_filter` where the noise is right.
    """
    n, nz, ny = K.shape
    V, N = np.empty((n, ny)), np.empty((n, nz))
    given, sizes = (system.A, system.B, system.C, system.a, K, L, V, N), (n, *system.sizes)
    run_parts(lambda record: call(_information, (*sizes, *record), given), system.records)
    return V, N


def _transposed(n, nx, nu, ny, some, A_, B_, C_, a_, K_, L_, E_, out_, r_):
    nz = nx + nu
    A, B = carray(A_, (n - 1, nx, nx)), carray(B_, (n - 1, nx, nu))
    C, a = carray(C_, (ny, nx)), carray(a_, n - 1)
    K, L = carray(K_, (n, nz, ny)), carray(L_, (n, ny, ny))
    E, out, r = carray(E_, (some, ny)), carray(out_, (some, ny)), carray(r_, (some, nz))
    later, of_x, of_w = np.zeros(nz), np.empty(nx), np.empty(nu)
    for k in range(some - 1, -1, -1):
        if k + 1 < some:
            np.dot(A[k].T, r[k + 1, :nx], of_x)
            np.dot(B[k].T, r[k + 1, :nx], of_w)
            for i in range(nx):
                later[i] = of_x[i]
            for i in range(nu):
                later[nx + i] = of_w[i] + a[k] * r[k + 1, nx + i]
        for i in range(ny):
            out[k, i] = 0.0
            for j in range(ny):
                out[k, i] += L[k, j, i] * E[k, j]
            for j in range(nz):
                out[k, i] -= K[k, j, i] * later[j]
        for j in range(nz):
            r[k, j] = later[j]
        for i in range(ny):
            for j in range(nx):
                r[k, j] += C[i, j] * out[k, i]


def _information(n, nx, nu, ny, begin, end, A_, B_, C_, a_, K_, L_, V_, N_):
    nz = nx + nu
    A, B = carray(A_, (n - 1, nx, nx)), carray(B_, (n - 1, nx, nu))
    C, a = carray(C_, (ny, nx)), carray(a_, n - 1)
    K, L = carray(K_, (n, nz, ny)), carray(L_, (n, ny, ny))
    V, diagonal = carray(V_, (n, ny)), carray(N_, (n, nz))
    N, NT, T = np.zeros((nz, nz)), np.empty((nz, nz)), np.empty((nx, nz))
    QK, KN, LL = np.empty((nz, ny)), np.empty((ny, nz)), np.empty((ny, ny))
    for k in range(end - 1, begin - 1, -1):
        if k + 1 < end:
            join_rows(A[k], B[k], T)
            np.dot(N[:nx].T, T, NT)  # N is symmetric
            for i in range(nz):
                for j in range(nx, nz):
                    NT[i, j] += a[k] * N[i, j]
            np.dot(T.T, NT[:nx], N)
            for i in range(nx, nz):
                for j in range(nz):
                    N[i, j] += a[k] * NT[i, j]
        np.dot(N, K[k], QK)
        np.dot(L[k].T, L[k], LL)
        for i in range(ny):
            V[k, i] = LL[i, i]
            for j in range(nz):
                V[k, i] += K[k, j, i] * QK[j, i]
        _seen(C, K[k], QK, LL, N, KN)
        for i in range(nz):
            diagonal[k, i] = N[i, i]


@internal
def _seen(C, K, QK, LL, N, KN):
    """Replaces Q, which stands in N, by (1 - K C)ᵀ Q (1 - K C) + Cᵀ Lᵀ L C; KN is scratch.

    The two factors are multiplied one after the other: what the sum of all four products rounds
    off grows from sample to sample.
    """
    for i in range(len(C)):
        for l in range(C.shape[1]):
            if C[i, l] != 0.0:
                for j in range(len(N)):
                    N[j, l] -= C[i, l] * QK[j, i]
    np.dot(K.T, N, KN)
    for i in range(len(C)):
        for l in range(C.shape[1]):
            if C[i, l] != 0.0:
                for j in range(len(N)):
                    N[l, j] -= C[i, l] * KN[i, j]
                for o in range(len(C)):
                    for m in range(C.shape[1]):
                        N[l, m] += C[i, l] * LL[i, o] * C[o, m]
    for i in range(len(N)):
        for j in range(i):
            N[i, j] = N[j, i] = (N[i, j] + N[j, i]) / 2
