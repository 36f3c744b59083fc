"""The callbacks that MuJoCo holds: each calls the laws of this process, one after the other.

passive, sensor      every law does its part
act_dyn, act_bias    the answer of the one law that knows the actuator; the others return zero

A law that is alone is held itself: the second call is a quarter of what the law of a twin takes.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import mujoco
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from identification.errors import InputError
from identification.native.cache import compile_once
from identification.native.element import Function
from identification.native.memory import load_word
from identification.native.table import KINDS, SHARE, callback, table

SIGNATURES: dict[str, Any] = {
    "passive": types.void(types.int64, types.int64),
    "act_dyn": types.double(types.int64, types.int64, types.intc),
    "act_bias": types.double(types.int64, types.int64, types.intc),
    "sensor": types.void(types.int64, types.int64, types.intc),
    SHARE: types.double(types.int64, types.int64, types.intc),
}


def caller(signature: Any) -> Any:
    """Returns the compiled function (address, arguments) -> what a C function there returns."""

    @intrinsic
    def call(typing_context, address, arguments):  # type: ignore[no-untyped-def]
        def emit(context, builder, own, args):  # type: ignore[no-untyped-def]
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

    def passive(m, d):  # type: ignore[no-untyped-def]
        laws = laws_of()
        for k in range(load_word(laws)):
            call(callback(laws, k), (m, d))

    def sensor(m, d, stage):  # type: ignore[no-untyped-def]
        laws = laws_of()
        for k in range(load_word(laws)):
            call(callback(laws, k), (m, d, stage))

    def answer(m, d, i):  # type: ignore[no-untyped-def]
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
    """Refuse to displace a callback of another library.

    Raises:
        InputError: another library has installed a callback of this kind.
    """
    present = getattr(mujoco, f"get_mjcb_{kind}")()
    if present is not None and not _is_ours(kind, present):
        raise InputError(
            f"another library has installed mjcb_{kind}, and MuJoCo holds one a process;"
            f" release it with mujoco.set_mjcb_{kind}(None), or use a process of its own"
        )


def hold(kind: str, alone: Any | None) -> None:
    """Let MuJoCo hold a callback; `refuse_foreign` comes first.

    Args:
        kind: of the callback.
        alone: of the only law of this process; None where there are more.
    """
    ours = _trampoline(kind) if alone is None else alone
    if not _is_ours(kind, ours):
        _OURS.setdefault(kind, []).append(ours)
    if getattr(mujoco, f"get_mjcb_{kind}")() is not ours:
        getattr(mujoco, f"set_mjcb_{kind}")(ours)


def release() -> None:
    """Take the callbacks back from MuJoCo; those of other libraries stay."""
    for kind in KINDS:
        if _is_ours(kind, getattr(mujoco, f"get_mjcb_{kind}")()):
            getattr(mujoco, f"set_mjcb_{kind}")(None)


def _is_ours(kind: str, callback: Any) -> bool:
    return any(callback is own for own in _OURS.get(kind, ()))
