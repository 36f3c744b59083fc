"""The arguments of a program: the command that they name, its help, and errors in one sentence.

Options that take several values add up when they are repeated: `--free A --free B` is `--free A B`.
A parser that keeps the last of them would leave out what a user wrote, without a word. What follows
an option up to the next one belongs to it; several values are those of a field `tuple[X, ...]`.
"""

from __future__ import annotations

import dataclasses
import inspect
import io
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import redirect_stderr
from itertools import chain
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import tyro

from identification.errors import InputError, unknown_name

_FRAME = "│╭╮╰╯─|+ "  # of a box, also where a terminal knows no lines
COMPLETION, SHELLS = "--completion", ("bash", "zsh", "fish")
_KINDS = {"FLOAT": "a number", "INT": "a whole number", "PATH": "a path"}


def parsed(
    commands: Any,
    name: str,
    description: str,
    arguments: Sequence[str],
    examples: tuple[str, ...] = (),
) -> Any:
    """Returns the command that some arguments name, or refuses them; see `run_program`.

    `--completion SHELL` prints a script that completes commands in bash, zsh or fish; after that,
    and after a help, it ends by SystemExit. `examples` are of the program; those of a command stand
    in its docstring.
    """
    if arguments[:1] == [COMPLETION]:
        shell = " ".join(arguments[1:])
        if shell not in SHELLS:
            raise InputError(f"{COMPLETION} {shell!r} is no shell; give one of {', '.join(SHELLS)}")
        arguments = ["--tyro-print-completion", shell]
    parser_words = io.StringIO()
    try:
        with redirect_stderr(parser_words):
            return tyro.cli(
                commands, prog=name, description=description, args=gathered(commands, arguments),
                config=(tyro.conf.AvoidSubcommands, tyro.conf.OmitArgPrefixes),
            )  # fmt: skip
    except SystemExit as end:
        at_hand = dict(_commands(commands))
        if end.code in (0, None):
            command = at_hand.get(next(iter(arguments), ""))
            if {"-h", "--help"} & {*arguments}:
                shown = examples if command is None else examples_of(command)
                sys.stdout.write("\n  ".join(["examples:", *shown]) + "\n")
            raise
        lines = (line.strip(_FRAME) for line in parser_words.getvalue().splitlines())
        text = " ".join(filter(None, lines))
        raise InputError(_sentence(text, name, arguments, at_hand)) from None
    except RecursionError:  # of the parser's boxes, which hold no word without end
        longest = max(arguments, key=len)
        raise InputError(
            f"{longest} is no argument of {name}; {name} --help lists the commands"
        ) from None


def examples_of(command: type) -> tuple[str, ...]:
    """Returns the command lines below `Examples:` in the docstring of a command's class."""
    _, _, block = (inspect.getdoc(command) or "").partition("\nExamples:\n")
    return tuple(line.strip() for line in block.splitlines() if line.strip())


def gathered(commands: Any, arguments: Sequence[str]) -> list[str]:
    """Returns arguments in which each option of several values stands once, with all its values."""
    several = {
        f"--{name}"
        for _, command in _commands(commands)
        for name, kind in _options(command)
        for each in (kind, *get_args(kind))
        if get_origin(each) is tuple and get_args(each)[1:] == (...,)
    }
    groups: list[list[str]] = [[]]
    first: dict[str, list[str]] = {}
    current = groups[0]
    for k, argument in enumerate(arguments):
        option, equals, value = argument.partition("=")
        option = option.replace("_", "-")
        if argument == "--":
            return [*chain(*groups), *arguments[k:]]
        if not argument.startswith("--"):
            current.append(argument)
            continue
        if option not in several:
            groups.append([argument])
        elif option not in first:
            first[option] = [option, value] if equals else [option]
            groups.append(first[option])
        elif equals:
            first[option].append(value)
        current = first.get(option, groups[-1])
    return [*chain(*groups)]


