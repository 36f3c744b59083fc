"""The next effect of a model: the best candidates are refitted, and unseen records decide.

    contenders    beyond chance by blocks, of a plausible size, and near the best score
    proven        predicts unseen windows better: beyond chance, over every length, and by enough
    chosen        of the proven ones the one with the best criterion on the fitted windows, or one
                  with fewer numbers that unseen records cannot tell from it

    criterion = -W n_y ln V - k ln W        W windows, k free parameters: BIC of W n_y errors

Errors within a window go along with each other, so that a window counts as one sample of each
output. Unseen records prove; they choose only between a law and one with fewer numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.options import DiscoveryOptions
from identification.discovery.scoring.sensitivities import list_common, list_single
from identification.effects.effect import Candidate, Effect
from identification.errors import InputError
from identification.prediction.contenders import (
    count_numbers,
    is_plausible,
    is_significant,
    list_contenders,
    list_simpler,
)
from identification.prediction.extension import with_effect
from identification.prediction.model import WindowModel
from identification.prediction.records import Record
from identification.prediction.scores import WindowScore, find_imitated, window_scores
from identification.prediction.several_places import several_scores
from identification.prediction.unseen import Prediction, compare

Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Contender:
    """An effect that was refitted.

    Attributes:
        model: with it.
        prediction: of unseen records, over the model without it.
        criterion: of the fitted windows, over the model without it.
        is_proven: whether unseen records prove it.
    """

    model: WindowModel
    prediction: Prediction
    criterion: float
    is_proven: bool

    @property
    def candidate(self) -> Candidate:
        """The effect, its shapes as they began."""
        return self.model.candidates[-1]


def score_all(
    model: WindowModel, effects: Sequence[Effect], options: DiscoveryOptions
) -> tuple[WindowScore, ...]:
    """Scores of what a model lacks: everywhere, then the best shapes at one place, and at several.

    Args:
        model: fitted.
        effects: the candidates.
        options: what is beyond chance.
    """
    has = {c.key for c in model.candidates}
    everywhere = {c.effect.name for c in model.candidates if not c.effect.places[c.where]}
    lacking = [e for e in effects if e.name not in everywhere]
    common = window_scores(model.fit, _without(list_common(lacking), has))
    best: dict[str, Candidate] = {}
    for s in common:
        best.setdefault(s.candidate.effect.name, s.candidate)
    single = window_scores(model.fit, _without(list_single([*best.values()]), has))
    found = sorted((*common, *single), key=lambda s: -s.fall)
    beyond = [
        s for s in found
        if is_significant(s, len(found), options) and is_plausible(s, options)
    ]  # fmt: skip
    known = find_imitated(model.fit, beyond)
    found, beyond = ([s for s in each if s.candidate.key not in known] for each in (found, beyond))
    several = several_scores(model.fit, beyond, options)
    return tuple(sorted((*found, *several), key=lambda s: -s.fall))


def _without(candidates: Sequence[Candidate], has: set[tuple[str, str]]) -> list[Candidate]:
    return [c for c in candidates if c.key not in has]


def refit_contenders(
    model: WindowModel,
    scores: Sequence[WindowScore],
    horizon: float,
    confirm: Sequence[Record],
    options: DiscoveryOptions,
    progress: Progress,
) -> tuple[Contender, ...]:
    """Refit the contenders of a round, the best first: proven ones before others, by criterion.

    Laws with fewer numbers that act as the best one does are refitted too. A law with fewer numbers
    comes before the best one where unseen records cannot tell them apart and the criterion does not
    speak very strongly; so does, of two that are no more than a bare mention apart, the one that is
    the same in all records.
    """
    chosen = list_contenders(scores, options, _windows(model) * len(model.scale))
    refits = len(chosen)

    def refit(s: WindowScore) -> list[Contender]:
        c = _refit(model, s, horizon, confirm, options, refits, progress)
        return [] if c is None else [c]

    out = [c for s in chosen for c in refit(s)]
    proven = [c for c in out if c.is_proven]
    if proven:
        best = max(proven, key=lambda c: c.criterion)
        tried = {c.candidate.key for c in out}
        for s in list_simpler(best.candidate, scores, options):
            if s.candidate.key not in tried:
                out += refit(s)
    return _ranked(out, refits, options)


def _refit(
    model: WindowModel, s: WindowScore, horizon: float, confirm: Sequence[Record],
    options: DiscoveryOptions, refits: int, progress: Progress,
) -> Contender | None:  # fmt: skip
    label = f"{s.candidate.effect.name}, {s.candidate.where}"
    try:
        new = with_effect(model, s, horizon, confirm)
    except InputError as error:
        progress(f"{label}: left out, {error}")
        return None
    if new is None:
        progress(f"{label}: explains no more than without it")
        return None
    found = compare(model.unseen, new.unseen)
    gain = criterion(new) - criterion(model)
    proven = gain > 0 and has_size(new, options) and is_proven(found, refits, options)
    at = model.unseen.lengths.index(1.0)
    progress(f"{label}: unseen mean square {-100 * found.falls[at]:+.0f} %, t {found.t:.1f}")
    return Contender(model=new, prediction=found, criterion=gain, is_proven=proven)


def _ranked(
    found: Sequence[Contender], refits: int, options: DiscoveryOptions
) -> tuple[Contender, ...]:
    """Contenders in the order of `refit_contenders`."""
    out = sorted(found, key=lambda c: (not c.is_proven, -c.criterion))
    for c in tuple(out[1:]):
        best = out[0]
        if not c.is_proven:
            continue
        apart = best.criterion - c.criterion
        is_shared = best.candidate.effect.own and not c.candidate.effect.own
        fewer = count_numbers(c.candidate) < count_numbers(best.candidate)
        told = is_proven(compare(c.model.unseen, best.model.unseen), refits, options)
        if (is_shared and apart < options.bare_bic) or (
            fewer and apart < options.strong_bic and not told
        ):
            out = [c, *(o for o in out if o is not c)]
    return tuple(out)


def is_proven(found: Prediction, refits: int, options: DiscoveryOptions) -> bool:
    """Whether unseen windows are predicted better: beyond chance, everywhere, by enough."""
    beyond = found.t > options.min_proof_t and found.chance * refits < options.significance
    return beyond and found.is_everywhere and min(found.falls) > options.min_fall


def has_size(model: WindowModel, options: DiscoveryOptions) -> bool:
    """Whether a free size of the last effect is beyond its own std, where it has one.

    It must be beyond what steps of the simulation err by too.
    """
    std, values, c = model.std, model.fit.values, model.candidates[-1]
    least = {n: s.smallest for n, s in zip(c.sizes, c.effect.sizes, strict=True)}
    own = [n for n in model.fit.problem.names if n.partition(" [")[0] in c.free]
    return not own or any(
        abs(values[n]) > max(options.min_proof_t * std[n], least[n.partition(" [")[0]]) for n in own
    )


def criterion(model: WindowModel) -> float:
    """Negative BIC of the fitted windows, in units of twice the log likelihood."""
    fit, W, ny = model.fit, _windows(model), len(model.scale)
    return -W * ny * float(np.log(fit.cost)) - len(fit.q) * float(np.log(W))


def _windows(model: WindowModel) -> int:
    return sum(len(p.cut.starts) for p in model.fit.problem.parts)
