"""The effects by name, and one of them drawn by chance."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np

from identification.errors import unknown_name
from inca_mj.robot.geometry import DRIVES
from inca_mj.studies.worlds import cable_effects, changes, drive_effects, sensor
from inca_mj.studies.worlds.effect import HiddenEffect, HiddenOneDriveEffect

_LAWS = {kind.name: kind for kind in (*drive_effects.KINDS, *cable_effects.KINDS)}
# What a discovery must call unknown, for it is in no catalogue. A backlash here is a play: the drum
# of the catalogue hangs at one edge of the gap.
_UNLISTED = ("backlash", "frame_vibration", "position_dependent_friction", "torque_ripple_time")

# What a discovery may name; the order is part of what a seed draws, here and below.
HIDDEN_EFFECTS = {name: kind for name, kind in _LAWS.items() if name not in _UNLISTED}
UNLISTED = {name: _LAWS[name] for name in _UNLISTED}
CHANGES = {kind.name: kind for kind in changes.KINDS}  # parameters that drift or jump
FAULTS = {kind.name: kind for kind in sensor.KINDS}  # of encoders
ALL_EFFECTS: dict[str, Any] = {**HIDDEN_EFFECTS, **UNLISTED, **CHANGES, **FAULTS}

# Sizes whose sign physics leaves open; the others keep that of their default.
_SIGNED = {"a", "b", "x", "y", "z", "delta", "alpha", "s"}

SEEN = (1.0, 4.0)  # when something jumps [s]: in the first half of a log of 10 s, which is fitted

# The same names by another law: a discovery that knows only the first law meets a wrong shape.
SHAPES: dict[str, dict[str, float | bool]] = {
    "stribeck_friction": {"exponent": 1.0},
    "quadratic_friction": {"exponent": 1.5},
    "torque_constant_drift": {"settle": 5.0},
    "current_saturation": {"soft": True, "i_max": 4.0},
    "spring_hardening": {"exponent": 1.0, "k_3": 1.0},
    "cable_hardening": {"exponent": 2.0, "kappa": 4e5},
    "cable_weight": {"sag": True},
    "air_drag": {"exponent": 1.5},
}


def effect(
    name: str, *, drive: int | None = None, other_shape: bool = False, **values: Any
) -> HiddenEffect:
    """Returns an effect of `ALL_EFFECTS`, of its default size where `values` give no other.

    It is on all drives, or on drive 1, where no drive is given; `other_shape` takes the law of
    `SHAPES`. Raises InputError if the name is unknown, or has no other shape.
    """
    if name not in ALL_EFFECTS:
        raise unknown_name("effect", name, ALL_EFFECTS)
    options = values if drive is None else {"drive": drive, **values}
    if other_shape:
        if name not in SHAPES:
            raise unknown_name("effect with another shape", name, SHAPES)
        options = {**SHAPES[name], **options}
    made: HiddenEffect = ALL_EFFECTS[name](**options)
    return made


def draw_effect(name: str, seed: int, *, other_shape: bool = False) -> HiddenEffect:
    """Returns an effect with drive, signs, direction and frequency drawn by chance.

    Sizes are between half and twice the default; give `world` a ratio to choose them.

    Raises:
        InputError: as `effect`.
    """
    rng = np.random.default_rng([seed, 77])
    chosen = effect(name, other_shape=other_shape)
    new: dict[str, float | int] = {}
    if isinstance(chosen, HiddenOneDriveEffect):
        new["drive"] = int(rng.integers(1, DRIVES + 1))
    have = {f.name for f in fields(chosen)}
    signed = [size for size in chosen.sizes if size in _SIGNED]
    length = float(np.linalg.norm([getattr(chosen, size) for size in signed]))
    direction = rng.normal(size=len(signed))
    for size, part in zip(signed, direction / (np.linalg.norm(direction) or 1.0), strict=True):
        new[size] = float(length * part)
    if "frequency" in have:
        new["frequency"] = float(rng.uniform(2.0, 12.0))
        new["phase"] = float(rng.uniform(-np.pi, np.pi))
    if name == "cogging":
        new["n"] = float(rng.choice([4, 6, 8, 12, 14, 18, 24]))
    if name == "cable_creep":
        new["tau"] = float(np.exp(rng.uniform(np.log(0.2), np.log(5.0))))
    if name == "stribeck_friction":
        new["v_s"] = float(rng.uniform(0.7, 3.0))
    if "t_s" in have:
        new["t_s"] = round(float(rng.uniform(*SEEN)), 2)
    if name == "encoder_lag":
        new["late"] = bool(rng.integers(2))
    factor = float(np.exp(rng.uniform(np.log(0.5), np.log(2.0))))
    return replace(chosen, **new).scaled(factor)
