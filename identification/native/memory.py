"""Loads and stores at bare addresses, for compiled callbacks: one machine instruction each.

All loads but `load_double` promise the compiler that a callback does not write there. It then
keeps them in registers across stores, which it could not otherwise tell apart.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic


def _load(numba_type: Any, *, constant: bool) -> Any:
    @intrinsic
    def load(typing_context, address):  # type: ignore[no-untyped-def]
        def emit(context, builder, signature, args):  # type: ignore[no-untyped-def]
            pointer = context.get_value_type(numba_type).as_pointer()
            value = builder.load(builder.inttoptr(args[0], pointer))
            if constant:
                value.set_metadata("invariant.load", builder.module.add_metadata([]))
            return value

        return numba_type(address), emit

    return load


@intrinsic
def store_double(typing_context, address, value):  # type: ignore[no-untyped-def]
    """Write a double at an address."""

    def emit(context, builder, signature, args):  # type: ignore[no-untyped-def]
        pointer = builder.inttoptr(args[0], ir.DoubleType().as_pointer())
        builder.store(args[1], pointer)
        return context.get_dummy_value()

    return types.void(address, types.float64), emit


load_double = _load(types.float64, constant=False)  # address -> value
load_constant = _load(types.float64, constant=True)
load_word = _load(types.int64, constant=True)
load_int = _load(types.int32, constant=True)
load_byte = _load(types.uint8, constant=True)
