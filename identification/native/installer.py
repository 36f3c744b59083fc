"""Laws, compiled and installed in this process.

A law is the passive force, and what else MuJoCo asks callbacks for, of one set of effects. Several
laws work side by side (see `identification.native.table`).
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from threading import Lock
from typing import Any

import mujoco

from identification.native import structs, trampolines
from identification.native.cache import compile_once
from identification.native.element import Function
from identification.native.share import Owners, has_shares
from identification.native.table import KINDS, SHARE, enter

_ENTERING = Lock()  # one thread at a time enters a law
_ENTERED: dict[tuple[str, float], Law] = {}  # the laws of this process


@dataclass(frozen=True, eq=False)
class Law:
    """Callbacks of one set of effects.

    Attributes:
        name: of what they act on, e.g. "joints".
        key: what its models carry; two laws with one key are one law, of which the newer counts.
        functions: kind of callback ("passive", "act_dyn", …) -> the function to be compiled; the
            kind "share" where an actuator's share is given too (`identification.native.share`).
        fields: the fields of mjModel and mjData that they touch.
        check: raises `InputError` where a function of an effect cannot be compiled.
        owners: which numbers of a model an actuator of this law alone reads; none of a model that
            carries another key.
    """

    name: str
    key: float
    functions: Mapping[str, Function]
    fields: frozenset[str]
    check: Callable[[], None]
    owners: Callable[[mujoco.MjModel], Owners] = field(default=lambda model: {})


def install(law: Law) -> None:
    """Install a law in this process; does nothing when it is installed already.

    Raises:
        InputError: another library has installed a MuJoCo callback of its own, or a function of an
            effect cannot be compiled.
        RuntimeError: MuJoCo's structs are not laid out as declared.
    """
    with _ENTERING:
        for kind in KINDS & law.functions.keys():
            trampolines.refuse_foreign(kind)
        compiled = _compiled(law)
        for kind, address in _addresses(law).items():
            laws = enter(kind, law.key, address)
            if kind != SHARE:
                trampolines.hold(kind, compiled[kind] if laws == 1 else None)
        _ENTERED[law.name, law.key] = law


def owners_of(model: mujoco.MjModel) -> Owners:
    """Returns which numbers of a model one actuator alone reads, by array and row."""
    if not has_shares(model):
        return {}
    return {entry: i for law in [*_ENTERED.values()] for entry, i in law.owners(model).items()}


def uninstall() -> None:
    """Release MuJoCo's callbacks, to compare a step with a law and without it."""
    trampolines.release()


@cache  # for the life of the process: MuJoCo holds bare pointers
def _compiled(law: Law) -> Mapping[str, Any]:
    structs.require(law.fields)
    try:
        return {
            kind: compile_once(function, trampolines.SIGNATURES[kind])
            for kind, function in law.functions.items()
        }
    except Exception:
        law.check()
        raise


@cache
def _addresses(law: Law) -> Mapping[str, int]:
    pointers = {k: ctypes.cast(f, ctypes.c_void_p).value for k, f in _compiled(law).items()}
    return {kind: address for kind, address in pointers.items() if address is not None}
