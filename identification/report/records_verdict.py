"""The verdict of a discovery on several records in sentences, and what supports it."""

from __future__ import annotations

from math import inf, isfinite

from identification.prediction.result import NamedByPrediction, RecordsDiscovery
from identification.report.bound_words import bound_sentences
from identification.report.curve_nodes import curve_nodes, nodes_sentence
from identification.report.effect_words import describe_there, phrase
from identification.report.error_words import change_words, error_words
from identification.report.finding_words import describe_finding, sentence
from identification.report.refitted_words import sizes_words
from identification.report.scale_words import describe_scale
from identification.shown import verdict_of

NO_ERROR = 1e-3  # of the inputs' rms: less is not told from none
DIGITS = 3  # of errors over a horizon


@verdict_of.register
def records_verdict(found: RecordsDiscovery) -> list[str]:
    """Returns sentences: the verdict first, then what supports it."""
    bounds = bound_sentences(found.final.plant.parameters, at_bound(found))
    return [*_verdict(found), *bounds, *describe_scale(found.nominal)]


def at_bound(found: RecordsDiscovery) -> list[str]:
    """Returns the names of the nominal model's values that end on a bound in the final model.

    Values with which a search began, because its fit was worse, lie inside their bounds.
    """
    own = found.nominal.fit.problem.names
    return [name for name in found.final.at_bound if name in own]


def _verdict(found: RecordsDiscovery) -> list[str]:
    if found.verdict == "nothing missing":
        return [
            _nothing(found),
            *(sentence(describe_finding(finding)) for finding in found.findings),
        ]
    if found.verdict == "unknown effect":
        return [_unknown(found)]
    said = [_named(found, named) for named in found.named]
    said.append(_proof(found))
    said += [sentence(describe_finding(finding)) for finding in found.findings]
    return said


def _nothing(found: RecordsDiscovery) -> str:
    """Returns a sentence: nothing is missing, or no effect is named as no candidate helps."""
    before, noise = _left(found)
    tried = "no candidate lowers the error of prediction on unseen data beyond chance"
    over = f"{before} over {found.horizon:g} s"
    ratio = found.before.rms / found.noise_rms if found.noise_rms else 1.0
    if found.input_error < NO_ERROR or ratio**2 <= 1 + found.options.min_gap_share:
        return (
            f"Nothing is missing, as far as these records can tell: {tried}. It is {over}, where"
            f" the sensors make {noise}." + _rest(found)
        )
    return (
        f"No effect is named: {tried}. It is {over}, {ratio:.2g} times the {noise} that the sensors"
        f" make. {_either(found)}"
    )


def _either(found: RecordsDiscovery) -> str:
    """Says what else than an effect may make the error: the inputs, where any input moves."""
    if not isfinite(found.input_error):
        return "No input moves that could err: something is missing that no candidate explains."
    return (
        f"Either the inputs err by {100 * found.input_error:.2g} % of their rms, or something is"
        " missing that no candidate explains."
    )


def _rest(found: RecordsDiscovery) -> str:
    """Returns a sentence on how far inputs would have to err to make what sensors do not."""
    if found.input_error < NO_ERROR:
        return " The sensors alone would make it."
    if not isfinite(found.input_error):
        return ""
    return f" Inputs that err by {100 * found.input_error:.2g} % of their rms would make the rest."


def _named(found: RecordsDiscovery, named: NamedByPrediction) -> str:
    first = "Missing from the model" if named is found.named[0] else "Missing too"
    if found.verdict == "unlisted effect":
        first += ", in no catalogue and drawn from the data"
    plant = found.nominal.plant
    mine = f"{describe_there(named.effect.candidate, plant)}{_twin(named)}"
    sizes = sizes_words(named.effect)
    confidence = f"{100 * named.effect.confidence:.0f} %"
    others = [
        f"{describe_there(r.candidate, plant)} ({100 * r.confidence:.0f} %)" for r in named.rivals
    ]
    if named.one_of:
        said = (
            f"{first} is one of these, which these records do not surely tell apart:"
            f" {'; '.join([f'{mine} ({confidence})', *others])}. The first is put into the model:"
            f" {sizes}."
        )
    else:
        compared = _compared(named, found.unexplained)
        said = f"{first}: {mine}, {sizes}; confidence {confidence}{compared}."
        said += f" Less likely: {', '.join(others)}." if others else ""
    if named.effect.candidate.effect.is_curve:
        said += f" {nodes_sentence(curve_nodes(named.effect.candidate, plant))}"
    said += _agreement(found, named)
    if named.disagrees:
        said += (
            f" The named effect raises the error on {', '.join(named.disagrees)}, beyond chance."
        )
    return said


def _twin(named: NamedByPrediction) -> str:
    """Returns the other name of the same force in words; "" where there is none."""
    if named.same_as is None:
        return ""
    return (
        f' (or "{phrase(named.same_as)}": below the Coulomb friction it is the same force, and no'
        " record tells which of the two it is)"
    )


def _compared(named: NamedByPrediction, is_left: bool) -> str:
    """Returns in words what a confidence rests on."""
    if not named.compared:
        when = "said while something is left" if is_left else "ever said"
        return f", the highest that is {when}, because no rival was near enough to be refitted"
    rivals = "1 rival that was" if named.compared == 1 else f"{named.compared} rivals that were"
    return f" beside {rivals} refitted in its place"


def _agreement(found: RecordsDiscovery, named: NamedByPrediction) -> str:
    """Returns a sentence on how many unseen records it helps, without those that repeat others."""
    confirm = [r.log.name for r in found.records if r.role == "confirm"]
    distinct = [name for name in confirm if name not in found.repeats]
    helped = sum(name in named.agrees for name in distinct)
    if not distinct:
        return " All unseen records repeat what was fitted, so that they hardly confirm it."
    what = "curve" if named.effect.candidate.effect.is_curve else "named effect"
    said = f" The {what} lowers the error on {helped} of {len(distinct)} unseen records."
    if found.repeats:
        one = len(found.repeats) == 1
        said += f" {', '.join(found.repeats)} {'repeats' if one else 'repeat'} the motion of others"
        said += " and does not count." if one else " and do not count."
    return said


def _proof(found: RecordsDiscovery) -> str:
    errors = found.before.rms_by_unit, found.after.rms_by_unit
    change, (noise,) = change_words(*errors, [found.noise_by_unit], DIGITS)
    fall = 1 - (found.after.rms / found.before.rms) ** 2
    return (
        f"On records that no fit has seen, the error of prediction over {found.horizon:g} s falls"
        f" {change} (mean square {-100 * fall:+z.0f} %); the sensors make {noise}."
        f" That is {100 * found.share:z.0f} % of the power above the sensors' noise."
    )


def _unknown(found: RecordsDiscovery) -> str:
    before, noise = _left(found)
    percent = f"{100 * found.input_error:.2g}"
    needed = f"; inputs would have to err by {percent} % of their rms to make that"
    if not 0 < found.input_error < inf:  # no more than noise is left, or no input moves
        needed = ""
    return (
        "Something is missing that none of the known effects surely explains: the fitted model is"
        f" {before} off over {found.horizon:g} s on unseen data, where the sensors make"
        f" {noise}{needed}. It is not named here rather than named wrongly."
        + "".join(f" {sentence(describe_finding(finding))}" for finding in found.findings)
    )


def _left(found: RecordsDiscovery) -> tuple[str, str]:
    """Returns what the nominal model leaves on unseen data, and what the sensors make of it."""
    errors = found.before.rms_by_unit, found.noise_by_unit
    return error_words(errors, digits=DIGITS)[0], error_words(errors, "", DIGITS)[1]
