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

The object file holds the callback and all functions that it calls. What it takes from outside (the
C library's mathematics, numba's helpers, Python's errors) LLVM finds in the process, as numba
itself does; LLVM says nothing where it does not find one, so all of them are looked up first. Each
object file has an engine of its own: the names that numba makes are unique in one process only, so
those of two processes could be confused.
"""

from __future__ import annotations

import ctypes
import gc
import hashlib
import logging
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from itertools import chain
from typing import Any

import llvmlite.binding as llvm
from numba import cfunc
from numba.core.codegen import JITCPUCodegen
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target
from numba.core.runtime import rtsys
from numba.core.typing.ctypes_utils import to_ctypes

from identification.native import cache_folder
from identification.native.cache_key import UnknownDependency, key_of

VARIABLE = "INCA_MJ_CACHE"
OFF = ("off", "no", "0", "false")
_FORMAT = b"inca_mj machine code 1"
_ENGINES: list[Any] = []  # they own the code that bare pointers in MuJoCo lead to


def compile_once(function: Callable[..., Any], signature: Any) -> Any:
    """Returns a callback as a ctypes function: loaded from the cache, or compiled and kept.

    The function must not raise; a division by zero in it gives inf or NaN.
    """
    is_off = os.environ.get(VARIABLE, "").strip().lower() in OFF
    if is_off or not hasattr(os, "getuid"):  # files have no owners here
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


@dataclass(frozen=True)
class MachineCode:
    """The machine code of one callback."""

    symbol: str  # name of the callback in the object file
    needs: tuple[str, ...]  # names of what the object file takes from outside
    object_file: bytes  # the object file, as LLVM wrote it


def compile_callback(
    function: Callable[..., Any], signature: Any
) -> tuple[Any, MachineCode | None]:
    """Compiles a callback with numba.

    Returns:
        The ctypes function, and its machine code; None where it holds addresses of this process.
    """
    with _uncollected():
        compiled: Any = cfunc(signature, error_model="numpy")(function)
    pointer, library = compiled.ctypes, compiled._library
    pointer.callback = compiled  # the machine code lives as long as the pointer to it
    if library.has_dynamic_globals:
        return pointer, None
    module = llvm.parse_assembly(compiled.inspect_llvm())
    declared = (
        v.name for v in chain(module.functions, module.global_variables) if v.is_declaration
    )
    needs = tuple(sorted(name for name in declared if not name.startswith("llvm.")))
    code = MachineCode(compiled.native_name, needs, library._get_compiled_object())
    return pointer, code


@contextmanager
def _uncollected() -> Iterator[None]:
    """Stops garbage collection in the block; it took an eighth of the time."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


@global_compiler_lock
def load_callback(code: MachineCode, signature: Any) -> Any | None:
    """Returns the ctypes function of kept code; None where this process lacks what it needs."""
    rtsys.initialize(cpu_target.target_context)  # tells LLVM where numba's helpers are
    if not all(map(llvm.address_of_symbol, code.needs)):
        return None
    codegen = JITCPUCodegen(code.symbol)  # it sets an engine up for this processor
    engine = codegen._engine._ee
    engine.add_object_file(llvm.ObjectFileRef.from_data(code.object_file))
    engine.finalize_object()
    _ENGINES.append(codegen)
    arguments = [to_ctypes(kind) for kind in signature.args]
    prototype = ctypes.CFUNCTYPE(to_ctypes(signature.return_type), *arguments)
    return prototype(engine.get_function_address(code.symbol))
