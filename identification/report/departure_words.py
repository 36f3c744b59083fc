"""Words on values that a fit moved far from what was known of them.

A value that left what was known by several std stands for something else: the model lacks an
effect that the value imitates, or what was known of it is wrong.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from identification.discovery.fitted import Fitted
from identification.quantities import held
from identification.report.error_words import listed
from identification.report.value_words import is_part, words_of

if TYPE_CHECKING:  # a search is slow to import
    from identification.discovery.result import Discovery

FAR = 3.0  # std of what was known: one value in 400 of a right model is farther


def departure_sentences(model: Fitted, words: Mapping[str, str] | None = None) -> list[str]:
    """Returns a sentence on the values that are far from what was known; none where none is."""
    far = {n: abs(by) for n, by in model.departures.items() if abs(by) > FAR and not is_part(n)}
    if not far:
        return []
    farthest_first = sorted(far, key=lambda n: -far[n])
    told = [f"{(words or {}).get(n, n)} by {held(far[n])} std" for n in farthest_first]
    return [
        f"The fit moved values far from what was known of them: {listed(told)}. Either the model"
        " lacks something that they imitate, or what was known is wrong."
    ]


def departures_found(found: Discovery) -> list[str]:
    """Returns sentences on the values that a discovery's fits moved far from what was known."""
    words = words_of(found)
    final = departure_sentences(found.final, words)
    if not found.named:
        return final
    before = departure_sentences(found.nominal, words)
    return [*final, *(f"Before anything was named: {s[0].lower()}{s[1:]}" for s in before)]
