"""The meaning of a name such as `coulomb_friction.f_c@slide`, or which part of it is unknown."""

from __future__ import annotations

from collections.abc import Sequence

from identification.effects.effect import Candidate, Effect, effect_parameters
from identification.effects.laws.joint_group import SLIDE, about_names
from identification.effects.plant.jointed import JointPlant
from identification.errors import InputError, nearest, unknown_name
from identification.model.predictor import Plant

SIDES = {"before": -1, "behind": 1}  # last word of the curve's name, and where the joint is


def joints_of(candidate: Candidate) -> list[str]:
    """Returns the names of the joints on which an effect with sizes at single joints acts."""
    at_each = [size.name.partition("@")[2] for size in candidate.effect.sizes]
    return [*dict.fromkeys(filter(None, at_each))] or [candidate.where.removeprefix("joint ")]


def neighbour(word: str, joint: str, plant: Plant) -> str:
    """Returns the name of the joint that a curve reads beside its own; "" where it reads none."""
    side = SIDES.get(word.rpartition("_")[2], 0)
    if not side or not isinstance(plant, JointPlant):
        return ""
    at = int(plant.model.joint(joint).id) + side
    return str(plant.model.joint(at).name) if 0 <= at < plant.model.njnt else ""


def phrase_there(candidate: Candidate, plant: Plant) -> str:
    """Returns the words of an effect, in which a neighbouring joint has its name.

    An effect at several joints reads another neighbour at each: its words then name none.
    """
    effect, joints = candidate.effect, joints_of(candidate)
    phrase = effect.phrase or effect.name.replace("_", " ")
    name = neighbour(effect.name, joints[0], plant) if len(joints) == 1 else ""
    return phrase.replace("of the joint be", f"of {name}, the joint be") if name else phrase


# What words that name no effect mean most likely.
USUAL = {
    "friction": "coulomb_friction",
    "dry_friction": "coulomb_friction",
    "stiction": "stribeck_friction",
    "static_friction": "stribeck_friction",
}
# A friction that grows with speed is no effect: every joint of a model has it as a number.
DAMPING = ("viscous_friction", "viscous_damping", "viscous", "damping")
NEAR = 0.5  # share of letters: the number and the kind of joint may be missing in a name


def means_effect(name: str, effects: Sequence[Effect]) -> bool:
    """Returns whether a name is meant as a number of an effect, and not as a path in the model."""
    near = nearest(effect_of(name), (e.name for e in effects))
    return "/" not in name and ("@" in name or near is not None)


def effect_of(name: str) -> str:
    """Returns the part of a name such as `coulomb_friction.f_c@slide` that is the effect's."""
    return name.partition("@")[0].partition(".")[0]


def unknown_effect(
    what: str, name: str, effects: Sequence[Effect], likely: str | None = None
) -> InputError:
    """Returns the error of an unknown effect; it lists the good names and explains `slide_`."""
    names = [e.name for e in effects]
    note = about_names(name, names)
    text = str(unknown_name(what, name, names, likely or nearest(effect_of(name), names)))
    return InputError(f"{text}.{note}" if note else text)


def unknown_number(name: str, effects: Sequence[Effect], is_free: bool = True) -> InputError:
    """Returns the error of a name that is no number of an effect; it says what is wrong.

    Args:
        name: the unknown one.
        effects: the known ones.
        is_free: whether it shall be fitted: only a size can be, and a shape is not suggested.
    """
    head, (whole, at, place) = effect_of(name), name.partition("@")
    size = whole[len(head) + 1 :]
    effect = next((e for e in effects if e.name == head), None)
    every = [n for e in effects for n in _numbers(e, is_free)]
    if effect is None:
        if is_free and (path := damping_of(name, effects)) is not None:
            return InputError(
                f"{name!r} is no number of an effect: viscous friction is a number that every joint"
                f" of a model has; did you mean {path!r}?"
            )
        what = "effect" if head == name else f"effect in {name!r}:"
        error = unknown_effect(what, head, effects, _meant(name, every))
        if not is_free or head != name or head in USUAL:
            return error
        return InputError(
            f"{name!r} is neither a path into the model, such as joint/NAME.damping, nor a number"
            f" of an effect: {error}"
        )
    numbers = _numbers(effect, is_free)
    # of a robot with slides and hinges each kind has effects of its own
    plain = head.removeprefix(SLIDE)
    both = [n for n in every if at and effect_of(n).removeprefix(SLIDE) == plain]
    kin = [n for n in both if n.partition(".")[2].startswith(f"{size}@" if size else "")]
    numbered = [n for n in kin if n.endswith(f"@{place}")] or [
        n for n in both if n.endswith(f"@{place}") and effect_of(n) != head
    ]
    if numbered:
        return unknown_name(f"number of {head}:", name, numbered, nearest(name, numbered, NEAR))
    if at and any(n.startswith(f"{head}.{size}@") for n in numbers):
        known = {at[1:]: where.partition(" ")[0] for where, at in effect.places.items() if at}
        (kind,) = set(known.values())
        at_all = {n.partition("@")[2]: n for n in kin}
        near = nearest(place, at_all)
        likely = at_all[near] if near and near not in known else None
        return unknown_name(f"{kind} in {name!r}:", place, known, likely)
    return unknown_name(f"number of {head}:", name, numbers, _meant(name, numbers))


def damping_of(name: str, effects: Sequence[Effect]) -> str | None:
    """Returns the path of a joint's damping in the model, where a name means that; else None."""
    if effect_of(name).removeprefix(SLIDE) not in DAMPING:
        return None
    joints = dict.fromkeys(where.removeprefix("joint ") for e in effects for where in e.places
                           if where.startswith("joint "))  # fmt: skip
    joint = nearest(name.partition("@")[2], joints) or next(iter(joints), None)
    return f"joint/{joint}.damping" if joint else None


def _numbers(effect: Effect, is_free: bool) -> list[str]:
    """Returns the names of an effect's numbers, or only of those that can be fitted: its sizes."""
    sizes = {s.name for s in effect.sizes}
    return [p.name for p in effect_parameters(effect) if p.symbol in sizes or not is_free]


def _meant(name: str, numbers: Sequence[str]) -> str | None:
    """Returns the number that is meant if the name of the effect is wrong or no number is given.

    Its effect is the nearest of those that have such a number there, else of those that act there.
    """
    head, (_, at, place) = effect_of(name), name.partition("@")
    numbered = [n for n in numbers if at and n.endswith(f"@{place}")]
    if at and not numbered:  # the place is misspelt too
        near = nearest(place, {n.partition("@")[2] for n in numbers})
        numbered = [n for n in numbers if near and n.endswith(f"@{near}")]
        place = near or place
    numbered = numbered or list(numbers)
    # without an effect, a size and a place are the whole name
    alone = [n for n in numbered if at and n.partition(".")[2] == f"{head}@{place}"]
    if at and not alone:  # the place is unknown
        alone = [n for n in numbered if n.partition(".")[2].startswith(f"{head}@")]
    if alone:
        return nearest(name, alone, 0.0)
    same = [n for n in numbered if n.partition(".")[2] == name[len(head) :].lstrip(".")]
    usual = [n for n in numbered if effect_of(n).removeprefix(SLIDE) == USUAL.get(head)]
    if usual and not same:
        return usual[0]
    for some in (same, numbered):
        if (found := nearest(name, some, NEAR)) is not None:
            return found
    heads = sorted({effect_of(n) for n in numbered}, key=len)
    near = nearest(head, heads) or next((h for h in heads if head in h), None)
    return next((n for n in numbered if effect_of(n) == near), None)
