"""Columns that are numbered through, such as q_0 to q_6: which joint each of them is.

Logs count from 0 and models from 1, or the other way round, so that q_1 may be the second joint and
not A1. A family is all columns that differ by their last number alone. One with as many members as
a model has drives, or measured joints, is theirs in the order of its numbers:

    q_0, ..., q_6        A1, ..., A7

Its words must say that it is an input, or an output, or be those of the joints: `temp_0` is neither
a torque nor a position. Of several such families the one counts that shares most words with the
joints, and of these the one with the fewest: `tau_0` rather than `tau_ext_0`. Joints without
numbers have names of their own, which tell more than an order does.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

from identification.inspection.channels import Channel, Match, may_be
from identification.inspection.inspected import Inspection
from identification.logs.headers.column_words import Role, words_of

_LAST_NUMBER = re.compile(r"(.*?)(\d+)(\D*)")  # of a name, with what stands before and behind it
Family = tuple[str, ...]  # names of columns, by their numbers


def numbered_matches(channels: Sequence[Channel], found: Inspection) -> tuple[Match, ...]:
    """Returns the channels to which a family of numbered columns belongs, with their columns.

    Args:
        channels: for which no column was found yet.
        found: the columns.
    """
    roles = {c.name: c.role for c in found.columns}
    out: list[Match] = []
    for kind in ((True, False), (False, False), (False, True)):
        group = _by_number([c for c in channels if (c.is_input, c.is_rate) == kind])
        ranks = {
            family: rank for family in _families([*roles])
            if len(group) == len(family) > 1
            and all(may_be(c, name, roles[name]) for c, name in zip(group, family, strict=True))
            and (rank := _rank(group, family, roles[family[0]]))
        }  # fmt: skip
        best = [family for family, rank in ranks.items() if rank == max(ranks.values())]
        if len(best) == 1:
            (family,) = best
            how = (
                f"guessed by its number: {family[0]} to {family[-1]} are"
                f" {group[0].name} to {group[-1].name}"
            )
            out += [Match(c, name, how) for c, name in zip(group, family, strict=True)]
    return tuple(out)


def _rank(group: Sequence[Channel], family: Family, role: Role) -> tuple[int, int] | None:
    """Returns how well the words of a family fit channels; None where they say nothing of them."""
    words, first = {*words_of(family[0])}, group[0]
    shared = len(words & {*words_of(first.name), *words_of(first.joint)})
    return (shared, -len(words)) if shared or role else None


def _families(names: Sequence[str]) -> list[Family]:
    """Returns the columns that differ by their last number alone, where none is left out."""
    each: dict[tuple[str, str], dict[int, str]] = {}
    for name in names:
        parts = _LAST_NUMBER.fullmatch(name)
        if parts is not None:
            each.setdefault((parts[1], parts[3]), {})[int(parts[2])] = name
    return [tuple(of[k] for k in sorted(of)) for of in each.values() if _is_whole(of)]


def _is_whole(numbers: Collection[int]) -> bool:
    """Returns whether no number between the least and the largest is left out."""
    return max(numbers) - min(numbers) == len(numbers) - 1


def _by_number(group: Sequence[Channel]) -> list[Channel]:
    """Returns channels by the last numbers of their joints; none where these are not numbered."""
    each: dict[int, Channel] = {}
    for channel in group:
        parts = _LAST_NUMBER.fullmatch(channel.joint or channel.name)
        if parts is None or int(parts[2]) in each:
            return []
        each[int(parts[2])] = channel
    return [each[k] for k in sorted(each)] if each and _is_whole(each) else []
