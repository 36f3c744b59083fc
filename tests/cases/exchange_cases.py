"""Records of which all have a law, or one of the fitted ones lacks it, seen from both sides."""

from dataclasses import replace
from functools import cache

import numpy as np
from records_cases import HORIZON, nominal_model, pendulum, record, records, roles, with_law

from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.judging.trial import Contender
from identification.prediction.selection.exchange import exchanged
from identification.windows.comparison import compare

NAME, MU = "transmitted_load_friction", "transmitted_load_friction.mu@hinge"
LOAD = {MU: 0.15}
SAMPLES = 300  # of each record


@cache
def pair(second):
    """Two fitted records, of which the second may lack the law, and two that confirm; models."""
    logs = records(4, LOAD, samples=500 if second == "lacks it" else SAMPLES)
    if second == "lacks it":
        logs[1] = record(2, plant=pendulum())
    every = roles(logs)
    without = fit_nominal(nominal_model(), every)
    return every, without, with_law(without, NAME, every)


@cache
def other_side(second):
    every, *models = pair(second)
    return [exchanged(m, every, HORIZON) for m in models]


def unproven(second, doubt="chance", is_curve=False, **weak):
    """A law whose gains in the records that confirm are no proof by themselves."""
    _, without, with_it = pair(second)
    (c,) = with_it.candidates
    if is_curve:
        with_it = replace(
            with_it, candidates=(replace(c, effect=replace(c.effect, name="curve_speed")),)
        )
    seen = replace(compare(without.unseen, with_it.unseen), t=1.0, chance=0.2, rank_chance=0.2)
    return Contender(
        model=with_it, gains=np.zeros(4), numbers=1, doubt=doubt, prediction=seen, criterion=1.0,
        explained=0.0, luck=0.2, **weak,
    )  # fmt: skip
