"""The examples of a command: the block `Examples:` of its docstring, printed below its help."""

from __future__ import annotations

import inspect


def examples_of(command: type) -> tuple[str, ...]:
    """Returns the command lines that a docstring shows as examples.

    Args:
        command: a command's class.
    """
    _, _, block = (inspect.getdoc(command) or "").partition("\nExamples:\n")
    lines = [line.strip() for line in block.splitlines()]
    return tuple(line for line in lines if line)


def examples_text(examples: tuple[str, ...]) -> str:
    """Returns examples as they are printed below a help."""
    return "\n".join(["examples:", *(f"  {line}" for line in examples)]) + "\n"