def _sentence(text: str, name: str, arguments: Sequence[str], commands: dict[str, type]) -> str:
    """Returns one sentence on what the parser wrote."""
    command = arguments[0] if arguments else ""
    if not command:
        return f"no command is given; give one of {', '.join(commands)}"
    if command not in commands:
        return str(unknown_name("command", command, commands))
    see = f"; {name} {command} --help tells more"
    options, places = dict(_options(commands[command])), _positional(commands[command])
    whole = " ".join([name, command, *places.values()])
    if found := re.search(r"Unrecognized (?:or misplaced )?options: ([^\s,]+)", text):
        if not found[1].startswith("-"):
            return f"{found[1]} is one argument too many{see}"
        known = [f"--{option}" for option in options]
        return str(unknown_name(f"option of {name} {command}:", found[1], known))
    if found := re.search(r"Error parsing (\S+?):", text):
        given = _given(found[1], arguments)
        if given.endswith((".csv", ".mat")) and "log" in options:
            return f"{found[1]} is {given!r}; write a log behind --log, as --log {given}{see}"
        return f"{found[1]} is {given!r}; give {_wanted(text)}{see}"
    if found := re.search(r"invalid choice (.+) for argument '([^']+)'.*\((.+)\)", text):
        words = sorted({*re.findall(r"'([^']*)'", found[3])} - {"None"})  # their order varies
        return f"{found[2]} is {found[1]}; give one of {', '.join(words)}"
    if found := re.search(r"Missing value for argument '([^']+)'", text):
        if what := places.get(found[1]):
            return f"{what} is missing; write {whole}{see}"
        return f"{found[1]} has no value; give one behind it{see}"
    if found := re.search(r"Missing from [^:]+: (\S+)", text):
        text = whole if found[1] in places.values() else f"{name} {command} {found[1]}"
        return f"{found[1]} is missing; write {text}{see}"
    return f"{text.partition('. ')[0].rstrip('.')}{see}"


def _wanted(text: str) -> str:
    """Returns in words what an option takes: one kind of value, or else the words of its help."""
    taken = re.search(r"Argument helptext: --\S+ ((?:[A-Z]+ )+)", text)
    words = taken[1].split() if taken else []
    if len(words) > 1 and len(words[-1]) > 1:
        return " ".join(words)
    kind = re.search(rf"\b({'|'.join(_KINDS)})\b", text.replace("to float:", "FLOAT"))
    return _KINDS[kind[1]] if kind else " ".join(words) or "another value"


def _given(option: str, arguments: Sequence[str]) -> str:
    """Returns the argument that stands behind an option."""
    for k, argument in enumerate(arguments):
        one, equals, value = argument.partition("=")
        if one == option:
            return value if equals else " ".join(arguments[k + 1 : k + 2])
    return ""


def _commands(kind: Any) -> Iterator[tuple[str, type]]:
    """Yields the commands of a program with their names."""
    for each in get_args(kind):
        if get_origin(each) is Annotated:
            one, *marks = get_args(each)
            yield from ((str(m.name), one) for m in marks if getattr(m, "name", None))


def _positional(command: type) -> dict[str, str]:
    """Returns the words in the help for a command's positional arguments, by field name."""
    hints = get_type_hints(command, include_extras=True)
    marks = {name: getattr(hint, "__metadata__", ()) for name, hint in hints.items()}
    return {
        name: next((m.metavar for m in each if getattr(m, "metavar", None)), name.upper())
        for name, each in marks.items()
        if tyro.conf.Positional in each
    }


def _options(command: type) -> Iterator[tuple[str, Any]]:
    """Yields the options of a command with their kinds, those of its parts among them."""
    positional = _positional(command)
    for name, kind in get_type_hints(command).items():
        if dataclasses.is_dataclass(kind):
            yield from _options(kind)  # type: ignore[arg-type]
        elif name not in positional:
            yield name.replace("_", "-"), kind
