"""Effects as parameters of the twin: one record per size and place, all zero in the nominal model.

drive k gets    size(all drives) + size@k
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np

from identification.effects.effect import Effect, effect_parameters
from identification.effects.values import Values, changed_columns, table_at, written_at
from identification.model.parameter import Parameter, ParameterSet
from identification.model.paths import Slot
from inca_mj.effects.hooks import THINGS, Layout, Platform
from inca_mj.robot.geometry import Geometry

# The centre of mass depends on no state.
_NOWHERE = Platform(**dict.fromkeys(Platform._fields, np.nan))


def records(effects: Sequence[Effect]) -> tuple[Parameter, ...]:
    """Returns the parameters of some effects: `name.size` at all its places, `name.shape` once."""
    return tuple(record for e in effects for record in effect_parameters(e))


def with_effects(parameters: ParameterSet, effects: Sequence[Effect]) -> ParameterSet:
    """Returns a parameter set with those of some effects, zero where they are new."""
    known = {p.name for p in parameters}
    new = tuple(p for p in records(effects) if p.name not in known)
    return replace(parameters, records=(*parameters.records, *new))


def drive_values(effect: Effect, values: Mapping[str, float]) -> np.ndarray:
    """Returns the sizes and shapes of an effect at each drive, shape (k, 8)."""
    return np.array([written_at(effect, thing, values) for thing in THINGS]).T


def present(effect: Effect, values: Mapping[str, float]) -> bool:
    """Returns whether any size of an effect is not zero."""
    return any(values[name] != 0.0 for name in effect.every_size)


def numbers(
    layout: Layout, names: Sequence[str], every: Values, model: mujoco.MjModel
) -> Iterator[tuple[Slot, float | np.ndarray]]:
    """Yields entries in the rows of drives and platform that some parameters of effects change."""
    for i, thing in enumerate(THINGS):
        changed = changed_columns(layout.effects, layout.on_drives, thing, names, every)
        for column, new in changed:
            yield Slot("actuator_user", (i,), column), new
    body = int(model.body("platform").id)
    changed = changed_columns(layout.effects, layout.on_platform, "platform", names, every)
    for column, new in changed:
        yield Slot("body_user", (body,), column), new


def centre_of_mass(effects: Sequence[Effect], every: Values, n: int) -> np.ndarray:
    """Returns the centre of mass with effects for n value sets, in body axes, shape (n, 3) [m]."""
    out = np.zeros((n, 3))
    for effect in (e for e in effects if "centre" in e.hooks):
        place: Any = effect.hooks["centre"]
        for moved, row in zip(out, table_at([effect], "platform", every, n), strict=True):
            if row[: len(effect.sizes)].any():
                moved += place.py_func(_NOWHERE, tuple(row))
    return out


def about_centre(
    geometry: Geometry, effects: Sequence[Effect], values: Mapping[str, float]
) -> Geometry:
    """Returns the geometry with its connectors as seen from the centre of mass."""
    (centre,) = centre_of_mass(effects, values, 1)
    if not centre.any():
        return geometry
    return replace(geometry, connectors=tuple(map(tuple, geometry.B - centre)))
