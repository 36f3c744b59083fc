"""The meaning of a fit, in sentences that say what to do next."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from identification.estimation.metrics import relative
from identification.model.protocol import FINER
from identification.quantities import held, quantity
from identification.report.bound_words import bound_sentences
from identification.report.error_words import error_words, times_words
from identification.report.untold_words import identifiable_sentences, weak_sentences

if TYPE_CHECKING:
    from identification.estimation.fit import Fit
    from identification.windows.window_estimate import WindowEstimate

# A residual above this multiple of the noise floor is more than noise; the floor itself is an upper
# bound of the noise that errs by a few percent.
ABOVE = 1.2
HOLDS = 1.2  # a fit holds on unseen data up to this multiple of the residual that is expected there
GROWN = 10.0  # a free run that errs by more than this multiple of the fitted residual has diverged
SHOWN = 3  # values that finer steps would move, those that move most first
LEVEL = 0.01  # significance of the tests of the residual: one false alarm in a hundred


def fit_verdict(fit: Fit) -> list[str]:
    """Returns sentences: did it converge, what is known, is it enough, does it hold unseen."""
    if fit.estimate.status == "stopped":  # a search that was stopped says nothing of the model
        return search_sentences(fit)
    return [
        *search_sentences(fit), *identifiable_sentences(fit), *_enough(fit), *_steps(fit),
        *_unseen(fit),
    ]  # fmt: skip


def _steps(fit: Fit) -> list[str]:
    """Returns a sentence on what a finer step would change beyond what the std tell."""
    far = fit.far
    if not far:
        return []
    step = float(fit.estimate.predictor.plant.model.opt.timestep)
    moves = dict(zip(fit.estimate.space.names, fit.step_shift.tolist(), strict=True))
    told = [f"{name} by {moves[name]:+z.2g}, {held(far[name])} std" for name in [*far][:SHOWN]]
    more = f" and {len(far) - SHOWN} more" if len(far) > SHOWN else ""
    return [
        f"A quarter of the model's step, {quantity(step / FINER, unit='s')}, would move"
        f" {'; '.join(told)}{more}; the std tell nothing of this. Where this matters, write"
        f' timestep="{step / FINER:.6g}" into the <option> of the model, and do this once more.'
    ]


def search_sentences(fit: Fit) -> list[str]:
    """Returns sentences on how the search ended."""
    said = {
        "converged": "The search converged.",
        "iterations": "The search ran out of iterations; start nearer, or allow more.",
        "stopped": "The search was stopped; these are the best values it had seen.",
    }[fit.estimate.status]
    bound = [n for n, at in zip(fit.found.names, fit.at_bound, strict=True) if at]
    return [said, *bound_sentences(fit.estimate.predictor.plant.parameters, bound)]


def window_sentences(found: WindowEstimate, floor: float, unit: str) -> list[str]:
    """Returns sentences on how a search over windows ended, what it cannot know, and its residual.

    Args:
        found: the search.
        floor: rms of the noise over all outputs, in `unit`.
        unit: of the outputs, "" where they have several.
    """
    said = ["The search converged." if found.converged else "The search ran out of iterations."]
    bound = [n for n, at in zip(found.values, found.at_bound, strict=True) if at]
    said += bound_sentences((), bound)
    if unknown := [n for n, u in zip(found.values, found.found.undetermined, strict=True) if u]:
        said.append(f"The windows cannot tell {' and '.join(unknown)}; fix one, or widen them.")
    said += weak_sentences(found)
    left = left_by_windows(len(found.residual), found.length, {unit: found.rms}, {unit: floor})
    return [*said, left]


def left_by_windows(
    count: int, length: float, rms: Mapping[str, float], floor: Mapping[str, float]
) -> str:
    """Returns a sentence on the error that windows leave, beside the noise where it is known.

    Args:
        count: of the windows.
        length: of each [s].
        rms: error by the outputs' units, each in it.
        floor: noise likewise.
    """
    (left,), (own,) = error_words([rms]), error_words([floor], "")
    ratio = f", {times_words(rms, floor)} times the noise floor of {own}"
    of = f"of {length:g} s"
    each = f"1 window {of} leaves" if count == 1 else f"{count} windows {of} leave"
    return f"{each} {left}{ratio if any(floor.values()) else ''}."


def coloured_outputs(fit: Fit) -> int:
    """Returns how many outputs' residuals are not white."""
    return int((fit.tests.white < LEVEL / len(fit.tests.white)).sum())


def _outputs(count: int) -> str:
    return "1 output" if count == 1 else f"{count} outputs"


def _above(fit: Fit) -> float:
    """Returns the residual as a multiple of the noise floor."""
    return relative(fit.rms_by_unit, fit.floor_by_unit)


def _enough(fit: Fit) -> list[str]:
    ratio, (floor,) = _above(fit), error_words([fit.floor_by_unit], "")
    (left,) = error_words([fit.rms_by_unit])
    times = times_words(fit.rms_by_unit, fit.floor_by_unit)
    sentences = [f"The residual is {left}, {times} times the noise floor of {floor}."]
    dependent = int((fit.tests.independent < LEVEL / len(fit.tests.independent)).sum())
    coloured = coloured_outputs(fit)
    if ratio > ABOVE:
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
            f"The residual of {_outputs(coloured)} is coloured, none depends on the input: noise"
            " that is not white, or an effect that the input does not excite."
        )
    elif ratio > ABOVE:
        sentences.append("It is white and independent of the input: look at the sensors first.")
    else:
        sentences.append("The residual is white and independent of the input: the model suffices.")
    return sentences


def _unseen(fit: Fit) -> list[str]:
    there, expected = fit.validation_rms_by_unit, fit.validation_expected_by_unit
    if there is None or expected is None:
        return ["There is no unseen data to confirm it on."]
    (unseen,) = error_words([there])
    ratio, grown = relative(there, expected), relative(there, fit.rms_by_unit)
    said = "it does not hold: too many parameters, or an effect missing"
    if ratio < HOLDS:
        said = "what was fitted holds there too"
        if _above(fit) > ABOVE:
            said = "no worse than on what was fitted, but what is missing is missing there too"
    if ratio < HOLDS and grown > GROWN:
        return [
            f"On unseen data the residual is {unseen}, {grown:.0f} times that of the fitted part;"
            " so small errors of the parameters may do that there, and it says little. Judge over"
            " a horizon."
        ]
    times = times_words(there, expected)
    return [
        f"On unseen data the residual is {unseen}, {times} times what the fit leads one to expect:"
        f" {said}."
    ]
