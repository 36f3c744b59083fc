"""What the joints' torques say of the names of a search, in sentences."""

from __future__ import annotations

from math import hypot

from identification.discovery.effect_results import NamedEffect
from identification.discovery.result import Discovery
from identification.discovery.second_opinion import TorqueOpinion
from identification.report.effect_words import value_with_std
from identification.report.value_words import phrase
from identification.shares import fall_words

SURE = 3.0  # std of both together, from which two sizes are not the same


def opinion_sentences(found: Discovery) -> list[str]:
    """Returns a sentence on each effect of which the joints' torques say something."""
    named = {n.candidate.key: n for n in found.named}
    return [_sentence(o, named.get((o.name, o.where))) for o in found.torques]


def _sentence(o: TorqueOpinion, named: NamedEffect | None) -> str:
    said = phrase(named.candidate.effect) if named else o.name.replace("_", " ")
    sizes = ", ".join(f"{n} = {value_with_std(v, s, u)}" for n, (v, s, u) in o.sizes.items())
    by = f"{o.t:.1f} std from what the model has"
    if o.fall is not None:
        by = f"their mean square on data that no fit has seen {fall_words(o.fall)}, t {o.t:z.1f}"
    which = f"{said}, {o.where}"
    if o.is_named and o.is_proven:
        what = "the same"
        known = named.parameters if named else {}
        pairs = [(o.sizes[n], known[n]) for n in o.sizes if n in known]
        if any(abs(a - b) > SURE * hypot(s, t) for (a, s, _), (b, t, _) in pairs):
            kind = "a friction" if "friction" in o.name else "such an effect"
            what = f"{kind} there too, with another size"
        return (
            f"The torques of the measured motion, computed without a simulation, prove {what}:"
            f" {which}, {sizes}; {by}."
        )
    if o.is_named:
        return (
            "The torques of the measured motion, computed without a simulation, do not prove"
            f" {which}: {by}. They may tell too little, or the name may be wrong."
        )
    return (
        "The torques of the measured motion, computed without a simulation, name another effect"
        f" first: {which}, {sizes}; {by}. The command `identification torques` tells more."
    )
