"""Models that may be large are first compiled by a process that can be ended.

MuJoCo cannot be stopped while it reads a model, and may take minutes or all memory: replicated
elements cost the square of their number, and heightfields, meshes and user data cost memory. What a
model asks for is counted in its text, in milliseconds. Only where a count is far beyond that of the
robots of MuJoCo Menagerie, another process compiles the model before this one does. So a usual
model pays nothing, and a large one its compilation twice.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from identification.errors import InputError
from identification.model import compile_child

ELEMENTS = 2000  # are read in 0.1 s; ten times as many take 20 s
CELLS = 2**20  # of heightfields and textures; they are compiled in 0.03 s
NUMBERS = 10_000  # of user data of one kind of element
BYTES = 2**24  # of the text, of what it includes, and of the files that it names
LARGEST = 2**27  # [bytes] of a compiled model; a search simulates some hundred copies at once
_WAITING = 20  # times as long for a process whose machine has others to serve
_REPLICATE = "lower its counts of replicate"
_GRIDS = "make its heightfields and textures smaller"
_FILES = "make the meshes and other files that it names smaller"
_ANY = f"{_REPLICATE} and its sizes nuser_*, or make its heightfields and meshes smaller"


@dataclass(frozen=True)
class Amount:
    """The amounts that a model asks for, as its text says them.

    Attributes:
        elements: of the text, those that repeat counted each.
        cells: of heightfields and textures.
        numbers: of user data, of the kind of element that has most.
        size: of the text, of what it includes, and of the files that it names [bytes].
        user_data: the attribute of <size> that asks for these numbers, such as "nuser_body".
    """

    elements: float = 0.0
    cells: float = 0.0
    numbers: float = 0.0
    size: int = 0
    user_data: str = ""

    @property
    def much(self) -> tuple[str, ...]:
        """Advice on what to make smaller, a clause for each count far beyond that of robots."""
        lower = f"lower {self.user_data}, which asks for {self.numbers:.3g} numbers of each element"
        each = (
            (self.numbers > NUMBERS, lower), (self.elements > ELEMENTS, _REPLICATE),
            (self.cells > CELLS, _GRIDS), (self.size > BYTES, _FILES),
        )  # fmt: skip
        return tuple(clause for is_large, clause in each if is_large)

    @property
    def may_be_large(self) -> bool:
        """Whether the model is compiled by another process first."""
        return bool(self.much)


def refuse_size(size: int, where: str, amount: Amount | None = None) -> None:
    """Refuses a compiled model of which a search cannot hold its copies.

    Args:
        size: of the compiled model [bytes].
        where: the model in messages, such as "the model slider.xml".
        amount: what its text asks for, where that is known.
    """
    if size > LARGEST:
        raise InputError(
            f"{where} has {size / 2**20:.0f} MB when it is compiled, more than the"
            f" {LARGEST / 2**20:.0f} MB of which a search can hold its copies; {_cure(amount)}"
        )


def refuse_endless(source: str | Path, where: str, amount: Amount) -> None:
    """Refuses a model that is not compiled within a bound of time and memory."""
    cure, is_file = _cure(amount), isinstance(source, Path)
    words = [str(source)] if is_file else []
    try:
        done = subprocess.run(
            [sys.executable, "-I", compile_child.__file__, *words],
            input=b"" if is_file else str(source).encode(), capture_output=True,
            timeout=_WAITING * compile_child.SECONDS, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        raise InputError(f"{where} is not compiled by MuJoCo in time; {cure}") from None
    if done.returncode == compile_child.FULL:
        raise InputError(
            f"{where} takes more than {compile_child.MEMORY / 2**30:.0f} GB of memory while MuJoCo"
            f" compiles it; {cure}"
        )
    if done.returncode == 0:
        refuse_size(int(done.stdout), where, amount)
    elif done.returncode != compile_child.REFUSED:  # ended by its limit, or a crash
        raise InputError(
            f"{where} is not compiled by MuJoCo within {compile_child.SECONDS} s; {cure}"
        )


def _cure(amount: Amount | None) -> str:
    """Says what to make smaller: what the text asks much of, or whatever makes a model large."""
    return " and ".join(amount.much) if amount and amount.much else _ANY
