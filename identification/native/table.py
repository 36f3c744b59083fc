"""The laws of this process, where compiled callbacks find them.

    table of a kind of callback = (n, key_1, address_1, key_2, address_2, …)      one word each

MuJoCo holds one callback of a kind in a process, and a process may need several laws: a robot with
other effects, or with joints in place of cables. A law has a key, which its models carry. The
callback that MuJoCo holds calls all laws of the table, and each law leaves alone the models that
carry another key. The callback of a law that is alone is held itself.

Compiled code knows a table by its symbol. The entries are only ever added or pointed elsewhere, so
that a simulation in another thread never misses a law.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import llvmlite.binding as llvm
import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from identification.native.decorators import internal
from identification.native.memory import load_double, load_word

KINDS = ("passive", "act_dyn", "act_bias", "sensor")  # of MuJoCo's callbacks
SHARE = "share"  # what one actuator alone does (`identification.native.share`)
CAPACITY = 1024  # laws in a process

_TABLES = {kind: np.zeros(1 + 2 * CAPACITY, np.int64) for kind in (*KINDS, SHARE)}
for _kind, _words in _TABLES.items():
    llvm.add_symbol(f"identification_laws_{_kind}", _words.ctypes.data)


def enter(kind: str, key: float, address: int) -> int:
    """Put the callback of a law into a table, in place of one with the same key.

    Returns:
        How many laws the table has.

    Raises:
        RuntimeError: the table is full.
    """
    words = _TABLES[kind]
    count = int(words[0])
    keys = words[1 : 1 + 2 * count : 2].view(np.float64) if count else np.empty(0)
    same = np.flatnonzero(keys == key)
    at = int(same[0]) if same.size else count
    if at >= CAPACITY:
        raise RuntimeError(f"{CAPACITY} sets of effects were compiled; start a new process")
    words[2 + 2 * at] = address
    words[1 + 2 * at : 2 + 2 * at].view(np.float64)[0] = key
    words[0] = max(count, at + 1)
    return int(words[0])


@cache
def table(kind: str) -> Any:
    """Returns the compiled function () -> address of the table of a kind."""

    @intrinsic
    def address(typing_context):  # type: ignore[no-untyped-def]
        def emit(context, builder, signature, args):  # type: ignore[no-untyped-def]
            name = f"identification_laws_{kind}"
            symbol = builder.module.globals.get(name)
            if symbol is None:
                symbol = ir.GlobalVariable(builder.module, ir.IntType(64), name)
                symbol.linkage = "external"
            return builder.ptrtoint(symbol, ir.IntType(64))

        return types.int64(), emit

    return address


@internal
def callback(laws, k):  # type: ignore[no-untyped-def]
    """Returns the address of the callback of law k of a table."""
    return load_word(laws + 16 + 16 * k)


_passive = table("passive")


@internal
def is_compiled(key):  # type: ignore[no-untyped-def]
    """Returns whether a law with this key is in this process; every law has a passive callback."""
    laws = _passive()
    for k in range(load_word(laws)):  # noqa: SIM110
        if load_double(laws + 8 + 16 * k) == key:
            return True
    return False
