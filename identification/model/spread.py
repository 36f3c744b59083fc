"""The spread of a body's mass: an inertia that cannot become impossible.

    σ_k = (I_i + I_j - I_k)/2 = ∫ x_k² dm      second moment along principal axis k, [kg m²]
    I_k = σ_i + σ_j

The pseudo-inertia of a body (Wensing, Kim, Slotine 2018) about its centre of mass and in its
principal axes is diag(σ_1, σ_2, σ_3, m). It belongs to a distribution of mass exactly where m and
all σ are positive, wherever the centre of mass is. So a search over m, the centre and the spreads
`body/NAME.spread[k]`, each kept positive, meets possible bodies only, and all of them with these
principal axes. Inertias that are searched one by one may break I_i + I_j >= I_k.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

from identification.errors import InputError, unknown_name
from identification.model.paths import Slot

_SPREAD = re.compile(r"body/(?P<name>[^.]+)\.spread\[(?P<axis>[0-2])\]")
Place = tuple[int, int]


def spread_place(path: str, model: mujoco.MjModel) -> Place | None:
    """Returns body and axis of a path such as `body/link.spread[0]`; None for any other path."""
    match = _SPREAD.fullmatch(path)
    if match is None:
        if path.startswith("body/") and ".spread" in path:
            raise InputError(f"{path!r}: a spread has an axis, such as body/NAME.spread[0], 1 or 2")
        return None
    names = [model.body(i).name for i in range(model.nbody)]
    if match["name"] not in names:
        raise unknown_name("body", match["name"], filter(None, names))
    return names.index(match["name"]), int(match["axis"])


def spreads(model: mujoco.MjModel, body: int) -> np.ndarray:
    """Returns σ of a body, shape (3,) [kg m²]."""
    inertia = model.body_inertia[body]
    return np.asarray(inertia.sum() / 2 - inertia)


def with_spreads(
    model: mujoco.MjModel, values: Mapping[Place, np.ndarray], count: int
) -> list[tuple[Slot, np.ndarray]]:
    """Returns the entries of a model that some spreads change.

    Args:
        model: gives the spreads that are not among the values.
        values: by body and axis, shape (count,) [kg m²].
        count: how many value sets there are.

    Returns:
        Slots of principal inertias, and their values, shape (count,) [kg m²].
    """
    found: list[tuple[Slot, np.ndarray]] = []
    for body in dict.fromkeys(body for body, _ in values):
        sigma = np.tile(spreads(model, body), (count, 1))
        for (other, axis), column in values.items():
            if other == body:
                sigma[:, axis] = column
        inertia = sigma.sum(axis=1, keepdims=True) - sigma
        found += [(Slot("body_inertia", (body,), k), inertia[:, k]) for k in range(3)]
    return found


def refuse_both(paths: Sequence[str], model: mujoco.MjModel) -> None:
    """Refuse parameters that move a body's spreads and its inertias at once."""
    for path in paths:
        place = spread_place(path, model)
        if place is None:
            continue
        name = model.body(place[0]).name
        other = next((p for p in paths if p.startswith(f"body/{name}.inertia")), None)
        if other is not None:
            raise InputError(f"{path} and {other} move the same inertia; free the spreads alone")
