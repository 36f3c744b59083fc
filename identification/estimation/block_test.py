"""A test of sizes by the scatter of blocks of samples, which needs no model of the noise.

    e⊥, S⊥        residual and columns of a candidate, without what the free parameters Φ explain
    a_b = S⊥_bᵀe⊥_b,   G_b = S⊥_bᵀS⊥_b,   Z_b = Λ^½ Φ_bᵀS⊥_b,   Λ = (ΦᵀΦ)⁻¹       of block b
    H = Σ_b G_b = 1,   η̂ = Σ_b a_b,   g_b = a_b - G_b η̂          in coordinates in which H is 1
    K_bc = cov(g_b, g_c)/σ² = δ_bc G_b - Z_bᵀZ_c - G_b G_c        where the noise is white
    Ω = Σ_b K_bb,   D = Ω^-½ (Σ_b g_b g_bᵀ) Ω^-½/σ̂²                 E D = 1 where the noise is white
    R_bc = Ω^-½ K_bc Ω^-½
    ν = m (m + 1)/Σ_bc ((tr R_bc)² + tr R_bc²),   f = m²/Σ_bc tr R_bc R_bcᵀ

D is the scatter of m sizes over what white noise makes of it (White 1980), ν are its degrees of
freedom (Bell, McCaffrey 2002; Pustejovsky, Tipton 2018) and f those of its trace. A candidate that
acts in one block has none: with it in the model nothing is left of that block, and a test that
forgets this takes any jump for significant. Few blocks borrow from the scatter of all candidates
(Smyth 2004):

    log(tr D_j/m) - ψ(f_j/2) + log(f_j/2)      has mean log s² - ψ(d/2) + log(d/2)
                                               and variance ψ'(f_j/2) + ψ'(d/2)
    V = (d s² + ν D)/(d + ν),   W = η̂ᵀV⁻¹η̂/σ̂²
    W (d + ν - m + 1)/((d + ν) m) ~ F(m, d + ν - m + 1)

d is infinite if candidates scatter as one noise makes all of them scatter, and small if some of
them scatter far more than others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special

from identification.chances import f_above

# Of the largest eigenvalue of H: a direction with less is one that no sample feels.
MIN_EIGENVALUE_SHARE = 1e-12
MIN_LEFT_SHARE = 1e-6  # of Ω in H: less is rounding
MIN_FREEDOM = 4.0  # f of a scatter that tells something of all scatters
MIN_SCATTERS = 10  # fewer do not tell how scatters differ
MOST_FREEDOM = 1e4  # as good as infinitely many


@dataclass(frozen=True, kw_only=True)
class Blocks:
    """The columns of J candidates with m sizes each by blocks, in coordinates in which H is 1."""

    root: np.ndarray  # H^-½, shape (J, m, m); zero in directions that no sample feels
    G: np.ndarray  # shape (B, J, m, m)
    over: np.ndarray  # Ω^-½, shape (J, m, m); zero in directions of which blocks tell no scatter
    rank: np.ndarray  # number of sizes that the samples feel, shape (J,)
    freedom: np.ndarray  # ν, shape (J,); zero where blocks tell nothing of the scatter
    trace_freedom: np.ndarray  # f, shape (J,)


@dataclass(frozen=True, kw_only=True)
class Scatter:
    """Estimated sizes of J candidates and their scatter."""

    blocks: Blocks  # of the candidates
    η: np.ndarray  # η̂ in coordinates in which H is 1, shape (J, m)
    D: np.ndarray  # shape (J, m, m)
    variance: np.ndarray  # σ̂², shape (J,)
    signs: np.ndarray  # that physics admits of the sizes, shape (J, m); 0 where it admits both


@dataclass(frozen=True)
class Common:
    """The scatter that all candidates have in common."""

    freedom: float  # d
    square: float  # s²


def make_blocks(G: np.ndarray, Z: np.ndarray) -> Blocks:
    """Returns what the columns of candidates tell by blocks.

    Args:
        G: shape (B, J, m, m).
        Z: shape (B, p, J, m).
    """
    B, J, m, _ = G.shape
    H = G.sum(axis=0)
    root = _power(H, -0.5)
    G = root @ G @ root
    flat = np.einsum("bpjm,jmn->jpbn", Z, root).reshape(J, -1, B * m)
    tall = np.moveaxis(G, 0, 1).reshape(J, B * m, m)
    K = -np.swapaxes(flat, 1, 2) @ flat - tall @ np.swapaxes(tall, 1, 2)
    K = np.moveaxis(K.reshape(J, B, m, B, m), 3, 2)  # (J, B, B, m, m)
    every = np.arange(B)
    K[:, every, every] += np.moveaxis(G, 0, 1)
    over = _power(np.einsum("jbbpq->jpq", K), -0.5, MIN_LEFT_SHARE)
    R = over[:, None, None] @ K @ over[:, None, None]
    traces = np.trace(R, axis1=3, axis2=4)
    squares = np.einsum("jbc,jbc->j", traces, traces) + np.einsum("jbcpq,jbcqp->j", R, R)
    products = np.einsum("jbcpq,jbcpq->j", R, R)
    rank, felt = _rank(root), _rank(over)
    is_told = (felt == rank) & (rank > 0)  # no direction is left without a scatter of its own
    with np.errstate(divide="ignore", invalid="ignore"):
        freedom = np.where(is_told, rank * (rank + 1) / squares, 0.0)
        trace_freedom = np.where(is_told, rank**2 / products, 0.0)
    return Blocks(
        root=root, G=G, over=over, rank=rank, freedom=freedom, trace_freedom=trace_freedom
    )


def scatter_of(blocks: Blocks, a: np.ndarray, variance: np.ndarray, signs: np.ndarray) -> Scatter:
    """Returns the sizes of candidates and their scatter.

    Args:
        blocks: of the candidates.
        a: shape (B, J, m).
        variance: σ̂² with each of them in the model, shape (J,).
        signs: that physics admits of their sizes, shape (J, m); 0 where it admits both.
    """
    a = np.einsum("jpq,bjq->bjp", blocks.root, a)
    η = a.sum(axis=0)
    g = a - np.einsum("bjpq,jq->bjp", blocks.G, η)
    g = np.einsum("jpq,bjq->bjp", blocks.over, g)
    D = np.einsum("bjp,bjq->jpq", g, g) / variance[:, None, None]
    return Scatter(blocks=blocks, η=η, D=D, variance=variance, signs=signs)


def common_scatter(scatters: Sequence[Scatter], least: float = 0.0) -> Common:
    """Returns what candidates of a fit have in common; it is worth nothing where they are few.

    Args:
        scatters: of groups of candidates.
        least: lower limit of s².
    """
    f = np.concatenate([np.zeros(0), *(s.blocks.trace_freedom for s in scatters)])
    traces = (np.trace(s.D, axis1=1, axis2=2) / np.maximum(s.blocks.rank, 1) for s in scatters)
    squares = np.concatenate([np.zeros(0), *traces])
    tells = (f >= MIN_FREEDOM) & (squares > 0)
    f, squares = f[tells], squares[tells]
    if len(f) < MIN_SCATTERS:
        # Few do not tell how scatters differ. Where a noise model says the least that they scatter,
        # it counts for as much as one of them.
        known = float(f.mean()) if least > 0 and len(f) else 0.0
        return Common(known, max(1.0, least))
    each = np.log(squares) - special.digamma(f / 2) + np.log(f / 2)
    half = _inverse_trigamma(float(each.var(ddof=1) - special.polygamma(1, f / 2).mean()))
    s2 = np.exp(each.mean() + special.digamma(half) - np.log(half))
    return Common(2 * half, max(float(s2), least))


def shrunk(scatter: Scatter, common: Common) -> np.ndarray:
    """Returns V of candidates, shape (J, m, m).

    Args:
        scatter: of them.
        common: what they have in common with others.
    """
    d, ν, m = common.freedom, scatter.blocks.freedom[:, None, None], scatter.D.shape[1]
    total = np.maximum(d + ν, 1e-300)
    return np.asarray((d * common.square * np.eye(m) + ν * scatter.D) / total)


def covariance(scatter: Scatter, common: Common) -> np.ndarray:
    """Returns the covariance of the sizes of candidates, shape (J, m, m), in their units.

    Args:
        scatter: of them.
        common: what they have in common with others.
    """
    root = scatter.blocks.root
    return np.asarray(root @ shrunk(scatter, common) @ root * scatter.variance[:, None, None])


def p_values(scatter: Scatter, common: Common) -> np.ndarray:
    """Returns the chances that sizes are as large by luck, shape (J,).

    A candidate with one size, of which physics admits one sign only, is tested on that side; with
    the other sign its chance is 1.

    Args:
        scatter: of the candidates.
        common: what they have in common with others.
    """
    rank, total = scatter.blocks.rank, common.freedom + scatter.blocks.freedom
    V = np.linalg.pinv(shrunk(scatter, common), hermitian=True)
    W = np.einsum("jp,jpq,jq->j", scatter.η, V, scatter.η) / scatter.variance
    rest = total - rank + 1
    is_tested = (rest > 0) & (rank > 0) & (total > 0)
    p = np.ones(len(W))
    n, m, t = rest[is_tested], rank[is_tested], total[is_tested]
    p[is_tested] = f_above(W[is_tested] * n / (t * m), m, n)
    if scatter.signs.shape[1] == 1:
        sign = scatter.signs[:, 0]
        size = (scatter.blocks.root @ scatter.η[..., None])[:, 0, 0]
        p = np.where(sign == 0, p, np.where(sign * size < 0, 1.0, p / 2))
    return p


def _inverse_trigamma(x: float) -> float:
    """Returns y of ψ'(y) = x, by Newton's method on 1/ψ' (Smyth 2004, appendix)."""
    if x <= 2 / MOST_FREEDOM:  # ψ'(y) is near 1/y
        return MOST_FREEDOM / 2
    y = 0.5 + 1 / x
    for _ in range(50):
        slope = float(special.polygamma(1, y))
        step = slope * (1 - slope / x) / float(special.polygamma(2, y))
        y += step
        if abs(step) < 1e-9 * y:
            break
    return y


def _rank(A: np.ndarray) -> np.ndarray:
    """Returns the number of directions in which symmetric matrices are not zero."""
    return np.asarray(np.linalg.matrix_rank(A, rtol=MIN_EIGENVALUE_SHARE, hermitian=True))


def _power(A: np.ndarray, power: float, least: float | None = None) -> np.ndarray:
    """Returns a power of symmetric matrices, zero in directions that they lack.

    Args:
        A: shape (..., m, m).
        power: which.
        least: eigenvalue of a direction that they have; a share of the largest one where None.
    """
    w, V = np.linalg.eigh(A)
    smallest = MIN_EIGENVALUE_SHARE * w.max(axis=-1, keepdims=True) if least is None else least
    has = w > np.maximum(smallest, 0.0)
    w = np.where(has, np.where(has, w, 1.0) ** power, 0.0)
    return np.asarray((V * w[..., None, :]) @ np.swapaxes(V, -1, -2))
