"""Callbacks that are compiled once a machine and kept in the user's cache folder.

The law with all effects takes numba 20 s; its machine code has 75 kB and loads in less than 0.1 s.
The first process that needs a callback compiles it and keeps it under its key (`cache_key`); others
wait for it, and later ones load it. An entry that cannot be used, for whatever reason, is compiled
anew and replaced; a folder that cannot be used means compiling in memory. `INCA_MJ_CACHE=off` (or
no, 0, false) switches the cache off.

An entry is a header of five lines and the object file; nothing in it is unpickled:

    inca_mj machine code 1          the format
    KEY                             64 hexadecimal digits
    DIGEST                          SHA-256 of the key and of all that follows
    SYMBOL                          name of the callback in the object file
    NAME NAME …                     what the object file takes from outside
"""

from __future__ import annotations

import hashlib
import logging
import os
from collections.abc import Callable
from functools import cache
from typing import Any

from identification.native import cache_folder
from identification.native.cache_key import UnknownDependency, key_of
from identification.native.machine_code import MachineCode, compile_callback, load_callback

VARIABLE = "INCA_MJ_CACHE"
OFF = ("off", "no", "0", "false")
_FORMAT = b"inca_mj machine code 1"


def compile_once(function: Callable[..., Any], signature: Any) -> Any:
    """Returns a callback as a ctypes function: loaded from the cache, or compiled and kept there.

    Args:
        function: what is compiled; it must not raise, and a division by zero gives inf or NaN.
        signature: its numba signature.

    Raises:
        numba.errors.NumbaError: it cannot be compiled.
    """
    if not enabled():
        return compile_callback(function, signature)[0]
    try:
        key = key_of(function, signature)
    except UnknownDependency as error:
        _note(f"{function.__qualname__} is compiled in memory: it depends on {error}")
        return compile_callback(function, signature)[0]
    loaded = _load(key, signature)
    if loaded is not None:
        return loaded
    with cache_folder.alone(key):
        loaded = _load(key, signature)  # what another process has compiled meanwhile
        if loaded is not None:
            return loaded
        callback, code = compile_callback(function, signature)
        if code is not None:
            _write(key, code)
        return callback


def enabled() -> bool:
    """Returns whether the cache is on: it is not switched off, and files have owners here."""
    return os.environ.get(VARIABLE, "").strip().lower() not in OFF and hasattr(os, "getuid")


def encode(key: str, code: MachineCode) -> bytes:
    """Returns the content of an entry."""
    rest = b"\n".join((code.symbol.encode(), " ".join(code.needs).encode(), code.object_file))
    return b"\n".join((_FORMAT, key.encode(), _digest(key, rest), rest))


def decode(key: str, content: bytes) -> MachineCode | None:
    """Returns the machine code of an entry; None when it is damaged or has another key."""
    *header, rest = content.split(b"\n", 3)
    if header != [_FORMAT, key.encode(), _digest(key, rest)]:
        return None
    try:
        symbol, needs, object_file = rest.split(b"\n", 2)
        return MachineCode(symbol.decode(), tuple(needs.decode().split()), object_file)
    except ValueError:  # another version of this program has laid it out otherwise
        return None


def _digest(key: str, rest: bytes) -> bytes:
    return hashlib.sha256(key.encode() + b"\n" + rest).hexdigest().encode()


def _load(key: str, signature: Any) -> Any | None:
    found = _read(key)
    return None if found is None else load_callback(found, signature)


def _read(key: str) -> MachineCode | None:
    try:
        return decode(key, cache_folder.read(key))
    except OSError as error:
        if not isinstance(error, FileNotFoundError):
            _note(f"the cache of compiled laws has an entry that is not used: {error}")
        return None


def _write(key: str, code: MachineCode) -> None:
    try:
        cache_folder.write(key, encode(key, code))
    except OSError as error:
        _note(f"the cache of compiled laws is not written: {error}")


@cache
def _note(text: str) -> None:
    """Say once, to those who ask for debug messages, what is compiled in memory and why."""
    logging.getLogger(__name__).debug(text)
