"""A twin with effects as files: model.xml, and effects.json with what MJCF cannot say.

The law of an effect is code and is not saved. So a model can be loaded only if effects with the
saved names are given. Those of the catalogue are given by default; the user passes effects of their
own.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from identification.effects.effect import Effect
from identification.errors import InputError
from identification.model.parameter import Parameter, ParameterSet
from identification.storage.files import MODEL, read_json, read_text, write_text
from inca_mj.effects.catalogue import EVERY
from inca_mj.effects.values import records
from inca_mj.robot.geometry import geometry_of
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread
from inca_mj.twin.twin import Twin, build_twin

# What a file of a model says of its physics: fields of mjModel that begin so, but for the looks.
_PHYSICS = ("body_", "jnt_", "dof_", "tendon_", "actuator_", "sensor_", "site_", "qpos", "key_")
_LOOKS = ("_rgba", "_matid", "_group", "_width", "_size", "dof_length")
ROUNDING = 1e-9  # relative: kernels of linear algebra differ in the last bits


def save_twin(robot: Twin, folder: str | Path) -> tuple[Path, Path]:
    """Write model.xml and effects.json into a folder; returns their paths.

    Args:
        robot: the twin.
        folder: where to write; it must exist.

    Raises:
        InputError: the folder does not exist or cannot be written to.
    """
    folder = Path(folder)
    record = {"model": "model.xml", **twin_to_record(robot)}
    text = json.dumps(record, indent=1, allow_nan=False, ensure_ascii=False) + "\n"
    return robot.save(folder / "model.xml"), write_text(folder / "effects.json", text)


def twin_to_record(robot: Twin) -> dict[str, Any]:
    """Returns what is needed to build a twin again, as plain values."""
    values = robot.parameters.values()
    return {
        "set": robot.parameters.name,
        "values": {p.name: p.value for p in robot.parameters if p.where != "effect"},
        "geometry": asdict(robot.geometry),
        "timestep": robot.model.opt.timestep,
        "settled": robot.settled,
        "effects": [_effect(effect, values) for effect in robot.effects],
    }


def twin_from_record(record: Mapping[str, Any], effects: Sequence[Effect], source: Path) -> Twin:
    """Builds the twin of a record by `twin_to_record`; `source` is where it was read, for messages.

    Raises InputError if an effect is not among `effects` or has another law there, or a value is
    out of bounds; KeyError, TypeError or ValueError if the record is damaged.
    """
    wanted: list[dict[str, Any]] = record["effects"]
    own, settled = _known(wanted, effects, source), record["settled"]
    if not isinstance(settled, bool):
        raise TypeError("settled is neither true nor false")
    values = {**record["values"], **{n: v for e in wanted for n, v in e["values"].items()}}
    return build_twin(
        _parameters(record["set"], values, own),
        geometry_of(record["geometry"]),
        timestep=record["timestep"],
        effects=own,
        settled=settled,
    )


def load_twin(path: str | Path, effects: Sequence[Effect] = EVERY) -> Twin:
    """Read a twin written by `save_twin`; it is the same to the last bit on the same processor.

    Its model is computed from effects.json. model.xml must say the same physics, to rounding.

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
        model = folder / record["model"]
        robot = twin_from_record(record, effects, folder)
    except InputError:
        raise
    except (KeyError, TypeError, AttributeError, ValueError, OverflowError) as error:
        raise InputError(
            f"{folder / 'effects.json'} is damaged ({type(error).__name__}: {error}); save the"
            " twin again"
        ) from error
    _same(robot.model, model)
    return robot


def _effect(effect: Effect, values: dict[str, float]) -> dict[str, Any]:
    names = [p.name for p in records([effect]) if p.name in values]
    known = [
        where for where, suffix in effect.places.items()
        if any(values.get(f"{effect.name}.{s.name}{suffix}", 0.0) for s in effect.sizes)
    ]  # fmt: skip
    return {
        "name": effect.name,
        "where": known,
        "law": effect.law,
        "reference": effect.reference,
        "values": {name: values[name] for name in names},
    }


def _read(path: Path) -> dict[str, Any]:
    if not path.exists():
        raise InputError(f"no {path}; inca discover --out DIR writes one")
    record = read_json(path, "file of a saved twin", "save the twin again")
    if not isinstance(record, dict):
        raise InputError(f"{path} holds no object; save the twin again")
    return record


def _known(
    wanted: Sequence[dict[str, Any]], effects: Sequence[Effect], source: Path
) -> tuple[Effect, ...]:
    """Returns the effects of these names, with these laws."""
    at_hand = {e.name: e for e in effects}
    missing = [e["name"] for e in wanted if e["name"] not in at_hand]
    if missing:
        raise InputError(
            f"the twin in {source} has effects of which the law is not at hand:"
            f" {', '.join(missing)}; pass them, as load_twin(path, effects=(*CATALOGUE, yours))"
        )
    changed = [e["name"] for e in wanted if at_hand[e["name"]].law != e["law"]]
    if changed:
        raise InputError(
            f"the twin in {source} was saved with another law of {', '.join(changed)}; pass the"
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
    """Refuses a model.xml that was edited after it was saved, or belongs to another twin."""
    if not path.is_file():
        raise InputError(f"no {path}; save the twin again")
    try:
        other = mujoco.MjModel.from_xml_string(read_text(path, what=MODEL))
    except ValueError as error:
        text = " ".join(str(error).split())
        raise InputError(f"{path} is not a model MuJoCo can read: {text}") from None
    for name, a, b in _physics(model, other):
        if a.shape != b.shape or not np.allclose(a, b, rtol=ROUNDING, atol=1e-12):
            raise InputError(
                f"{path} is not the model of its effects.json: {name} differs; change values with"
                " Twin.with_values, or save the twin again"
            )


def _physics(one: mujoco.MjModel, other: mujoco.MjModel) -> Iterator[tuple[str, Any, Any]]:
    """Yields the physics of two models: the name of each field, and what it is in both."""
    for name in dir(one):
        if name.startswith(_PHYSICS) and not name.endswith(_LOOKS):
            a, b = getattr(one, name), getattr(other, name)
            if isinstance(a, np.ndarray):
                yield name, a, b
    for name in dir(one.opt):
        a, b = getattr(one.opt, name), getattr(other.opt, name)
        if isinstance(a, np.ndarray | float | int):
            yield name, np.asarray(a), np.asarray(b)
