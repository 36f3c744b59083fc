"""The steps that simulations took, what a quarter of the step would change, and what to do."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.discovery.fitted import TOLD_SHIFT, Fitted
from identification.model.protocol import FINER
from identification.quantities import held, quantity
from identification.windows.coarse import OUTPUT_ERROR, steps_of

SHOWN = 3  # values that are told, those that move most first


def step_sentences(
    model: Fitted,
    words: Mapping[str, str] | None = None,
    steps: tuple[float, float] | None = None,
) -> list[str]:
    """Returns a paragraph on the steps; none where they are the model's and finer change little.

    Args:
        model: fitted.
        words: what to call the values by name; their names when None.
        steps: of the simulations and of the user's model [s]; those of `model` when None.
    """
    taken, own = steps or steps_of(model.plant)
    changed = _changed(model, words or {})
    if taken <= own and not changed:
        return []
    model_step, finer = quantity(own, unit="s"), own / FINER
    said = f"Simulations took steps of {model_step}, as the model says."
    if taken > own:
        is_last_own = steps_of(model.plant)[0] <= own
        said = (
            f"{'The search' if is_last_own else 'Simulations'} took steps of"
            f" {quantity(taken, unit='s')} where the model has {model_step}: this changes what is"
            f" predicted by less than {100 * OUTPUT_ERROR:.0f} % of its error."
        )
        if is_last_own:
            said += " The last fit took the steps of the model."
    if model.finer is None or not model.finer.is_known:
        return [said]
    said += (
        f" The last fit was checked with a quarter of the model's step, {quantity(finer, unit='s')}"
    )
    if not changed:
        return [f"{said}: no value would move by more than {held(TOLD_SHIFT)} std."]
    return [
        f"{said}: it would {', and would '.join(changed)}. Where this matters, write"
        f' timestep="{finer:.6g}" into the <option> of the model, and do this once more.'
    ]


def std_sentence(
    model: Fitted,
    words: Mapping[str, str] | None = None,
) -> str:
    """Returns a sentence where the error of the steps, which the std leave out, is larger; else "".

    It stands beside the std; `step_sentences` says by how much, and what to do.

    Args:
        model: as of `step_sentences`.
        words: as of `step_sentences`.
    """
    far, words = [*_far(model)], words or {}
    if not far:
        return ""
    told = ", ".join(words.get(n, n) for n in far[:SHOWN])
    more = f" and {len(far) - SHOWN} more" if len(far) > SHOWN else ""
    return (
        "The std leave out the error of the simulation's steps, which is more than"
        f" {held(TOLD_SHIFT)} std for {told}{more}."
    )


def _changed(model: Fitted, words: Mapping[str, str]) -> list[str]:
    """Returns clauses on what finer steps would do beyond what the std tell."""
    finer, said = model.finer, []
    if finer is None:
        return []
    if far := _far(model):
        most = [*far][:SHOWN]
        told = ", ".join(f"{words.get(n, n)} by {held(far[n])} std" for n in most)
        more = f" and {len(far) - SHOWN} more" if len(far) > SHOWN else ""
        said.append(f"move {told}{more}, of which the std tell nothing")
    if finer.is_lower():
        said.append(
            f"lower the error of the fitted windows to {held(finer.error)} of what it is: that part"
            " is of the steps, and nothing that is missing"
        )
    return said


def _far(model: Fitted) -> dict[str, float]:
    """Returns the values that finer steps would move far enough to be told, in std by name."""
    if model.finer is None:
        return {}
    names, std = [*model.told_std], np.array([*model.told_std.values()])
    return model.finer.far(names, std)
