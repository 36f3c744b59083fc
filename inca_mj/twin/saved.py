"""A twin with effects as files: model.xml, and effects.json with what MJCF cannot say.

The law of an effect is code and is not saved. So a model can be loaded only if effects with the
saved names are given. Those of the catalogue are given by default; the user passes effects of their
own.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from identification.effects.effect import Effect
from identification.errors import InputError
from identification.files import write_text
from identification.model.parameter import Parameter, ParameterSet
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.effects.values import records
from inca_mj.robot.geometry import geometry_of
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread
from inca_mj.twin.twin import Twin, build_twin

_ARRAYS = (
    "actuator_user", "actuator_gear", "tendon_user", "body_user", "body_mass", "body_inertia",
    "dof_damping", "dof_armature", "site_pos", "qpos0", "key_qpos", "key_act",
)  # fmt: skip


def save_twin(robot: Twin, folder: str | Path) -> tuple[Path, Path]:
    """Write model.xml and effects.json into a folder; returns their paths.

    Args:
        robot: the twin.
        folder: where to write; it must exist.

    Raises:
        InputError: the folder does not exist or cannot be written to.
    """
    folder = Path(folder)
    values = robot.parameters.values()
    record = {
        "model": "model.xml",
        "set": robot.parameters.name,
        "values": {p.name: p.value for p in robot.parameters if p.where != "effect"},
        "geometry": asdict(robot.geometry),
        "timestep": robot.model.opt.timestep,
        "settled": robot.settled,
        "effects": [_effect(effect, values) for effect in robot.effects],
    }
    text = json.dumps(record, indent=1, allow_nan=False, ensure_ascii=False) + "\n"
    return robot.save(folder / "model.xml"), write_text(folder / "effects.json", text)


def load_twin(path: str | Path, effects: Sequence[Effect] = CATALOGUE) -> Twin:
    """Read a twin written by `save_twin`; it is the same to the last bit.

    Args:
        path: the folder, or one of the two files.
        effects: the effects that the twin may have.

    Raises:
        InputError: a file is missing or damaged, an effect is not among `effects` or has another
            law in them, or the two files do not belong together.
    """
    own_file = Path(path).suffix in (".xml", ".json")
    folder = Path(path).parent if own_file else Path(path)
    record = _read(folder / "effects.json")
    try:
        geometry = geometry_of(record["geometry"])
        wanted: list[dict[str, Any]] = record["effects"]
        own = _known(wanted, effects, folder)
        values = {**record["values"], **{n: v for e in wanted for n, v in e["values"].items()}}
        robot = build_twin(
            _parameters(record["set"], values, own),
            geometry,
            timestep=record["timestep"],
            effects=own,
            settled=record["settled"],
        )
    except (KeyError, TypeError, AttributeError) as error:
        raise InputError(
            f"{folder / 'effects.json'} is damaged ({type(error).__name__}: {error}); save the"
            " twin again"
        ) from error
    _same(robot.model, folder / record["model"])
    return robot


def _effect(effect: Effect, values: dict[str, float]) -> dict[str, Any]:
    names = [p.name for p in records([effect]) if p.name in values]
    there = [
        where for where, suffix in effect.places.items()
        if any(values.get(f"{effect.name}.{s.name}{suffix}", 0.0) for s in effect.sizes)
    ]  # fmt: skip
    return {
        "name": effect.name,
        "where": there,
        "law": effect.law,
        "reference": effect.reference,
        "values": {name: values[name] for name in names},
    }


def _read(path: Path) -> dict[str, Any]:
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(f"no {path}; inca discover --out DIR writes one") from None
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise InputError(f"{path} cannot be read as JSON ({error}); save the twin again") from None
    if not isinstance(record, dict):
        raise InputError(f"{path} holds no object; save the twin again")
    return record


def _known(
    wanted: Sequence[dict[str, Any]], effects: Sequence[Effect], folder: Path
) -> tuple[Effect, ...]:
    """The effects of these names, with these laws."""
    at_hand = {e.name: e for e in effects}
    missing = [e["name"] for e in wanted if e["name"] not in at_hand]
    if missing:
        raise InputError(
            f"the twin in {folder} has effects of which the law is not at hand:"
            f" {', '.join(missing)}; pass them, as load_twin(path, effects=(*CATALOGUE, yours))"
        )
    changed = [e["name"] for e in wanted if at_hand[e["name"]].law != e["law"]]
    if changed:
        raise InputError(
            f"the twin in {folder} was saved with another law of {', '.join(changed)}; pass the"
            " effect as it was then"
        )
    return tuple(at_hand[e["name"]] for e in wanted)


def _parameters(name: str, values: dict[str, float], effects: Sequence[Effect]) -> ParameterSet:
    base = parameter_set(name)
    if any("@" in value and "." not in value for value in values):
        base = with_spread(base)
    known: tuple[Parameter, ...] = (*base.records, *records(effects))
    return replace(base, records=known).with_values(values)


def _same(model: mujoco.MjModel, path: Path) -> None:
    """Refuse a model.xml that was edited after it was saved, or that belongs to another twin.

    Raises:
        InputError: the file was edited, belongs to another twin, or cannot be read.
    """
    if not path.is_file():
        raise InputError(f"no {path}; save the twin again")
    try:
        other = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise InputError(f"{path} is not a model MuJoCo can read: {error}") from None
    for name in _ARRAYS:
        a, b = getattr(model, name), getattr(other, name)
        if a.shape != b.shape or not np.array_equal(a, b):
            raise InputError(
                f"{path} is not the model of its effects.json: {name} differs; change values with"
                " Twin.with_values, or save the twin again"
            )
