"""What a fit means, in sentences that say what to do next."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from identification.estimation.identifiability import in_words
from identification.quantities import error, held, matched

if TYPE_CHECKING:
    from identification.estimation.fit import Fit
    from identification.estimation.identifiability import Identifiability
    from identification.windows.window_estimate import WindowEstimate

# A residual above this multiple of the noise floor is more than noise; the floor itself is an upper
# bound of the noise that errs by a few percent.
ABOVE = 1.2
HOLDS = 1.2  # a fit holds on unseen data up to this multiple of the residual that is expected there
GROWN = 10.0  # a free run that errs by more than this multiple of the fitted residual has diverged
LEVEL = 0.01  # significance of the tests of the residual: one false alarm in a hundred
WEAK = 0.5  # of its value: the std of a value that is not worth its digits
ROUGH = 1e-4  # relative error of a sensitivity, which a smooth simulation stays far below


def fit_verdict(fit: Fit) -> list[str]:
    """Sentences: did it converge, what can be known, is the model enough, does it hold unseen."""
    if fit.estimate.status == "stopped":  # a search that was stopped says nothing of the model
        return search_sentences(fit)
    return [*search_sentences(fit), *identifiable_sentences(fit), *_enough(fit), *_unseen(fit)]


def search_sentences(fit: Fit) -> list[str]:
    """How the search ended."""
    said = {
        "converged": "The search converged.",
        "iterations": "The search ran out of iterations; start nearer, or allow more.",
        "stopped": "The search was stopped; these are the best values it had seen.",
    }[fit.estimate.status]
    bound = [n for n, at in zip(fit.found.names, fit.at_bound, strict=True) if at]
    if bound:
        return [said, f"At a bound: {', '.join(bound)}; widen it or fix the parameter."]
    return [said]


def identifiable_sentences(fit: Fit) -> list[str]:
    """Which parameters, or products of them, can be known from the log."""
    found = fit.found
    if not len(found.blind):
        values = np.array(list(fit.estimate.values.values()))
        relative = fit.std / np.where(fit.estimate.space.logarithmic, np.abs(values), np.inf)
        weak = [n for n, r in zip(found.names, relative, strict=True) if r > 0.5]
        said = f"All {len(found.names)} directions of the parameters are felt by the outputs."
        if weak:
            said += (
                f" Too weakly for this noise: {', '.join(weak)}, their std exceeds half the value."
            )
        return [said]
    felt = f"{found.rank} of {len(found.names)} directions are felt"
    sentences = []
    if found.symmetries:
        scaled = [n for n in found.names if any(n in s.powers for s in found.symmetries)]
        along = "; ".join(in_words(s.row(found.names), found.names) for s in found.symmetries)
        sentences.append(
            f"{felt}: {' and '.join(scaled)} trade off along ({along}) without any output feeling"
            " it."
        )
    for combination, value, std in fit.combinations:
        told, known = matched(value, std)
        error = f" ± {known}" if np.isfinite(std) else " (its std is not known)"
        sentences.append(
            f"Of {' and '.join(combination.exponents)} only {combination} can be known from this"
            f" log: {told}{error}; fix one of them."
        )
    if k := len(found.unresolved):
        count = f"{k} more" if found.symmetries else f"{felt}; {k}"
        sentences.append(f"{count} {'are' if k > 1 else 'is'}{unresolved_words(found)}")
    return sentences


def unresolved_words(found: Identifiability) -> str:
    """What directions that differences cannot resolve lack, and which parameters that leaves."""
    moved = found.moved_by_unresolved
    names = [n for n, m in zip(found.names, moved, strict=True) if m]
    share = np.where(moved, found.errors / np.where(found.norms > 0, found.norms, np.inf), 0.0)
    worst = np.argsort(-share)[: min(3, len(names))]
    errors = ", ".join(f"{_percent(share[i])} for {found.names[i]}" for i in worst)
    listed = " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))
    said = (
        f" lost in the errors of the sensitivities ({errors}), so that {listed}"
        f" {'have' if len(names) > 1 else 'has'} no std."
    )
    if share.max() > ROUGH:
        said += " The simulation is rough at these values; a smaller timestep may resolve more."
    return said


def _weak(found: WindowEstimate) -> list[str]:
    """Parameters of which the noise leaves too little, and what they trade off along."""
    names, values = found.found.names, np.array(list(found.values.values()))
    known = ~found.found.undetermined & np.isfinite(found.std)
    weak = [n for n, v, s, k in zip(names, values, found.std, known, strict=True)
            if k and s > WEAK * abs(v) and v > 0]  # fmt: skip
    if not weak:
        return []
    felt = found.found.directions[: found.found.rank]
    at = [names.index(n) for n in weak]
    share = np.linalg.norm(felt[:, at], axis=1)  # of each direction that lies in the weak ones
    words = in_words(felt[np.argmax(share / found.found.strengths[: len(felt)])], names)
    said = f"Too weakly for this noise: {', '.join(weak)}, their std exceeds half the value."
    if "," in words:
        said += f" They trade off along ({words}): what does not change along it is known."
    return [said + " Fix one of them, or record a motion that tells more of them."]


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %" if share > 0.1 else f"{100 * share:.2g} %"


def window_sentences(found: WindowEstimate, floor: float, unit: str) -> list[str]:
    """How a search over windows ended, which parameters it cannot know, and its residual.

    Args:
        found: the search.
        floor: rms of the noise over all outputs, in `unit`.
        unit: of the outputs, "" where they have several.
    """
    said = ["The search converged." if found.converged else "The search ran out of iterations."]
    if bound := [n for n, at in zip(found.values, found.at_bound, strict=True) if at]:
        said.append(f"At a bound: {', '.join(bound)}; widen it or fix the parameter.")
    if unknown := [n for n, u in zip(found.values, found.found.undetermined, strict=True) if u]:
        said.append(f"The windows cannot tell {' and '.join(unknown)}; fix one, or widen them.")
    said += _weak(found)
    share, own = held(found.rms / floor) if floor > 0 else "", error(floor, unit)
    ratio = f", {share} times the noise floor of {own}" if share else ""
    left = error(found.rms, unit)
    said.append(f"{len(found.residual)} windows of {found.length:g} s leave {left} rms{ratio}.")
    return said


def coloured_outputs(fit: Fit) -> int:
    """How many outputs' residuals are not white."""
    return int((fit.tests.white < LEVEL / len(fit.tests.white)).sum())


