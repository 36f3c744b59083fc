"""The meaning of a fit, in sentences that say what to do next."""

from __future__ import annotations

from math import isnan, nan
from typing import TYPE_CHECKING

import numpy as np

from identification.estimation.fit import Fit
from identification.estimation.metrics import output_units, relative
from identification.report.fit.fitted_values import first_few, std_sentence, step_sentences
from identification.report.fit.step_words import free_run_steps, part_of_steps, steps_answer
from identification.report.fit.untold_words import (
    WEAK,
    bound_sentences,
    cure,
    identifiable_sentences,
    too_weak,
    weak_sentences,
)
from identification.report.fit.window_words import (
    blind_sentences,
    count_windows,
    few_sentences,
    left_by_windows,
)
from identification.report.words.errors import describe_scale, error_words, times_words
from identification.report.words.parts import records_words
from identification.report.words.rest import is_all_at_rest
from identification.shares import change, times_noise

if TYPE_CHECKING:  # both are slow to import
    from identification.prediction.records_fit import RecordsFit
    from identification.windows.window_estimate import WindowEstimate

# A residual above this multiple of the noise floor is more than noise; the floor itself is an upper
# bound of the noise that errs by a few percent, and by `FLOOR`/√n of n samples: 8 % of 400.
ABOVE = 1.2
FLOOR = 1.6  # of white noise: std of ln(floor) times √n, within 5 % from 60 to 4000 samples
SURE = 3.0  # such std, for a white residual that shows nothing but its size
HOLDS = 1.2  # a fit holds on unseen data up to this multiple of the residual that is expected there
GROWN = 10.0  # a free run that errs by more than this multiple of the fitted residual has diverged
LEVEL = 0.01  # significance of the tests of the residual: one false alarm in a hundred
REST = "but there the robot hardly moves, so that this proves little"
CONVERGED = {True: "The search converged.", False: "The search ran out of iterations."}


def error_over_noise(fit: Fit | RecordsFit) -> float:
    """Returns the error on unseen data over the sensors' noise; NaN where the noise is not known.

    A free run strays on unseen data by small errors of its values: there the fitted data count,
    unless what was fitted does not hold.
    """
    if isinstance(fit, Fit):
        floor = fit.floor_by_unit
        errors = fit.rms_by_unit if _holds(fit) else fit.validation_rms_by_unit or {}
    else:
        floor, errors = fit.noise_by_unit, fit.unseen_by_unit
    return relative(errors, floor) if all(floor.values()) else nan


def _holds(fit: Fit) -> bool:
    """Returns whether no unseen data contradict what was fitted along a free run."""
    there, expected = fit.validation_rms_by_unit, fit.validation_expected_by_unit
    return not (there and expected) or relative(there, expected) < HOLDS


def most_of_noise(fit: Fit | RecordsFit) -> float:
    """Returns the multiple of the noise floor up to which an error is noise.

    The floor of few samples errs by more, which a residual along a free run that is white leaves
    open. One that is not says itself that it is no noise.
    """
    if not isinstance(fit, Fit) or not _holds(fit) or coloured_outputs(fit):
        return ABOVE
    return max(ABOVE, float(np.exp(SURE * FLOOR / np.sqrt(len(fit.residual)))))


def judged_on(fit: Fit | RecordsFit) -> str:
    """Returns of which data the error is by which a fit is judged."""
    if isinstance(fit, Fit):
        return "the fitted data" if _holds(fit) else "unseen data"
    return f"unseen data ({_names(fit, 'confirm')})"


def _names(fit: RecordsFit, role: str) -> str:
    return records_words([r.log.name for r in fit.records if r.role == role])


def answer_sentence(fit: Fit | RecordsFit, is_better: bool = True) -> str:
    """Returns in one sentence whether the model explains the log.

    Args:
        fit: that has ended.
        is_better: whether unseen data do not speak for the values with which it began.
    """
    ratio = error_over_noise(fit)
    if isnan(ratio):
        return "Whether the model explains the log is not known: the log shows no sensor noise."
    of_what = f"its error on {judged_on(fit)} is {times_noise(ratio)} of the sensors"
    most = most_of_noise(fit)
    if not ratio <= most:
        part = part_of_steps(fit, ratio, most)
        if part != "no":
            return steps_answer(fit, part, of_what)
        return (
            f"Something is missing from the model, or a column is not what it expects: {of_what};"
            " discover looks for what is missing."
        )
    if rests(fit):
        known = "Whether the model explains a motion that was not fitted is not known"
        return f"{known}: {of_what}, {REST}."
    if not is_better:
        return f"The log does not show that anything is missing: {of_what}."
    return f"The model with the fitted values explains the log: {of_what}."


def rests(fit: Fit | RecordsFit) -> bool:
    """Returns whether the robot hardly moves in all data by which a fit is judged."""
    return not isinstance(fit, Fit) and is_all_at_rest(fit.records)


def fit_verdict(fit: Fit | RecordsFit) -> list[str]:
    """Returns sentences: did the search converge, what is known, is it enough, is it confirmed."""
    if not isinstance(fit, Fit):
        return _of_records(fit)
    if fit.stopped:  # a search that was stopped says nothing of the model
        return search_sentences(fit)
    return [
        *search_sentences(fit), *_begun(fit), *identifiable_sentences(fit), *_enough(fit),
        *free_run_steps(fit), *_unseen(fit),
    ]  # fmt: skip


