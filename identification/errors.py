"""The errors a user can cause, and can cure: each message is one sentence that says how."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from difflib import get_close_matches

_LONGEST = 60  # of an argument in a message
_WORD = 240  # letters of a word in a message, such as a path
_ENDS = 80  # letters of a longer one that are shown, at each end
LISTED = 60  # good names that a message lists; of more the nearest `NEAREST` ones
NEAREST = 20


class InputError(ValueError):
    """Bad input: the message names the bad thing, lists the good ones, says the next step.

    A message is one line whatever it quotes: letters that cannot be printed are escaped, and words
    without end are shortened.
    """

    def __init__(self, message: object = "") -> None:
        super().__init__(_one_line(str(message)))


class DivergenceError(InputError):
    """A simulation left the finite numbers: the model, its values or its step are wrong."""


class GraphicsError(InputError):
    """No OpenGL context could be made; everything that does not draw still works."""


@contextmanager
def told_of(where: str) -> Iterator[None]:
    """Adds to an `InputError` of the block the place where a user wrote the bad input."""
    try:
        yield
    except InputError as error:
        raise type(error)(f"{where}: {error}") from error


def _one_line(text: str) -> str:
    words = ("".join(c if c.isprintable() else repr(c)[1:-1] for c in w) for w in text.split())
    return " ".join(w if len(w) <= _WORD else f"{w[:_ENDS]}...{w[-_ENDS:]}" for w in words)


def repeated(names: Sequence[str]) -> list[str]:
    """Returns the names that occur more than once, in alphabetical order."""
    return sorted(name for name, count in Counter(names).items() if count > 1)


def refuse_negative(name: str, value: int) -> None:
    """Refuse a whole number below zero."""
    if value < 0:
        raise InputError(f"{name} {value} is negative; give 0 or more")


def refuse_number(name: str, value: float, is_good: bool, good: str) -> None:
    """Refuse a number outside its range."""
    if not is_good:
        raise InputError(f"{name} = {value:g} is not allowed; give {good}")


def refuse_kind(value: object, kinds: type | tuple[type, ...], what: str) -> None:
    """Refuse an argument of another type than a function takes."""
    if not isinstance(value, kinds):
        shown = repr(value)
        shown = shown if len(shown) <= _LONGEST else f"{shown[: _LONGEST - 3]}..."
        line = " ".join(shown.split())
        raise InputError(f"{what}, not {line} of type {type(value).__name__}")


def unknown_name(
    what: str, name: str, known: Iterable[str], likely: str | None = None
) -> InputError:
    """Returns an `InputError` for a misspelt name, with the likely one and all good ones listed.

    Args:
        what: the name is of.
        name: the misspelt one.
        known: good ones; of more than `LISTED` the nearest are listed.
        likely: what was meant, where that is known; the nearest good one when None.
    """
    names = sorted(known)
    likely = likely or nearest(name, names)
    hint = f" did you mean {likely!r}?" if likely else ""
    shown, rest = names, ""
    if len(names) > LISTED:
        shown = sorted(get_close_matches(name, names, n=NEAREST, cutoff=0.0))
        rest = f" and {len(names) - len(shown)} more"
    if any("," in n for n in shown):
        shown = [repr(n) for n in shown]
    return InputError(f"unknown {what} {name!r};{hint} known: {', '.join(shown)}{rest}")


def nearest(name: str, known: Iterable[str], cutoff: float = 0.6) -> str | None:
    """Returns the good name most similar to another, None where none has similarity `cutoff`."""
    return next(iter(get_close_matches(name, sorted(known), n=1, cutoff=cutoff)), None)
