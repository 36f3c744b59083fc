"""What speaks for a model with one more effect, and what against it.

numbers     the gain pays for the numbers of the effect over all windows    (`evidence`)
data        windows that no fit has seen are predicted better               (`trial.find_doubt`)
size        it differs from zero, lies inside its bounds, and physics admits it
"""

from __future__ import annotations

import numpy as np

from identification.discovery.impossible import find_impossible
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.evidence import all_gains, evidence
from identification.prediction.judging.trial import (
    Contender,
    Doubt,
    compared,
    find_doubt,
    has_size,
    is_at_bound,
    luck_of,
)
from identification.prediction.scoring.contenders import count_numbers
from identification.windows.unseen import Unseen

REFUTED: tuple[Doubt, ...] = ("numbers", "chance", "differ")  # by windows of the horizon alone


def judged(
    model: WindowModel, new: WindowModel, refits: int, options: DiscoveryOptions,
    worse_fit: Unseen | None = None,
) -> Contender:  # fmt: skip
    """Returns the contender of a model with one more effect: what speaks for it, and against it.

    Args:
        model: without the effect.
        new: with it, as the last of its candidates.
        refits: how many effects were refitted, which chance has to pay for.
        options: what matters.
        worse_fit: errors of the fitted values, where those with which the fit began were better.
    """
    c = new.candidates[-1]
    found = compared(worse_fit or model.unseen, new.unseen, options)
    gains = all_gains(model, new, options)
    records = len(model.unseen.at_horizon) + len(model.fit.problem.parts)
    numbers = count_numbers(c) * (records if c.effect.own else 1)
    gain = float(evidence([gains], [numbers], len(model.scale))[0, 0])
    doubt: Doubt | None = "numbers" if gain <= 0 else find_doubt(found, refits, options)
    if doubt is None and worse_fit and _is_worse(new.unseen, model.unseen, options):
        doubt = "record"
    if doubt is None:
        doubt = doubt_of_size(new, options)
    if doubt in REFUTED and _explains_fitted(model, new, options):
        doubt = "differ"
    return Contender(
        model=new, prediction=found, gains=gains, numbers=numbers, criterion=gain,
        explained=model.fitted_power - new.fitted_power, outputs=_shares_of_outputs(model, new),
        doubt=doubt, luck=luck_of(found, refits, options), refits=refits,
    )  # fmt: skip


def _shares_of_outputs(model: WindowModel, new: WindowModel) -> tuple[float, ...]:
    """Returns the share of each output in what a model explains beyond another one, (ny,).

    Outputs that lose have none; it is empty where no output gains.
    """
    falls = np.maximum(model.powers_of_outputs - new.powers_of_outputs, 0.0)
    return tuple((falls / falls.sum()).tolist()) if falls.any() else ()


def doubt_of_size(model: WindowModel, options: DiscoveryOptions) -> Doubt | None:
    """Returns what is against the size of the last effect of a model; None where nothing is.

    Args:
        model: with the effect.
        options: what is beyond chance.
    """
    if not has_size(model, options):
        return "size"
    if is_at_bound(model, uses(options, "shape_bounds")):
        return "bound"
    if not uses(options, "impossible_sizes"):
        return None
    logs = [p.predictor.log for p in model.fit.problem.parts]
    return find_impossible(model.candidates[-1], model, logs)


def _explains_fitted(model: WindowModel, new: WindowModel, options: DiscoveryOptions) -> bool:
    """Returns whether a model explains fitted records that unseen ones contradict.

    Then the records differ in something that the effect stands for, and its gain is no luck.
    """
    falls = 1 - new.fitted_power / model.fitted_power
    return falls > options.min_gap_share and _is_worse(new.unseen, model.unseen, options)


def _is_worse(new: Unseen, old: Unseen, options: DiscoveryOptions) -> bool:
    """Returns whether unseen records prove that a model predicts worse than another."""
    return find_doubt(compared(new, old, options), 1, options) is None
