"""Sentences on what a log does not tell of the parameters, and what to do."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from identification.estimation.identifiability import in_words
from identification.estimation.scaling_symmetry import ScalingSymmetry
from identification.model.parameter import Parameter
from identification.quantities import matched
from identification.report.words.errors import listed
from identification.report.words.values import gathered, parameter_words
from identification.shares import percent

if TYPE_CHECKING:
    from identification.estimation.fit import Fit
    from identification.estimation.identifiability import Identifiability
    from identification.logs.log import Log
    from identification.windows.window_estimate import WindowEstimate


def bound_sentences(parameters: Iterable[Parameter], at_bound: Iterable[str]) -> list[str]:
    """Returns sentences on values that lie on a bound, with what moves it; none where none does.

    A value that a record has for itself is called `name [record]`.
    """
    reasons = {p.name: p.bounded_by for p in parameters}
    each = {name: reasons.get(name.partition(" [")[0], "") for name in at_bound}
    plain = [name for name, reason in each.items() if not reason]
    said = [
        f"At a bound: {', '.join(gathered(n for n in each if each[n] == reason))}; {reason}."
        for reason in dict.fromkeys(filter(None, each.values()))
    ]
    if plain:
        said.insert(0, f"At a bound: {', '.join(gathered(plain))}; widen it or fix the parameter.")
    return said


WEAK = 0.5  # of its value: the std of a value that is not worth its digits
ROUGH = 1e-4  # relative error of a sensitivity, which a smooth simulation stays far below


def identifiable_sentences(fit: Fit) -> list[str]:
    """Returns sentences on which parameters, or products of them, can be known from the log."""
    found = fit.found
    if not len(found.blind):
        values = np.array(list(fit.estimate.values.values()))
        relative = fit.std / np.where(fit.estimate.space.logarithmic, np.abs(values), np.inf)
        weak = [n for n, r in zip(found.names, relative, strict=True) if r > WEAK]
        said = f"The outputs depend on all {len(found.names)} directions of the parameters."
        if not weak:
            return [said]
        traded = _traded(weak, found)
        why = scale_of_forces([fit.estimate.predictor.log]) if traded else ""
        return [f"{said} {too_weak(weak, 'noise')}{traded}{why}"]
    felt = f"The outputs depend on {found.rank} of {len(found.names)} directions of the parameters"
    sentences = []
    if found.symmetries:
        words = parameter_words(fit.estimate.predictor.plant.parameters)
        sentences.append(f"{felt}: {untold(found.symmetries, found.names, words)}.")
    for combination, value, std in fit.combinations:
        told, known = matched(value, std)
        error = f" ± {known}" if np.isfinite(std) else " (its std is not known)"
        sentences.append(
            f"Of {' and '.join(combination.exponents)} only {combination} can be known from this"
            f" log: {told}{error}; fix one of them."
        )
    if any(len(s.powers) > 1 for s in found.symmetries):
        sentences += filter(None, [scale_of_forces([fit.estimate.predictor.log]).strip()])
    if k := len(found.unresolved):
        count = f"{k} more" if found.symmetries else f"{felt}; {k}"
        sentences.append(f"{count} {'are' if k > 1 else 'is'}{unresolved_words(found)}")
    return sentences


def untold(
    symmetries: Sequence[ScalingSymmetry], names: Sequence[str], words: Mapping[str, str]
) -> str:
    """Returns in words what no output feels: single parameters, and those that trade off.

    Single parameters are called by `words`, or by their names where these lack them.
    """
    single = [s for s in symmetries if len(s.powers) == 1]
    several = [s for s in symmetries if len(s.powers) > 1]
    said = []
    if alone := [n for n in names if any(n in s.powers for s in single)]:
        said.append(f"the data do not tell {' and '.join(words.get(n, n) for n in alone)}")
    if scaled := [n for n in names if any(n in s.powers for s in several)]:
        along = "; ".join(in_words(s.row(names), names) for s in several)
        said.append(f"{' and '.join(scaled)} trade off along ({along}), and no output changes")
    return "; ".join(said)


def unresolved_words(found: Identifiability) -> str:
    """Returns in words what differences cannot resolve, and which parameters have no std then."""
    moved = found.moved_by_unresolved
    names = [n for n, m in zip(found.names, moved, strict=True) if m]
    share = np.where(moved, found.errors / np.where(found.norms > 0, found.norms, np.inf), 0.0)
    worst = np.argsort(-share)[: min(3, len(names))]
    errors = ", ".join(f"{percent(float(share[i]), 2)} for {found.names[i]}" for i in worst)
    said = (
        f" lost in the errors of the sensitivities ({errors}), so that {listed(names)}"
        f" {'have' if len(names) > 1 else 'has'} no std."
    )
    if share.max() > ROUGH:
        said += " The simulation is rough at these values; a smaller timestep may resolve more."
    return said


def weak_sentences(found: WindowEstimate) -> list[str]:
    """Returns a sentence on parameters of which noise leaves too little, and how they trade off."""
    names, values = found.found.names, np.array(list(found.values.values()))
    known = ~found.found.undetermined & np.isfinite(found.std)
    weak = [n for n, v, s, k in zip(names, values, found.std, known, strict=True)
            if k and s > WEAK * abs(v) and v > 0]  # fmt: skip
    if not weak:
        return []
    return [f"{too_weak(weak, 'noise')}{_traded(weak, found.found)} {cure(weak)}"]


def _traded(weak: Sequence[str], found: Identifiability) -> str:
    """Says along which direction weak parameters trade off with others; empty where with none."""
    felt = found.directions[: found.rank]
    at = [found.names.index(n) for n in weak]
    share = np.linalg.norm(felt[:, at], axis=1)  # of each direction that lies in the weak ones
    words = in_words(felt[np.argmax(share / found.strengths[: len(felt)])], found.names)
    if "," not in words:
        return ""
    which = "They trade" if len(weak) > 1 else "It trades"
    return f" {which} off along ({words}): what does not change along it is known."


def scale_of_forces(logs: Sequence[Log]) -> str:
    """Returns why a free swing leaves parameters that trade off; "" where an input moves."""
    if any(log.inputs.any() for log in logs):
        return ""
    return (
        " No input moves, so that nothing sets how large forces are: a free swing tells masses,"
        " inertias, frictions and stiffnesses by their ratios only."
    )


def too_weak(names: Sequence[str], what: str) -> str:
    """Returns a sentence on parameters whose std is too large for "noise" or "windows"."""
    their = "its" if len(names) == 1 else "their"
    this = "this" if what == "noise" else "these"
    which = ", ".join(gathered(names))
    return (
        f"With {this} {what} the log tells too little about {which}: {their} std exceeds half the"
        " value."
    )


def cure(names: Sequence[str]) -> str:
    """Returns a sentence on what to do about them."""
    if len(names) == 1:
        return "Fix it, or record a motion that tells more of it."
    return "Fix one of them, or record a motion that tells more of them."
