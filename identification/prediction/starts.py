"""A record's start is no parameter of predictions: each window begins at a state of its own."""

from __future__ import annotations

from dataclasses import replace

from identification.discovery.nominal_model import NominalModel
from identification.model.plant import start_place


def without_starts(nominal_model: NominalModel) -> NominalModel:
    """Returns a nominal model without free parameters that are entries of the initial state.

    Args:
        nominal_model: any.
    """
    plant, names = nominal_model.plant, nominal_model.names
    at = plant.parameters
    keep = [k for k, n in enumerate(names) if start_place(at[n].where, plant.model) is None]
    kept = tuple(names[k] for k in keep)
    return replace(
        nominal_model, names=kept, std=nominal_model.std[keep],
        own=tuple(n for n in nominal_model.own if n in kept),
        mean={n: mean for n, mean in nominal_model.mean.items() if n in kept},
    )  # fmt: skip
