"""Functions of MuJoCo's library that compiled callbacks call.

LLVM finds them by their names, as it finds those of the C library, so that machine code that calls
them can be kept and loaded again by another process.
"""

from __future__ import annotations

import ctypes
from typing import Any

import llvmlite.binding as llvm
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from identification.engine import library


def _enter(name: str) -> None:
    address = ctypes.cast(getattr(library(), name), ctypes.c_void_p).value
    llvm.add_symbol(name, address)


_enter("mj_rne")


@intrinsic
def mj_rne(typing_context, m, d, with_acceleration, result):  # type: ignore[no-untyped-def]
    """Recursive Newton-Euler: bias forces of a model and its data to the address `result`."""

    def emit(context, builder, signature, args):  # type: ignore[no-untyped-def]
        kinds: list[Any] = [ir.IntType(64), ir.IntType(64), ir.IntType(32), ir.IntType(64)]
        function = builder.module.globals.get("mj_rne")
        if function is None:
            kind = ir.FunctionType(ir.VoidType(), kinds)
            function = ir.Function(builder.module, kind, "mj_rne")
        m, d, flag, out = args
        builder.call(function, [m, d, builder.trunc(flag, kinds[2]), out])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64, types.int64), emit
