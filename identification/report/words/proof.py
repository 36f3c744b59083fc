"""What named effects do on unseen data, in sentences: beside the noise, and on which records.

An effect may be proven where the whole error is as small as the noise: a small part of it may
follow a law beyond chance, and the noise is estimated rather too high than too low. What the error
is beside the noise is then told as a number, and with what the effect takes away.
"""

from __future__ import annotations

from identification.discovery.effect_results import Gap, NamedEffect
from identification.discovery.result import Discovery
from identification.report.words.effects import describe_effect
from identification.report.words.errors import change_words, listed
from identification.report.words.parts import is_untouched
from identification.report.words.rest import resting
from identification.shares import HELD, change, fall_words, percent, times_estimated

NOT_FITTED = "the fit has not seen, but on which the search has decided"
EXACT_SHARE = 0.97  # a law with less is told to be inexact
ALMOST = 0.9999  # nearly all: "more than 99.9 %"


def proof_sentences(found: Discovery) -> str:
    """Returns sentences on how far the error on unseen data falls, beside the noise."""
    errors = found.errors_of(found.before), found.errors_of(found.after)
    moved, (noise, own) = change_words(*errors, [found.floor, found.sensors])
    whom = "it" if len(found.named) == 1 else "them"
    rest = f", of which the sensors cause {own} and unlogged errors of the inputs the rest"
    made = rest if found.floor_rms > found.noise_rms else ""
    of = found.over and f" of prediction{found.over}"
    square = (found.after.rms / found.before.rms) ** 2 - 1 if found.before.rms > 0 else 0.0
    is_one = found.scale is not None or len(errors[0]) == 1  # else the square has no meaning
    changed = f" (mean square {change(square)})" if is_one else ""
    data = "neither the fit nor the search has used" if is_untouched(found) else NOT_FITTED
    said = (
        f"On data that {data}, the error{of} falls {moved} with {whom} in the"
        f" model{changed}; the noise is {noise}{made}."
    )
    if is_at_noise(found, found.before):
        said += _beside_noise(found)
    elif found.share is not None:
        # Of outputs of several units one may be above its noise while the sum of all is not.
        share = min(found.share, ALMOST) if found.times_noise(found.after) > 1 else found.share
        said += f" This removes {percent(share)} of the power above the noise."
    return f"{said}{_smooth(found)}"


def is_at_noise(found: Discovery, gap: Gap) -> bool:
    """Tells whether an error is no larger than one that is said to be noise elsewhere."""
    return 0 < found.times_noise(gap) <= 1 + found.options.min_gap_share


def _beside_noise(found: Discovery) -> str:
    """Returns a sentence on named effects that take away a part of what seems to be noise."""
    before, after = (found.times_noise(gap) for gap in (found.before, found.after))
    each = [percent(n.proof.told.chance, HELD) for n in found.named]
    if len(each) > 1:
        pairs = zip(each, found.named, strict=True)
        each = [f"{chance} for {describe_effect(n.candidate)}" for chance, n in pairs]
    return (
        f" The error before was {times_estimated(before)}, which may be estimated a little too"
        f" high: with {'it' if len(each) == 1 else 'them'} the mean square"
        f" {fall_words(1 - (after / before) ** 2, HELD)}, which chance would do in"
        f" {listed(each)} of cases."
    )


def _smooth(found: Discovery) -> str:
    """Returns sentences on what the named effects explain of what smooth forces could.

    Each of several that is not exact is told by itself.
    """
    if found.smooth_share is None:
        return ""
    inexact = [
        f"{percent(n.smooth_share)} for {describe_effect(n.candidate)}"
        for n in found.named
        if len(found.named) > 1 and n.smooth_share is not None and n.smooth_share < EXACT_SHARE
    ]
    each = f" At their own joints the shares are {listed(inexact)}." if inexact else ""
    who, alone = "this effect", "it alone explains"
    if len(found.named) > 1:
        who, alone = "these effects", "they alone explain"
    return (
        " Smooth forces of any shape at the joints (over rate, position, drive or time), added to"
        f" {who}, show how much can be explained at most: {alone}"
        f" {percent(found.smooth_share)} of that.{each}"
    )


def agreement_sentences(found: Discovery, named: NamedEffect) -> str:
    """Returns sentences on the unseen records that a named effect helps.

    Those that repeat others, and those in which the robot hardly moves, do not count.
    """
    names = [e.name for e in found.errors if e.role == "confirm"]
    names = names or [e.name for e in found.errors if len(found.errors) > 1]
    still = [name for name in resting(found) if name in names]
    distinct = [name for name in names if name not in (*found.repeats, *still)]
    helped = [name for name in distinct if name in named.proof.told.agrees]
    said = ""
    if distinct:
        what = "curve" if named.candidate.effect.is_curve else "named effect"
        which = f" ({listed(helped)})" if 0 < len(helped) < len(distinct) else ""
        said = f" The {what} lowers the error on {len(helped)} of {len(distinct)} unseen records"
        if len(distinct) == 1:
            does = "lowers" if helped else "does not lower"
            said = f" The {what} {does} the error on the unseen record"
        said += f"{which}."
    elif names and still == names:
        said = " In all unseen records the robot hardly moves, so that they hardly confirm it."
    elif names:
        rest = ", or the robot hardly moves in them" if still else ""
        said = f" All unseen records repeat what was fitted{rest}, so that they hardly confirm it."
    if found.repeats and distinct:
        one = len(found.repeats) == 1
        said += f" {', '.join(found.repeats)} {'repeats' if one else 'repeat'} the motion of others"
        said += " and does not count." if one else " and do not count."
    if still and distinct:
        one = len(still) == 1
        said += f" {', '.join(still)}, in which the robot hardly moves,"
        said += " does not count." if one else " do not count."
    if worse := named.proof.told.disagrees:
        said += f" It raises the error on {', '.join(worse)} beyond chance."
    return said
