"""A named effect in sentences: what it is, what else it may be, and on which records it holds."""

from __future__ import annotations

from identification.discovery.effect_results import NamedEffect
from identification.discovery.result import Discovery
from identification.report.effect_words import describe_effect, describe_outside, describe_sizes
from identification.report.parameter_words import words_of

RETUNED = 0.05  # the explanation without an effect gets a sentence above this confidence


def named_sentences(found: Discovery, named: NamedEffect) -> str:
    """Returns all that is said of a named effect."""
    return f"{_named(found, named)}{_retuned(found, named)}{_outside(named)}{_agreement(named)}"


def diff_line(named: NamedEffect) -> str:
    """Returns a named effect as a line of a diff of the model."""
    return f"+ {describe_effect(named.candidate)}: {describe_sizes(named)}"


def _named(found: Discovery, named: NamedEffect) -> str:
    """Returns a sentence on a named effect, or on the set to which it belongs if it is `one_of`."""
    first = "Missing from the model" if named is found.named[0] else "Missing too"
    if named.one_of and named.rivals:
        rivals = [r for r in named.rivals if r.confidence >= 0.1 * named.confidence] or [
            named.rivals[0]
        ]
        total = named.confidence + sum(r.confidence for r in rivals)
        each = "; ".join(
            [f"{describe_effect(named.candidate)} ({100 * named.confidence:.0f} %)"]
            + [f"{describe_effect(r.candidate)} ({100 * r.confidence:.0f} %)" for r in rivals]
        )
        return (
            f"{first} is one of these, which this log does not surely tell apart: {each};"
            f" together {_percent(total)}. The first is put into the model:"
            f" {describe_sizes(named)}." + (f" {named.advice}" if named.advice else "")
        )
    return (
        f"{first}: {describe_effect(named.candidate)}, {describe_sizes(named)}"
        f"; confidence {100 * named.confidence:.0f} % among the known effects"
        + ("." if named.rivals else ", none of which was near enough to be refitted in its place.")
    )


def _retuned(found: Discovery, named: NamedEffect) -> str:
    """Returns a sentence where a parameter far from what was known would explain the same."""
    other = named.retuned
    if other.confidence < RETUNED:
        return ""
    what = words_of(found)[other.parameter]
    return (
        f" Or it is no effect ({100 * other.confidence:.0f} %): with {what}"
        f" {abs(other.distance):.2g} std {'above' if other.distance > 0 else 'below'} what was said"
        " to be known of it, the model explains the same. Measure it, or record another motion."
    )


def _outside(named: NamedEffect) -> str:
    """Returns a sentence where a law that no catalogue lists may explain the same."""
    if named.outside is None or named.outside.confidence < RETUNED:
        return ""
    return f" Or it is {describe_outside(named.outside)}."


def _agreement(named: NamedEffect) -> str:
    """Returns sentences on which of several records the effect holds."""
    proof = named.proof
    said = f" It holds on {', '.join(proof.agrees)}." if len(proof.agrees) > 1 else ""
    if proof.disagrees:
        said += f" It raises the error on {', '.join(proof.disagrees)}, beyond chance."
    return said


def _percent(chance: float) -> str:
    """Returns a probability in percent; rounding makes no certainty of it."""
    return "more than 99 %" if chance > 0.995 else f"{100 * chance:.0f} %"
