"""The limits of what a log shows: the smallest effects it shows, and those that noise hides."""

from __future__ import annotations

from collections.abc import Sequence

from identification.discovery.effect_results import Detectable, Hidden
from identification.discovery.result import Discovery
from identification.quantities import quantity
from identification.report.effect_words import describe_effect

SHOWN = 4  # of the effects that a log would have shown, or that its noise hides, so many are listed
SHARE = 0.1  # of the inputs' error, by power: an effect that would be less of it has no share told


def hiding(found: Discovery) -> str:
    """Returns a sentence on how large effects may be that fitted noise hides; "" without any."""
    if not found.hidden:
        return ""
    listed = "; ".join(map(_describe, found.hidden[:SHOWN]))
    return (
        " The fitted noise may still hide effects up to these sizes (what the log seems to show of"
        f" each, by luck or not, and 1.96 std more): {listed}."
    )


def _describe(h: Hidden) -> str:
    sizes = ", ".join(f"{n} {quantity(most, unit=unit)}" for n, (_, most, unit) in h.sizes.items())
    taken = f" (it would be {100 * h.taken:.0f} % of what passes for errors of the inputs)"
    return f"{describe_effect(h.candidate)}, {sizes}{taken if h.taken >= SHARE else ''}"


def split_detectable(
    detectable: Sequence[Detectable],
) -> tuple[list[Detectable], list[Detectable]]:
    """Returns effects that a plausible size would show, the easiest to find first; and others."""
    seen = [d for d in detectable if is_plausible(d)]
    return (
        sorted(seen, key=lambda d: d.smallest / largest(d)),
        [d for d in detectable if not is_plausible(d)],
    )


def is_plausible(d: Detectable) -> bool:
    """Returns whether a plausible size would have shown."""
    return d.smallest < float("inf") and d.smallest <= largest(d)


def smallest(d: Detectable) -> str:
    """Returns the smallest size in words."""
    return f"{d.size} {quantity(d.smallest, unit=d.unit)}"


def largest(d: Detectable) -> float:
    """Returns the largest plausible magnitude of a size [unit]; inf where none is known."""
    return next((s.largest for s in d.candidate.effect.sizes if s.name == d.size), float("inf"))
