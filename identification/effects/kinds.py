"""Names that tell effects of slides from those of hinges, on a robot that has both.

One law has other units on a slide than on a hinge. A robot with both therefore has two effects of
it: `coulomb_friction` of its hinges, and `slide_coulomb_friction` of its slides. A robot with
joints of one kind has `coulomb_friction`, whichever kind that is.
"""

from __future__ import annotations

from collections.abc import Iterable

from identification.effects.axes import Kind

SLIDE = "slide_"  # before names of effects of slides, on a robot that has hinges too
WORDS: dict[Kind, str] = {"hinge": "(hinges)", "slide": "(slides)"}


def prefix_of(kind: Kind, both: bool) -> str:
    """Returns the prefix of the names of effects of joints of a kind.

    Args:
        kind: of the joints.
        both: whether effects act on joints of both kinds.
    """
    return SLIDE if both and kind == "slide" else ""


def with_kind(phrase: str, kind: Kind, both: bool) -> str:
    """Returns an effect in words, with the kind of its joints where there are both."""
    return f"{phrase} {WORDS[kind]}" if both else phrase


def about_names(asked: str, known: Iterable[str]) -> str:
    """Returns a sentence on the names of slides' effects, behind a list of good names; "" for none.

    Args:
        asked: the name that is not among them.
        known: names of effects.
    """
    if any(name.startswith(SLIDE) for name in known):
        return (
            f" Names of effects of slides begin with {SLIDE} here, because effects may act on"
            " hinges too."
        )
    if asked.startswith(SLIDE):
        return (
            f" Names of effects of slides begin with {SLIDE} only where effects may act on hinges"
            " too."
        )
    return ""
