"""The examples of a command: the block `Examples:` of its docstring, printed below its help."""

from __future__ import annotations

import inspect


def examples_of(command: type) -> tuple[str, ...]:
    """The command lines that a docstring shows.

    Args:
        command: a command's class.
    """
    _, _, block = (inspect.getdoc(command) or "").partition("\nExamples:\n")
    lines = [line.strip() for line in block.splitlines()]
    return tuple(line for line in lines if line)


def examples_text(examples: tuple[str, ...]) -> str:
    """Examples as they stand below a help."""
    return "\n".join(["examples:", *(f"  {line}" for line in examples)]) + "\n"
