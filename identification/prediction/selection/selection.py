"""The next effect of a model: the best candidates are refitted, and unseen records decide.

contenders    beyond chance by blocks, of a sign that physics admits, and near the best score
proven        predicts unseen windows better: beyond chance, over every length, and by enough
chosen        of the proven ones the one for which most speaks (`evidence`), or one with fewer
              numbers that all windows cannot tell from it
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt_each, refuse_infinite, tell_dropped
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.prediction.fits.crossing import at_all_lengths, at_their_best
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.extension import weighed, with_effect
from identification.prediction.judging.judging import REFUTED, judged
from identification.prediction.judging.trial import Contender, evidences
from identification.prediction.scoring.contenders import (
    list_contenders,
    list_limits,
    list_starts,
    refit_level,
)  # fmt: skip
from identification.prediction.scoring.first_fit import Begun, begin
from identification.prediction.scoring.scores import WindowScore, window_scores
from identification.prediction.scoring.screening import has_what_it_needs
from identification.prediction.selection.simpler_laws import is_dear, likelier, simpler_laws
from identification.prediction.selection.smooth_rivals import without_imitated
from identification.prediction.verdict.remaining import is_much_left, output_ratios
from identification.runtime.pool import OutOfTime, lift_limit, run_parts
from identification.runtime.progress import Progress, counted
from identification.shares import fall_words
from identification.windows.records import Record
from identification.windows.unseen import Unseen

# Of an output's error to its noise, above which limits are fitted whatever their scores are. What a
# smaller limit does is nearly linear, and its score tells it.
MIN_LIMITED_RATIO = 10.0
STRONG_BIC = 10.0  # "very strong evidence" of one law against another (Kass and Raftery 1995)


def refit_contenders(
    model: WindowModel,
    scores: Sequence[WindowScore],
    horizon: float,
    confirm: Sequence[Record],
    options: DiscoveryOptions,
    progress: Progress,
    worse_fit: Unseen | None = None,
    suggested: Sequence[Candidate] = (),
    are_curves: bool = False,
    refused: int = 0,
) -> tuple[WindowModel, tuple[Contender, ...]]:
    """Refit the contenders of a round, the best first: proven ones before others, by evidence.

    They are laws, or curves of the data. Chance also pays for the effects that were `refused` when
    they were refitted in the same round.

    Where the fit without effects was worse than the values with which it began, an effect must be
    proven against that fit, and be no worse than these values: it says why the fit went wrong.
    Suggested effects are refitted whatever their scores are.
    Laws with fewer numbers that act as the best one does are refitted too. A law with fewer numbers
    comes before the best one where resamples cannot tell them apart and the evidence does not
    speak very strongly.

    Returns:
        The model without them, its windows at the best states that any of them found, and they.
    """
    is_weak = refit_level(scores, options) < options.significance
    is_far = not are_curves and output_ratios(model.unseen.select).max() > MIN_LIMITED_RATIO
    # what is left is simulated only where something depends on it
    is_much = (is_weak or is_far) and is_much_left(model, options)
    chosen = list_contenders(scores, options, is_much, are_curves)
    if is_far and is_much and uses(options, "limits_of_much_left"):
        chosen += list_limits(scores, chosen)
    if uses(options, "suggested_effects"):
        has = {*(s.candidate.key for s in chosen), *(c.key for c in model.candidates)}
        each = [c for c in suggested if c.key not in has and has_what_it_needs(model, c)]
        chosen += window_scores(model.fit, each)
    refits, crosses, is_late = refused + len(chosen), uses(options, "states_of_others"), False

    def refit(each: Sequence[Begun]) -> list[WindowModel]:
        nonlocal is_late
        tasks = [(b.candidate, partial(_refit, model, b, horizon, confirm)) for b in each]
        out = []
        try:
            for new in counted(attempt_each(tasks), "refits", len(each)):
                if isinstance(new, Begun):
                    reason = "its refit explains no more than the model without it"
                    tell_dropped(new.candidate, reason)
                elif new is not None:
                    out.append(new)
        except OutOfTime:
            is_late = True
            if not out:
                raise
        if out:
            lift_limit()  # what was refitted in time, the best begun first, is judged and accepted
        own = partial(weighed, horizon=horizon, confirm=confirm, options=options)
        return list(run_parts(own, out))

    def judge(
        parent: WindowModel, children: Sequence[WindowModel]
    ) -> tuple[WindowModel, list[Contender]]:
        best = tuple(children)
        if crosses:
            parent, best = at_their_best(parent, children, horizon, confirm)

        def judge_one(c: WindowModel) -> Contender:
            return judged(parent, c, refits, options, worse_fit)

        each = {k: judge_one(c) for k, c in enumerate(best)}
        # the other lengths decide nothing where the horizon itself refutes
        some = [k for k, c in each.items() if c.doubt not in REFUTED]
        some_models = [best[k] for k in some]
        parent, whole = at_all_lengths(parent, some_models, horizon, confirm, crosses)
        for k, c in zip(some, whole, strict=True):
            if c is None:
                del each[k]
            else:
                each[k] = judge_one(c)
        return parent, [*each.values()]

    children = refit(_near_best(_begun(model, chosen, scores, options), options))
    parent, out = judge(model, children)
    # of laws that a smooth force of a joint does as well, none is left: a curve may draw that force
    out = [*first_not_imitated(parent, ranked(out, options), options)]
    proven = [c for c in out if c.is_proven]
    better = [c for c in out if c.is_proven or is_dear(c, refits, options)]
    if better and not is_late and uses(options, "simpler_laws"):
        # Chance is not paid for these laws: they are asked only where a richer one has passed.
        best = max(better, key=lambda c: (c.is_proven, c.criterion))
        there, simpler = simpler_laws(parent, best, scores, options, is_much)
        known = {c.candidate.key for c in proven}
        rest = [s for s in simpler if s.candidate.key not in known]
        more = refit(_begun(there, rest, simpler, options))
        if more:
            parent, out = judge(parent, likelier([*(c.model for c in out), *more]))
    for c in out:
        change, t = fall_words(c.prediction.fall), c.prediction.t
        progress(f"{_label(c.candidate)}: mean square error on unseen records {change}, t {t:z.1f}")
    return parent, first_not_imitated(parent, ranked(out, options), options)


def first_not_imitated(
    parent: WindowModel, found: tuple[Contender, ...], options: DiscoveryOptions
) -> tuple[Contender, ...]:
    """Returns contenders, those unproven and behind others whose law a smooth force does as well.

    Args:
        parent: the model without them.
        found: in their order.
        options: the switches of `without_imitated`.
    """
    while found and found[0] is not (best := without_imitated(parent, found[0], options)):
        found = ranked([best, *found[1:]], options)
    return found


def _begun(
    model: WindowModel, chosen: Sequence[WindowScore], scores: Sequence[WindowScore],
    options: DiscoveryOptions,
) -> list[Begun]:  # fmt: skip
    """Returns effects fitted to some of the windows; those that cannot be simulated are told."""
    is_loud = uses(options, "loud_windows")
    each = ((s.candidate, [s, *list_starts(s, scores)]) for s in chosen)
    tasks = [(c, partial(begin, model, starts, is_loud)) for c, starts in each]
    return [begun for begun in attempt_each(tasks) if begun is not None]


def _near_best(begun: Sequence[Begun], options: DiscoveryOptions) -> list[Begun]:
    """Returns the few best on some windows, and those that these cannot tell from them."""
    each = [(_evidence_of_some(b), b) for b in begun]
    each.sort(key=lambda pair: -pair[0])
    least = min((e for e, _ in each[: options.max_refits]), default=0.0) - STRONG_BIC
    for e, b in each:
        if not e > least:
            tell_dropped(b.candidate, "others explain far more in a first fit")
    return [b for e, b in each if e > least]


def _evidence_of_some(begun: Begun) -> float:
    """Returns E of an effect fitted to some windows, but for what all of them have alike."""
    outputs = begun.task.parts[0].cut.outputs.shape[-1]
    price = len(begun.q) * np.log(max(2, begun.windows))
    return float(-begun.windows * outputs * np.log(begun.cost) - price)


def _label(c: Candidate) -> str:
    return f"{c.effect.name}, {c.where}"


def _refit(
    model: WindowModel, begun: Begun, horizon: float, confirm: Sequence[Record]
) -> WindowModel | Begun:
    """Returns the model with an effect, or what it began with where it explains nothing."""
    new = with_effect(model, begun, horizon, confirm)
    if new is None:
        return begun
    refuse_infinite(new.fit.cost, *new.unseen.at_horizon)
    return new


def _against(c: Contender) -> float:
    """Returns what a difference between records must have more of evidence than a law."""
    return STRONG_BIC if c.candidate.effect.is_of_records else 0.0


def ranked(found: Sequence[Contender], options: DiscoveryOptions) -> tuple[Contender, ...]:
    """Returns contenders in their order: proven ones before others, by evidence.

    One with fewer numbers comes first where resamples cannot tell it from the best one.

    A difference between records comes before a proven law only where the evidence for it is very
    strong: with numbers of each record it explains much that a law of all of them is.
    """
    out = sorted(found, key=lambda c: (not c.is_proven, -c.criterion + _against(c)))
    for c in tuple(out[1:]):
        best = out[0]
        apart = best.criterion - c.criterion
        fewer = c.numbers < best.numbers
        if c.is_proven and fewer and apart < STRONG_BIC:
            each = evidences([best, c])[:, 1:]
            if np.mean(each[1] >= each[0]) > options.significance:
                out = [c, *(o for o in out if o is not c)]
    return tuple(out)
