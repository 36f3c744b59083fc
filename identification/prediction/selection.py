"""The next effect of a model: the best candidates are refitted, and unseen records decide.

    contenders    beyond chance by blocks, of a plausible size, and near the best score
    proven        predicts unseen windows better: beyond chance, over every length, and by enough
    chosen        of the proven ones the one with the best criterion on the fitted windows

    criterion = -W n_y ln V - k ln W        W windows, k free parameters: BIC of W n_y errors

Errors within a window go along with each other, so that a window counts as one sample of each
output. Unseen records prove, but do not choose.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.options import DiscoveryOptions
from identification.discovery.scoring.sensitivities import list_common, list_single
from identification.effects.effect import Candidate, Effect
from identification.errors import InputError
from identification.prediction.extension import with_effect
from identification.prediction.model import WindowModel
from identification.prediction.records import Record
from identification.prediction.scores import WindowScore, window_scores
from identification.prediction.several_places import list_several
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
    has = {(c.effect.name, c.where) for c in model.candidates}
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
    several = window_scores(model.fit, list_several(beyond))
    return tuple(sorted((*found, *several), key=lambda s: -s.fall))


def _without(candidates: Sequence[Candidate], has: set[tuple[str, str]]) -> list[Candidate]:
    return [c for c in candidates if (c.effect.name, c.where) not in has]


def list_contenders(
    scores: Sequence[WindowScore], options: DiscoveryOptions, errors: int
) -> list[WindowScore]:
    """The few best scores that are beyond chance, the best shape of each effect at each place.

    All that explain about as much as the best one are refitted, up to twice the usual number: a
    score is linear, and what is right may be one of them. The best curve of the data is among them
    only where its criterion promises to be better than that of every law: a curve can imitate any
    law of what it depends on.

    Args:
        scores: of all candidates, the best first.
        options: what is beyond chance, and how many are refitted.
        errors: number of errors that count as a sample of the criterion.
    """
    laws = _best_few([s for s in scores if not s.candidate.effect.is_curve], scores, options)
    curves = _best_few([s for s in scores if s.candidate.effect.is_curve], scores, options)[:1]

    def promised(s: WindowScore) -> float:
        return -errors * np.log(max(1e-12, 1 - s.fall)) - len(s.size) * np.log(max(2, errors))

    best = max([promised(s) for s in laws], default=0.0)
    return [*laws, *(s for s in curves if promised(s) > best)]


def _best_few(
    listed: Sequence[WindowScore], scores: Sequence[WindowScore], options: DiscoveryOptions
) -> list[WindowScore]:
    each: dict[tuple[str, str], WindowScore] = {}
    for s in listed:
        if is_significant(s, len(scores), options) and is_plausible(s, options):
            each.setdefault((s.candidate.effect.name, s.candidate.where), s)
    out: list[WindowScore] = []
    best: dict[str, float] = {}
    for s in each.values():
        least = options.refit_share * max([t.fall for t in out], default=0.0)
        own = options.other_place_share * best.get(s.candidate.effect.name, 0.0)
        if s.fall > max(least, own):
            out.append(s)
            best.setdefault(s.candidate.effect.name, s.fall)
    near = sum(s.fall > options.equal_share * out[0].fall for s in out) if out else 0
    return out[: max(options.max_refits, min(near, 2 * options.max_refits))]


def is_significant(s: WindowScore, count: int, options: DiscoveryOptions) -> bool:
    """Whether a score is beyond chance among `count` of them, and large enough to matter."""
    return s.p_value * count < options.significance and s.fall > options.min_fall


def is_plausible(s: WindowScore, options: DiscoveryOptions) -> bool:
    """Whether sizes have signs and magnitudes that physics admits."""
    sizes = s.candidate.effect.sizes
    pairs = zip(s.size, sizes * (len(s.size) // len(sizes)), strict=True)
    return all(z.sign * v >= 0 and abs(v) <= options.size_factor * z.largest for v, z in pairs)


def refit_contenders(
    model: WindowModel,
    scores: Sequence[WindowScore],
    horizon: float,
    confirm: Sequence[Record],
    options: DiscoveryOptions,
    progress: Progress,
) -> tuple[Contender, ...]:
    """Refit the contenders of a round, the best first: proven ones before others, by criterion.

    Of two that are no more than a bare mention apart the one comes first that is the same in all
    records.
    """
    chosen = list_contenders(scores, options, _windows(model) * len(model.scale))
    out = []
    for s in chosen:
        label = f"{s.candidate.effect.name}, {s.candidate.where}"
        try:
            new = with_effect(model, s, horizon, confirm)
        except InputError as error:
            progress(f"{label}: left out, {error}")
            continue
        if new is None:
            progress(f"{label}: explains no more than without it")
            continue
        found = compare(model.unseen, new.unseen)
        gain = criterion(new) - criterion(model)
        proven = gain > 0 and has_size(new, options) and is_proven(found, len(chosen), options)
        out.append(Contender(model=new, prediction=found, criterion=gain, is_proven=proven))
        at = model.unseen.lengths.index(1.0)
        progress(f"{label}: unseen mean square {-100 * found.falls[at]:+.0f} %, t {found.t:.1f}")
    best = max([c.criterion for c in out if c.is_proven], default=0.0)

    def rank(c: Contender) -> tuple[bool, bool, float]:
        near = c.criterion > best - options.bare_bic and not c.candidate.effect.own
        return not c.is_proven, not near, -c.criterion

    return tuple(sorted(out, key=rank))


def is_proven(found: Prediction, refits: int, options: DiscoveryOptions) -> bool:
    """Whether unseen windows are predicted better: beyond chance, everywhere, by enough."""
    beyond = found.t > options.min_proof_t and found.chance * refits < options.significance
    return beyond and found.is_everywhere and min(found.falls) > options.min_fall


def has_size(model: WindowModel, options: DiscoveryOptions) -> bool:
    """Whether a free size of the last effect is beyond its own std, where it has one."""
    std, values, free = model.std, model.fit.values, model.candidates[-1].free
    own = [n for n in model.fit.problem.names if n.partition(" [")[0] in free]
    return not own or any(abs(values[n]) > options.min_proof_t * std[n] for n in own)


def criterion(model: WindowModel) -> float:
    """Negative BIC of the fitted windows, in units of twice the log likelihood."""
    fit, W, ny = model.fit, _windows(model), len(model.scale)
    return -W * ny * float(np.log(fit.cost)) - len(fit.q) * float(np.log(W))


def _windows(model: WindowModel) -> int:
    return sum(len(p.cut.starts) for p in model.fit.problem.parts)
