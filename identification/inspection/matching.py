"""Which column of a log an actuator or a sensor of a model is, as their names tell.

Columns that are numbered through belong to the joints in their order (`numbered`). Of the others
the words are compared with those of the actuator or sensor and of its joint. A column
that shares more words with one than with any other is that one; of two that share as many, the one
whose name says that it is an input, or an output. What is left is taken in its order where there
are as many columns left as actuators or sensors. Either way it is a guess. Where an actuator bears
the name of its joint, that name does not tell which column is whose (`shared_names`).
"""

from __future__ import annotations

from collections.abc import Sequence

from identification.inspection.channels import Channel, Match, may_be
from identification.inspection.inspected import Inspection
from identification.inspection.numbered import numbered_matches
from identification.inspection.shared_names import shared_matches
from identification.logs.headers.column_words import name_words, role_of

SAME = "the same name"  # how a column was found, which is no guess
BY_PLACE = ("guessed by its order", "guessed: no other is left")  # of columns that no name tells


def match(channels: Sequence[Channel], found: Inspection) -> tuple[Match, ...]:
    """Returns for each channel of a model the column that it most likely is."""
    free = [c.name for c in found.columns]
    out = {m.channel: m for m in shared_matches(channels, found)}
    in_doubt = {n for m in out.values() for n in (m.column, m.channel.name)}
    free = [name for name in free if name not in in_doubt]
    for channel in channels:
        if channel.name in free and channel not in out:
            out[channel] = Match(channel, channel.name, SAME)
            free.remove(channel.name)
    for m in numbered_matches([c for c in channels if c not in out], found):
        if m.column in free:
            out[m.channel] = m
            free.remove(m.column)
    roles = {c.name: c.role for c in found.columns}
    pairs = sorted(
        ((_alike(channel, name), i, k) for i, channel in enumerate(channels)
         for k, name in enumerate(free)
         if channel not in out and may_be(channel, name, roles[name])),
        key=lambda pair: pair[0],
        reverse=True,
    )  # fmt: skip
    names = [*free]
    for score, i, k in pairs:
        rivals = [p for p in pairs if p[0] == score and (p[1] == i) != (p[2] == k)
                  and channels[p[1]] not in out and names[p[2]] in free]  # fmt: skip
        if score[0] > 0 and channels[i] not in out and names[k] in free and not rivals:
            out[channels[i]] = Match(channels[i], names[k], "guessed by the words of its name")
            free.remove(names[k])
    for kind in ((True, False), (False, False), (False, True)):
        rest = [c for c in channels if c not in out and (c.is_input, c.is_rate) == kind]
        columns = [name for name in free if any(may_be(c, name, roles[name]) for c in rest)]
        pairs_of = zip(rest, columns, strict=False)
        if len(rest) == len(columns) and all(may_be(c, name, roles[name]) for c, name in pairs_of):
            for channel, name in zip(rest, columns, strict=True):
                how = BY_PLACE[len(rest) == 1]
                out[channel] = Match(channel, name, how)
                free.remove(name)
    return tuple(out.get(channel, Match(channel, "", "")) for channel in channels)


def _alike(channel: Channel, name: str) -> tuple[int, bool]:
    """Returns how many words a column shares with a channel or its joint, and if roles agree."""
    names = name_words(channel.name) | name_words(channel.joint)
    role = "input" if channel.is_input else "output"
    return len(names & name_words(name)), role_of(name) == role
