"""The forces at single joints that a model would need over a horizon, and what is said of them.

They are those of `identification.prediction.verdict.needed_force`. Where joints have no such linear
response, they are the curves of eight nodes of the scores of the final model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.result import Discovery
from identification.effects.laws.curves import NODES
from identification.effects.plant.jointed import JointPlant
from identification.prediction.fits.model import WindowModel
from identification.prediction.scoring.scores import WindowScore
from identification.prediction.verdict.needed_force import fine_forces
from identification.report.discovery.named_words import Nodes, curve_nodes, nodes_over
from identification.report.words.errors import listed
from identification.shares import percent

SURE = 1.96  # std on each side of 95 %
MUCH = 0.1  # of the fitted error: what explains less is not told where it may be luck


@dataclass(frozen=True)
class NeededForce:
    """The force at one joint that would take most of what the final model leaves."""

    nodes: Nodes  # at which it is known, and what it is drawn over
    # at the nodes, in `unit`: where the joint's position rises and where it falls, or once where it
    # is the same in both directions, shape (1 or 2, m)
    force: np.ndarray
    std: np.ndarray  # of it, of this shape
    unit: str  # of the force
    fall: float  # share of the fitted error that it would take away
    chance: float  # that one of all that were tried takes away as much by luck
    has_sides: bool = False  # whether it was asked for a difference between the two directions

    @property
    def known(self) -> np.ndarray:
        """Whether the motion tells the force at each node, in the shape of `force`."""
        finite = np.where(np.isfinite(self.std), np.abs(self.force), 0.0)
        return np.isfinite(self.std) & (self.std < finite.max())

    @property
    def largest(self) -> tuple[int, int]:
        """Where the force is surely large: the largest |f| - 1.96 std; direction and node."""
        least = np.where(self.known, np.abs(self.force) - SURE * self.std, -np.inf)
        way, node = np.unravel_index(int(np.argmax(least)), least.shape)
        return int(way), int(node)


@dataclass(frozen=True)
class NeededForces:
    """The forces that a model would need."""

    # of each joint at which a force would explain more than luck, the largest share first
    forces: tuple[NeededForce, ...] = ()
    # where there is none: the force at one joint that explains most; None where none explains much
    doubtful: NeededForce | None = None
    tried: int = 0  # forces on one joint, or candidates
    is_asked: bool = False  # whether any force on one joint was among them


def find_needed(found: Discovery, final: WindowModel) -> NeededForces:
    """Returns the forces that the final model of a discovery would need."""
    options, plant = found.options, final.plant
    fine = attempt(None, partial(fine_forces, final.fit, tuple(final.scale.tolist())))
    if fine is None or not isinstance(plant, JointPlant):
        every, tried = _of_scores(found, final), len(found.remaining)
    else:
        kinds = {axis.joint: "N m" if axis.kind == "hinge" else "N" for axis in plant.axes}
        drawn, tried = fine
        every = [
            NeededForce(nodes_over(f.depends_on, f.joint, plant, f.at), f.force, f.std,
                        kinds[f.joint], f.fall, f.chance, has_sides=f.depends_on != "speed")
            for f in drawn
        ]  # fmt: skip
    best: dict[str, NeededForce] = {}
    for f in every:
        if f.fall > options.min_fall and f.chance < options.significance and f.known.any():
            best.setdefault(f.nodes.joint, f)
    forces = tuple(sorted(best.values(), key=lambda f: -f.fall))
    most = max(every, key=lambda f: f.fall, default=None)
    is_little = most is None or most.fall < MUCH
    return NeededForces(forces, None if forces or is_little else most, tried, bool(every))


def _of_scores(found: Discovery, final: WindowModel) -> list[NeededForce]:
    """Returns all curves that act on one joint, as the scores of the final model have them."""
    out = []
    for s in found.remaining:
        if not isinstance(s, WindowScore) or not s.candidate.effect.is_curve:
            continue
        nodes = curve_nodes(s.candidate, final.plant)
        if len(nodes) == 1 and len(s.size) == NODES:
            (n,), order = nodes, np.argsort(nodes[0].at)
            unit = s.candidate.effect.sizes[0].unit
            each = Nodes(n.joint, n.depends_on, n.reads, n.unit, n.at[order])
            chance = min(1.0, len(found.remaining) * s.p_value)
            out.append(NeededForce(each, s.size[order][None], s.std[order][None], unit, s.fall,
                                   chance))  # fmt: skip
    return out


def needed_sentences(forces: Sequence[NeededForce]) -> list[str]:
    """Returns a sentence on the forces that a fitted model would need; none where none is known."""
    if not forces:
        return []
    each = listed([f"on {f.nodes.joint} that depends on the {f.nodes.reads}" for f in forces])
    first = forces[0]
    alone = ", each asked by itself" if len(forces) > 1 else ""
    return [
        f"It looks like a force {each}{alone}: the force on {first.nodes.joint} would remove"
        f" {percent(first.fall)} of the fitted error."
    ]
