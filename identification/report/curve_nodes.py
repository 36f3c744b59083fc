"""The nodes of a curve that was drawn from the data: of what, and at which values they stand.

    speed           v = ±x² v_top               x = ¼, ½, ¾, 1, first the negative ones; also of a
                                                neighbouring joint
    load            f_u = ±x f_top              the same
    position        q = q_mid + x q_far         x evenly from -1 to 1; also of a neighbouring joint
    time            t = (x + 1)/2 t_end         the same

The laws are those of `identification.effects.curves`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.effects.curves import NODES
from identification.effects.effect import Candidate
from identification.effects.jointed import JointPlant
from identification.effects.named import joints_of, neighbour
from identification.model.predictor import Plant
from identification.quantities import held

# The longer ones first: the end of one is another.
READS = ("speed_before", "speed_behind", "before", "behind", "position", "speed", "load", "time")


@dataclass(frozen=True)
class Nodes:
    """The nodes of a curve.

    Attributes:
        joint: on which the curve acts.
        depends_on: the last words of the curve's name, such as "position" or "speed_before".
        reads: what it is drawn over, in words.
        unit: of that.
        at: its values at the nodes, shape (8,).
    """

    joint: str
    depends_on: str
    reads: str
    unit: str
    at: np.ndarray


def curve_nodes(candidate: Candidate, plant: Plant) -> tuple[Nodes, ...]:
    """Returns the nodes of a curve, once for each joint on which it acts.

    A curve at several joints has eight sizes at each of them, and each joint has a range of its own
    over which they stand.

    Args:
        candidate: a curve (`Effect.is_curve`) on one joint, or on several.
        plant: the robot.

    Raises:
        TypeError: the robot is none with effects on its joints, which alone have curves.
    """
    if not isinstance(plant, JointPlant):
        raise TypeError(f"a {type(plant).__name__} has no curves on joints")
    word = next(w for w in READS if candidate.effect.name.endswith(f"_{w}"))
    return tuple(_nodes_at(word, joint, plant) for joint in joints_of(candidate))


def _nodes_at(word: str, joint: str, plant: JointPlant) -> Nodes:
    """Returns the nodes of a curve that acts on one joint and depends on what a word says."""
    every = {axis.joint: axis for axis in plant.axes}
    axis = every.get(neighbour(word, joint, plant), every[joint])
    x, steps = "rad" if axis.kind == "hinge" else "m", np.arange(1, NODES // 2 + 1) / (NODES // 2)
    even, signed = np.linspace(-1.0, 1.0, NODES), np.concatenate([-steps, steps])
    if word.startswith("speed"):
        at = np.sign(signed) * signed**2 * axis.speed
        return Nodes(joint, word, f"rate of {axis.joint}", f"{x}/s", at)
    if word == "load":
        unit = "N m" if axis.kind == "hinge" else "N"
        return Nodes(joint, word, f"force of the drives of {joint}", unit, signed * axis.force)
    if word == "time":
        return Nodes(joint, word, "time", "s", (even + 1) / 2 * axis.duration)
    at = axis.middle + even * axis.travel / 2
    return Nodes(joint, word, f"position of {axis.joint}", x, at)


def nodes_sentence(nodes: Sequence[Nodes]) -> str:
    """Returns a sentence that says where the nodes of a curve stand, at each of its joints."""
    each = []
    for n in nodes:
        values = ", ".join(held(float(v)) for v in n.at)
        at_joint = f" of joint {n.joint}" if len(nodes) > 1 else ""
        each.append(f"c_1 to c_{NODES}{at_joint} stand at {values} {n.unit} ({n.reads})")
    return f"Its nodes {'; '.join(each)}."
