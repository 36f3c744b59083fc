"""The verdict of a discovery in sentences, and what supports it."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, inf, isfinite

from identification.discovery.effect_results import RejectedEffect
from identification.discovery.findings.finding import FindingKind
from identification.discovery.findings.records_evidence import UnprovenEffect
from identification.discovery.result import Discovery
from identification.quantities import held, quantity
from identification.report.discovery.finding_words import describe_finding, sentence
from identification.report.discovery.horizon_gap import find_gap
from identification.report.discovery.longer_horizon import longer_sentences
from identification.report.discovery.missing_place import find_place
from identification.report.discovery.named_words import basis_sentence, named_sentences
from identification.report.discovery.needed_forces import MUCH, NeededForce, needed_sentences
from identification.report.discovery.nothing_words import NOISIER, errors_left, nothing_sentence
from identification.report.discovery.shown_words import hiding
from identification.report.discovery.straight_curves import (
    limit_of_named,
    line_of_named,
    lines_needed,
)
from identification.report.discovery.unseen_motion import unseen_motion
from identification.report.fit.untold_words import bound_sentences
from identification.report.torques.opinion_words import opinion_sentences
from identification.report.words.effects import (
    describe_chance,
    describe_effect,
    describe_rejected,
    difference_sentences,
    none_explains,
)
from identification.report.words.errors import change_words, describe_scale, error_words, listed
from identification.report.words.parts import unseen_of
from identification.report.words.proof import is_at_noise, proof_sentences
from identification.report.words.rest import rest_sentences, resting
from identification.runtime.progress import duration
from identification.shares import (
    HELD,
    fall_words,
    percent,
    ratio_of,
    times,
    times_estimated,
    times_noise,
)
from identification.storage.shown import verdict_of

SOUGHT = {  # what the moves that the time limit ends seek, by their names
    "add_effect": "the next effect",
    "add_yielding_friction": "a friction that yields before it slips",
    "add_set": "sets of several effects",
    "add_curve": "curves of the data",
    "add_pair": "pairs of effects",
    "add_deviants": "parts that deviate from the others",
}


@verdict_of.register
def discovery_verdict(found: Discovery) -> list[str]:
    """Returns sentences: the verdict first, then what supports it."""
    bounds = bound_sentences(found.final.plant.parameters, found.at_bound)
    still = rest_sentences(resting(found), found.run is not None)
    told = [*still, *_noisier(found), *difference_sentences(found), *bounds]
    return [*_verdict(found), *_cut_short(found), *opinion_sentences(found), *told]


def further_sentences(found: Discovery) -> list[str]:
    """Returns what a verdict rests on and what may stay hidden: a page folds it."""
    return [
        *(basis_sentence(found, named) for named in found.named),
        *filter(None, ["" if found.unexplained else hiding(found.hidden)]),
        *describe_scale(found.outputs, found.scale),
    ]


def _verdict(found: Discovery) -> list[str]:
    if found.verdict == "nothing missing":
        return [nothing_sentence(found), *longer_sentences(found), *_findings(found)]
    if found.verdict == "unknown effect":
        return _unknown(found)
    plant = found.final.plant
    said = [
        named_sentences(found, named)
        + line_of_named(named, plant)
        + limit_of_named(named, found.final)
        for named in found.named
    ]
    said.append(proof_sentences(found))
    if found.unexplained:
        said.append(_unexplained(found))
    else:  # how the search began, where the fit without effects was worse
        said += _findings(found)
    if found.hidden and not found.unexplained:
        said.append("Nothing else is missing that this log shows.")
    return said


def _cut_short(found: Discovery) -> list[str]:
    """Returns the sentence that says what the time limit ended, and how to go on."""
    if not found.cut_short:
        return []
    limit = duration(60 * found.options.max_minutes)
    sought = listed([SOUGHT[name] for name in found.cut_short])
    rest = (
        "What is named is proven as always, but more may be missing"
        if found.named
        else "Effects that it has not tried may explain the error"
    )
    return [
        f"The time limit of {limit} ended the search while it sought {sought}. {rest};"
        " give more time by --minutes or max_minutes."
    ]


def _noisier(found: Discovery) -> list[str]:
    """Returns a sentence on each output that is noisier than the others of its unit.

    Where something is missing that nothing explains, it may be what makes that noise.
    """
    out: list[str] = []
    if found.verdict == "unknown effect":
        return out
    for name, noise in found.noise_by_output.items():
        unit = found.outputs[name]
        others = [
            s for other, s in found.noise_by_output.items()
            if other != name and found.outputs[other] == unit
        ]  # fmt: skip
        rms = hypot(*others) / len(others) ** 0.5 if others else inf
        if noise > NOISIER * rms > 0:
            size = quantity(noise, unit=unit)
            out.append(
                f"The noise of {name} is {size}, {times(noise / rms)} that of the other outputs"
                " of its unit."
            )
    return out


def _findings(found: Discovery) -> list[str]:
    """Returns a sentence on each thing that the final model leaves.

    What effects that are not named would leave is no error of a model that is told of.
    """
    unnamed, likeliest = found.verdict == "unknown effect", _likeliest(found)
    key = likeliest.candidate.key if likeliest else None  # which has a sentence of its own
    told = []
    for finding in found.findings:
        e = finding.evidence
        if isinstance(e, UnprovenEffect) and (e.name, e.where) == key:
            continue
        if not (unnamed and finding.kind is FindingKind.REMAINING_ERROR):
            told.append(sentence(describe_finding(finding)))
    return told


def _likeliest(found: Discovery) -> RejectedEffect | None:
    """Returns the likeliest effect of those that were tried and not believed, or None."""
    tried = [
        r for r in found.rejected
        if isfinite(r.evidence) and r.proof.told.fall > 0 and not r.candidate.effect.is_curve
    ]  # fmt: skip
    return max(tried, key=lambda r: r.evidence, default=None)


def _likeliest_sentences(found: Discovery) -> list[str]:
    """Returns the sentence on the likeliest effect that was tried, with its size; none without."""
    best = _likeliest(found)
    return [] if best is None else [f"The likeliest is {describe_rejected(best, found)}."]


def _unknown(found: Discovery) -> list[str]:
    """Returns paragraphs on something missing that no known effect explains.

    They say how much it is, what is likeliest, which force at which place would do it, what else
    was left, and what is different in a record.
    """
    tried = len({s.candidate.effect.name for s in found.scores})
    left, noise, _ = errors_left(found)
    ratio = found.times_noise(found.before)
    times = f", {held(ratio)} times the sensors' noise of {noise}" if isfinite(ratio) else ""
    needed = ""
    if found.unlogged is None and 0 < found.input_error < inf:
        size = ratio_of(found.input_error, "their rms")
        needed = f"; the inputs would have to err by {size} to cause this"
    place, gap = [], find_gap(found)
    forces = gap.needed.forces if gap else ()
    if (at := find_place(found)) is not None:
        figure = "" if found.horizon is None else "; see the figure"  # a free run has none of it
        place.append(f"{sentence(str(at)).removesuffix('.')}{figure}.")
    paragraphs = [
        [
            f"Something is missing that {none_explains(tried)}: the error of the fitted model on"
            f" unseen data{unseen_of(found)} is {left}{found.over}{times}{needed}.",
            "The program gives no name rather than a wrong one.",
        ],
        unseen_motion(found),
        [*_likeliest_sentences(found), *_doubtful(found)],
        [
            *place,
            *needed_sentences(forces),
            *lines_needed(found),
            *_any_forces(found, forces),
        ],
        _findings(found),
        [sentence(describe_finding(f)) for f in found.located],
    ]
    return [" ".join(each) for each in paragraphs if each]


def _any_forces(found: Discovery, forces: Sequence[NeededForce]) -> list[str]:
    """Returns the sentence that says at which joint some force is missing, whatever its law is.

    A force that explains more, because it is finer, says it better.
    """
    shares = found.smooth_by_joint
    most = max(shares.values(), default=0.0)
    if not shares or (forces and forces[0].fall > most):
        return []
    which = "whether it follows the rate, the position, the drive or the time, or two of these"
    if most < MUCH:
        return ["No smooth force at one joint would explain much of the fitted error: the best one"
                f" {percent(most)}, {which}."]  # fmt: skip
    each = [f"{percent(share)} at {joint}" for joint, share in shares.items() if share > 0]
    return [f"A force at one joint would explain a part of the fitted error, {which}:"
            f" {listed(each)}."]  # fmt: skip


def _doubtful(found: Discovery) -> list[str]:
    """Returns the sentence that says how far effects without a sure name predict together."""
    if found.doubtful is None:
        return []
    of_each = found.errors_of(found.before), found.errors_of(found.doubtful)
    moved, _ = change_words(*of_each, [found.floor])
    return [
        f"Effects that were proven, but whose names are not sure, together take this error {moved}:"
        " they stand among those that are not believed."
    ]


def _unexplained(found: Discovery) -> str:
    """Returns the paragraph on what is left after the named effects."""
    findings = _findings(found)
    more = "named effect" if len(found.named) == 1 else "named effects"
    ratio = found.times_noise(found.after)
    noise = times_estimated(ratio) if is_at_noise(found, found.after) else times_noise(ratio)
    times = f", {noise}" if 1 < ratio < inf else ""
    (left,) = error_words([found.errors_of(found.after)])
    return " ".join(
        [
            f"Something is left that no known effect surely explains: with the {more} in the model,"
            f" the error on unseen data{unseen_of(found)} is still {left}{found.over}{times}.",
            *_likeliest_sentences(found),
            *findings,
            *_nearest(found),
        ]
    )


def _nearest(found: Discovery) -> list[str]:
    """Returns a sentence on what was refitted, is beyond chance, and is not named."""
    if (nearest := found.nearest) is None:
        return []
    told = nearest.proof.told
    return [
        f"The nearest candidate is {describe_effect(nearest.candidate)}: with it each next unseen"
        f" sample is predicted better ({describe_chance(told)}), and the mean square of the free"
        f" run {fall_words(told.fall, HELD)}. It is too small to matter, or another effect is"
        " likelier."
    ]
