"""The recursions of the Kalman filter over the samples of a log, compiled.

    S_k = C P_k Cᵀ + I = F Fᵀ,    L_k = F⁻¹,    W = P_k Cᵀ L_kᵀ,    K_k = W L_k
    P_{k+1} = A_k (P_k - W Wᵀ) A_kᵀ + s_k P_0

    ε_k = e_k - C z_k,    E_k = L_k ε_k,    z_{k+1} = A_k (z_k + K_k ε_k),    z_0 = 0

    D_{k+1} = A_k D_k A_kᵀ + s_k P_0,    D_0 = P_0          the same without any measurement

    M_k = A_k (1 - K_k C),    N_k = M_kᵀ N_{k+1} M_k + Cᵀ L_kᵀ L_k C,    N_N = 0      backwards
    V_k = L_kᵀ L_k + K_kᵀ A_kᵀ N_{k+1} A_k K_k

K: gains, L: inverted Cholesky factors of the covariances S of the innovations ε over σ². V_k is a
block of the diagonal of the inverse covariance of all residuals. A sample of a plant with few
states costs less than a call of numpy, of which the loop would need a dozen. Columns are filtered
on all threads at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from ctypes import POINTER, c_double, c_int64
from functools import cache
from threading import Lock
from typing import Any

import numpy as np
from numba import carray, types

from identification.native.cache import compile_once
from identification.native.memory import internal
from identification.pool import run_parts, split

# Columns that are filtered together: their states stay in a processor's own cache, and products
# with fewer columns take longer for each of them.
COLUMNS_PER_CALL = 192

# Addresses of arrays of doubles and of integers, to numba and to ctypes.
ADDRESSES: dict[str, tuple[Any, Any]] = {
    "f": (types.CPointer(types.float64), POINTER(c_double)),
    "i": (types.CPointer(types.int64), POINTER(c_int64)),
}
_LOCK = Lock()


def filter_gains(
    A: np.ndarray, C: np.ndarray, P: np.ndarray, share: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Returns the gains K (N, nz, ny) of the Kalman filter, L (N, ny, ny), and Σ log det S.

    Args:
        A: transitions of the state, shape (N-1, nz, nz).
        C: outputs from the state, shape (ny, nz).
        P: covariance over σ² of the first state, shape (nz, nz).
        share: s, the covariance of each sample's process noise in units of P, shape (N-1,).
    """
    n, nz, ny = len(A), len(P), len(C)
    K, L = np.empty((n + 1, nz, ny)), np.empty((n + 1, ny, ny))
    given = (np.ascontiguousarray(a, float) for a in (A, C, P, share))
    call(_gains, (n, nz, ny), (*given, K, L))
    return K, L, -2 * float(np.log(np.diagonal(L, axis1=1, axis2=2)).sum())


def filter_innovations(
    A: np.ndarray, C: np.ndarray, K: np.ndarray, L: np.ndarray, e: np.ndarray
) -> np.ndarray:
    """Returns the innovations, of std σ each, of residuals e (n, ny, p) of n <= N samples."""
    n, ny, p = e.shape
    out = np.empty((n, ny, p))
    given = [np.ascontiguousarray(a, float) for a in (A, C, K, L, e)]

    def part(some: slice) -> None:
        call(_innovations, (n, A.shape[1], ny, p, some.start, some.stop), (*given, out))

    run_parts(part, split(p, COLUMNS_PER_CALL))
    return out


