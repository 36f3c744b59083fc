"""A named effect in sentences: what it is, what else it may be, and on which records it holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.effect_results import NamedEffect, Rival
from identification.discovery.result import Discovery
from identification.effects.axes import Axis
from identification.effects.effect import Candidate
from identification.effects.laws.curves import NODES
from identification.effects.named import joints_of, neighbour
from identification.effects.plant.jointed import JointPlant
from identification.model.predictor import Plant
from identification.quantities import quantity
from identification.report.words.effects import (
    describe_outside,
    describe_sizes,
    describe_there,
    largest_known,
)
from identification.report.words.proof import agreement_sentences
from identification.report.words.values import phrase, words_of
from identification.shares import fall_words, percent

# The longer ones first: the end of one is another.
READS = ("speed_before", "speed_behind", "before", "behind", "position", "speed", "load", "time")


@dataclass(frozen=True)
class Nodes:
    """The nodes of a curve."""

    joint: str  # on which the curve acts
    depends_on: str  # the last words of the curve's name, such as "position" or "speed_before"
    reads: str  # what it is drawn over, in words
    unit: str  # of that
    at: np.ndarray  # its values at the nodes, shape (m,)


def curve_nodes(candidate: Candidate, plant: Plant) -> tuple[Nodes, ...]:
    """Returns the nodes of a curve, once for each joint on which it acts."""
    if not isinstance(plant, JointPlant):
        raise TypeError(f"a {type(plant).__name__} has no curves on joints")
    word = next(w for w in READS if candidate.effect.name.endswith(f"_{w}"))
    return tuple(_nodes_at(word, joint, plant) for joint in joints_of(candidate))


def _nodes_at(word: str, joint: str, plant: JointPlant) -> Nodes:
    """Returns the nodes of a curve that acts on one joint and depends on what a word says."""
    axis, steps = _read_axis(word, joint, plant), np.arange(1, NODES // 2 + 1) / (NODES // 2)
    even, signed = np.linspace(-1.0, 1.0, NODES), np.concatenate([-steps, steps])
    dense = np.sign(signed) * signed**2  # near zero
    at = axis.middle + even * axis.travel / 2
    if word.startswith("speed"):
        at = dense * axis.speed
    elif word == "load":
        at = dense * axis.force
    elif word == "time":
        at = (even + 1) / 2 * axis.duration
    return nodes_over(word, joint, plant, at)


def nodes_over(word: str, joint: str, plant: JointPlant, at: np.ndarray) -> Nodes:
    """Returns nodes at some values of what a force on a joint depends on, as a word says it."""
    axis = _read_axis(word, joint, plant)
    x, force = ("rad", "N m") if axis.kind == "hinge" else ("m", "N")
    if word.startswith("speed"):
        return Nodes(joint, word, f"rate of {axis.joint}", f"{x}/s", at)
    if word == "load":
        return Nodes(joint, word, f"force of the drives of {joint}", force, at)
    if word == "time":
        return Nodes(joint, word, "time", "s", at)
    return Nodes(joint, word, f"position of {axis.joint}", x, at)


def _read_axis(word: str, joint: str, plant: JointPlant) -> Axis:
    """Returns the joint of which a curve on a joint reads something."""
    every = {axis.joint: axis for axis in plant.axes}
    return every.get(neighbour(word, joint, plant), every[joint])


def curve_top(named: NamedEffect, plant: Plant) -> tuple[str, str]:
    """Returns the largest force of a curve with its std, and in words where it is so large."""
    name = largest_known(named.parameters)
    value, std, unit = named.parameters[name]
    number, _, joint = name.partition("@")
    nodes = curve_nodes(named.candidate, plant)
    at = next((n for n in nodes if n.joint == joint), nodes[0])
    place = quantity(float(at.at[int(number.removeprefix("c_")) - 1]), unit=at.unit)
    return quantity(value, std, unit), f"{at.reads}: {place}"


def node_lines(named: NamedEffect, plant: Plant) -> list[str]:
    """Returns lines with the nodes of a curve at each of its joints, and the forces there."""
    lines, values = [], named.parameters
    for n in curve_nodes(named.candidate, plant):
        names = [f"c_{k + 1}" for k in range(NODES)]
        alone = names[0] in values
        each = [values[name if alone else f"{name}@{n.joint}"] for name in names]
        most = max((abs(v) for v, std, _ in each if 0 < std < np.inf), default=0.0)
        told = sorted(zip(n.at, each, strict=True), key=lambda pair: pair[0])
        lines.append(f"force on {n.joint} at these values of the {n.reads}:")
        for at, (value, std, unit) in told:  # one that no data hold has no std, or ends on a bound
            force = "not known, too few data"
            if 0 < std < np.inf:
                force = quantity(value, std, unit, like=most)
            lines.append(f"  {quantity(float(at), unit=n.unit)}: {force}")
    return lines


RETUNED = 0.05  # the explanation without an effect gets a sentence above this confidence
SHOWN = 0.005  # an explanation with a smaller confidence is not told
NEAR = 0.1  # of the confidence of the first one: a less likely member of a set is not told


def named_sentences(found: Discovery, named: NamedEffect) -> str:
    """Returns what a verdict says of a named effect; `basis_sentence` has the rest."""
    outside = ""  # a law that no catalogue lists may explain the same
    if named.outside is not None and named.outside.confidence >= RETUNED:
        outside = f" Or it is {describe_outside(named.outside)}."
    return (
        f"{_named(found, named)}{nearest_law(found, named)}{_retuned(found, named)}{outside}"
        f"{agreement_sentences(found, named)}"
    )


def _named(found: Discovery, named: NamedEffect) -> str:
    """Returns a sentence on a named effect, or on the set to which it belongs if it is `one_of`."""
    plant, own = found.final.plant, named.confidence
    first = "Missing from the model" if named is found.named[0] else "Missing too"
    if named.candidate.effect.is_curve:
        first += " (in no catalogue, drawn from the data)"
    mine = describe_there(named.candidate, plant)
    if named.same_as is not None:  # another name of the same force
        sized = f", {describe_sizes(named.twin)}" if named.twin else ""
        mine += (
            f' (or "{phrase(named.same_as)}"{sized}: below the Coulomb friction it is the same'
            " force, and no record tells the two apart)"
        )
    if named.one_of and named.rivals:
        each = [with_sizes(f"{mine} ({percent(own)})", named, plant)]
        each += [rival_words(r, plant) for r in likely_rivals(named)]
        return (
            f"{first} is one of these, and the data do not tell which: {'; '.join(each)}. It is one"
            f" of them with a confidence of {percent(confidence_of_set(found, named))}. The model"
            f" got the first one{'' if is_likeliest(named) else ', which is not the likeliest'}."
            + (f" {named.advice}" if named.advice else "")
        )
    others = [
        f"{describe_there(r.candidate, plant)} ({percent(r.confidence)})"
        for r in likely_rivals(named)
    ]  # fmt: skip
    less = f" Less likely: {'; '.join(others)}." if others else ""
    return f"{first}: {mine}, {describe_sizes(named, plant)}; confidence {percent(own)}.{less}"


def rival_words(rival: Rival, plant: Plant) -> str:
    """Returns a member of a set with its odds and the sizes that its own fit gave it."""
    return with_sizes(
        f"{describe_there(rival.candidate, plant)} ({percent(rival.confidence)})", rival, plant
    )


def with_sizes(said: str, effect: NamedEffect | Rival, plant: Plant) -> str:
    """Returns words on an effect with its sizes behind them, where these are known."""
    return ", ".join(filter(None, [said, describe_sizes(effect, plant)]))


def likely_rivals(named: NamedEffect) -> list[Rival]:
    """Returns the rivals of a named effect that are told, the likeliest first.

    Of a set they are those near the first one.
    """
    is_set, rivals = named.one_of and bool(named.rivals), _sorted(named.rivals)
    least = NEAR * named.confidence if is_set else SHOWN
    return [r for r in rivals if r.confidence >= least] or rivals[:is_set]


def _sorted(rivals: Sequence[Rival]) -> list[Rival]:
    return sorted(rivals, key=lambda r: -r.confidence)


def is_likeliest(named: NamedEffect) -> bool:
    """Returns whether no rival of a named effect is likelier than it."""
    return all(r.confidence <= named.confidence for r in named.rivals)


def confidence_of_set(found: Discovery, named: NamedEffect) -> float:
    """Returns the confidence that one of the told names of a set is right.

    It is no higher than that of a name may be.
    """
    limit = found.options.left_confidence if found.unexplained else found.options.max_confidence
    return min(limit, named.confidence + sum(r.confidence for r in likely_rivals(named)))


def basis_sentence(found: Discovery, named: NamedEffect) -> str:
    """Returns a sentence on what the confidence of a named effect rests on."""
    among = "" if named.candidate.effect.is_curve else "it compares known effects; "
    said = f"Confidence of {describe_there(named.candidate, found.final.plant)}: {among}"
    if named.compared:
        rivals = "1 rival was" if named.compared == 1 else f"{named.compared} rivals were"
        return f"{said}{rivals} refitted in its place."
    said += "no other came near enough to be refitted in its place"
    limits = found.options.max_confidence, found.options.left_confidence
    if named.confidence < limits[found.unexplained]:
        return f"{said}."
    when = " while something is left" if found.unexplained else ""
    return f"{said}, and {percent(named.confidence)} is the highest confidence that is given{when}."


def set_words(named: NamedEffect) -> str:
    """Returns the names of a set with their odds in one line; "" where a name is none of a set."""
    if not (named.one_of and named.rivals):
        return ""
    first = named.candidate, named.confidence
    each = [first, *((r.candidate, r.confidence) for r in likely_rivals(named))]
    told = [f"{c.effect.name}, {c.where} ({percent(share)})" for c, share in each]
    return " ".join(
        f"one of these is missing, and the data do not tell which: {'; or '.join(told)}; the model"
        " has the first one".split()
    )


def nearest_law(found: Discovery, named: NamedEffect) -> str:
    """Returns a sentence on the listed law that comes nearest to a curve; "" where none does.

    The law was refitted at the curve's joint, predicts unseen data better than the model without
    it, and was left because a smooth force explains as much.
    """
    c = named.candidate
    if not c.effect.is_curve:
        return ""
    left = [r for r in found.rejected if r.doubt == "smooth" and r.candidate.where == c.where]
    best = max(left, key=lambda r: r.evidence, default=None)
    if best is None or not best.proof.told.fall > 0:
        return ""
    said, change = describe_there(best.candidate, found.final.plant), best.proof.told.fall
    return (
        f" The nearest listed law is {said}, {describe_sizes(best)}; with it in place of the curve"
        f" the mean square {fall_words(change)}."
    )


def _retuned(found: Discovery, named: NamedEffect) -> str:
    """Returns a sentence where a parameter far from what was known would explain the same."""
    other = named.retuned
    if other is None or other.confidence < RETUNED:
        return ""
    what = words_of(found)[other.parameter]
    far = f"{abs(other.distance):.2g} std {'above' if other.distance > 0 else 'below'}"
    return (
        f" Or no effect is missing ({percent(other.confidence)}): the model explains the same if"
        f" {what} is {far} what was given as known. Measure it, or record another motion."
    )
