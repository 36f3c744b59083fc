"""The neighbour of a joint, over whose position or speed a curve is drawn, by its name."""

from __future__ import annotations

from identification.effects.effect import Candidate
from identification.effects.jointed import JointPlant
from identification.model.predictor import Plant

SIDES = {"before": -1, "behind": 1}  # last word of the curve's name, and where the joint is


def joints_of(candidate: Candidate) -> list[str]:
    """Returns the names of the joints on which an effect with sizes at single joints acts.

    Args:
        candidate: an effect at one joint, or at several with sizes of its own at each.
    """
    at_each = [size.name.partition("@")[2] for size in candidate.effect.sizes]
    return [*dict.fromkeys(filter(None, at_each))] or [candidate.where.removeprefix("joint ")]


def neighbour(word: str, joint: str, plant: Plant) -> str:
    """Returns the name of the joint that a curve reads beside its own; "" where it reads none.

    Args:
        word: the last word of the curve's name, such as "before" or "position".
        joint: on which the curve acts.
        plant: the robot.
    """
    side = SIDES.get(word.rpartition("_")[2], 0)
    if not side or not isinstance(plant, JointPlant):
        return ""
    at = int(plant.model.joint(joint).id) + side
    return str(plant.model.joint(at).name) if 0 <= at < plant.model.njnt else ""


def phrase_there(candidate: Candidate, plant: Plant) -> str:
    """Returns the words of an effect, in which a neighbouring joint has its name.

    An effect at several joints reads another neighbour at each: its words then name none.

    Args:
        candidate: an effect at its place.
        plant: the robot.
    """
    effect, joints = candidate.effect, joints_of(candidate)
    said = effect.phrase or effect.name.replace("_", " ")
    name = neighbour(effect.name, joints[0], plant) if len(joints) == 1 else ""
    return said.replace("of the joint be", f"of {name}, the joint be") if name else said