def _of_records(fit: RecordsFit) -> list[str]:
    model, floor, rms = fit.model, fit.noise_by_unit, fit.rms_by_unit
    # positive parameters of which the windows tell too little
    rows = zip(fit.values.items(), fit.std, model.fit.problem.prior.space.logarithmic, strict=True)
    weak = [n for (n, v), std, positive in rows if positive and std > WEAK * abs(v)]
    said = [
        *_worse(fit),  # first, because nothing else matters then
        CONVERGED[fit.converged],
        *filter(None, [std_sentence(model)]),
        *bound_sentences(model.plant.parameters, model.at_bound),
        *blind_sentences(fit),
        *([f"{too_weak(weak, 'windows')} {cure(weak)}"] if weak else []),
        *few_sentences(fit),
        left_by_windows(count_windows(fit), fit.horizon, rms, floor, _names(fit, "fit")),
    ]
    scale = describe_scale(output_units(fit.records[0].log), model.scale)
    return [*said, *scale, *step_sentences(model)]


def window_sentences(found: WindowEstimate, floor: float, unit: str) -> list[str]:
    """Returns sentences on a search over windows; `floor` is the rms of the noise [unit]."""
    bound = [n for n, at in zip(found.values, found.at_bound, strict=True) if at]
    said = [CONVERGED[found.converged], *bound_sentences((), bound)]
    if unknown := [n for n, u in zip(found.values, found.found.undetermined, strict=True) if u]:
        said.append(
            f"The windows do not tell {' and '.join(unknown)}; fix one, or take longer windows."
        )
    left = left_by_windows(len(found.residual), found.length, {unit: found.rms}, {unit: floor})
    return [*said, *weak_sentences(found), left]


def search_sentences(fit: Fit) -> list[str]:
    """Returns sentences on how the search of a free run ended."""
    said = {
        "converged": CONVERGED[True],
        "iterations": "The search ran out of iterations; start nearer, or allow more.",
        "stopped": "The search was stopped; these are the best values it had seen.",
    }[fit.estimate.status]
    bound = [n for n, at in zip(fit.found.names, fit.at_bound, strict=True) if at]
    return [said, *bound_sentences(fit.estimate.predictor.plant.parameters, bound)]


def _begun(fit: Fit) -> list[str]:
    """Returns a sentence on what of the log's beginning was estimated beside the values."""
    begun = fit.information.names[fit.information.asked :]
    if not begun:
        return []
    return [
        f"Where the log begins ({first_few(begun)}) was estimated too, because its first samples"
        " tell it with noise; the std of the values contain this."
    ]


def coloured_outputs(fit: Fit) -> int:
    """Returns how many outputs' residuals are not white."""
    return int((fit.tests.white < LEVEL / len(fit.tests.white)).sum())


def _enough(fit: Fit) -> list[str]:
    ratio, most = relative(fit.rms_by_unit, fit.floor_by_unit), most_of_noise(fit)
    (left,), (floor,) = error_words([fit.rms_by_unit]), error_words([fit.floor_by_unit], "")
    times = times_words(fit.rms_by_unit, fit.floor_by_unit)
    sentences = [f"The residual is {left}, {times} times the noise floor of {floor}."]
    dependent = int((fit.tests.independent < LEVEL / len(fit.tests.independent)).sum())
    coloured = coloured_outputs(fit)
    part = part_of_steps(fit, ratio, most)
    if part != "no":
        return [*sentences, f"That is more than noise, and {part} of it comes from the steps."]
    if ratio > most:
        sentences.append(
            "That is more than noise: the model lacks something, or the robot was disturbed."
        )
    if dependent:
        sentences.append(
            f"The residual of {_outputs(dependent)} depends on the input, which excites what is"
            " missing."
        )
    elif coloured:
        sentences.append(
            f"The residual of {_outputs(coloured)} is coloured, and none depends on the input: the"
            " noise is not white, or there is an effect that the input does not excite."
        )
    elif ratio > most:
        sentences.append("It is white and independent of the input: look at the sensors first.")
    else:
        sentences.append("The residual is white and independent of the input: the model suffices.")
    return sentences


def _outputs(count: int) -> str:
    return "1 output" if count == 1 else f"{count} outputs"


def _unseen(fit: Fit) -> list[str]:
    there, expected = fit.validation_rms_by_unit, fit.validation_expected_by_unit
    if there is None or expected is None:
        return ["There are no unseen data that could confirm it."]
    (unseen,) = error_words([there])
    ratio, grown = relative(there, expected), relative(there, fit.rms_by_unit)
    if ratio < HOLDS and grown > GROWN:
        return [
            f"On unseen data the residual is {unseen}, {grown:.0f} times that of the fitted part."
            " Small errors of the parameters may cause this along a free run, so that it says"
            " little. Judge the model over a horizon."
        ]
    said = "it does not hold there: it has too many parameters, or an effect is missing"
    if ratio < HOLDS and fit.validation_rests:
        said = REST
    elif ratio < HOLDS:
        said = "what was fitted holds there too"
        left = relative(fit.rms_by_unit, fit.floor_by_unit)
        most = most_of_noise(fit)
        if part_of_steps(fit, left, most) != "no":
            said = "no worse than on what was fitted, and the steps err there too"
        elif left > most:
            said = "no worse than on what was fitted, but what is missing is missing there too"
    return [
        f"On unseen data the residual is {unseen}, {times_words(there, expected)} times what the"
        f" fit leads us to expect: {said}."
    ]


def _worse(fit: RecordsFit) -> list[str]:
    """Returns a sentence where unseen records are predicted worse than by the first values."""
    if fit.worse is None:
        return []
    before, after = fit.unseen_rms
    rise = change((after / before) ** 2 - 1)
    return [
        "The fitted values predict unseen data worse than the values with which the fit"
        f" began (mean square {rise}, t = {fit.worse.t:z.1f}): do not use them. The"
        " model may lack something, for which the fit has changed the values: run discover to look"
        " for it. Or fit more records, state in the robot's file what is known of the free"
        " parameters (known), or"
        " leave some of them out."
    ]
