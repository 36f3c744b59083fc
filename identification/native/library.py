"""Functions of MuJoCo's library that compiled code calls.

LLVM finds them by their names, as it finds those of the C library, so that machine code that calls
them can be kept and loaded again by another process.
"""

from __future__ import annotations

import ctypes
from typing import Any

import llvmlite.binding as llvm
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from identification.engine import library

POINTER, INT = 64, 32  # bits of an argument


def _function(name: str, bits: tuple[int, ...]) -> Any:
    """Returns the compiled function (tuple of int64) -> None that calls one of MuJoCo's.

    Args:
        name: of the function.
        bits: of its arguments.
    """
    llvm.add_symbol(name, ctypes.cast(getattr(library(), name), ctypes.c_void_p).value)

    @intrinsic
    def call(typing_context, arguments):  # type: ignore[no-untyped-def]
        def emit(context, builder, signature, args):  # type: ignore[no-untyped-def]
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
# model, data: forces of springs, dampers and gravity compensation, and those of passive callbacks
mj_passive = _function("mj_passive", (POINTER, POINTER))
