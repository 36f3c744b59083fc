"""What speaks against the names of the effects that a search has accepted.

neighbour     a force drawn from the data explains much of what a law leaves
mass, ...     physics forbids the size (`identification.discovery.impossible`)
size          beside what was found later, its size is not beyond its std any more
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
from identification.effects.effect import Candidate
from identification.prediction.judging.trial import Contender, Doubt, has_size
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


def doubts_of_values(state: WindowSearch) -> tuple[Doubt | None, ...]:
    """Returns what speaks against the values of each effect that may be named, in the final model.

    Later effects may have moved them since it was accepted.
    """
    options, logs = state.task.options, [r.log for r in state.task.records]

    def doubt(c: Candidate) -> Doubt | None:
        forbidden = find_impossible(c, state.model, logs)
        if forbidden and uses(options, "impossible_sizes"):
            return forbidden
        return None if has_size(state.model, c, options) else "size"

    return tuple(doubt(a.candidate) for a in laws_of(state))


def doubts_of_names(
    named: Sequence[NamedEffect], of_values: Sequence[Doubt | None],
    findings: Sequence[Finding], share: float, options: DiscoveryOptions,
) -> tuple[Doubt | None, ...]:  # fmt: skip
    """Returns why each accepted effect is no name; None where nothing is against it.

    Args:
        named: the accepted effects.
        of_values: what speaks against the values of each.
        findings: what the final model leaves.
        share: of the gap that the effects close.
        options: what is beyond chance, and enough to matter.
    """
    of_all: Doubt | None = "gap" if _is_small(named, findings, share, options) else None
    return tuple(
        "neighbour" if has_neighbours_name(n.neighbour, options)
        else against or of_all or (None if is_sure(n) else "odds")
        for n, against in zip(named, of_values, strict=True)
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
