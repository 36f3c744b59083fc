"""Where a model fails over a horizon, in lines and sentences."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.result import Discovery
from identification.quantities import alike, held, quantity
from identification.report.error_words import listed
from identification.report.horizon_gap import (
    HorizonGap,
    LengthError,
    NeededForce,
    OutputError,
    find_gap,
)
from identification.shares import percent


def output_line(o: OutputError) -> str:
    """Returns the error of an output, beside its sensor's noise."""
    size, noise = alike([o.after, o.noise], o.unit, 3)
    times = (
        f", {held(o.after / o.noise)} times its sensor's noise of {noise}" if o.noise > 0 else ""
    )
    return f"the error of {o.name} on unseen data is {size} rms{times}"


def worst_lines(gap: HorizonGap) -> list[str]:
    """Returns which window errs most, in which record; none where no window is known."""
    most = max(gap.records, key=lambda r: float(r.after.max(initial=0.0)))
    if not len(most.after):
        return []
    at, every = int(np.argmax(most.after)), np.concatenate([r.after for r in gap.records])
    begin, ratio = float(most.time[at]), float(most.after[at])
    return [
        f"the worst window begins at {quantity(begin, unit='s')} of {most.name}, with"
        f" {held(ratio)} times the noise; the median of all windows is"
        f" {held(float(np.median(every)))} times the noise"
    ]


def length_lines(lengths: Sequence[LengthError]) -> list[str]:
    """Returns how errors grow with the length of the windows."""
    if len(lengths) < 2:
        return []
    over = listed([f"{n.length:g} s" for n in lengths])
    ratios = listed([held(n.after) for n in lengths])
    return [f"over {over} the error on unseen data is {ratios} times the noise"]


def force_line(needed: NeededForce) -> str:
    """Returns what a force at a joint would explain, and where it would be largest."""
    k, nodes = needed.largest, needed.nodes
    size = quantity(float(needed.force[k]), float(needed.std[k]), needed.unit)
    at = quantity(float(nodes.at[k]), unit=nodes.unit)
    return (
        f"a force on {needed.nodes.joint} that depends on the {needed.nodes.reads} would remove"
        f" {percent(needed.fall)} of the fitted error; it would be largest at {at}: {size}"
    )


def doubtful_sentences(needed: NeededForce, tried: int) -> str:
    """Returns which of the forces that were tried would explain most, where none is missing."""
    which = f"one on {needed.nodes.joint} that depends on the {needed.nodes.reads}"
    chance = percent(needed.chance, 2)
    doubt = f"This may be luck (chance {chance}, {tried} such forces were tried)."
    if not needed.known.any():
        doubt = "The motion tells its size nowhere."
    return (
        f"The force that would explain most is {which}: {percent(needed.fall)} of the fitted"
        f" error. {doubt}"
    )


def needed_sentences(found: Discovery) -> list[str]:
    """Returns a sentence on the forces that a fitted model would need; none where none is known.

    Along a free run other sentences tell of forces.
    """
    gap = find_gap(found)
    if gap is None or not gap.forces:
        return []
    each = listed([f"on {f.nodes.joint} that depends on the {f.nodes.reads}" for f in gap.forces])
    first = gap.forces[0]
    return [
        f"It looks like a force {each}: the force on {first.nodes.joint} would remove"
        f" {percent(first.fall)} of the fitted error."
    ]
