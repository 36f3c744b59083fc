"""A result that shows itself by its verdict, at the end of a cell or in a debugger.

The words are those of the report, which knows the results while they know nothing of it: it
registers, for each kind of result, the function that tells its verdict (`verdict_of.register`).
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import singledispatch
from html import escape

# Of the verdict's box: good, bad, neither; the colours of a report's page.
COLOURS = {True: "#00805b", False: "#b8430a", None: "#0072b2"}

SENTENCE = r"(?<=\.) (?=[A-Z])"  # between two of them


@singledispatch
def verdict_of(result: object) -> Sequence[str]:
    """Returns the sentences of a result's verdict, the first one first; its kind where none is."""
    return [f"<{type(result).__name__}>"]


class Shown:
    """A result of a search whose representation is its verdict and not all of its numbers."""

    verdict: str
    unexplained: bool

    @property
    def is_good(self) -> bool | None:
        """False where something is missing that has no name, None where something is left."""
        return False if self.verdict == "unknown effect" else None if self.unexplained else True

    def __repr__(self) -> str:
        """Returns the first sentence of the verdict."""
        return re.split(SENTENCE, verdict_of(self)[0], maxsplit=1)[0]

    def _repr_html_(self) -> str:
        """Returns the verdict's box, for a notebook."""
        each = "".join(
            f"<p style='margin:.2rem 0'>{escape(s, quote=False)}</p>" for s in verdict_of(self)
        )
        colour = COLOURS[self.is_good]
        return f"<div style='border-left:5px solid {colour};padding:.7rem 1.1rem'>{each}</div>"
