"""What the torques of joints say: what a search may try, and what its names are worth.

A load at any place may sit at the body's end, where it needs no place of its own; where neither is
a candidate, it is another mass or another centre of mass. Every fit of torques has Coulomb friction
and an offset of each joint: where those are far from the model's, the model lacks them. A robot of
one joint needs no such help with its frictions, because the search compares them with their rivals
at that joint. A name that is no candidate of the search, such as a gain, is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from identification.discovery.candidates import iterate_shapes
from identification.discovery.result import Discovery
from identification.discovery.second_opinion import TorqueOpinion
from identification.effects.effect import Candidate, Effect
from identification.errors import InputError
from identification.prediction.screening import at_several
from identification.robot.robot import Robot
from identification.robot.torques import fit_torques
from identification.torques.evidence import Evidence
from identification.torques.scores import PROOF, Score

# How the names of frictions begin that every fit of torques has, their effects, and sizes of these.
FRICTIONS = (
    ("coulomb of ", "coulomb_friction", "f_c"), ("offset of ", "offset", "f_0"),
)  # fmt: skip


def ask_torques(robot: Robot, progress: Callable[[str], None] | None = None) -> Evidence | None:
    """Returns what the joints' torques say of a robot.

    None where they tell nothing: a position is not measured, a drive has a state, bodies form a
    loop.
    """
    try:
        evidence = fit_torques(robot).found
    except InputError:  # they need more than a search over windows does
        return None
    if progress is not None:
        named = ", ".join(s.missing.title for s in evidence.named) or "nothing"
        progress(f"the torques of the joints name {named}")
    return evidence


def with_torques(found: Discovery, evidence: Evidence | None) -> Discovery:
    """Returns a discovery with what the joints' torques say of its names, if they tell anything.

    A discovery in which nothing is missing is returned as it is.
    """
    if evidence is None or found.verdict == "nothing missing":
        return found
    return replace(found, torques=opinions(found, evidence))


def opinions(found: Discovery, evidence: Evidence) -> tuple[TorqueOpinion, ...]:
    """Returns what torques say of each named effect that they can tell, in the search's order.

    Where they prove none of these, what they name first themselves comes last; so it does where
    nothing is named. An effect of a sensor or of a state is none that they can tell, and a search
    that names one is not contradicted by them.
    """
    scores = {s.missing.key: s for s in (*reversed(evidence.scores), *evidence.named)}
    known = {key: _opinion(s, is_named=True) for key, s in scores.items()} | frictions(evidence)
    named = [n.candidate.key for n in found.named]
    told = [known[key] for key in named if key in known]
    is_asked = len(told) == len(named) and not any(o.is_proven for o in told)
    others = [s for s in evidence.named if s.missing.key not in named] if is_asked else []
    return (*told, *(_opinion(s, is_named=False) for s in others[:1]))


def frictions(evidence: Evidence) -> dict[tuple[str, str], TorqueOpinion]:
    """Returns how far frictions that every fit has are from those of the model, by effect."""
    fit, out = evidence.final, {}
    for k, model in enumerate(evidence.friction):
        at = fit.inertial + k
        for word, effect, size in FRICTIONS:
            if fit.names[at].startswith(word) and fit.fit.std[at] > 0:
                where = f"joint {fit.names[at].removeprefix(word)}"
                value, std = float(fit.fit.θ[at] - model), float(fit.fit.std[at])
                out[effect, where] = TorqueOpinion(
                    name=effect, where=where, sizes={size: (value, std, fit.units[at])}, fall=None,
                    t=abs(value) / std, is_proven=abs(value) > PROOF * std, is_named=True,
                )  # fmt: skip
    return out


def _opinion(score: Score, is_named: bool) -> TorqueOpinion:
    m = score.missing
    sizes = {
        n.rpartition(".")[2].partition("@")[0]: (float(v), float(s), u)
        for n, v, s, u in zip(m.sizes, score.size, score.std, m.units, strict=True)
    }
    return TorqueOpinion(
        name=m.name, where=m.where, sizes=sizes, fall=score.fall, t=score.t,
        is_proven=score.is_proven, is_named=is_named,
    )  # fmt: skip


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
