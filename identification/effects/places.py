"""The places of an effect among several joints, drives or inputs."""

from __future__ import annotations


def places(kind: str, names: tuple[str, ...]) -> dict[str, str]:
    """Returns the places of an effect, in words, with the suffix of their parameters' names.

    Args:
        kind: of the things, e.g. "joint".
        names: of the things; where there are several, the effect may act on all alike, or on one.
    """
    each = {f"{kind} {name}": f"@{name}" for name in names}
    return each if len(names) < 2 else {f"all {kind}s": "", **each}
