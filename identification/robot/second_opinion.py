"""The joints' torques are asked what is missing, and what they say of what a search has named."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from identification.discovery.result import Discovery
from identification.discovery.second_opinion import TorqueOpinion
from identification.errors import InputError
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
    """Returns a discovery with what the joints' torques say of its names.

    A discovery in which nothing is missing is returned as it is.

    Args:
        found: over a horizon.
        evidence: of the torques of the same records; None where they tell nothing.
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
