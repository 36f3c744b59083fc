"""The meaning of a fit of the windows of records, in sentences that say what to do next."""

from __future__ import annotations

import numpy as np

from identification.estimation.identifiability import in_words
from identification.estimation.metrics import output_units, relative
from identification.prediction.records_fit import RecordsFit
from identification.report.bound_words import bound_sentences
from identification.report.fit_verdict import left_by_windows
from identification.report.scale_words import describe_scale
from identification.report.step_words import std_sentence, step_sentences
from identification.report.untold_words import WEAK, cure, scale_of_forces, too_weak

MUCH = 3.0  # times the noise floor, beyond which a fit is told to lack something


def records_fit_verdict(found: RecordsFit) -> list[str]:
    """Returns sentences: is it worse than its start, did it converge, what is untold, what is left.

    That it is worse comes first, because nothing else matters then.
    """
    fit = found.model.fit
    said = _worse(found)
    said.append("The search converged." if fit.converged else "The search ran out of iterations.")
    if steps := std_sentence(found.model):
        said.append(steps)
    said += bound_sentences(found.model.plant.parameters, found.model.at_bound)
    said += _blind(found) + _weak(found) + _unknown_std(found)
    windows = sum(len(part.cut.starts) for part in fit.problem.parts)
    floor, rms = found.noise_by_unit, found.rms_by_unit
    said.append(left_by_windows(windows, found.horizon, rms, floor))
    if any(floor.values()) and relative(rms, floor) > MUCH:
        said.append(
            "That is far more than the sensors make: the model lacks something, or a column is not"
            " what the model takes it for; discover looks for what is missing."
        )
    return [
        *said,
        *describe_scale(output_units(found.records[0].log), found.model.scale),
        *step_sentences(found.model),
    ]


def _blind(found: RecordsFit) -> list[str]:
    """Returns sentences on directions that the windows tell less of than was known before."""
    names, out = found.model.fit.problem.names, []
    for direction in found.blind:
        moved = in_words(direction, names)
        one = names[int(abs(direction).argmax())]
        if "," in moved:
            out.append(
                f"The windows tell less along ({moved}) than was known before the fit; what does"
                " not change along it is known. Fix one of these, or record a motion that tells"
                f" them apart.{scale_of_forces([r.log for r in found.records if r.role == 'fit'])}"
            )
        else:
            out.append(
                f"The windows tell less of {one} than was known before the fit; fix it, or record a"
                " motion that shows it."
            )
    return out


def _weak(found: RecordsFit) -> list[str]:
    """Returns a sentence on positive parameters of which the windows tell too little."""
    space = found.model.fit.problem.prior.space
    rows = zip(found.values.items(), found.std, space.logarithmic, strict=True)
    weak = [n for (n, v), std, positive in rows if positive and std > WEAK * abs(v)]
    if not weak:
        return []
    return [f"{too_weak(weak, 'windows')} {cure(weak)}"]


def _unknown_std(found: RecordsFit) -> list[str]:
    """Returns the sentence on values that are fitted and whose std too few windows tell."""
    rows = zip(found.values, found.std, found.at_bound, strict=True)
    few = [n for n, std, at_bound in rows if np.isnan(std) and not at_bound]
    if not few:
        return []
    count = sum(len(part.cut.starts) for part in found.model.fit.problem.parts)
    one = len(few) == 1
    it, is_fitted = ("it", "is") if one else ("them", "are")
    told = (
        "the only window cannot be compared with another"
        if count == 1
        else f"too few of the {count} windows tell of {it}"
    )
    return [
        f"The value{'' if one else 's'} of {', '.join(few)} {is_fitted} fitted, but how far off"
        f" {'it' if one else 'they'} may be is not known: a std comes from how much windows differ,"
        f" and {told}. Record longer or give more logs for a std, or compare the"
        f" value{'' if one else 's'} with those of a fit of another log."
    ]


def _worse(found: RecordsFit) -> list[str]:
    """Returns a sentence where unseen records are predicted worse than by the first values."""
    if found.worse is None:
        return []
    before, after = found.unseen_rms
    percent = 100 * ((after / before) ** 2 - 1)
    return [
        "The fitted values predict what was not fitted worse than the values with which the fit"
        f" began (mean square {percent:+z.0f} %, t = {found.worse.t:z.1f}): do not use them. Fit"
        " more records, state in the robot's file what is known of the free parameters (known), or"
        " leave some of them out."
    ]
