"""Fitted effects in words: where they act, how large they are, and what speaks for them."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite, isinf, isnan
from typing import TYPE_CHECKING

from identification.errors import InputError
from identification.quantities import probability, quantity
from identification.report.words.values import in_record, phrase, without_colon
from identification.shares import fall_words, percent

if TYPE_CHECKING:  # a search is slow to import, and a page may tell of a model alone
    from identification.discovery.effect_results import (
        NamedEffect,
        Outside,
        Proof,
        RejectedEffect,
        Rival,
    )
    from identification.discovery.options import DiscoveryOptions
    from identification.discovery.result import Discovery
    from identification.effects.effect import Candidate, Effect
    from identification.model.predictor import Plant


FEW = 0.01  # a chance above it is told as a share, and not as a power of ten
# Number of a joint or body to which the size of an effect is added, by the effect's name.
ADDED_TO = {
    "coulomb_friction": "joint/{}.frictionloss", "stiffness": "joint/{}.stiffness",
    "rotor_inertia": "joint/{}.armature", "mass_mismatch": "body/{}.mass",
}  # fmt: skip
SIGNIFICANCE = 0.01  # where the options of a search are not at hand
SCATTERS = "its gain differs too much from block to block of the data that decide"
NOT_TOLD = "(std not known, because too few data depend on it)"
DOUBTS = {
    "numbers": "its gain is too small for so many parameters",
    "chance": "its gain on the data that decide may be luck",
    "lengths": "windows of some length are predicted worse with it",
    "record": "a record is predicted worse with it",
    "little": "it removes too little of the error of any output to matter",
    "size": "its size is not known well enough to differ from zero",
    "bound": "its size ends on the largest value that is believed, so that it stands for something"
    " else",
    "exchange": "if the other records are fitted instead, it predicts a record worse, or all of"
    " them on average",
    "smooth": "a smooth force of a joint explains as much, and it adds little to that",
    "neighbour": "beside it a force drawn from the data explains much of what the two explain",
    "gap": "it removes less than half of the power above the noise, and something is left",
    "odds": "other effects in its place are together likelier than it",
    "further": "another law is surer, and smooth forces of the joint explain more than this one",
    "beside": "it was found beside an effect that has no sure name",
    "differ": "it explains the fitted records and makes unseen ones much worse, so that the records"
    " differ in something that it stands for",
    "steps": "the error of the simulation's steps makes half of what it explains, or more",
    "mass": "the body would lose half or more of the mass in the model's file, and no drawing is so"
    " wrong",
    "gain": "the gain would leave the range of 0.5 to 1.5 times its value within a record",
    "command": "the outputs would move before the command of their servo",
}


def none_explains(tried: int) -> str:
    """Returns that no known effect explains something, behind "that" or before "it"."""
    if tried == 1:
        return "the one known effect that was tried does not surely explain"
    return f"none of the {tried} known effects surely explains"


def describe_effect(candidate: Candidate) -> str:
    """Returns an effect and its place in words."""
    return f"{phrase(candidate.effect)}, {candidate.where}"


def describe_there(candidate: Candidate, plant: Plant) -> str:
    """Returns an effect and its place in words, in which a neighbouring joint has its name."""
    from identification.effects.named import phrase_there  # slow to import

    return f"{without_colon(phrase_there(candidate, plant))}, {candidate.where}"


def value_with_std(value: float, std: float, unit: str, like: float = 0.0) -> str:
    """Returns a value and its std [unit] in words, also where the std is not known.

    The std is NaN where too few data tell of it, and inf where none feel it.
    """
    if isinf(std):
        return f"{quantity(value, unit=unit, like=like)}, not felt"
    said = quantity(value, std, unit, like)
    return f"{said} {NOT_TOLD}" if isnan(std) else said


def number(effect: Effect, name: str, value: float, std: float, unit: str) -> str:
    """Returns a size or shape with its std [unit]; a power is no share, and not told in percent."""
    is_power = not unit and any(s.name == name for s in effect.shapes)
    return value_with_std(value, std, unit, like=float(is_power))


def describe_sizes(found: NamedEffect | RejectedEffect | Rival, plant: Plant | None = None) -> str:
    """Returns sizes and shapes of a fitted effect with std, but no shape that no data tell.

    Where a size is added to a number that the plant's model has, it says that number too. Of a
    curve, whose numbers are a figure, it returns the largest force of its nodes. It returns "" of a
    rival whose numbers are not known.
    """
    effect, shown = found.candidate.effect, shown_parameters(found)
    if not shown:
        return ""
    if effect.is_curve:
        value, std, unit = shown[largest_known(shown)]
        return f"up to {quantity(abs(value), std, unit)} at one of its {len(effect.sizes)} nodes"
    about = effect.about
    said = ", ".join(
        say_choice(found.candidate, name, told[0])
        or (f"{name} not felt" if isinf(told[1]) else f"{name} = {number(effect, name, *told)}")
        + (f" ({about[name]})" if about.get(name) else "")
        for name, told in {in_record(n, {}): v for n, v in shown.items()}.items()
    )
    has = "" if plant is None else _already(found.candidate, plant)
    return f"{said}, in addition to the {has} of the model" if has else said


def _already(candidate: Candidate, plant: Plant) -> str:
    """Returns the number of the model to which an effect at one place adds; "" without one."""
    from identification.effects.laws.joint_group import SLIDE  # slow to import
    from identification.effects.plant.jointed import JointPlant
    from identification.model.tied import value_of

    name = candidate.effect.name.removeprefix(SLIDE)
    (size, *_) = candidate.effect.sizes
    at = candidate.effect.places[candidate.where].removeprefix("@")
    if not isinstance(plant, JointPlant) or name not in ADDED_TO or not at:
        return ""
    try:
        value = value_of(plant.model, ADDED_TO[name].format(at))
    except InputError:  # a body without a name, which is called by its joint
        return ""
    return quantity(value, unit=size.unit) if value else ""


def shown_parameters(
    found: NamedEffect | RejectedEffect | Rival,
) -> dict[str, tuple[float, float, str]]:
    """Returns the sizes and shapes of a fitted effect that tell something of the robot.

    Shapes that no data tell, and those of one log alone, are left out.
    """
    shapes = {s.name: s for s in found.candidate.effect.shapes}
    return {
        name: each
        for name, each in found.parameters.items()
        if name not in shapes
        or (not shapes[name].of_log and (bool(shapes[name].words) or isfinite(each[1])))
    }


def largest_known(parameters: Mapping[str, tuple[float, float, str]]) -> str:
    """Returns the name of the largest value whose std is known, or of the largest of all."""
    known = {n: v for n, (v, std, _) in parameters.items() if 0 < std < abs(v)}
    of = known or {n: v for n, (v, *_) in parameters.items()}
    return max(of, key=lambda n: abs(of[n]))


def say_choice(candidate: Candidate, name: str, value: float) -> str:
    """Returns in words what a shape says that is a choice, such as a side; "" where it is none."""
    words = next((s.words for s in candidate.effect.shapes if s.name == name), ())
    return words[round(value)] if words and 0 <= round(value) < len(words) else ""


def difference_sentences(found: Discovery) -> list[str]:
    """Returns a sentence on each thing that differs between records and is no effect."""
    from identification.effects.effect import BY_RECORD  # slow to import

    said = []
    for d in found.differences:
        effect, (where, is_split, _) = d.candidate.effect, d.candidate.where.partition(BY_RECORD)
        each = [
            f"{in_record(name, {})} = {quantity(value, std, d.unit)}"
            for name, (value, std) in d.values.items()
        ]
        if is_split:
            how_much = f"{quantity(d.spread, unit=d.unit)} between two of them"
        else:
            how_much = quantity(max(abs(value) for value, _ in d.values.values()), unit=d.unit)
            each += [f"{size.name} is {size.about}" for size in effect.sizes]
        values = f"by {how_much} at most ({'; '.join(each)})"
        said.append(
            f"{phrase(effect).capitalize()}, {where}: {values}. In the model each record has its"
            " own value; this is no effect of the robot."
        )
    return said


def describe_next(found: Discovery) -> str:
    """Returns the best candidate that was not refitted, where none was refused; "" without one."""
    if found.rejected or found.next_best is None:
        return ""
    best, luck = found.next_best
    why = f"chance {luck:.2g} that one of {len(found.remaining)} does as well by luck"
    if luck < found.options.significance:
        why = "beyond chance, but its size has the wrong sign or is larger than physics admits"
    beside = " beside what is named" if found.named else ""
    return (
        f"Next best{beside}, and not refitted: {describe_effect(best.candidate)}, gain"
        f" {best.explains:z.3g}, {why}."
    )


def describe_rejected(rejected: RejectedEffect, found: Discovery) -> str:
    """Returns a rejected effect in a line: its size, what it does on unseen data, and why not."""
    proof, plant = rejected.proof, found.final.plant
    why = describe_doubt(rejected, found.options)
    told = proof.told
    # A few windows that err by far make the mean square; blocks of windows make t.
    but = ", but most of the data are predicted worse" if told.fall > 0 and told.t < 0 else ""
    return (
        f"{describe_there(rejected.candidate, plant)}: {describe_sizes(rejected, plant)};"
        f" {_where_told(proof)} the mean square {fall_words(told.fall, 3)}{but}"
        f" (t = {told.t:z.1f}, chance {chance_words(told.chance)}){why and f'; {why}'}"
    )


def describe_doubt(rejected: RejectedEffect, options: DiscoveryOptions) -> str:
    """Returns in words why an effect is not believed; "" where no number of its own says so."""
    proof = rejected.proof
    why = doubt_words(rejected.doubt, rejected.luck, options.significance)
    if rejected.doubt is None and rejected.bic_gain <= 0:
        why = DOUBTS["numbers"]
    elif rejected.doubt is None and proof.fall <= 0:
        why = "it does not predict unseen data better"
    elif rejected.doubt is None and proof.fall <= options.min_fall:
        why = "it removes too little of the error to matter"
    if rejected.doubt == "differ" and proof.disagrees:
        why += f" (worse: {', '.join(proof.disagrees)})"
    if rejected.outside is not None:
        why = "; ".join(filter(None, [why, f"likelier is {describe_outside(rejected.outside)}"]))
    return why


def doubt_words(doubt: str | None, luck: float, asked: float = SIGNIFICANCE) -> str:
    """Returns what a word of doubt says, with the chance of luck; "" without a word.

    Args:
        doubt: the word.
        luck: the chance that one of all that were tried gains as much by luck.
        asked: below which chance a gain is none by luck.
    """
    said = DOUBTS.get(doubt or "", "")
    if doubt == "chance" and luck < asked:
        return SCATTERS
    if doubt == "chance" and isfinite(luck):
        said += f" (chance {chance_words(luck)}, all effects that were tried counted)"
    return said


def describe_chance(proof: Proof) -> str:
    """Returns in words how far unseen samples are from chance, and by which test."""
    return f"t = {proof.t:z.1f}, chance {chance_words(proof.chance)} by {proof.test}"


def chance_words(chance: float) -> str:
    """Returns the chance of a gain as large as this by luck."""
    return f"{chance:.2g}" if chance > FEW else probability(chance)


def describe_gains(named: NamedEffect) -> str:
    """Returns in words what a named effect gains on fitted samples, and on those told of."""
    told, fitted = named.proof.told, f"BIC gain {named.bic_gain:z.4g} on fitted samples"
    if not isfinite(named.bic_gain):
        fitted = f"evidence {named.evidence:z.4g} on the windows that decide"
    higher = f" log likelihood {told.gain:+z.4g}," if isfinite(told.gain) else ""
    return f"{fitted}; {_where_told(named.proof)}{higher} {describe_chance(told)}"


def _where_told(proof: Proof) -> str:
    """Returns on which data something is told."""
    return "on unseen data" if proof.untouched is None else "on untouched data"


def describe_outside(outside: Outside) -> str:
    """Returns in words a curve that no catalogue lists, and how likely it is."""
    link = "at" if outside.along == "time" else "of"
    return (
        f"some force that follows the {outside.along} {link} {outside.where}, by a law that is in"
        f" no catalogue ({percent(outside.confidence)})"
    )
