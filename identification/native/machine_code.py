"""Machine code of a callback: made by numba, kept as an object file, loaded again by LLVM.

The object file holds the callback and all functions that it calls. What it takes from outside (the
C library's mathematics, numba's helpers, Python's errors) LLVM finds in the process, as numba
itself does; LLVM says nothing where it does not find one, so all of them are looked up first. Each
object file has an engine of its own: the names that numba makes are unique in one process only, so
those of two processes could be confused.
"""

from __future__ import annotations

import ctypes
import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain
from typing import Any

import llvmlite.binding as llvm
from numba import cfunc
from numba.core.codegen import JITCPUCodegen
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target
from numba.core.runtime import rtsys
from numba.core.typing.ctypes_utils import to_ctypes

_ENGINES: list[Any] = []  # they own the code that bare pointers in MuJoCo lead to


@dataclass(frozen=True)
class MachineCode:
    """The machine code of one callback.

    Attributes:
        symbol: name of the callback in the object file.
        needs: names of what the object file takes from outside.
        object_file: the object file, as LLVM wrote it.
    """

    symbol: str
    needs: tuple[str, ...]
    object_file: bytes


def compile_callback(
    function: Callable[..., Any], signature: Any
) -> tuple[Any, MachineCode | None]:
    """Compile a callback with numba.

    Args:
        function: what is compiled; it must not raise, and a division by zero gives inf or NaN.
        signature: its numba signature.

    Returns:
        The ctypes function, and its machine code; None where the code holds addresses of this
        process.
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
    """Returns the ctypes function of machine code that was compiled earlier.

    Args:
        code: made by `compile_callback` for the same processor and the same versions.
        signature: its numba signature.

    Returns:
        The ctypes function; None where this process lacks something that the code needs.
    """
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
