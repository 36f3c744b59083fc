"""Linear systems over the intervals of a trajectory: their transitions, and their responses.

    ẋ = F x + g  over Δt:    x ← A x + Γ g,    X = D⁻¹ F Δt D
    φ(X) = Σ_k X^k/(k+1)!,    A = e^X = I + X φ(X),    Γ = Δt φ(X)
    φ(2X) = (φ(X) + e^X φ(X))/2,    e^2X = (e^X)²              (Moler, Van Loan 2003, method 3)

D balances the states' units by powers of two, which rounds nothing (Parlett, Reinsch 1969): an
elastic cable in metres beside angles makes a matrix of norm 1e5, whose doublings cost more than all
else; balanced it is 10. The series is taken where no X is longer than `MAX_SERIES_NORM`, and
doubled from there. How long a matrix is for a series tell its powers, |X⁴|^¼ and |X⁵|^⅕ (Al-Mohy,
Higham 2009, theorem 4.2), of oscillations less than half its norm. The polynomial is taken in
groups of five powers (Paterson, Stockmeyer 1973), with 8 products of matrices in place of 23.
All is compiled: between its products a matrix stays in a processor's own cache, and
`scipy.linalg.expm`, which takes the matrices one by one as well, takes ten times as long.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from numba import carray
from scipy.linalg import matrix_balance

from identification.kalman.compiled import call
from identification.native.memory import internal
from identification.runtime.pool import run_parts, split, threads

MAX_SERIES_NORM = 2.8  # 2.8^25/26! is below the rounding of doubles
GROUP = 5  # powers of X that are kept: a series of 25 terms is summed in groups of as many
SERIES = np.array([1 / factorial(k + 1) for k in range(GROUP**2)]).reshape(GROUP, GROUP)
PER_CALL = 64  # matrices or columns at most, so that the threads end together


def transitions(
    F: np.ndarray, duration: np.ndarray, forced: int = 0
) -> tuple[np.ndarray, np.ndarray]:
    """Returns A (n, nx, nx) and Γ (n, nx, nx - forced) of F (n, nx, nx) [1/s] over times (n,) [s].

    Only the rates of the states from the index `forced` on are forced.
    """
    F, duration = (np.ascontiguousarray(a, float) for a in (F, duration))
    D = _balance(np.maximum(F.max(axis=0, initial=0.0), -F.min(axis=0, initial=0.0)))
    nx = F.shape[1]
    A, Γ = np.empty(F.shape), np.empty((len(F), nx, nx - forced))

    def part(some: slice) -> None:
        arrays = (F[some], duration[some], D, SERIES, A[some], Γ[some])
        call(_exponentials, (some.stop - some.start, nx, forced), arrays)

    run_parts(part, split(len(F), PER_CALL))
    return A, Γ


def respond(
    A: np.ndarray, Γ: np.ndarray, first: np.ndarray, g: np.ndarray, every: int, rows: np.ndarray
) -> np.ndarray:
    """Computes entries of the state at the samples for m forcings of its rates: (m, N, r).

        δx_{l+1} = A_l δx_l + Γ_l g_l,    δx_0 given            l: the L intervals of a trajectory

    Args:
        A: transition over each interval, shape (L, nx, nx).
        Γ: effect of a constant rate of change, shape (L, nx, nf).
        first: the first state of each forcing, shape (m, nx).
        g: means of the forcings over the intervals, shape (m, L, nf).
        every: intervals of a sample.
        rows: indices of the r entries.
    """
    L, nx, nf = Γ.shape
    m, wanted = len(g), np.asarray(rows, np.int64)
    out = np.empty((m, L // every + 1, len(wanted)))
    A, Γ, first, g = (np.ascontiguousarray(a, float) for a in (A, Γ, first, g))
    workers = threads()
    width = max(1, min(PER_CALL, -(-m // workers)))
    chunks = [slice(k, min(k + width, m)) for k in range(0, m, width)]

    def part(k: int) -> None:
        for chunk in chunks[k::workers]:
            sizes = L, nx, nf, chunk.stop - chunk.start, every, len(wanted)
            call(_respond, sizes, (A, Γ, first[chunk], g[chunk], wanted, out[chunk]))

    run_parts(part, range(min(workers, len(chunks))))
    return out


def _balance(largest: np.ndarray) -> np.ndarray:
    """Returns the scaling D of matrices whose entries have these largest sizes, shape (nx,)."""
    if not np.isfinite(largest).all() or not largest.size:  # what is not finite stays so
        return np.ones(len(largest))
    _, (D, _) = matrix_balance(largest, permute=False, separate=True)
    return np.asarray(D)


def _exponentials(n, nx, forced, F_, duration_, D_, series_, A_, Γ_):
    F, duration, D = carray(F_, (n, nx, nx)), carray(duration_, n), carray(D_, nx)
    A, Γ = carray(A_, (n, nx, nx)), carray(Γ_, (n, nx, nx - forced))
    c, X = carray(series_, (GROUP, GROUP)), np.empty((GROUP + 1, nx, nx))
    φ, E = np.empty((nx, nx)), np.empty((nx, nx))
    own, moved = np.empty((nx, nx - forced)), np.empty((nx, nx - forced))
    for k in range(n):
        for i in range(nx):
            for j in range(nx):
                X[1, i, j] = F[k, i, j] * (duration[k] * (D[j] / D[i]))
        for power in range(2, GROUP + 1):
            np.dot(X[power - 1], X[1], X[power])
        longest = max(_norm(X[GROUP - 1]) ** (1 / (GROUP - 1)), _norm(X[GROUP]) ** (1 / GROUP))
        is_long = MAX_SERIES_NORM < longest < np.inf
        doublings = int(np.ceil(np.log2(longest / MAX_SERIES_NORM))) if is_long else 0
        for power in range(1, GROUP + 1):
            X[power] *= 0.5 ** (doublings * power)
        φ[:] = 0.0
        _add_group(φ, c[GROUP - 1], X)
        for group in range(GROUP - 2, -1, -1):
            np.dot(X[GROUP], φ, E)
            _add_group(E, c[group], X)
            φ, E = E, φ
        np.dot(X[1], φ, E)
        for i in range(nx):
            E[i, i] += 1.0
            for j in range(nx - forced):
                own[i, j] = φ[i, forced + j] * 0.5**doublings
        for _ in range(doublings):
            np.dot(E, own, moved)
            own += moved
            np.dot(E, E, φ)
            φ, E = E, φ
        for i in range(nx):
            for j in range(nx):
                A[k, i, j] = E[i, j] * (D[i] / D[j])
            for j in range(nx - forced):
                Γ[k, i, j] = own[i, j] * (duration[k] * (D[i] / D[forced + j]))


@internal
def _add_group(to, c, X):
    """Add a group of the series: the sum of c[k] X^k."""
    for i in range(len(to)):
        to[i, i] += c[0]
        for j in range(len(to)):
            low, high = c[1] * X[1, i, j] + c[2] * X[2, i, j], c[3] * X[3, i, j] + c[4] * X[4, i, j]
            to[i, j] += low + high


@internal
def _norm(X):
    """Returns the largest sum of the absolute values in a column."""
    sums = np.zeros(len(X))
    for i in range(len(X)):
        for j in range(len(X)):
            sums[j] += abs(X[i, j])
    return sums.max() if len(X) else 0.0


def _respond(L, nx, nf, m, every, r, A_, Γ_, first_, g_, rows_, out_):
    A, Γ = carray(A_, (L, nx, nx)), carray(Γ_, (L, nx, nf))
    first, g = carray(first_, (m, nx)), carray(g_, (m, L, nf))
    rows, out = carray(rows_, r), carray(out_, (m, L // every + 1, r))
    x, moved, forced = np.empty((nx, m)), np.empty((nx, m)), np.empty((nf, m))
    for i in range(nx):
        for j in range(m):
            x[i, j] = first[j, i]
    for k in range(L + 1):
        if k % every == 0:
            for i in range(r):
                for j in range(m):
                    out[j, k // every, i] = x[rows[i], j]
        if k == L:
            break
        for j in range(m):
            for i in range(nf):
                forced[i, j] = g[j, k, i]
        np.dot(A[k], x, moved)
        np.dot(Γ[k], forced, x)
        for i in range(nx):
            for j in range(m):
                x[i, j] += moved[i, j]
