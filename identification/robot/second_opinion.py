"""What the joints' torques say of the names of a search, and what they name themselves.

Every fit of torques has Coulomb friction and an offset of each joint: where those are far from the
model's, the model lacks them. An effect of a sensor, of a servo or of a state is none that torques
can tell.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from identification.discovery.result import Discovery
from identification.discovery.second_opinion import Standing, TorqueOpinion
from identification.effects.laws.joint_group import SLIDE
from identification.errors import InputError
from identification.model.tied import gain_path, value_of
from identification.prediction.scoring.screening import places_of
from identification.report.torques.opinion_words import OTHERWISE
from identification.report.words.effects import ADDED_TO
from identification.robot.robot import Robot
from identification.robot.torques import fit_torques
from identification.torques.evidence import Evidence
from identification.torques.scores import PROOF, Score

# How the names of frictions begin that every fit of torques has, their effects, and sizes of these.
FRICTIONS = (
    ("coulomb of ", "coulomb_friction", "f_c"), ("offset of ", "offset", "f_0"),
)  # fmt: skip
MOST_RIVALS = 4  # of what torques name first, that are told
# Numbers that an effect of torques adds to, beside those of the catalogue.
OF_TORQUES = {"load": "body/{}.mass", "payload": "body/{}.mass"}


def ask_torques(
    robot: Robot, progress: Callable[[str], None] | None = None
) -> Evidence | InputError:
    """Returns what the joints' torques say of a robot, or the error that says why they cannot.

    They cannot where a position is not measured, a drive has a state, or bodies form a loop.
    """
    try:
        evidence = fit_torques(robot).found
    except InputError as error:  # they need more than a search over windows does
        return error
    if progress is not None:
        named = ", ".join(s.missing.title for s in evidence.named) or "nothing but friction"
        progress(f"the torques of the joints name {named}")
    return evidence


def with_torques(found: Discovery, evidence: Evidence | InputError, robot: Robot) -> Discovery:
    """Returns a discovery with what the joints' torques say of its names, or why they cannot.

    A discovery in which nothing is missing is returned as it is.
    """
    if found.verdict == "nothing missing":
        return found
    if isinstance(evidence, InputError):
        # what follows is advice for those who asked for torques
        why = str(evidence).partition("; ")[0].partition(": ")[0]
        return replace(found, torques_refused=why)
    return replace(found, torques=opinions(found, evidence, robot), torques_refused="")


def opinions(found: Discovery, evidence: Evidence, robot: Robot) -> tuple[TorqueOpinion, ...]:
    """Returns what torques say of each named effect that they can tell, in the search's order.

    What they name themselves and the search does not comes last, in their order, then what they do
    not tell from the first of these; where they name nothing, what they would name if physics
    allowed it. Where the search names nothing, frictions that are far from the model's are names of
    theirs too, if no free number stands for them.
    """
    known, told = _known(evidence), list[TorqueOpinion]()
    for named in found.named:
        for where in places_of(named.where):
            plain = named.name.removeprefix(SLIDE), where
            of = known.get((named.name, where)) or known.get(plain)
            if of is not None:
                told.append(replace(of, name=named.name, is_named=True))
    keys = {(o.name, o.where) for o in told}
    own = [s.missing.key for s in evidence.named or evidence.tried]
    if any(known[key].is_first for key in own if key not in keys):
        own += [s.missing.key for s in evidence.rivals[:MOST_RIVALS]]
    if not found.named:
        own += [
            key
            for key, o in frictions(evidence).items()
            if o.standing == "named" and not _is_free(o, robot)
        ]
    others = [known[key] for key in dict.fromkeys(own) if key not in keys]
    return (*told, *(replace(o, free=_number(o, robot)) for o in others))


def _known(evidence: Evidence) -> dict[tuple[str, str], TorqueOpinion]:
    """Returns what torques say of each effect that they can tell, by its name and its place."""
    added = {s.missing.key for s in evidence.added}
    alike = {s.missing.key for s in evidence.rivals}
    first = {s.missing.key for s in evidence.named[:1]}
    out: dict[tuple[str, str], TorqueOpinion] = {}
    for score in (*reversed(evidence.scores), *evidence.added):
        key = score.missing.key
        # where torques add no effect, something is against one that its own score proves
        doubt: str = score.doubt or ("" if evidence.found else OTHERWISE)
        standing: Standing = "unproven" if doubt else "alike" if key in alike else "alone"
        if key in added:
            doubt = evidence.doubts.get(key, "")
            standing = "forbidden" if doubt else "named"
        out[key] = replace(_opinion(score, standing, doubt), is_first=key in first)
    return out | frictions(evidence)


def frictions(evidence: Evidence) -> dict[tuple[str, str], TorqueOpinion]:
    """Returns how far frictions that every fit has are from those of the model, by effect."""
    fit, out = evidence.final, dict[tuple[str, str], TorqueOpinion]()
    for k, model in enumerate(evidence.friction):
        at = fit.inertial + k
        for word, effect, size in FRICTIONS:
            if fit.names[at].startswith(word) and fit.fit.std[at] > 0:
                where = f"joint {fit.names[at].removeprefix(word)}"
                value, std = float(fit.fit.θ[at] - model), float(fit.fit.std[at])
                is_far = abs(value) > PROOF * std
                out[effect, where] = TorqueOpinion(
                    name=effect, where=where, sizes={size: (value, std, fit.units[at])}, fall=None,
                    t=abs(value) / std, standing="named" if is_far else "unproven",
                    doubt="" if is_far else "small", is_named=False,
                )  # fmt: skip
    return out


def _is_free(o: TorqueOpinion, robot: Robot) -> bool:
    """Returns whether a robot frees the number that a friction of the torques would change."""
    size, joint = next(iter(o.sizes)), o.where.partition(" ")[2]
    stands = {f"{o.name}.{size}@{joint}", f"joint/{joint}.frictionloss"}
    return any(
        n in stands or p.where in stands
        for n in robot.file.free
        for p in robot.plant.parameters
        if p.name == n
    )


def _opinion(score: Score, standing: Standing, doubt: str) -> TorqueOpinion:
    m = score.missing
    sizes = {
        n.rpartition(".")[2].partition("@")[0]: (float(v), float(s), u)
        for n, v, s, u in zip(m.sizes, score.size, score.std, m.units, strict=True)
    }
    return TorqueOpinion(
        name=m.name, where=m.where, phrase=m.phrase, sizes={} if m.is_curve else sizes,
        fall=score.fall, t=score.t, chance=score.chance, standing=standing, doubt=doubt,
        is_named=False,
    )  # fmt: skip


def _number(o: TorqueOpinion, robot: Robot) -> str:
    """Returns the number of a robot that an effect changes: a path, or a size of the effect."""
    model, thing = robot.plant.model, o.where.partition(" ")[2]
    if o.name == "gain":
        return gain_path(model, int(model.actuator(thing).id))
    of_effect, parameters = f"{o.name}.{next(iter(o.sizes), '')}@{thing}", robot.plant.parameters
    path = (ADDED_TO | OF_TORQUES).get(o.name, of_effect).format(thing)
    if path == of_effect:
        return path if path in {p.name for p in parameters} else ""
    try:
        value_of(model, path)
    except InputError:  # a body without a name, which is called by its joint
        return ""
    return "" if any(p.where == path and p.name in robot.file.free for p in parameters) else path
