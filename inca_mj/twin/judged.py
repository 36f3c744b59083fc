"""Checks of a log that are judgements, and how a user overrules them."""

from __future__ import annotations

from identification.robot.trust import TRUST

JUDGED = {word: TRUST[word] for word in ("sensors", "units", "wiring")}  # a user may overrule
UNJUDGED = (*JUDGED,)  # for who draws a log as it is


def overruled_by(*words: str) -> str:
    """Returns how the user overrules judgements, for the end of their message."""
    known = " and that ".join(JUDGED[word] for word in words)
    return f"; if you know that {known}, write --trust {' '.join(words)}"
