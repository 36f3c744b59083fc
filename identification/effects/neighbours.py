"""The neighbour of a joint, over whose position or speed a curve is drawn, by its name."""

from __future__ import annotations

from identification.effects.effect import Candidate
from identification.effects.jointed import JointPlant
from identification.model.predictor import Plant

SIDES = {"before": -1, "behind": 1}  # last word of the curve's name, and where the joint is


def neighbour(candidate: Candidate, plant: Plant) -> str:
    """The joint before or behind that of a curve in the model; "" where it reads none.

    Args:
        candidate: an effect at its place.
        plant: the robot.
    """
    side = SIDES.get(candidate.effect.name.rpartition("_")[2], 0)
    if not side or not isinstance(plant, JointPlant):
        return ""
    at = int(plant.model.joint(candidate.where.removeprefix("joint ")).id) + side
    return str(plant.model.joint(at).name) if 0 <= at < plant.model.njnt else ""


def phrase_there(candidate: Candidate, plant: Plant) -> str:
    """The words of an effect, in which a neighbouring joint has its name.

    Args:
        candidate: an effect at its place.
        plant: the robot.
    """
    effect = candidate.effect
    said = effect.phrase or effect.name.replace("_", " ")
    joint = neighbour(candidate, plant)
    return said.replace("of the joint be", f"of {joint}, the joint be") if joint else said
