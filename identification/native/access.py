"""MuJoCo's structs from compiled callbacks: their fields at constant offsets.

A set of `offsets` is frozen into the compiled code; whoever compiles it checks it against live
objects first (`identification.native.structs.check`).
"""

from __future__ import annotations

from collections import namedtuple
from typing import Any

import numpy as np

from identification.native import structs
from identification.native.decorators import internal
from identification.native.memory import load_constant, load_int, load_word


def offsets(struct: str, names: str) -> Any:
    """Returns the word offsets of some fields of a struct, as a named tuple.

    Args:
        struct: "mjModel" or "mjData".
        names: the fields, with blanks between them.
    """
    fields = names.split()
    kind: Any = namedtuple(struct, fields)  # type: ignore[misc]
    return kind(*(structs.word(struct, n) for n in fields))


@internal
def word(struct, at):  # type: ignore[no-untyped-def]
    """Returns a size, or the address of an array."""
    return load_word(struct + 8 * at)


@internal
def double(struct, at, i):  # type: ignore[no-untyped-def]
    """Returns entry i of an array of doubles that no callback writes."""
    return load_constant(load_word(struct + 8 * at) + 8 * i)


@internal
def integer(struct, at, i):  # type: ignore[no-untyped-def]
    """Returns entry i of an array of ints."""
    return np.int64(load_int(load_word(struct + 8 * at) + 4 * i))
