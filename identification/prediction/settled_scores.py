"""The score of an effect whose linear score tells little: windows are searched with it once.

    V_w(η) = min over d_w of ‖r_w(η, d_w)‖²         fall = 1 - Σ_w V_w(η)/Σ_w V_w(0)
    gain_w = ln(V_w(0) + V̄) - ln(V_w(η) + V̄)        V̄: median of V_w(0)

η: the probe. Friction that gives hides behind friction that a fit has made smaller instead, so that
a small probe shows nothing, or the wrong sign. Blocks of windows are the sample of a t-test.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.stats import ttest_1samp

from identification.effects.effect import Candidate
from identification.model.coordinates import NOTHING
from identification.prediction.fit import BLOCKS, WindowFit
from identification.prediction.joint_states import part_for, widened
from identification.windows.window_search import search_states

MOST_WINDOWS = 80  # over all records: two for each block of the sample


def settled_score(
    fit: WindowFit, candidate: Candidate
) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Size, std, fall and chance of a candidate, where its sizes are its probes.

    Args:
        fit: the model without it.
        candidate: the effect, its shapes and its probe.

    Raises:
        DivergenceError: a window leaves the finite numbers.
    """
    sizes = candidate.effect.sizes
    size = np.array([(-1 if s.sign < 0 else 1) * s.probe * candidate.probe for s in sizes])
    there = {**candidate.fixed, **dict(zip(candidate.sizes, size.tolist(), strict=True))}
    before, after = [], []
    each = zip(fit.problem.parts, fit.moves, fit.tangents, strict=True)
    for k, (part, d, t) in enumerate(each):
        keep = np.unique(np.linspace(0, len(d) - 1, MOST_WINDOWS // len(fit.moves)).astype(int))
        values = fit.of_record(k)
        new = part_for(part.rows(keep), candidate, values)
        fixed = {**new.predictor.fixed, **values, **there}
        predictor = replace(new.predictor, names=(), fixed=fixed)
        begun = widened(d[keep], new)
        found = search_states(replace(new, predictor=predictor, space=NOTHING), begun)
        before.append(np.sum(t.r[keep] ** 2, axis=1))
        after.append(np.sum(found.tangent.r**2, axis=1))
    old, new_ = np.concatenate(before), np.concatenate(after)
    usual = float(np.median(old))  # so that windows in which nothing happens do not decide
    gain = np.log(old + usual) - np.log(new_ + usual)
    blocks = np.array([b.mean() for b in np.array_split(gain, min(BLOCKS, max(2, len(gain))))])
    test = ttest_1samp(blocks, 0.0, alternative="greater") if blocks.std() > 0 else None
    chance, t_ = (1.0, 0.0) if test is None else (float(test.pvalue), float(test.statistic))
    fall = 1 - float(new_.sum()) / max(float(old.sum()), 1e-300)
    return size, np.abs(size) / max(abs(t_), 1e-3), fall, chance
