"""What speaks against the names of the effects that a search has accepted.

neighbour     a force drawn from the data explains much of what a law leaves
mass, ...     physics forbids the size (`identification.discovery.impossible`)
odds          others in its place are likelier than it, and it is in no set with its look-alike
gap           it closes less of the gap than a name has to, and something is left
beside        nothing, but it was found beside an effect that has no sure name
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.effect_results import NamedEffect
from identification.discovery.findings.finding import Finding
from identification.discovery.impossible import find_impossible
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.prediction.judging.trial import Contender, Doubt
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.neighbours import has_neighbours_name
from identification.prediction.verdict.told_effects import named_effect
from identification.prediction.verdict.yardstick import Yardstick, measure

EVEN_ODDS = 0.5  # a name below them is none, unless it is told with its look-alike


def names_of(
    state: WindowSearch, limit: float, is_left: bool
) -> tuple[tuple[NamedEffect, ...], Yardstick | None]:
    """Returns the accepted effects as they would be named, and what smooth forces would explain.

    Args:
        state: with the model that has them.
        limit: the upper limit of a confidence.
        is_left: whether the model leaves something.
    """
    make = partial(measure, state.model, state.task.effects, is_left)
    stick = attempt(None, make) if state.accepted else None
    return tuple(named_effect(state, a, limit, stick) for a in laws_of(state)), stick


def laws_of(state: WindowSearch) -> tuple[Contender, ...]:
    """Returns the accepted effects that may be named: no value that differs between records."""
    return tuple(a for a in state.accepted if not a.candidate.effect.is_of_records)


def forbidden_of(state: WindowSearch) -> tuple[Doubt | None, ...]:
    """Returns what physics forbids of each effect that may be named, at the model's values.

    Later effects may have moved them since it was accepted.
    """
    logs = [r.log for r in state.task.records]
    is_asked = uses(state.task.options, "impossible_sizes")
    return tuple(
        find_impossible(a.candidate, state.model, logs) if is_asked else None
        for a in laws_of(state)
    )


def doubts_of_names(
    named: Sequence[NamedEffect], impossible: Sequence[Doubt | None],
    findings: Sequence[Finding], share: float, options: DiscoveryOptions,
) -> tuple[Doubt | None, ...]:  # fmt: skip
    """Returns why each accepted effect is no name; None where nothing is against it.

    Args:
        named: the accepted effects.
        impossible: what physics forbids of each.
        findings: what the final model leaves.
        share: of the gap that the effects close.
        options: what is beyond chance, and enough to matter.
    """
    of_all: Doubt | None = "gap" if _is_small(named, findings, share, options) else None
    return tuple(
        "neighbour" if has_neighbours_name(n.neighbour, options)
        else forbidden or of_all or (None if is_sure(n) else "odds")
        for n, forbidden in zip(named, impossible, strict=True)
    )  # fmt: skip


def is_sure(named: NamedEffect) -> bool:
    """Returns whether a name is at least as likely as not, or one of a set that is told."""
    return named.confidence >= EVEN_ODDS or named.one_of


def _is_small(
    named: Sequence[NamedEffect], findings: Sequence[Finding], share: float,
    options: DiscoveryOptions,
) -> bool:  # fmt: skip
    """Returns whether a law closes less of the gap than a name has to, and something is left.

    Such a law may be the neighbour of a force in no catalogue.
    """
    is_asked = bool(findings) and uses(options, "closed_gap")
    is_law = any(not n.candidate.effect.is_curve for n in named)
    return is_asked and is_law and not share > options.min_explained_share
