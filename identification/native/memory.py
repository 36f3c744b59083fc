"""Memory from compiled callbacks: bare addresses, fields of MuJoCo's structs, tuples of numbers.

A load or a store is one machine instruction. All loads but `load_double` promise the compiler that
a callback does not write there. It then keeps them in registers across stores, which it could not
otherwise tell apart. A set of `offsets` is frozen into the compiled code; whoever compiles it
checks it against live objects first (`identification.native.structs`). Numba writes functions of
tuples for one length at a time; those here are made for any.
"""

from __future__ import annotations

from collections import namedtuple
from functools import cache
from typing import Any

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.core.errors import TypingError
from numba.extending import intrinsic

from identification.native import structs

# For functions that only compiled code calls. Numba also makes a wrapper for Python of every one;
# leaving it out halves the compilation. Functions of effects are plain njit: Python calls some too.
_OPTIONS: Any = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}  # numba's stubs lack them
internal = njit(**_OPTIONS)
inlined = njit(forceinline=True, **_OPTIONS)


def _load(numba_type: Any, *, constant: bool) -> Any:
    @intrinsic
    def load(typing_context, address):
        def emit(context, builder, signature, args):
            pointer = context.get_value_type(numba_type).as_pointer()
            value = builder.load(builder.inttoptr(args[0], pointer))
            if constant:
                value.set_metadata("invariant.load", builder.module.add_metadata([]))
            return value

        return numba_type(address), emit

    return load


@intrinsic
def store_double(typing_context, address, value):
    """Write a double at an address."""

    def emit(context, builder, signature, args):
        pointer = builder.inttoptr(args[0], ir.DoubleType().as_pointer())
        builder.store(args[1], pointer)
        return context.get_dummy_value()

    return types.void(address, types.float64), emit


load_double = _load(types.float64, constant=False)  # address -> value
load_constant = _load(types.float64, constant=True)
load_word = _load(types.int64, constant=True)
load_int = _load(types.int32, constant=True)
load_byte = _load(types.uint8, constant=True)


def offsets(struct: str, names: str) -> Any:
    """Returns the word offsets of some fields of "mjModel" or "mjData", as a named tuple."""
    fields = names.split()
    kind: Any = namedtuple(struct, fields)  # type: ignore[misc]
    return kind(*(structs.word(struct, n) for n in fields))


@internal
def word(struct, at):
    """Returns a size, or the address of an array."""
    return load_word(struct + 8 * at)


@internal
def double(struct, at, i):
    """Returns entry i of an array of doubles that no callback writes."""
    return load_constant(load_word(struct + 8 * at) + 8 * i)


@internal
def integer(struct, at, i):
    """Returns entry i of an array of ints."""
    return np.int64(load_int(load_word(struct + 8 * at) + 4 * i))


@cache
def loader(count: int) -> Any:
    """Returns the compiled function (address) -> tuple of `count` doubles no callback writes."""

    @intrinsic
    def load(typing_context, address):
        def emit(context, builder, signature, args):
            double = ir.DoubleType()
            first = builder.inttoptr(args[0], double.as_pointer())
            values = []
            for k in range(count):
                value = builder.load(builder.gep(first, [ir.Constant(ir.IntType(64), k)]))
                value.set_metadata("invariant.load", builder.module.add_metadata([]))
                values.append(value)
            return context.make_tuple(builder, signature.return_type, values)

        return types.UniTuple(types.float64, count)(address), emit

    return load


@cache
def replacer(kind: Any, names: str) -> Any:
    """Returns the compiled function (record, values) -> named tuple with other values in fields."""
    columns = [kind._fields.index(name) for name in names.split()]

    @intrinsic
    def replaced(typing_context, record, values):
        def emit(context, builder, signature, args):
            record, (given, new) = args[0], (signature.args[1], args[1])
            values = cgutils.unpack_tuple(builder, new)
            for column, value, of in zip(columns, values, given.types, strict=True):
                field = signature.return_type.types[column]
                value = context.cast(builder, value, of, field)
                record = builder.insert_value(record, value, column)
            return record

        return record(record, values), emit

    return replaced


@intrinsic
def added(typing_context, total, more):
    """Returns a number or tuple of numbers with what an effect adds to it."""
    if not typing_context.can_convert(more, total):
        raise TypingError(f"{more} cannot be added to {total}")

    def emit(context, builder, signature, args):
        more = context.cast(builder, args[1], signature.args[1], signature.return_type)
        if isinstance(signature.return_type, types.Float):
            return builder.fadd(args[0], more)
        old, new = (cgutils.unpack_tuple(builder, x) for x in (args[0], more))
        sums = [builder.fadd(a, b) for a, b in zip(old, new, strict=True)]
        return context.make_tuple(builder, signature.return_type, sums)

    return total(total, more), emit
