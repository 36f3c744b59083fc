"""Effects that the steps of the simulation make: the search goes on with finer steps, once.

    1 - ε² > ½ (1 - V_e/V)       finer steps alone do half of what the effect does, or more
    δ_j² > 9 (s_j² - δ_j²)       they would move a size of the effect by more than 3 std of noise

V, V_e: criterion of the fitted windows without and with the effect; ε, δ: error of the fit without
it over what it is, and change of a size in the fit with it, after a quarter of the model's step
(`identification.prediction.fits.std`). Simulations take longer steps than the model says where
these change predictions by little beside what the model leaves; and the model's own may be too long
for a friction that turns within a step. What either makes looks like an effect. What the finest
steps still make in the same measure is told as tried, and is no name.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.extension import with_finer_steps
from identification.prediction.judging.trial import Contender
from identification.prediction.scoring.screening import score_all
from identification.prediction.task import WindowSearch

STEPS_SHARE = 0.5  # of what an effect explains
MOVED = 3.0  # std of a size, without the error of the steps, which a told std contains


def is_of_steps(parent: WindowModel, best: Contender) -> bool:
    """Returns whether the steps may make an effect, or its size.

    Args:
        parent: the model without it.
        best: the effect that is to be accepted.
    """
    return is_made_by_steps(parent, best) or _is_moved(best)


def is_made_by_steps(parent: WindowModel, best: Contender) -> bool:
    """Returns whether finer steps alone do half of what an effect does, or more."""
    by_steps = 1 - parent.finer.error**2
    return bool(by_steps > STEPS_SHARE * (1 - best.model.fitted_power / parent.fitted_power))


def _is_moved(best: Contender) -> bool:
    """Returns whether finer steps would move a size of an effect by far."""
    if best.candidate.effect.is_curve:
        return False
    model, sizes = best.model, {*best.candidate.free}
    std, shift = model.told_std, model.step_shift
    own = (n for n in std if n.partition(" [")[0] in sizes)
    return any(shift[n] ** 2 > MOVED**2 * (std[n] ** 2 - shift[n] ** 2) for n in own)


def at_finer_steps(state: WindowSearch) -> WindowSearch | None:
    """Returns the state whose models take finer steps, all candidates scored again.

    Returns:
        None where there are none, or where a model cannot be simulated with them.
    """
    task = state.task
    finer = partial(with_finer_steps, horizon=task.horizon, confirm=task.confirm)
    model = attempt(None, partial(finer, state.model))
    nominal = model
    if state.nominal is not state.model:
        nominal = attempt(None, partial(finer, state.nominal))
    if model is None or nominal is None:
        return None
    scores = score_all(model, task.effects, task.options)
    return replace(
        state, model=model, nominal=nominal, scores=scores, exchanged=None,
        nominal_scores=scores if nominal is model else state.nominal_scores,
    )  # fmt: skip
