"""The mass matrix as MuJoCo has it factorised behind its position stage.

    M = Lᵀ D L,    M⁻¹ = L⁻¹ D⁻¹ L⁻ᵀ,    (M⁻¹)_jj = Σ_i y_i²/D_i,  y = L⁻ᵀ e_j

(M⁻¹)_jj is the mobility of a joint: its acceleration under a force of one while all others are
free. 1/(M⁻¹)_jj is the inertia that it feels, at most M_jj.
"""

from __future__ import annotations

from identification.native.access import double, integer, offsets, word
from identification.native.decorators import inlined
from identification.native.memory import load_double, store_double

M = offsets("mjModel", "nv M_rowadr M_rownnz M_colind")
D = offsets("mjData", "qLD qLDiagInv")
FIELDS = frozenset((*M._fields, *D._fields))


@inlined
def _rise(m, d, x, last):  # type: ignore[no-untyped-def]
    """Computes L⁻ᵀ x in place, where x is zero behind its entry `last`."""
    L = word(d, D.qLD)
    for i in range(last, -1, -1):
        first, count = integer(m, M.M_rowadr, i), integer(m, M.M_rownnz, i)
        for k in range(first, first + count - 1):
            at = x + 8 * integer(m, M.M_colind, k)
            store_double(at, load_double(at) - load_double(L + 8 * k) * load_double(x + 8 * i))


@inlined
def solve(m, d, x):  # type: ignore[no-untyped-def]
    """Computes M⁻¹ x in place, x an address."""
    n, L = word(m, M.nv), word(d, D.qLD)
    _rise(m, d, x, n - 1)
    for i in range(n):
        store_double(x + 8 * i, load_double(x + 8 * i) * double(d, D.qLDiagInv, i))
    for i in range(n):
        first, count = integer(m, M.M_rowadr, i), integer(m, M.M_rownnz, i)
        for k in range(first, first + count - 1):
            less = load_double(L + 8 * k) * load_double(x + 8 * integer(m, M.M_colind, k))
            store_double(x + 8 * i, load_double(x + 8 * i) - less)


@inlined
def unit(x, j, n):  # type: ignore[no-untyped-def]
    """Writes the unit vector e_j of n entries to the address x."""
    for i in range(n):
        store_double(x + 8 * i, 0.0)
    store_double(x + 8 * j, 1.0)


@inlined
def mobility(m, d, dof, x):  # type: ignore[no-untyped-def]
    """Returns (M⁻¹)_jj of a degree of freedom [1/kg or 1/(kg m²)]; x: address of nv numbers."""
    unit(x, dof, dof + 1)
    _rise(m, d, x, dof)
    out = 0.0
    for i in range(dof + 1):
        out += load_double(x + 8 * i) ** 2 * double(d, D.qLDiagInv, i)
    return out
