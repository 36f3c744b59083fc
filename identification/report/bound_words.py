"""Values that a search ended with on a bound, and why the bound is where it is."""

from __future__ import annotations

from collections.abc import Iterable

from identification.model.parameter import Parameter


def bound_sentences(parameters: Iterable[Parameter], at_bound: Iterable[str]) -> list[str]:
    """Returns sentences on values that lie on a bound, with what moves it; none where none does.

    Args:
        parameters: of the plant, some of which say why their bounds are where they are.
        at_bound: names of the values; one that a record has for itself is `name [record]`.
    """
    reasons = {p.name: p.bounded_by for p in parameters}
    each = {name: reasons.get(name.partition(" [")[0], "") for name in at_bound}
    plain = [name for name, reason in each.items() if not reason]
    said = [f"At a bound: {name}; {reason}." for name, reason in each.items() if reason]
    if plain:
        said.insert(0, f"At a bound: {', '.join(plain)}; widen it or fix the parameter.")
    return said
