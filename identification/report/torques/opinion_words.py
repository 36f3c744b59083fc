"""What the joints' torques say of the names of a search, and what they name first, in sentences."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, isfinite

from identification.discovery.effect_results import NamedEffect
from identification.discovery.impossible import IMPOSSIBLE
from identification.discovery.result import Discovery
from identification.discovery.second_opinion import TorqueOpinion
from identification.prediction.scoring.screening import places_of
from identification.report.words.effects import DOUBTS, describe_effect, value_with_std
from identification.report.words.errors import listed
from identification.report.words.values import phrase, without_colon
from identification.shares import decimal, fall_words, percent

SURE = 3.0  # std of both together, from which two sizes are not the same
TORQUES = "The torques of the measured motion, computed without a simulation,"
SAME = {"armature": "a", "m": "M"}  # sizes that a search calls otherwise
FRICTION = "friction, which they always fit, does not count as one"
OTHERWISE = "otherwise"  # doubt of what is proven by itself, and is in no fit
AGAINST = {  # why torques do not prove an effect
    "sign": "its size would have a sign that physics does not allow",
    "large": "its size would be larger than any that is believed",
    "body": "no body can have such a mass, centre of mass and inertia together",
    "rise": "with it data that no fit has seen are predicted no better",
    "unseen": "data that no fit has seen do not prove it",
    "chance": "all candidates counted, one of them explains as much by luck with a chance of {}",
    OTHERWISE: "with it more is left of another joint, or a curve drawn from the data explains what"
    " it leaves",
    "small": "it may be what the model has",
    **{word: DOUBTS[word] for word in (*IMPOSSIBLE, "beside")},
}  # fmt: skip


def opinion_sentences(found: Discovery) -> list[str]:
    """Returns what the joints' torques say of each name, and what they name themselves.

    There are none where nobody asked them, and one where they cannot say anything.
    """
    if found.torques_refused is None:
        return []
    if found.torques_refused:
        why = found.torques_refused
        return [f"The torques of the measured motion give no second opinion: {why}."]
    judged = [o for o in found.torques if o.is_named]
    own = [o for o in found.torques if not o.is_named]
    clauses = [*(_of_name(o, _named(o, found)) for o in judged), *_untold(found, judged)]
    if own and not _is_agreed(found):
        clauses = [_own(own, found), *clauses]
    elif own:
        clauses.append(_own(own, found))
    elif not any(o.standing == "named" for o in judged):
        which = " of their own" if judged else "" if found.named else " either"
        clauses.append(f"name no effect{which}; {FRICTION}.")
    said = [f"{'They' if k else TORQUES} {clause}" for k, clause in enumerate(clauses)]
    return [*said, *_conclusion(own, judged, found)]


def _is_agreed(found: Discovery) -> bool:
    """Returns whether torques name an effect that the search names."""
    return any(o.is_named and o.standing == "named" for o in found.torques)


def _named(o: TorqueOpinion, found: Discovery) -> NamedEffect:
    """Returns the effect of the search of which torques say something."""
    return next(n for n in found.named if n.name == o.name and o.where in places_of(n.where))


def _untold(found: Discovery, judged: Sequence[TorqueOpinion]) -> list[str]:
    """Returns a clause on names that torques cannot tell."""
    places = {(o.name, o.where) for o in judged}
    untold = [n for n in found.named if not any((n.name, w) in places for w in places_of(n.where))]
    if not untold:
        return []
    names = listed([describe_effect(n.candidate) for n in untold])
    return [f"cannot judge {names}, which is no candidate of theirs."]


def _of_name(o: TorqueOpinion, named: NamedEffect) -> str:
    """Returns a clause on an effect that the search has named."""
    which, by = f"{phrase(named.candidate.effect)}, {o.where}", _by(o)
    apart = _apart(o, named)
    sized = f", {_sizes(o)}" if o.sizes else ""
    if apart is not None:
        sized += f" ({decimal(apart, 2)} std from the size over windows)"
    if o.standing == "named":
        what = "the same"
        if apart is None or apart > SURE:
            what = f"{'a friction' if 'friction' in o.name else 'such an effect'} there too"
            what += ", with another size" if apart is not None else ""
        return f"prove {what}: {which}{sized}; {by}."
    if o.standing == "alike":
        return f"predict as well, within chance, with {which}, alone{sized}: {by}."
    if o.standing == "alone":
        return f"would prove {which}, if it were alone{sized}: {by}."
    return f"do not prove {which}{sized}: {against(o.doubt, o.chance)}; {by}."


def _own(own: Sequence[TorqueOpinion], found: Discovery) -> str:
    """Returns a clause on what torques name and the search does not."""
    first, *rest = own
    which = _with_sizes(first)
    if first.standing == "forbidden":
        return f"would name {which}, but {against(first.doubt, first.chance)}; {_by(first)}."
    alike = "; or ".join(_with_sizes(o) for o in rest if o.standing == "alike")
    others = "".join(f"; then {_with_sizes(o)}" for o in rest if o.standing != "alike")
    others = f"{alike and '; within chance as good: '}{alike}{others}"
    how = "first" if first.is_first else "too"
    return f"name {_kind(first, found)} {how}: {which}; {_by(first)}{others}."


def _kind(o: TorqueOpinion, found: Discovery) -> str:
    """Returns how what torques name lies to what the search names."""
    if any(n.name == o.name for n in found.named):
        return "the same law at another place"
    same = any(o.where in places_of(n.where) for n in found.named)
    return f"another effect{' at the same place' if same else ''}"


def _conclusion(
    own: Sequence[TorqueOpinion], judged: Sequence[TorqueOpinion], found: Discovery
) -> list[str]:
    """Returns which names only one of both supports, and what to do next."""
    if not own:
        return []
    first = own[0]
    if first.standing == "forbidden":
        return ["So something is missing that acts like it."]
    only = f"only the torques name {_called(first)}"
    if found.named and not _is_agreed(found):
        names = listed([describe_effect(n.candidate) for n in found.named])
        if any(o.standing == "alike" for o in judged):
            only = f"the torques do not tell it from {_called(first)}"
        only = f"only the search over windows names {names}, and {only}"
    free = [o for o in own if _is_one_number(o) and (o is first or o.standing == "alike")]
    return [f"So {only}. {_advice(free)}"]


def _called(o: TorqueOpinion) -> str:
    return f"{without_colon(o.phrase) or o.name.replace('_', ' ')}, {o.where}"


def _sizes(o: TorqueOpinion) -> str:
    return ", ".join(f"{n} = {value_with_std(v, s, u)}" for n, (v, s, u) in o.sizes.items())


def _with_sizes(o: TorqueOpinion) -> str:
    return ", ".join(filter(None, [_called(o), _sizes(o)]))


def _by(o: TorqueOpinion) -> str:
    """Returns by how much torques are predicted better, and how sure that is."""
    if o.fall is None:
        return f"{o.t:.1f} std from what the model has"
    return f"their mean square on data that no fit has seen {fall_words(o.fall)}, t {o.t:z.1f}"


def against(doubt: str, chance: float | None) -> str:
    """Returns in words why torques do not prove an effect, or why it is no name of theirs."""
    return AGAINST[doubt].format(percent(chance or 0.0, 2))


def _apart(o: TorqueOpinion, named: NamedEffect) -> float | None:
    """Returns how many std of both together the farthest sizes are apart; None where unknown."""
    known, thing = named.parameters, o.where.partition(" ")[2]
    far = []
    for name, (value, std, _) in o.sizes.items():
        called = SAME.get(name, name)
        other = next((known[n] for n in (called, f"{called}@{thing}") if n in known), None)
        both = hypot(std, other[1]) if other else 0.0
        if other and isfinite(both) and both > 0:
            far.append(abs(value - other[0]) / both)
    return max(far, default=None)


def _is_one_number(o: TorqueOpinion) -> bool:
    """Returns whether one number that is freed tests what torques name.

    A law with several numbers is not tested by its first one alone.
    """
    return bool(o.free) and ("/" in o.free or len(o.sizes) == 1)


def _advice(free: Sequence[TorqueOpinion]) -> str:
    """Returns what to do next about effects that only torques name, and which numbers can be."""
    if not free:
        return "The command `identification torques` tells more."
    first, *others = dict.fromkeys(_entry(o) for o in free)
    turns = f", or in its place {listed(others)}" if others else ""
    return (
        f"To decide, add {first} to the list free of the robot's file, and search again{turns}: if"
        " nothing is missing then, it was this; if the same is named again, it was not."
    )


def _entry(o: TorqueOpinion) -> str:
    """Returns a number to be freed, with a value where the model may have none to begin with."""
    value = next((v for v, *_ in o.sizes.values()), 0.0)
    given = f'with value = {value:.3g} in the table [parameters."{o.free}"]'
    if "/" not in o.free:  # of an effect, which no model has
        return f'"{o.free}" ({given})'
    # A search cannot begin at zero, where the model has no friction or no rotor.
    is_none = o.free.endswith((".frictionloss", ".armature", ".damping")) and value > 0
    return f'"{o.free}"' + (f" (where the model has zero, {given})" if is_none else "")
