"""Effects that the joints' torques suggest to a search over windows, which judges them.

A load at any place may sit at the body's end, where it needs no place of its own; where neither is
a candidate, it is another mass or another centre of mass. A robot of one joint needs no such help
with its frictions, because the search compares them with their rivals at that joint. A name that is
no candidate of the search, such as a gain, is left out.
"""

from __future__ import annotations

from collections.abc import Mapping

from identification.discovery.candidates import iterate_shapes
from identification.effects.effect import Candidate, Effect
from identification.prediction.scoring.screening import at_several
from identification.robot.robot import Robot
from identification.robot.second_opinion import frictions
from identification.torques.evidence import Evidence

OF_A_LOAD = (("payload", "load"), ("mass_mismatch",), ("com_offset",))


def suggest(evidence: Evidence, robot: Robot) -> tuple[Candidate, ...]:
    """Returns what torques find and a search over windows can fit, the first found first.

    What has a size that physics forbids is among them: the windows judge it too.
    """
    known = {effect.name: effect for effect in robot.candidates}
    out: list[Candidate] = []
    for score in evidence.added:
        m = score.missing
        shape = {name: value for name, value, _ in m.shape}
        for names in OF_A_LOAD if m.name == "load" else ((m.name,),):
            each = [known[n] for n in names if n in known and m.where in known[n].places]
            out += [Candidate(e, m.where, _believed(e, shape)) for e in each]
            if each:
                break
    changed = [(c.effect.needs, c.where) for c in out if c.effect.needs]
    return (*out, *_frictions(evidence, robot, known, changed))


def _believed(effect: Effect, told: Mapping[str, float]) -> dict[str, float]:
    """Returns shapes that torques tell, moved to the nearest that the search believes.

    Torques see a jump within one sample, which a simulation cannot: it takes some time there. Where
    they tell nothing, these are the first ones to try.
    """
    first = next(iterate_shapes(effect))
    return {
        shape.name: min(max(told.get(shape.name, first[shape.name]), shape.lower), shape.upper)
        for shape in effect.shapes
    }


def _frictions(
    evidence: Evidence, robot: Robot, known: dict[str, Effect], changed: list[tuple[str, str]]
) -> list[Candidate]:
    """Returns the frictions and offsets that joints have and the model has not.

    Besides those that torques prove, these are the levels that are `changed` by what torques name,
    such as a friction that grows along the way: the level itself is then hard to tell.
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