def transpose_filter(
    A: np.ndarray, C: np.ndarray, K: np.ndarray, L: np.ndarray, E: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Applies the transposed filter to E (n, ny): x · e = E · (innovations of e) for any e.

        r_k = A_kᵀ r_{k+1} + Cᵀ x_k,    x_k = L_kᵀ E_k - K_kᵀ A_kᵀ r_{k+1}

    Returns x, shape (n, ny), and r, shape (n, nz).
    """
    n, ny = E.shape
    out, r = np.empty((n, ny)), np.empty((n, A.shape[1]))
    given = (np.ascontiguousarray(a, float) for a in (A, C, K, L, E))
    call(_transposed, (n, A.shape[1], ny), (*given, out, r))
    return out, r


def information(
    A: np.ndarray, C: np.ndarray, K: np.ndarray, L: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the diagonals of V_k, shape (N, ny), and of N_k, shape (N, nz).

    N_k is the covariance over σ² of the r_k of `transpose_filter` where the noise is right.
    """
    n, nz, ny = len(A), A.shape[1], len(C)
    V, N = np.empty((n + 1, ny)), np.empty((n + 1, nz))
    given = (np.ascontiguousarray(a, float) for a in (A, C, K, L))
    call(_information, (n + 1, nz, ny), (*given, V, N))
    return V, N


def propagate(A: np.ndarray, C: np.ndarray, P: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Returns output variances over σ² (N-1, ny) by the process noise if nothing is measured."""
    n, nz, ny = len(A), len(P), len(C)
    out = np.empty((n, ny))
    given = (np.ascontiguousarray(a, float) for a in (A, C, P, share))
    call(_propagate, (n, nz, ny), (*given, out))
    return out


def _gains(n, nz, ny, A_, C_, P_, share_, K_, L_):
    A, share, first = carray(A_, (n, nz, nz)), carray(share_, n), carray(P_, (nz, nz))
    C, P = carray(C_, (ny, nz)), first.copy()
    K, L = carray(K_, (n + 1, nz, ny)), carray(L_, (n + 1, ny, ny))
    PC, W, M, AM = np.empty((nz, ny)), np.empty((nz, ny)), np.empty((nz, nz)), np.empty((nz, nz))
    S, F = np.empty((ny, ny)), np.empty((ny, ny))
    for k in range(n + 1):
        np.dot(P, C.T, PC)
        np.dot(C, PC, S)
        for j in range(ny):
            S[j, j] += 1.0
        _inverted_factor(S, F, L[k])
        np.dot(PC, L[k].T, W)
        np.dot(W, L[k], K[k])
        if k < n:
            np.dot(W, W.T, M)
            for i in range(nz):
                for j in range(nz):
                    P[i, j] -= M[i, j]
            _step(A[k], P, first, share[k], M, AM)


def _propagate(n, nz, ny, A_, C_, P_, share_, out_):
    A, share, first = carray(A_, (n, nz, nz)), carray(share_, n), carray(P_, (nz, nz))
    C, P, out = carray(C_, (ny, nz)), first.copy(), carray(out_, (n, ny))
    CP, M, AM = np.empty((ny, nz)), np.empty((nz, nz)), np.empty((nz, nz))
    for k in range(n):
        _step(A[k], P, first, share[k], M, AM)
        np.dot(C, P, CP)
        for i in range(ny):
            out[k, i] = 0.0
            for j in range(nz):
                out[k, i] += CP[i, j] * C[i, j]


@internal
def _step(A, P, first, share, M, AM):
    """Replaces P by that of the next sample; M and AM are scratch."""
    np.dot(A, P, AM)
    np.dot(AM, A.T, M)
    for i in range(len(P)):
        for j in range(len(P)):
            P[i, j] = (M[i, j] + M[j, i]) / 2 + share * first[i, j]


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


def _innovations(n, nz, ny, columns, begin, end, A_, C_, K_, L_, e_, out_):
    p = end - begin
    A, C = carray(A_, (max(n - 1, 0), nz, nz)), carray(C_, (ny, nz))
    K, L = carray(K_, (n, nz, ny)), carray(L_, (n, ny, ny))
    e, out = carray(e_, (n, ny, columns)), carray(out_, (n, ny, columns))
    z, new = np.zeros((nz, p)), np.empty((ny, p))
    KL, seen = np.empty((nz + ny, ny)), np.empty((nz + ny, p))
    for k in range(n):
        for i in range(ny):
            for j in range(p):
                new[i, j] = e[k, i, begin + j]
            for l in range(nz):
                if C[i, l] != 0.0:  # a sensor reads few of the states
                    for j in range(p):
                        new[i, j] -= C[i, l] * z[l, j]
        KL[:nz], KL[nz:] = K[k], L[k]
        np.dot(KL, new, seen)  # one product of gains and factors takes less than two
        for i in range(ny):
            for j in range(p):
                out[k, i, begin + j] = seen[nz + i, j]
        if k + 1 < n:
            for i in range(nz):
                for j in range(p):
                    seen[i, j] += z[i, j]
            np.dot(A[k], seen[:nz], z)


def _transposed(n, nz, ny, A_, C_, K_, L_, E_, out_, r_):
    A, C = carray(A_, (max(n - 1, 0), nz, nz)), carray(C_, (ny, nz))
    K, L = carray(K_, (n, nz, ny)), carray(L_, (n, ny, ny))
    E, out, r = carray(E_, (n, ny)), carray(out_, (n, ny)), carray(r_, (n, nz))
    later = np.zeros(nz)
    for k in range(n - 1, -1, -1):
        if k + 1 < n:
            np.dot(A[k].T, r[k + 1], later)
        for i in range(ny):
            out[k, i] = 0.0
            for j in range(ny):
                out[k, i] += L[k, j, i] * E[k, j]
            for j in range(nz):
                out[k, i] -= K[k, j, i] * later[j]
        for j in range(nz):
            r[k, j] = later[j]
            for i in range(ny):
                r[k, j] += C[i, j] * out[k, i]


def _information(n, nz, ny, A_, C_, K_, L_, V_, N_):
    A, C = carray(A_, (max(n - 1, 0), nz, nz)), carray(C_, (ny, nz))
    K, L = carray(K_, (n, nz, ny)), carray(L_, (n, ny, ny))
    V, diagonal = carray(V_, (n, ny)), carray(N_, (n, nz))
    N, NA, M = np.zeros((nz, nz)), np.empty((nz, nz)), np.empty((nz, nz))
    KC, LC, NK = np.empty((nz, nz)), np.empty((ny, nz)), np.empty((nz, ny))
    for k in range(n - 1, -1, -1):
        if k + 1 < n:
            np.dot(N, A[k], NA)
            np.dot(A[k].T, NA, N)  # Aᵀ N A
        np.dot(N, K[k], NK)
        for i in range(ny):
            V[k, i] = 0.0
            for j in range(ny):
                V[k, i] += L[k, j, i] ** 2
            for j in range(nz):
                V[k, i] += K[k, j, i] * NK[j, i]
        np.dot(K[k], C, KC)
        for i in range(nz):
            for j in range(nz):
                KC[i, j] = (1.0 if i == j else 0.0) - KC[i, j]
        np.dot(N, KC, NA)
        np.dot(KC.T, NA, M)
        np.dot(L[k], C, LC)
        np.dot(LC.T, LC, N)
        for i in range(nz):
            for j in range(nz):
                N[i, j] += M[i, j]
            diagonal[k, i] = N[i, i]


def call(
    function: Callable[..., Any], sizes: tuple[int, ...], arrays: Iterable[np.ndarray]
) -> None:
    """Runs a function of sizes and of the addresses of arrays, which is compiled once."""
    given = [(a, *ADDRESSES[a.dtype.kind]) for a in arrays]
    with _LOCK:  # one of several threads compiles
        run = _compiled(function, len(sizes), tuple(kind for _, kind, _ in given))
    run(*sizes, *(a.ctypes.data_as(pointer) for a, _, pointer in given))


@cache
def _compiled(function: Callable[..., Any], sizes: int, kinds: tuple[Any, ...]) -> Any:
    return compile_once(function, types.void(*[types.int64] * sizes, *kinds))
