"""The recursions of the Kalman filter over the samples of a log, compiled.

    S_k = C P_k Cᵀ + I = F Fᵀ,    L_k = F⁻¹,    W = P_k Cᵀ L_kᵀ,    K_k = W L_k
    P_{k+1} = A_k (P_k - W Wᵀ) A_kᵀ + (1 - a_k²) P_0,    P_0 = diag(0, ρ²)

    ε_k = e_k - C z_k,    E_k = L_k ε_k,    z_{k+1} = A_k (z_k + K_k ε_k),    z_0 = 0

    D_{k+1} = A_k D_k A_kᵀ + (1 - a_k²) P_0,    D_0 = P_0          the same without any measurement

K: gains, L: inverted Cholesky factors of the covariances S of the innovations ε over σ². A_k stands
for the transition [[A_k, B_k], [0, a_k]] of the whole state z = (x, w)
(`identification.kalman.system`). Its lower rows are no product of matrices, and C reads few states:
both save a third of the work. A sample of a plant with few states costs less than a call of numpy,
of which the loop would need a dozen. Records are filtered side by side, and so are columns.
"""

from __future__ import annotations

import numpy as np
from numba import carray

from identification.kalman.compiled import call
from identification.kalman.system import System
from identification.native.memory import internal
from identification.runtime.pool import run_parts, split

# Columns that are filtered together: their states stay in a processor's own cache, and products
# with fewer columns take longer for each of them.
COLUMNS_PER_CALL = 192


def filter_gains(system: System) -> tuple[np.ndarray, np.ndarray, float]:
    """Returns the gains K (N, nz, ny) of the Kalman filter, L (N, ny, ny), and Σ log det S."""
    nx, nu, ny = system.sizes
    n = len(system.A) + 1
    K, L = np.empty((n, nx + nu, ny)), np.empty((n, ny, ny))
    given = (system.A, system.B, system.C, system.a, system.variances, K, L)
    run_parts(lambda record: call(_gains, (n, nx, nu, ny, *record), given), system.records)
    return K, L, -2 * float(np.log(np.diagonal(L, axis1=1, axis2=2)).sum())


def filter_innovations(
    system: System, K: np.ndarray, L: np.ndarray, e: np.ndarray
) -> np.ndarray:  # fmt: skip
    """Returns the innovations, of std σ each, of residuals e (n, ny, p) of n <= N samples."""
    n, ny, p = e.shape
    out = np.empty((n, ny, p))
    given = (system.A, system.B, system.C, system.a, K, L, np.ascontiguousarray(e, float), out)
    sizes = (len(system.A) + 1, *system.sizes, p)

    def part(some: tuple[int, int, int, int]) -> None:
        call(_innovations, (*sizes, *some), given)

    columns = split(p, COLUMNS_PER_CALL)
    records = [(first, min(end, n)) for first, end in system.records if first < n]
    run_parts(part, [(*record, c.start, c.stop) for record in records for c in columns])
    return out


def propagate(system: System) -> np.ndarray:
    """Returns output variances over σ² (N-1, ny) by the inputs' errors if nothing is measured."""
    n, (_, _, ny) = len(system.A), system.sizes
    out = np.empty((n, ny))
    given = (system.A, system.B, system.C, system.a, system.variances, out)
    call(_propagate, (n, *system.sizes), given)
    return out


def _gains(n, nx, nu, ny, begin, end, A_, B_, C_, a_, variances_, K_, L_):
    nz = nx + nu
    A, B = carray(A_, (n - 1, nx, nx)), carray(B_, (n - 1, nx, nu))
    C, a, variances = carray(C_, (ny, nx)), carray(a_, n - 1), carray(variances_, nu)
    K, L = carray(K_, (n, nz, ny)), carray(L_, (n, ny, ny))
    P, M, W = _first(nx, variances), np.empty((nz, nz)), np.empty((ny, nz))
    T, TP, X = np.empty((nx, nz)), np.empty((nx, nz)), np.empty((nx, nx))
    CP, S, F = np.empty((ny, nz)), np.empty((ny, ny)), np.empty((ny, ny))
    for k in range(begin, end):
        _read(C, P, CP, S)
        for j in range(ny):
            S[j, j] += 1.0
        _inverted_factor(S, F, L[k])
        np.dot(L[k], CP, W)
        np.dot(W.T, L[k], K[k])
        if k + 1 < end:
            np.dot(W.T, W, M)
            for i in range(nz):
                for j in range(nz):
                    P[i, j] -= M[i, j]
            _step(A[k], B[k], a[k], variances, P, T, TP, X)