def _floor(fit: Fit) -> float:
    """Rms of the noise over all outputs."""
    return float(np.sqrt(np.mean(fit.floor**2)))


def _outputs(count: int) -> str:
    return "1 output" if count == 1 else f"{count} outputs"


def _error(fit: Fit, value: float) -> str:
    """A residual of a fit with the unit of its outputs."""
    return error(value, fit.estimate.predictor.log.output_unit)


def _above(fit: Fit) -> float:
    """The residual as a multiple of the noise floor."""
    return fit.rms / _floor(fit) if _floor(fit) > 0 else np.inf


def _enough(fit: Fit) -> list[str]:
    floor, ratio = _error(fit, _floor(fit)), _above(fit)
    sentences = [
        f"The residual is {_error(fit, fit.rms)} rms, {held(ratio)} times the noise floor of"
        f" {floor}."
    ]
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
    if fit.validation_rms is None:
        return ["There is no unseen data to confirm it on."]
    unseen = _error(fit, fit.validation_rms)
    likely = max(fit.rms, fit.validation_expected or 0.0)
    ratio = fit.validation_rms / likely if likely > 0 else np.inf
    said = "it does not hold: too many parameters, or an effect missing"
    if ratio < HOLDS:
        said = "what was fitted holds there too"
        if _above(fit) > ABOVE:
            said = "no worse than on what was fitted, but what is missing is missing there too"
    if ratio < HOLDS and fit.validation_rms > GROWN * fit.rms:
        return [
            f"On unseen data the residual is {unseen} rms,"
            f" {fit.validation_rms / fit.rms:.0f} times that of the fitted part; so small errors of"
            " the parameters may do that there, and it says little. Judge over a horizon."
        ]
    return [
        f"On unseen data the residual is {unseen} rms,"
        f" {held(ratio)} times what the fit leads one to expect: {said}."
    ]
