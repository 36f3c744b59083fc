"""What the commands share: which robot, where results go, how they are said."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

if TYPE_CHECKING:
    from identification.effects.effect import Effect
    from identification.model.parameter import ParameterSet
    from inca_mj.robot.geometry import Geometry


@dataclass(frozen=True)
class Values:
    """Which robot: a parameter set, some values of your own, a geometry of your own."""

    set: Literal["trial", "simulation"] = "trial"
    """Parameter set: the thesis' Table 3.2 (trial) or Table 2.1 (simulation)."""
    param: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME=VALUE")] = ()
    """Values of your own in SI units, such as m=0.2 lambda=26000."""
    geometry: Path | None = None
    """TOML file with exit points and connectors; the built-in ones are assumed."""

    def parameters(self) -> ParameterSet:
        """The parameter set with the values replaced.

        Raises:
            InputError: a value is malformed, unknown, given twice or out of bounds.
        """
        from inca_mj.robot.parameters import parameter_set

        values = assignments(self.param, "--param")
        return parameter_set(self.set, values)

    def place(self) -> Geometry:
        """The geometry.

        Raises:
            InputError: the file cannot be read as one.
        """
        from inca_mj.robot.geometry import INCA, read_geometry

        return INCA if self.geometry is None else read_geometry(self.geometry)


@dataclass(frozen=True)
class Robot(Values):
    """A robot to be simulated."""

    step: float = 1e-3
    """Largest step of the integrator [s]; stiff cables and light motors need a smaller one."""


def assignments(texts: Sequence[str], option: str, example: str = "m=0.2") -> dict[str, float]:
    """The values of an option that is given as NAME=VALUE.

    Args:
        texts: what was given.
        option: its name.
        example: a right one.

    Raises:
        InputError: one is malformed, or a name is given twice.
    """
    from identification.errors import InputError

    values: dict[str, float] = {}
    for text in texts:
        left, equals, right = text.partition("=")
        name = left.strip()
        try:
            if not equals:
                raise ValueError
            value = float(right)
        except ValueError:
            raise InputError(f"{text!r} is not NAME=VALUE; write e.g. {option} {example}") from None
        if name in values:
            raise InputError(
                f"{option} gives {name} twice, {values[name]:g} and {value:g}; give it once"
            )
        values[name] = value
    return values


def effects_of(words: Sequence[str]) -> tuple[tuple[Effect, ...], dict[str, float]]:
    """The effects of the catalogue that NAME.SIZE=VALUE words name, and their values.

    NAME alone stands for its first size, NAME.SIZE@3 for drive 3.

    Raises:
        InputError: a word is malformed, given twice, or names no effect or parameter of one.
    """
    from identification.errors import InputError, unknown_name
    from inca_mj.effects.catalogue import CATALOGUE
    from inca_mj.effects.values import records

    known = {effect.name: effect for effect in CATALOGUE}
    values: dict[str, float] = {}
    given = assignments(words, "--effect", "load_dependent_friction.mu=0.05")
    for word, value in given.items():
        name, _, place = word.partition("@")
        own, _, size = name.partition(".")
        if own not in known:
            raise unknown_name("effect", own, known)
        full = f"{own}.{size or known[own].sizes[0].name}" + (f"@{place}" if place else "")
        parameters = [p.name for p in records([known[own]])]
        if full not in parameters:
            raise unknown_name("parameter of an effect", full, parameters)
        if full in values:
            raise InputError(f"--effect gives {full} twice; give it once")
        values[full] = value
    named = {name.partition(".")[0] for name in values}
    return tuple(e for e in CATALOGUE if e.name in named), values


def cannot_draw() -> str:
    """Settle the OpenGL backend before MuJoCo is imported: "" or why nothing can be drawn."""
    from identification.errors import GraphicsError
    from inca_mj.rendering.graphics import choose_backend

    try:
        choose_backend()
    except GraphicsError as error:
        do_not_draw()
        return str(error)
    return ""


def do_not_draw() -> None:
    """Import MuJoCo without OpenGL, for commands that do not draw: a bad MUJOCO_GL breaks it."""
    before = os.environ.get("MUJOCO_GL")
    os.environ["MUJOCO_GL"] = "disable"
    try:
        import mujoco  # noqa: F401
    finally:
        if before is None:
            del os.environ["MUJOCO_GL"]
        else:
            os.environ["MUJOCO_GL"] = before


values_field: Any = field(default_factory=Values)
robot_field: Any = field(default_factory=Robot)