def _propagate(n, nx, nu, ny, A_, B_, C_, a_, variances_, out_):
    A, B = carray(A_, (n, nx, nx)), carray(B_, (n, nx, nu))
    C, a, variances = carray(C_, (ny, nx)), carray(a_, n), carray(variances_, nu)
    out, nz = carray(out_, (n, ny)), nx + nu
    P, T, TP, X = _first(nx, variances), np.empty((nx, nz)), np.empty((nx, nz)), np.empty((nx, nx))
    CP, S = np.empty((ny, nz)), np.empty((ny, ny))
    for k in range(n):
        _step(A[k], B[k], a[k], variances, P, T, TP, X)
        _read(C, P, CP, S)
        for i in range(ny):
            out[k, i] = S[i, i]


@internal
def _first(nx, variances):
    """Returns the covariance over σ² of the first state of a record."""
    P = np.zeros((nx + len(variances), nx + len(variances)))
    for i in range(len(variances)):
        P[nx + i, nx + i] = variances[i]
    return P


@internal
def _read(C, P, CP, S):
    """Writes C P into CP and C P Cᵀ into S; P is symmetric."""
    CP[:] = 0.0
    S[:] = 0.0
    for i in range(len(C)):
        for l in range(C.shape[1]):
            if C[i, l] != 0.0:
                for j in range(len(P)):
                    CP[i, j] += C[i, l] * P[l, j]
    for i in range(len(C)):
        for l in range(C.shape[1]):
            if C[i, l] != 0.0:
                for j in range(len(C)):
                    S[j, i] += C[i, l] * CP[j, l]


@internal
def join_rows(A, B, T):
    """Writes the upper rows of a transition of the whole state into T."""
    nx = len(A)
    for i in range(nx):
        for j in range(nx):
            T[i, j] = A[i, j]
        for j in range(B.shape[1]):
            T[i, nx + j] = B[i, j]


@internal
def _step(A, B, a, variances, P, T, TP, X):
    """Replaces P by that of the next sample; T, TP and X are scratch."""
    nx = len(A)
    join_rows(A, B, T)
    np.dot(T, P, TP)
    np.dot(TP, T.T, X)
    for i in range(nx):
        for j in range(nx):
            P[i, j] = (X[i, j] + X[j, i]) / 2
        for j in range(nx, len(P)):
            P[i, j] = P[j, i] = a * TP[i, j]
    for i in range(nx, len(P)):
        for j in range(nx, len(P)):
            P[i, j] *= a * a
        P[i, i] += (1 - a * a) * variances[i - nx]


@internal
def _inverted_factor(S, F, L):
    """Writes the Cholesky factor of S into F, and its inverse into L; both are lower triangles."""
    for j in range(len(S)):
        for i in range(j, len(S)):
            s = S[i, j]
            for k in range(j):
                s -= F[i, k] * F[j, k]
            F[i, j] = np.sqrt(s) if i == j else s / F[j, j]
    L[:] = 0.0
    for j in range(len(S)):
        for i in range(j, len(S)):
            s = 1.0 if i == j else 0.0
            for k in range(j, i):
                s -= F[i, k] * L[k, j]
            L[i, j] = s / F[i, i]


def _innovations(
    n, nx, nu, ny, columns, begin, end, left, right, A_, B_, C_, a_, K_, L_, e_, out_
):  # fmt: skip
    p, nz = right - left, nx + nu
    A, B = carray(A_, (n - 1, nx, nx)), carray(B_, (n - 1, nx, nu))
    C, a = carray(C_, (ny, nx)), carray(a_, n - 1)
    K, L = carray(K_, (n, nz, ny)), carray(L_, (n, ny, ny))
    e, out = carray(e_, (n, ny, columns)), carray(out_, (n, ny, columns))
    x, w, new = np.zeros((nx, p)), np.zeros((nu, p)), np.empty((ny, p))
    T, KL, seen = np.empty((nx, nz)), np.empty((nz + ny, ny)), np.empty((nz + ny, p))
    for k in range(begin, end):
        for i in range(ny):
            for j in range(p):
                new[i, j] = e[k, i, left + j]
            for l in range(nx):
                if C[i, l] != 0.0:  # a sensor reads few of the states
                    for j in range(p):
                        new[i, j] -= C[i, l] * x[l, j]
        KL[:nz], KL[nz:] = K[k], L[k]
        np.dot(KL, new, seen)  # one product of gains and factors takes less than two
        for i in range(ny):
            for j in range(p):
                out[k, i, left + j] = seen[nz + i, j]
        if k + 1 < end:
            for i in range(nx):
                for j in range(p):
                    seen[i, j] += x[i, j]
            for i in range(nu):
                for j in range(p):
                    seen[nx + i, j] += w[i, j]
                    w[i, j] = a[k] * seen[nx + i, j]
            join_rows(A[k], B[k], T)
            np.dot(T, seen[:nz], x)
