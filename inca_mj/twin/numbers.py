"""Entries of mjModel that follow from the robot's parameters, for n value sets at once.

a drive k gets      value (1 + δ_k)
an exit point       A_k + its displacement
a connector         B_k + its displacement - the centre of mass

`owners` says which of the model's numbers one drive alone reads, so that its share is all that they
change.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import mujoco
import numpy as np

from identification.effects.values import Values
from identification.model.parameter import ParameterSet
from identification.model.paths import Slot, resolve
from identification.model.predictor import Numbers
from identification.native.installer import is_balanced_rotor
from inca_mj.effects.hooks import KEY, Layout
from inca_mj.effects.values import centre_of_mass
from inca_mj.effects.values import numbers as effect_numbers
from inca_mj.robot import law
from inca_mj.robot.geometry import Geometry
from inca_mj.robot.spread import AXES

Entries = Iterator[tuple[Slot, float | np.ndarray]]


def model_numbers(
    model: mujoco.MjModel, parameters: ParameterSet, geometry: Geometry, layout: Layout,
    names: Sequence[str], every: Values, n: int,
) -> Numbers:  # fmt: skip
    """Returns the entries of the model that the named parameters change, for n value sets.

    `every` holds the values of all parameters, one or n of each.
    """
    changed = [
        *_in_paths(model, parameters, names, every),
        *_points(model, geometry, layout, names, every, n),
        *effect_numbers(layout, names, every, model),
    ]
    return [(slot, np.broadcast_to(column, n)) for slot, column in changed]


def _in_paths(
    model: mujoco.MjModel, parameters: ParameterSet, names: Sequence[str], every: Values
) -> Entries:
    """Returns parameters that stand in the model, at each drive by itself where they differ."""
    touched = {name.partition("@")[0] for name in names}
    for parameter in parameters:
        name = parameter.name
        if name not in touched or "/" not in parameter.where:
            continue
        slot, value = resolve(model, parameter.where), every[name]
        if f"{name}@1" not in every:
            yield slot, value
            continue
        for k, row in enumerate(slot.rows, 1):
            yield Slot(slot.field, (row,), slot.column), value * (1 + every[f"{name}@{k}"])


def _points(
    model: mujoco.MjModel, geometry: Geometry, layout: Layout, names: Sequence[str],
    every: Values, n: int,
) -> Entries:  # fmt: skip
    """Yields points that parameters displace; connectors are seen from the centre of mass."""
    touched = {name.partition(".")[0] for name in names}
    moves_centre = any("centre" in e.hooks and e.name in touched for e in layout.effects)
    centre = centre_of_mass(layout.effects, every, n)
    for point, places, seen_from, all_move in (
        ("exit", geometry.A, np.zeros((n, 3)), False),
        ("connector", geometry.B, centre, moves_centre),
    ):
        for k, j in np.ndindex(places.shape):
            name = f"{point}_{AXES[j]}@{k + 1}"
            if all_move or name in names:
                site = int(model.site(f"{point}_{k + 1}").id)
                moved = every.get(name, 0.0) - seen_from[:, j]
                yield Slot("site_pos", (site,), j), places[k, j] + moved


def owners(model: mujoco.MjModel, key: float) -> dict[tuple[str, int], int]:
    """Returns the drive that alone reads a number of a model, by (array, row)."""
    out: dict[tuple[str, int], int] = {}
    if model.nuser_actuator < law.ACTUATOR_COLUMNS or model.nuser_tendon < law.TENDON_COLUMNS:
        return out
    cables = model.actuator_user[:, law.CABLE].tolist()
    if len({*model.wrap_objid.tolist()}) < model.nwrap or len({*cables}) < len(cables):
        return out  # two cables end at one point, or two drives pull at one cable
    for i, row in enumerate(model.actuator_user):
        if row[law.ACTUATOR_TAG] == law.TAG and (row[KEY] if len(row) > KEY else 0.0) == key:
            k, joint = int(row[law.CABLE]), model.actuator_trnid[i, 0]
            a, b = model.wrap_objid[model.tendon_adr[k] : model.tendon_adr[k] + 2]
            if model.body_weldid[model.site_bodyid[a]] or model.tendon_num[k] != 2:
                continue  # a share takes the cable from one point to the other, the first at rest
            out |= {
                ("actuator_user", i): i, ("actuator_gear", i): i, ("tendon_user", k): i,
                ("dof_damping", int(model.jnt_dofadr[joint])): i,
                ("site_pos", int(a)): i, ("site_pos", int(b)): i,
            }  # fmt: skip
            if is_balanced_rotor(model, joint):
                out["qpos", int(model.jnt_qposadr[joint])] = i
                out["qvel", int(model.jnt_dofadr[joint])] = i
    return out
