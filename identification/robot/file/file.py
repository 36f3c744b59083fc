"""A TOML that says what a robot is: its model, its log's columns, what is free or missing.

`docs/robot/keys.md` has every key with its type, unit, default and meaning. A free name is a key
under `parameters`, a path into the model or its start, or a size of an effect.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from identification.errors import InputError
from identification.refusals.trust import trusted
from identification.robot.file.alike import Alike, read_alike
from identification.robot.file.file_checks import (
    EFFECTS_KEYS,
    KEYS,
    PARAMETER_KEYS,
    check_table,
    numbers,
    numbers_of,
    read_own,
    read_own_values,
    texts,
    words_of,
)
from identification.storage.files import is_file, read_toml

LONGEST = 1e6  # [s] of a horizon
MODELS = (".xml", ".mjcf", ".urdf")  # endings of models, which are given by mistake


@dataclass(frozen=True, kw_only=True)
class RobotFile:
    """The content of a robot's TOML."""

    path: Path
    model: Path  # the MJCF
    free: tuple[str, ...]  # names of the free parameters
    held: tuple[str, ...] = ()  # names of parameters that are told of and keep their value
    own: tuple[str, ...] = ()  # those of which each log has a value of its own
    outputs: tuple[str, ...] = ()  # sensors; empty for all joint positions
    horizon: float | None = None  # of the windows that are predicted [s]; None for a free run
    every: int = 1  # n, where every n-th sample is kept
    trust: tuple[str, ...] = ()  # words of `TRUST`: judgements that do not refuse a log
    start: Mapping[str, float] = field(default_factory=dict)  # entries of the state by path
    log: Mapping[str, Any] = field(default_factory=dict)  # what a log's own TOML may say otherwise
    columns: Mapping[str, str] = field(default_factory=dict)  # by actuator or sensor
    poses: Mapping[str, tuple[str, ...]] = field(default_factory=dict)  # by free joint or sensor
    fixed: Mapping[str, float] = field(default_factory=dict)  # of effects, by parameter
    records: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)  # by free parameter
    own_values: Mapping[str, Mapping[str, float]] = field(default_factory=dict)  # by log, name
    joints: tuple[str, ...] = ()  # where effects may act; empty for the measured ones
    only: tuple[str, ...] = ()  # candidates by name; empty for all
    own_effects: tuple[str, ...] = ()  # that are not of the catalogue, by name
    turns: tuple[float, ...] = ()  # periods of a turn to try; empty for the catalogue's
    fitted: Mapping[str, str] = field(default_factory=dict)  # digests of logs by name
    spread: tuple[Alike, ...] = ()  # their parameters are free too, behind those that it frees

    @property
    def by_itself(self) -> tuple[str, ...]:
        """The free parameters that belong to no spread."""
        return tuple(n for n in self.free if n not in {m for a in self.spread for m in a.names})

    @property
    def stray(self) -> str:
        """The error where it tells of a parameter that is neither free nor held; "" without one."""
        stray = [name for name in self.records if name not in (*self.free, *self.held)]
        if not stray:
            return ""
        return (
            f"{self.path} tells of parameter {stray[0]!r}, which is not among its `free`"
            f" ({', '.join(sorted(self.free))}); correct the name in one of the two places, or name"
            " it under `held`, where it keeps its value"
        )


def read_robot_file(path: str | Path) -> RobotFile:
    """Read a robot's TOML."""
    path = Path(path)
    if path.suffix.lower() in MODELS and is_file(path):
        raise InputError(
            f"{path} is a model and no robot file; write identification new {path} LOG, which"
            " writes one, robot.toml"
        )
    content = read_toml(path, "robot file, such as robot.toml")
    check_table(content, KEYS, str(path))
    for key in ("model", "free"):
        if not content.get(key) and not (key == "free" and content.get(key) == []):
            raise InputError(f"{path} does not say {key!r}; give {KEYS[key][1]}")
    horizon = content.get("horizon")
    if horizon is not None and abs(horizon) > LONGEST:
        raise InputError(
            f"horizon in {path} is {horizon:g} s; give one that fits into a log, such as 0.2 s"
        )
    alike = read_alike(content, path, content["free"])
    free = (*texts(content["free"], "free", path), *(n for a in alike for n in a.names))
    records = content.get("parameters", {})
    for name, record in records.items():
        if not isinstance(record, dict):
            raise InputError(f"parameters.{name} in {path} must be a table")
        check_table(record, PARAMETER_KEYS, f"parameters.{name} in {path}")
    held = texts(content.get("held", []), "held", path)
    if twice := [name for name in held if name in free]:
        raise InputError(f"{path} has {twice[0]} under free and under held; keep one of both")
    every = content.get("columns", {})
    poses = {n: texts(x, f"columns.{n}", path) for n, x in every.items() if isinstance(x, list)}
    columns = {name: each for name, each in every.items() if name not in poses}
    start = numbers_of(content.get("start", {}), f"start in {path}")
    if twice := [name for name in start if name in content["free"]]:
        raise InputError(f"{path} gives {twice[0]} under [start] and frees it; keep one of both")
    effects = content.get("effects", {})
    check_table(effects, EFFECTS_KEYS, f"effects in {path}")
    model = path.parent / content["model"]
    if not is_file(model):
        raise InputError(f"{path} names the model {model}, which is no file; correct it there")
    return RobotFile(
        path=path,
        model=model,
        free=free,
        held=held,
        own=read_own(content, path),
        outputs=texts(content.get("outputs", []), "outputs", path),
        horizon=horizon,
        every=content.get("every", 1),
        trust=trusted(content.get("trust", []), f"under trust in {path}"),
        start=start,
        log=content.get("log", {}),
        columns=words_of(columns, f"columns in {path}"),
        poses=poses,
        fixed=numbers_of(content.get("fixed", {}), f"fixed in {path}"),
        records=records,
        own_values=read_own_values(content, path),
        joints=texts(effects.get("joints", []), "effects.joints", path),
        only=texts(effects.get("only", []), "effects.only", path),
        own_effects=texts(effects.get("own", []), "effects.own", path),
        turns=numbers(effects.get("turns", []), "effects.turns", path),
        spread=alike,
        fitted=words_of(content.get("fitted", {}), f"fitted in {path}"),
    )


def refuse_nothing_free(file: RobotFile) -> None:
    """Refuses a robot whose file frees nothing, where something is to be fitted.

    Torques are compared without: what they fit always is friction (`fit_torques`).
    """
    if not file.free:
        raise InputError(
            f"`free` in {file.path} is empty, so that there is nothing to fit; write what is to be"
            ' found into it, such as free = ["joint/slide.damping"]; identification torques needs'
            " none"
        )


def with_spread(file: RobotFile, word: str) -> RobotFile:
    """Returns a robot's file with its own spread ("usual"), no deviations ("none"), or another.

    Args:
        file: of the robot.
        word: one of these words, or the path of a TOML with tables [spread.NAME].

    Raises:
        InputError: there is no such file, or it holds anything else.
    """
    if word == "usual":
        return file
    alike = tuple(replace(a, deviates=False) for a in file.spread)
    if word != "none":
        if not is_file(Path(word)):
            raise InputError(f"no spread {word!r}; give none, usual, or a TOML file")
        content = read_toml(Path(word))
        check_table(content, {"spread": KEYS["spread"]}, word)
        alike = read_alike(content, Path(word), file.by_itself)
    free = (*file.by_itself, *(n for a in alike for n in a.names))
    records = {n: r for n, r in file.records.items() if n in free}
    return replace(file, free=free, records=records, spread=alike)
