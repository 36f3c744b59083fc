"""What is no force of its own but a number of the model: straight curves, and limits of a force.

    f = s x,   s = Σ w x f / Σ w x²,   w = 1/σ²          at the nodes that the motion tells
    share = 1 - Σ w (f - s x)² / Σ w (f - f̄)²            of the changes of the curve, by the line

A curve that is a straight line through zero is a gain, 1 + s, over the force of a joint's drives,
and over the rate a damping, off by -s. A limit of a voltage that falls with no speed is one of the
force.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.discovery.effect_results import NamedEffect
from identification.discovery.fitted import Fitted
from identification.discovery.result import Discovery
from identification.effects.axes import drives_of
from identification.model.predictor import Plant
from identification.model.tied import gain_path
from identification.quantities import matched, quantity
from identification.report.discovery.horizon_gap import find_gap
from identification.report.discovery.named_words import Nodes, curve_nodes
from identification.shares import percent

LIMIT = "voltage_limit"  # the effect, of hinges or of slides
# Of the changes of a curve, that a line explains: of a cube over a full range it explains 85 %.
STRAIGHT = 0.95
FEWEST = 4  # nodes that tell a line from a bent one


@dataclass(frozen=True)
class Line:
    """A straight line through zero that a curve follows."""

    slope: float  # of the force over what the curve depends on
    std: float  # of it, by how far the nodes lie from the line
    share: float  # of the changes of the curve, that it explains


def find_line(at: np.ndarray, force: np.ndarray, std: np.ndarray) -> Line | None:
    """Returns the line through zero that nodes lie on; None where they are bent, or too few.

    Args:
        at: what the curve depends on, at its nodes, shape (n,).
        force: there, shape (n,).
        std: of the forces; nodes without one, or that are not known, do not count.
    """
    known = np.isfinite(std) & (std > 0)
    known &= std < np.abs(force[known]).max(initial=0.0)
    x, f = at[known], force[known]
    if len(x) < FEWEST or not (x.min() < 0 < x.max()):
        return None
    w = 1 / std[known] ** 2
    slope = float(w @ (x * f) / (w @ x**2))
    left, changes = w @ (f - slope * x) ** 2, w @ (f - np.average(f, weights=w)) ** 2
    share = float(1 - left / changes) if changes > 0 else 0.0
    if share < STRAIGHT:
        return None
    scatter = max(1.0, float(left) / (len(x) - 1))
    return Line(slope, float(np.sqrt(scatter / (w @ x**2))), share)


def line_words(nodes: Nodes, force: np.ndarray, std: np.ndarray, unit: str, plant: Plant) -> str:
    """Returns sentences on the number of the model that a straight curve stands for; "" if none.

    Args:
        nodes: of a curve on one joint.
        force: at the nodes, shape (m,).
        std: of it.
        unit: of the force.
        plant: with the joint.
    """
    line = find_line(nodes.at, force, std)
    if nodes.depends_on not in ("load", "speed") or line is None:
        return ""
    if nodes.depends_on == "speed":
        size = quantity(-line.slope, line.std, f"{unit} s/{nodes.unit.partition('/')[0]}")
        what, path = (
            f"a damping that differs from the model's by {size}",
            f"joint/{nodes.joint}.damping",
        )
    elif 1 + line.slope > 0:
        what = f"a gain of {' ± '.join(matched(1 + line.slope, line.std))}"
        drives = _drives_of(plant, nodes.joint)
        path = gain_path(plant.model, drives[0]) if len(drives) == 1 else ""
    else:  # no drive turns against what it is told
        return ""
    free = f'; add "{path}" to the list free of the robot\'s file and search again' if path else ""
    return (
        f" The force on {nodes.joint} is a straight line of the {nodes.reads}, which explains"
        f" {percent(line.share, 3)} of its changes: {what}{free}."
    )


def line_of_named(named: NamedEffect, plant: Plant) -> str:
    """Returns these sentences on each joint of a named curve; "" of what is no curve."""
    if not named.candidate.effect.is_curve:
        return ""
    out, values = "", named.parameters
    for nodes in curve_nodes(named.candidate, plant):
        names = [f"c_{k + 1}" for k in range(len(nodes.at))]
        alone = names[0] in values
        each = [values[name if alone else f"{name}@{nodes.joint}"] for name in names]
        force, std = (np.array([e[k] for e in each], float) for k in (0, 1))
        out += line_words(nodes, force, std, each[0][2], plant)
    return out


def limit_of_named(named: NamedEffect, model: Fitted) -> str:
    """Returns what a limit of a motor is that does not fall with its speed; "" of anything else.

    Args:
        named: any effect.
        model: with it, which knows what ended on a bound.
    """
    if not _is_limit_of_force(named, model):
        return ""
    force, _, unit = named.parameters["f_m"]
    (name, least), *_ = [*force_ranges(named, model).items(), ("", 0.0)]
    cure = (
        f': write forcerange="-{least:.4g} {least:.4g}" into its actuator {name}, as it stands in'
        " the model.xml that --out keeps. To fit the limit too, take that file as the model, leave"
        f' this effect out, and add "actuator/{name}.forcerange" to the list free of the robot\'s'
        " file"
        if name
        else ""
    )
    return (
        " No fall of the force with the speed is seen, and v_0 ended on its bound: this is a limit"
        f" of the force of the drive, ±{quantity(force, unit=unit)}{cure}."
    )


def force_ranges(named: NamedEffect, model: Fitted) -> dict[str, float]:
    """Returns the forcerange that a named limit of the force is, by the name of its actuator.

    It is empty of any other effect, and where several actuators share the limit or one has no name.

    Args:
        named: any effect.
        model: with it, which knows what ended on a bound.
    """
    if not _is_limit_of_force(named, model):
        return {}
    plant = model.plant
    drives = _drives_of(plant, named.candidate.where.removeprefix("joint "))
    if len(drives) != 1 or not (name := plant.model.actuator(drives[0]).name):
        return {}
    return {name: named.parameters["f_m"][0] / abs(float(plant.model.actuator_gear[drives[0], 0]))}


def _is_limit_of_force(named: NamedEffect, model: Fitted) -> bool:
    """Returns whether an effect is a limit of a motor that does not fall with its speed."""
    effect = named.candidate.effect.name
    return effect.endswith(LIMIT) and f"{effect}.v_0" in model.at_bound


def lines_needed(found: Discovery) -> list[str]:
    """Returns these sentences on each force that a model needs over a horizon and is a line."""
    gap = find_gap(found)
    each = [
        line_words(f.nodes, f.force[0], f.std[0], f.unit, found.final.plant).strip()
        for f in (gap.needed.forces if gap else ())
        if len(f.force) == 1  # it is the same in both directions
    ]
    return [*filter(None, each)]


def _drives_of(plant: Plant, joint: str) -> list[int]:
    """Returns the actuators that act on a joint alone."""
    return drives_of(plant.model, int(plant.model.joint(joint).id))
