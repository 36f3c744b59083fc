"""Where the nodes of a curve stand that was drawn from the data: of what, and at which values.

    speed           v = ±x² v_top               x = ¼, ½, ¾, 1, first the negative ones; also of a
                                                neighbouring joint
    load            f_u = ±x f_top              the same
    position        q = q_mid + x q_far         x evenly from -1 to 1; also of a neighbouring joint
    time            t = (x + 1)/2 t_end         the same

The laws are those of `identification.effects.curve_laws`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.effects.curve_laws import NODES
from identification.effects.effect import Candidate
from identification.effects.jointed import JointPlant
from identification.effects.neighbours import neighbour
from identification.model.predictor import Plant
from identification.quantities import held

# The longer ones first: the end of one is another.
READS = ("speed_before", "speed_behind", "before", "behind", "position", "speed", "load", "time")


@dataclass(frozen=True)
class Nodes:
    """The nodes of a curve.

    Attributes:
        depends_on: the last words of the curve's name, such as "position" or "speed_before".
        reads: what it is drawn over, in words.
        unit: of that.
        at: its values at the nodes, shape (8,).
    """

    depends_on: str
    reads: str
    unit: str
    at: np.ndarray


def curve_nodes(candidate: Candidate, plant: Plant) -> Nodes:
    """The nodes of a curve on a joint of a robot.

    Args:
        candidate: a curve (`Effect.is_curve`) on one joint.
        plant: the robot.

    Raises:
        TypeError: the robot is none with effects on its joints, which alone have curves.
    """
    if not isinstance(plant, JointPlant):
        raise TypeError(f"a {type(plant).__name__} has no curves on joints")
    word = next(w for w in READS if candidate.effect.name.endswith(f"_{w}"))
    joint = candidate.where.removeprefix("joint ")
    name = neighbour(candidate, plant) or joint
    axis = next(axis for axis in plant.axes if axis.joint == name)
    x, steps = "rad" if axis.kind == "hinge" else "m", np.arange(1, NODES // 2 + 1) / (NODES // 2)
    even, signed = np.linspace(-1.0, 1.0, NODES), np.concatenate([-steps, steps])
    if word.startswith("speed"):
        at = np.sign(signed) * signed**2 * axis.speed
        return Nodes(word, f"rate of {axis.joint}", f"{x}/s", at)
    if word == "load":
        unit = "N m" if axis.kind == "hinge" else "N"
        return Nodes(word, f"force of the drives of {joint}", unit, signed * axis.force)
    if word == "time":
        return Nodes(word, "time", "s", (even + 1) / 2 * axis.duration)
    return Nodes(word, f"position of {axis.joint}", x, axis.middle + even * axis.travel / 2)


def nodes_sentence(nodes: Nodes) -> str:
    """Where the nodes stand, in words."""
    values = ", ".join(held(float(v)) for v in nodes.at)
    return f"Its nodes c_1 to c_{NODES} stand at {values} {nodes.unit} ({nodes.reads})."
