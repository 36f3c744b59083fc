"""The limits of what a log shows: the smallest effects it shows, and those that noise hides.

Each effect has one line at its place, the hardest to see first, because the others would have been
seen: who reads that nothing is missing asks what may be missing all the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isfinite

from identification.discovery.effect_results import Detectable, Hidden
from identification.discovery.result import Discovery
from identification.quantities import quantity
from identification.report.page.page import Section, Table
from identification.report.words.effects import describe_effect
from identification.shares import percent

SHOWN = 4  # of the effects that a log would have shown, or that its noise hides, so many are listed
SHARE = 0.1  # of the inputs' error, by power: an effect that would be less of it has no share told
LISTED = 8  # effects that have a line; the others are counted
FEW = 4  # that are told in a paragraph, above the table of all
NEVER = "effects that this log would not have shown at any plausible size"
SEEN = "effects that this log would have shown in 9 cases of 10, the hardest to see first:"
SMALLEST = (
    "The smallest size of each effect that is found in 9 of 10 logs like this one, beside the"
    " largest plausible size, the hardest to see first. A smaller effect stays hidden."
)
WHERE = (
    "An effect is judged at all places together or, if it acts at one place only, at the place"
    " where it is hardest to see."
)


@dataclass(frozen=True)
class Shown:
    """The sizes of an effect, at the place where it is judged, that a log would have shown."""

    sizes: tuple[Detectable, ...]

    def __str__(self) -> str:
        """Returns the effect and its place in words."""
        return describe_effect(self.sizes[0].candidate)

    @property
    def share(self) -> float:
        """The smallest size that shows over the largest plausible one, the best of all sizes."""
        return min(d.smallest / d.largest if isfinite(d.smallest) else inf for d in self.sizes)

    @property
    def is_seen(self) -> bool:
        """Tells whether a plausible size shows."""
        return any(d.is_plausible for d in self.sizes)

    @property
    def bounds(self) -> str:
        """From which size on it shows, and up to which it is plausible, in words."""
        return ", ".join(
            f"{d.size} from {sized(d.smallest, d.unit)} on"
            + (f" (plausible up to {sized(d.largest, d.unit)})" if isfinite(d.largest) else "")
            for d in self.sizes
            if d.is_plausible
        )


def shown_effects(detectable: Sequence[Detectable]) -> tuple[list[Shown], list[Shown]]:
    """Returns effects that a log would have shown, the hardest to see first, and all others."""
    each: dict[str, list[Detectable]] = {}
    for d in detectable:
        each.setdefault(d.candidate.effect.name, []).append(d)
    shown = sorted((Shown(tuple(sizes)) for sizes in each.values()), key=lambda s: -s.share)
    return [s for s in shown if s.is_seen], [s for s in shown if not s.is_seen]


def unseen_section(found: Discovery) -> list[Section]:
    """Returns the section on what this log would have shown, and what not; none where unknown."""
    if not found.detectable:
        return []
    seen, never = shown_effects(found.detectable)
    said, lines, rows = [], [], []
    if never:
        said.append(f"{NEVER.capitalize()}: {'; '.join(map(str, never))}.")
        lines += [f"{NEVER}:", *(f"  {s}" for s in never)]
    if seen:
        hard = "; ".join(f"{s}, {s.bounds}" for s in seen[:FEW])
        said.append(f"Hardest to see{' of the others' if never else ''}: {hard}.")
        lines += [SEEN, *(f"  {s}: {s.bounds}" for s in seen[:LISTED])]
    if (count := len(seen) - LISTED) > 0:
        who = "1 more effect, which shows" if count == 1 else f"{count} more effects, which show"
        share = percent(seen[LISTED].share, 2)
        lines.append(
            f"  and {who} from {share} of the largest plausible size on, or less; report and JSON"
            " list all"
        )
    for s in (*never, *seen):
        names = [f"{d.size} " if len(s.sizes) > 1 else "" for d in s.sizes]
        each = list(zip(names, s.sizes, strict=True))
        least = "; ".join(
            name + (sized(d.smallest, d.unit) if d.is_plausible else "not at any plausible size")
            for name, d in each
        )
        most = "; ".join(name + sized(d.largest, d.unit) for name, d in each)
        rows.append((str(s), least if s.is_seen else "not by this log", most))
    table = Table(("effect", "smallest seen", "largest plausible"), tuple(rows))
    text, plain = f"{SMALLEST}\n\n{' '.join([*said, WHERE])}", "\n".join([*lines, f"  {WHERE}"])
    return [Section("What it could have seen", text, table=table, plain=plain)]


def sized(value: float, unit: str) -> str:
    """Returns a size in words; without a unit it is a share, in percent also from 1 on."""
    if not isfinite(value):
        return "–"
    return quantity(value, unit=unit) if unit else percent(value, 3)


def hiding(hidden: Sequence[Hidden]) -> str:
    """Returns a sentence on how large effects may be that fitted noise hides; "" without any."""
    if not hidden:
        return ""
    told = []
    for h in hidden[:SHOWN]:
        sizes = (f"{n} {quantity(most, unit=unit)}" for n, (_, most, unit) in h.sizes.items())
        taken = f" (it would be {percent(h.taken)} of what counts as errors of the inputs)"
        effect = f"{describe_effect(h.candidate)}, {', '.join(sizes)}"
        told.append(effect + (taken if h.taken >= SHARE else ""))
    return (
        "The fitted noise may still hide effects up to these sizes (the size that the log seems to"
        f" show, possibly by luck, plus 1.96 std): {'; '.join(told)}."
    )
