"""The key of a compiled callback: the digest of everything that its machine code depends on.

    key = SHA-256(machine, signature, the functions and constants that the callback reaches)

Numba freezes the globals and the closures of a function into its machine code: called functions,
columns, offsets of struct fields. So the key follows them all, from the callback through every
function that it calls. It reads the bytecode that Python has loaded and not the text of the files,
which may have been edited since they were imported. Libraries count by their versions.
"""

from __future__ import annotations

import dis
import enum
import hashlib
import platform
import sys
from collections.abc import Iterator
from functools import cache
from types import BuiltinFunctionType, CellType, CodeType, FunctionType, ModuleType
from typing import Any

import llvmlite
import mujoco
import numba
import numpy as np
from numba.core import config
from numba.core.dispatcher import Dispatcher
from numba.core.registry import cpu_target
from numba.core.types import Type
from numba.core.typing import Signature
from numba.extending import _Intrinsic

LIBRARIES = {*sys.stdlib_module_names, "llvmlite", "numba", "numpy"}  # known by their versions

# Numba's settings that change what it compiles.
_SETTINGS = (
    "BOUNDSCHECK", "CPU_FEATURES", "CPU_NAME", "DEBUGINFO_DEFAULT", "DISABLE_JIT", "ENABLE_AVX",
    "LLVM_REFPRUNE_FLAGS", "LLVM_REFPRUNE_PASS", "LOOP_VECTORIZE", "OPT", "SLP_VECTORIZE",
    "USE_LLVMLITE_MEMORY_MANAGER", "USING_SVML",
)  # fmt: skip

_PLAIN = (type(None), bool, int, float, complex, str, bytes, type(...))
_Seen = dict[int, tuple[int, Any]]  # id of a compiled function -> its number, and itself


class UnknownDependency(Exception):
    """A function reaches something of which nobody can say whether it has changed."""


def key_of(function: Any, signature: Any) -> str:
    """Returns the key of a callback, 64 hexadecimal digits."""
    digest = hashlib.sha256()
    for part in (*machine(), str(signature), *_function(function, {})):
        digest.update(f"{len(part)} {part}\n".encode())
    return digest.hexdigest()


@cache
def machine() -> tuple[str, ...]:
    """Returns the versions, processor and settings on which all machine code depends."""
    return (
        sys.version,
        str(sys.implementation.cache_tag),
        repr(platform.libc_ver()),  # LLVM computes constants with the C library
        *(f"{p.__name__} {p.__version__}" for p in (llvmlite, mujoco, numba, np)),
        repr(cpu_target.target_context.codegen().magic_tuple()),  # processor and its features
        *(f"{name} {getattr(config, name, None)!s}" for name in _SETTINGS),
    )


def _function(function: Any, seen: _Seen) -> Iterator[str]:
    """Yields the parts of a function: bytecode, defaults, closure and the globals that it reads."""
    code: CodeType = function.__code__
    yield from _code(code)
    yield from _value(function.__defaults__, code, seen)
    for name, cell in zip(code.co_freevars, function.__closure__ or (), strict=True):
        yield f"closure {name}"
        yield from _cell(cell, code, seen)
    for name in sorted(_global_names(code) & function.__globals__.keys()):  # others are Python's
        yield f"global {name}"
        yield from _value(function.__globals__[name], code, seen)


def _cell(cell: CellType, code: CodeType, seen: _Seen) -> Iterator[str]:
    try:
        value = cell.cell_contents
    except ValueError:  # it has no value yet
        yield "empty"
        return
    yield from _value(value, code, seen)


@cache  # the callbacks of a law reach the same functions
def _code(code: CodeType) -> tuple[str, ...]:
    """Returns the parts of a code object, without where its file is."""
    parts = [repr((
        code.co_name, code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount,
        code.co_flags, code.co_code, code.co_names, code.co_varnames, code.co_freevars,
        code.co_cellvars, code.co_exceptiontable,
    ))]  # fmt: skip
    for constant in code.co_consts:
        is_code = isinstance(constant, CodeType)
        parts += _code(constant) if is_code else _value(constant, code, {})
    return tuple(parts)


@cache
def _global_names(code: CodeType) -> set[str]:
    """Returns the global names that a code object reads, also those of functions inside it."""
    names = {i.argval for i in dis.get_instructions(code) if i.opname == "LOAD_GLOBAL"}
    inner = [c for c in code.co_consts if isinstance(c, CodeType)]
    return names.union(*map(_global_names, inner))


def _value(value: Any, code: CodeType, seen: _Seen) -> Iterator[str]:
    """Yields the parts of anything that a function with some code may refer to."""
    kind = type(value)
    if isinstance(value, (Dispatcher, _Intrinsic)):
        yield from _compiled(value, seen)
    elif isinstance(value, ModuleType):
        yield f"module {value.__name__}"
        if not _in_library(value.__name__):
            for name in sorted({*code.co_names} & vars(value).keys()):
                yield f"attribute {name}"
                yield from _value(vars(value)[name], code, seen)
    elif kind in _PLAIN:
        yield f"{kind.__name__} {value!r}"
    elif isinstance(value, enum.Enum):
        yield f"{kind.__module__}.{kind.__qualname__} {value.name} {value.value!r}"
    elif isinstance(value, (tuple, list, frozenset)):
        items = [[*_value(item, code, seen)] for item in value]
        yield f"{kind.__qualname__} {getattr(kind, '_fields', '')} of {len(items)}"
        for item in sorted(items) if isinstance(value, frozenset) else items:
            yield from item
    elif isinstance(value, (np.ndarray, np.generic)) and not value.dtype.hasobject:
        yield f"{kind.__name__} {value.dtype.str} {value.shape} {value.tobytes().hex()}"
    elif isinstance(value, (Type, Signature, np.dtype)):
        yield f"{kind.__name__} {value!r}"
    elif isinstance(value, type) and issubclass(value, tuple) and hasattr(value, "_fields"):
        yield f"named tuple {value.__qualname__} {value._fields}"
    elif isinstance(value, (type, BuiltinFunctionType, FunctionType, np.ufunc)) and _in_library(
        str(getattr(value, "__module__", ""))
    ):
        yield f"{value.__module__}.{value.__name__}"
    else:
        name = getattr(value, "__qualname__", repr(value))
        raise UnknownDependency(f"{name}, a {kind.__name__}")


def _compiled(value: Any, seen: _Seen) -> Iterator[str]:
    """Yields the parts of a function that numba compiles, or of an intrinsic, which writes LLVM."""
    if id(value) in seen:
        yield f"as number {seen[id(value)][0]}"
        return
    seen[id(value)] = (len(seen), value)  # the value too, so that its id stays its own
    if isinstance(value, Dispatcher):
        yield f"compiled {sorted(value.targetoptions.items())!r}"
        yield from _function(value.py_func, seen)
    else:
        yield "intrinsic"
        yield from _function(value._defn, seen)


def _in_library(module: str) -> bool:
    return module.partition(".")[0] in LIBRARIES
