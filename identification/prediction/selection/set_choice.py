"""The laws of which a set is tried, chosen by what they explain of fitted windows together.

The set is chosen by a linear model about the present one (`identification.discovery.set_selection`)
in which its members compete with all other laws: their sizes make no room, and the residual is

    r + Σ_j S_j η_j         j: members, η_j: their sizes

as it would be without them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.options import DiscoveryOptions
from identification.discovery.set_selection import folded, select_set
from identification.effects.effect import Candidate
from identification.prediction.fits.model import WindowModel
from identification.prediction.scoring.first_fit import shapes_of
from identification.prediction.scoring.scores import WindowScore, condensed
from identification.prediction.scoring.screening import AND, MAX_SCORED, some_windows

MAX_LISTED = 120  # laws, the best by themselves, of which a set is chosen
MAX_SHAPES = 4  # of a law at a place among them


def choose(
    model: WindowModel, members: Sequence[Candidate], scores: Sequence[WindowScore],
    options: DiscoveryOptions, most: int,
) -> tuple[Candidate, ...]:  # fmt: skip
    """Returns the laws that explain most of the fitted windows together.

    Args:
        model: with the members.
        members: that compete with all others for their places.
        scores: of the candidates on the model without members, the best first.
        options: how large a size may be.
        most: laws.

    Returns:
        The members where a law cannot be simulated beside them.
    """
    listed = [*members, *_listed(model, members, scores)]
    listed.sort(key=lambda c: c.effect.state or "")  # those of one plant are simulated at once
    fit = model.fit if len(scores) <= MAX_SCORED else some_windows(model.fit)
    held = {n for c in members for n in (*c.free, *shapes_of(c))}
    known = attempt(None, partial(condensed, fit, listed, held)) if listed else None
    if known is None:
        return tuple(members)
    values = {**model.plant.parameters.values(), **model.fit.of_record(0)}
    is_member = [any(c is m for m in members) for c in listed]
    present = np.concatenate([
        [values[n] if is_in else 0.0 for n in c.sizes]
        for c, is_in in zip(listed, is_member, strict=True)
    ])  # fmt: skip
    counts = [len(c.sizes) for c in listed]
    first = tuple(j for j in range(len(listed)) if is_member[j])
    sizes = [size for c in listed for size in c.effect.sizes]
    columns = folded(
        known.G, known.a + known.G @ present, counts,
        [f"{c.effect.name}, {c.where}" for c in listed],
        np.array([s.sign for s in sizes]),
        np.array([options.size_factor * s.largest for s in sizes]),
    )  # fmt: skip
    chosen = select_set(columns, most, first)
    return tuple(listed[j] for j in chosen)


def find_members(model: WindowModel, parent: WindowModel) -> list[Candidate]:
    """Returns the effects that a model has and its parent has not, with their fitted shapes."""
    old = {c.key for c in parent.candidates}
    values = {**model.plant.parameters.values(), **model.values}
    return [
        replace(c, shape={s.name: values[c.effect.parameter(s.name, c.where)]
                          for s in c.effect.shapes})
        for c in model.candidates if c.key not in old
    ]  # fmt: skip


def _listed(
    model: WindowModel, members: Sequence[Candidate], scores: Sequence[WindowScore]
) -> list[Candidate]:
    """Returns the best laws in their best shapes."""
    count = Counter({c.key: MAX_SHAPES for c in members})
    out: list[Candidate] = []
    for s in scores:
        c = s.candidate
        is_own = c.effect.own and len(model.fit.problem.parts) > 1
        if c.effect.is_curve or is_own or AND in c.where or count[c.key] >= MAX_SHAPES:
            continue
        count[c.key] += 1
        out.append(c)
    return out[:MAX_LISTED]
