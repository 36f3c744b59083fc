"""Effects that the joints' torques name, as candidates of a search over windows.

A load at any place may sit at the body's end, where it needs no place of its own; where neither is
a candidate, it is another mass or another centre of mass. Every fit of torques has Coulomb friction
and an offset of each joint: where those are far from the model's, the model lacks them. A robot of
one joint needs no such help with its frictions, because the search compares them with their rivals
at that joint. A name that is no candidate of the search, such as a gain, is left out.
"""

from __future__ import annotations

from identification.discovery.candidates import iterate_shapes
from identification.effects.effect import Candidate, Effect
from identification.prediction.screening import at_several
from identification.robot.robot import Robot
from identification.robot.second_opinion import frictions
from identification.torques.evidence import Evidence

OF_A_LOAD = (("payload", "load"), ("mass_mismatch",), ("com_offset",))


def suggest(evidence: Evidence, robot: Robot) -> tuple[Candidate, ...]:
    """Returns what torques name and a search over windows can fit, the first found first."""
    known = {effect.name: effect for effect in robot.candidates}
    out: list[Candidate] = []
    for score in evidence.named:
        m = score.missing
        shape = {name: value for name, value, _ in m.shape}
        for names in OF_A_LOAD if m.name == "load" else ((m.name,),):
            each = [known[n] for n in names if n in known and m.where in known[n].places]
            out += [Candidate(e, m.where, shape or next(iterate_shapes(e))) for e in each]
            if each:
                break
    changed = [(c.effect.needs, c.where) for c in out if c.effect.needs]
    return (*out, *_frictions(evidence, robot, known, changed))


def _frictions(
    evidence: Evidence, robot: Robot, known: dict[str, Effect], changed: list[tuple[str, str]]
) -> list[Candidate]:
    """Returns the frictions and offsets that joints have and the model has not.

    Args:
        evidence: of the torques.
        robot: whose model may lack them.
        known: the candidates of the search, by name.
        changed: effects and places that what torques name only changes, such as a level of
            friction that grows along the way; where it does so, the level itself is hard to tell.
    """
    if len(robot.plant.joints) < 2:
        return []
    proven = [key for key, opinion in frictions(evidence).items() if opinion.is_proven]
    far: dict[str, list[str]] = {}
    for name, where in dict.fromkeys((*proven, *changed)):
        effect, joint = known.get(name), where.removeprefix("joint ")
        is_fitted = f"joint/{joint}.frictionloss" in robot.file.free and name != "offset"
        if effect and where in effect.places and not is_fitted:
            far.setdefault(name, []).append(where)
    out = []
    for name, places in far.items():
        effect = at_several(known[name], places) if len(places) > 1 else known[name]
        where = next(iter(effect.places)) if len(places) > 1 else places[0]
        out.append(Candidate(effect, where, next(iterate_shapes(effect))))
    return out
