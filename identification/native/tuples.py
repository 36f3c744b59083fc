"""Tuples of numbers in compiled code: loaded from a row, added, and copied with new fields.

Numba writes such functions for one length at a time; these are made for any.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.errors import TypingError
from numba.extending import intrinsic


@cache
def loader(count: int) -> Any:
    """Returns the compiled function (address) -> tuple of `count` doubles no callback writes."""

    @intrinsic
    def load(typing_context, address):  # type: ignore[no-untyped-def]
        def emit(context, builder, signature, args):  # type: ignore[no-untyped-def]
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
    """Returns the compiled function (record, values) -> named tuple with other values in fields.

    Args:
        kind: the named tuple's class.
        names: the fields that change, with blanks between them.
    """
    columns = [kind._fields.index(name) for name in names.split()]

    @intrinsic
    def replaced(typing_context, record, values):  # type: ignore[no-untyped-def]
        def emit(context, builder, signature, args):  # type: ignore[no-untyped-def]
            record, (given, new) = args[0], (signature.args[1], args[1])
            for column, value, of in zip(
                columns, cgutils.unpack_tuple(builder, new), given.types, strict=True
            ):
                field = signature.return_type.types[column]
                value = context.cast(builder, value, of, field)
                record = builder.insert_value(record, value, column)
            return record

        return record(record, values), emit

    return replaced


@intrinsic
def added(typing_context, total, more):  # type: ignore[no-untyped-def]
    """Returns a number or tuple of numbers with what an effect adds to it."""
    if not typing_context.can_convert(more, total):
        raise TypingError(f"{more} cannot be added to {total}")

    def emit(context, builder, signature, args):  # type: ignore[no-untyped-def]
        more = context.cast(builder, args[1], signature.args[1], signature.return_type)
        if isinstance(signature.return_type, types.Float):
            return builder.fadd(args[0], more)
        pairs = zip(
            cgutils.unpack_tuple(builder, args[0]),
            cgutils.unpack_tuple(builder, more),
            strict=True,
        )
        sums = [builder.fadd(a, b) for a, b in pairs]
        return context.make_tuple(builder, signature.return_type, sums)

    return total(total, more), emit
