"""Effects as parameters of the twin: one record per size and place, all zero in the nominal model.

drive k gets    size(all drives) + size@k
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import mujoco
import numpy as np

from identification.effects.effect_parameters import effect_parameters
from identification.model.parameter import Parameter, ParameterSet
from identification.model.paths import Slot
from identification.model.predictor import Numbers
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.layout import Layout, Place
from inca_mj.robot.geometry import DRIVES, Geometry


def records(effects: Sequence[DriveEffect]) -> tuple[Parameter, ...]:
    """The parameters of some effects: `name.size` at all its places, `name.shape` once."""
    return tuple(record for e in effects for record in effect_parameters(e.effect))


def with_effects(parameters: ParameterSet, effects: Sequence[DriveEffect]) -> ParameterSet:
    """A parameter set with those of some effects, zero where it does not name them already."""
    known = {p.name for p in parameters}
    new = tuple(p for p in records(effects) if p.name not in known)
    return replace(parameters, records=(*parameters.records, *new))


def drive_values(effect: DriveEffect, values: Mapping[str, float]) -> np.ndarray:
    """Sizes and shapes of an effect at each drive, shape (k, 8)."""
    out = [
        [
            sum(values.get(f"{effect.name}.{size.name}{at}", 0.0) for at in ("", f"@{drive}"))
            for drive in range(1, DRIVES + 1)
        ]
        for size in effect.effect.sizes
    ]
    out += [[values[f"{effect.name}.{shape.name}"]] * DRIVES for shape in effect.effect.shapes]
    return np.array(out, float)


def present(effect: DriveEffect, values: Mapping[str, float]) -> bool:
    """Whether any size of an effect is not zero."""
    sizes = drive_values(effect, values)[: len(effect.effect.sizes)]
    return bool(sizes.any())


def numbers(layout: Layout, names: Sequence[str], own: Mapping[str, float], values: np.ndarray,
            model: mujoco.MjModel, geometry: Geometry) -> Numbers:  # fmt: skip
    """Model numbers of n value sets, for the effects that `names` touch.

    Args:
        layout: the effects and their columns.
        names: parameters that differ from `own`, p of them.
        own: values of all parameters.
        values: shape (n, p).
        model: with the names of the robot.
        geometry: its connectors, of which the centre of mass may move away.
    """
    touched = {name.partition(".")[0] for name in names}
    out: list[tuple[Slot, np.ndarray]] = []
    for place in layout:
        if place.effect.name in touched:
            rows = [{**own, **dict(zip(names, row, strict=True))} for row in values]
            each = np.array([drive_values(place.effect, row) for row in rows])  # (n, k, 8)
            out += _columns(place, each, model, geometry)
    return out


def inputs(
    effects: Sequence[DriveEffect], names: Sequence[str], own: Mapping[str, float],
    values: np.ndarray, held: np.ndarray, timestep: float,
) -> np.ndarray:  # fmt: skip
    """Currents after the effects that act before the model, for n value sets.

    Returns:
        `held` itself where no such effect is there, else shape (n, steps, 8) [A].
    """
    acting = [e for e in effects if e.inputs is not None]
    rows = [{**own, **dict(zip(names, row, strict=True))} for row in values] if acting else []
    if not any(present(e, row) for e in acting for row in rows):
        return held
    out = np.repeat(held[None], len(rows), axis=0)
    for n, row in enumerate(rows):
        for effect in acting:
            if effect.inputs is not None and present(effect, row):
                out[n] = effect.inputs(out[n], timestep, drive_values(effect, row))
    return out


def _columns(place: Place, each: np.ndarray, model: mujoco.MjModel, geometry: Geometry) -> Numbers:
    k = range(each.shape[1])
    if place.effect.centre:
        sites = [model.site(f"connector_{drive}").id for drive in range(1, DRIVES + 1)]
        return [
            (Slot("site_pos", (site,), j), b[j] - each[:, j, 0])
            for site, b in zip(sites, geometry.B, strict=True)
            for j in k
        ]
    if place.on_platform:
        row = (model.body("platform").id,)
        return [(Slot("body_user", row, place.column + j), each[:, j, 0]) for j in k]
    return [
        (Slot("actuator_user", (i,), place.column + j), each[:, j, i])
        for j in k
        for i in range(DRIVES if place.on_drives else 0)
    ]


def about_centre(
    geometry: Geometry, effects: Sequence[DriveEffect], values: Mapping[str, float]
) -> Geometry:
    """The geometry with its connectors as seen from where the centre of mass is."""
    moved = [drive_values(e, values)[:, 0] for e in effects if e.centre and present(e, values)]
    if not moved:
        return geometry
    return replace(geometry, connectors=tuple(map(tuple, geometry.B - np.sum(moved, axis=0))))
