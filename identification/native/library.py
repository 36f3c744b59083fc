"""Functions of MuJoCo's library that compiled code calls, and its factorised mass matrix.

LLVM finds the functions by their names, as it finds those of the C library, so that machine code
that calls them can be kept and loaded again by another process. Behind MuJoCo's position stage

    M = Lᵀ D L,    M⁻¹ = L⁻¹ D⁻¹ L⁻ᵀ,    (M⁻¹)_jj = Σ_i y_i²/D_i,  y = L⁻ᵀ e_j

(M⁻¹)_jj is the mobility of a joint: its acceleration under a force of one while all others are
free. 1/(M⁻¹)_jj is the inertia that it feels, at most M_jj.
"""

from __future__ import annotations

import ctypes
from typing import Any

import llvmlite.binding as llvm
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from identification.native.memory import (
    double,
    inlined,
    integer,
    load_double,
    offsets,
    store_double,
    word,
)
from identification.runtime.engine import library

POINTER, INT = 64, 32  # bits of an argument


def _function(name: str, bits: tuple[int, ...]) -> Any:
    """Returns the compiled function (tuple of int64) -> None that calls one of MuJoCo's."""
    llvm.add_symbol(name, ctypes.cast(getattr(library(), name), ctypes.c_void_p).value)

    @intrinsic
    def call(typing_context, arguments):
        def emit(context, builder, signature, args):
            kinds: list[Any] = [ir.IntType(n) for n in bits]
            function = builder.module.globals.get(name)
            if function is None:
                kind = ir.FunctionType(ir.VoidType(), kinds)
                function = ir.Function(builder.module, kind, name)
            given = cgutils.unpack_tuple(builder, args[0])
            narrowed = [
                value if value.type == kind else builder.trunc(value, kind)
                for value, kind in zip(given, kinds, strict=True)
            ]
            builder.call(function, narrowed)
            return context.get_dummy_value()

        return types.void(arguments), emit

    return call


# model, data, whether with accelerations, address of the result: recursive Newton-Euler
mj_rne = _function("mj_rne", (POINTER, POINTER, INT, POINTER))
# model, data: all that follows from positions
mj_fwdPosition = _function("mj_fwdPosition", (POINTER, POINTER))
# model, data, the last stage that is there already, whether sensors are left out
mj_forwardSkip = _function("mj_forwardSkip", (POINTER, POINTER, INT, INT))
# model, data: the step of an integrator, after the forward dynamics
mj_Euler = _function("mj_Euler", (POINTER, POINTER))
mj_implicit = _function("mj_implicit", (POINTER, POINTER))
# model, data: forces of springs, dampers and gravity compensation, and those of passive callbacks
mj_passive = _function("mj_passive", (POINTER, POINTER))

M = offsets("mjModel", "nv M_rowadr M_rownnz M_colind")
D = offsets("mjData", "qLD qLDiagInv")
FIELDS = frozenset((*M._fields, *D._fields))


@inlined
def _rise(m, d, x, last):
    """Computes L⁻ᵀ x in place, where x is zero behind its entry `last`."""
    L = word(d, D.qLD)
    for i in range(last, -1, -1):
        first, count = integer(m, M.M_rowadr, i), integer(m, M.M_rownnz, i)
        for k in range(first, first + count - 1):
            at = x + 8 * integer(m, M.M_colind, k)
            store_double(at, load_double(at) - load_double(L + 8 * k) * load_double(x + 8 * i))


@inlined
def solve(m, d, x):
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
def unit(x, j, n):
    """Writes the unit vector e_j of n entries to the address x."""
    for i in range(n):
        store_double(x + 8 * i, 0.0)
    store_double(x + 8 * j, 1.0)


@inlined
def mobility(m, d, dof, x):
    """Returns (M⁻¹)_jj of a degree of freedom [1/kg or 1/(kg m²)]; x: address of nv numbers."""
    unit(x, dof, dof + 1)
    _rise(m, d, x, dof)
    out = 0.0
    for i in range(dof + 1):
        out += load_double(x + 8 * i) ** 2 * double(d, D.qLDiagInv, i)
    return out
