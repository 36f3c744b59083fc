"""The headline of a report on torques: what they need, its first size, and the residual with it."""

from __future__ import annotations

import mujoco
import numpy as np

from identification.quantities import alike, quantity
from identification.report.effect_words import value_with_std
from identification.report.headline import Answer, Headline, Tile, capital
from identification.report.torque_words import joint_names
from identification.torques.evidence import Evidence
from identification.torques.scores import Score


def torque_headline(evidence: Evidence, model: mujoco.MjModel) -> Headline:
    """Returns what torques say in a few words and numbers."""
    tile = _residual(evidence, model)
    if not evidence.named:
        place = "Friction, which is always fitted, is in the table."
        return Headline("", (Answer("No effect is proven", place, (tile,)),))
    first, *others = (_answer(score) for score in evidence.named)
    first = Answer(first.name, first.place, (*first.tiles, tile))
    return Headline("The torques need", (first, *others))


def _answer(score: Score) -> Answer:
    missing = score.missing
    if missing.is_curve:
        tile = Tile("change", quantity(score.reach, unit=missing.units[0]), missing.phrase)
        return Answer("An unlisted force", missing.where, (tile,))
    value = value_with_std(float(score.size[0]), float(score.std[0]), missing.units[0])
    name = missing.name.replace("_", " ")
    return Answer(capital(name), missing.where, (Tile(missing.sizes[0], value, missing.phrase),))


def _residual(evidence: Evidence, model: mujoco.MjModel) -> Tile:
    """Returns the tile on the joint whose residual the model as it is leaves largest, by its own.

    It is of data that no fit has seen.
    """
    _, nominal, final = evidence.unseen
    names, units = joint_names(model)
    fall = nominal / np.maximum(final, 1e-300)
    j = int(np.argmax(np.where(np.isfinite(fall), fall, -1.0)))
    before, after = alike([float(nominal[j]), float(final[j])], units[j])
    same = nominal[j] == final[j]
    return Tile(
        f"residual of {names[j]} on unseen data",
        after if same else f"{before} → {after}",
        "" if same else "of the model, and with what it needs",
    )
