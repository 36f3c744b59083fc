"""The laws of this process, and the callbacks that MuJoCo holds, which call them.

    table of a kind of callback = (n, key_1, address_1, key_2, address_2, …)      one word each

MuJoCo holds one callback of a kind in a process, and a process may need several laws: a robot with
other effects, or with joints in place of cables. A law has a key, which its models carry. MuJoCo
holds a trampoline, which calls all laws of the table, and each law leaves alone the models that
carry another key:

    passive, sensor      every law does its part
    act_dyn, act_bias    the answer of the one law that knows the actuator; the others return zero

A law that is alone is held itself: the second call is a quarter of what the law of a twin takes.
Compiled code knows a table by its symbol. The entries are only ever added or pointed elsewhere, so
that a simulation in another thread never misses a law.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import llvmlite.binding as llvm
import mujoco
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from identification.errors import InputError
from identification.native.cache import compile_once
from identification.native.element import Function
from identification.native.memory import internal, load_double, load_word

KINDS = ("passive", "act_dyn", "act_bias", "sensor")  # of MuJoCo's callbacks
SHARE = "share"  # what one actuator alone does (`identification.native.installer`)
CAPACITY = 1024  # laws in a process
SIGNATURES: dict[str, Any] = {
    "passive": types.void(types.int64, types.int64),
    "act_dyn": types.double(types.int64, types.int64, types.intc),
    "act_bias": types.double(types.int64, types.int64, types.intc),
    "sensor": types.void(types.int64, types.int64, types.intc),
    SHARE: types.double(types.int64, types.int64, types.intc),
}

_TABLES = {kind: np.zeros(1 + 2 * CAPACITY, np.int64) for kind in (*KINDS, SHARE)}
for _kind, _words in _TABLES.items():
    llvm.add_symbol(f"identification_laws_{_kind}", _words.ctypes.data)


def enter(kind: str, key: float, address: int) -> int:
    """Puts a callback into a table, or in place of one with its key; returns how many there are."""
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
    def address(typing_context):
        def emit(context, builder, signature, args):
            name = f"identification_laws_{kind}"
            symbol = builder.module.globals.get(name)
            if symbol is None:
                symbol = ir.GlobalVariable(builder.module, ir.IntType(64), name)
                symbol.linkage = "external"
            return builder.ptrtoint(symbol, ir.IntType(64))

        return types.int64(), emit

    return address


@internal
def callback(laws, k):
    """Returns the address of the callback of law k of a table."""
    return load_word(laws + 16 + 16 * k)


_passive = table("passive")


@internal
def is_compiled(key):
    """Returns whether a law with this key is in this process; every law has a passive callback."""
    laws = _passive()
    for k in range(load_word(laws)):  # noqa: SIM110
        if load_double(laws + 8 + 16 * k) == key:
            return True
    return False


def caller(signature: Any) -> Any:
    """Returns the compiled function (address, arguments) -> what a C function there returns."""

    @intrinsic
    def call(typing_context, address, arguments):
        def emit(context, builder, own, args):
            given = cgutils.unpack_tuple(builder, args[1])
            returns = ir.VoidType()
            if signature.return_type != types.void:
                returns = context.get_value_type(signature.return_type)
            kind = ir.FunctionType(returns, [value.type for value in given])
            value = builder.call(builder.inttoptr(args[0], kind.as_pointer()), given)
            return context.get_dummy_value() if signature.return_type == types.void else value

        return signature.return_type(address, arguments), emit

    return call


def _function(kind: str) -> Function:
    """Returns the function of a trampoline, to be compiled."""
    laws_of, call = table(kind), caller(SIGNATURES[kind])

    def passive(m, d):
        laws = laws_of()
        for k in range(load_word(laws)):
            call(callback(laws, k), (m, d))

    def sensor(m, d, stage):
        laws = laws_of()
        for k in range(load_word(laws)):
            call(callback(laws, k), (m, d, stage))

    def answer(m, d, i):
        laws = laws_of()
        for k in range(load_word(laws) - 1, -1, -1):  # the newest law is most often the one
            value = call(callback(laws, k), (m, d, i))
            if value != 0.0:
                return value
        return 0.0

    functions: dict[str, Function] = {"passive": passive, "sensor": sensor}
    return functions.get(kind, answer)


@cache
def _trampoline(kind: str) -> Any:
    return compile_once(_function(kind), SIGNATURES[kind])


_OURS: dict[str, list[Any]] = {}  # kind -> what MuJoCo was ever given of it


def refuse_foreign(kind: str) -> None:
    """Refuse to displace a callback that another library has installed."""
    present = getattr(mujoco, f"get_mjcb_{kind}")()
    if present is not None and not _is_ours(kind, present):
        raise InputError(
            f"another library has installed mjcb_{kind}, and MuJoCo holds one a process;"
            f" release it with mujoco.set_mjcb_{kind}(None), or use a process of its own"
        )


def hold(kind: str, alone: Any | None) -> None:
    """Let MuJoCo hold the callback of the only law, or of all where `alone` is None."""
    ours = _trampoline(kind) if alone is None else alone
    if not _is_ours(kind, ours):
        _OURS.setdefault(kind, []).append(ours)
    if getattr(mujoco, f"get_mjcb_{kind}")() is not ours:
        getattr(mujoco, f"set_mjcb_{kind}")(ours)


def uninstall() -> None:
    """Take the callbacks back from MuJoCo, to compare a step; those of other libraries stay."""
    for kind in KINDS:
        if _is_ours(kind, getattr(mujoco, f"get_mjcb_{kind}")()):
            getattr(mujoco, f"set_mjcb_{kind}")(None)


def _is_ours(kind: str, callback: Any) -> bool:
    return any(callback is own for own in _OURS.get(kind, ()))
