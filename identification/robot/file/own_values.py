"""Values that hold in one log alone, `[values]` of its TOML, and `fixed` ones of a robot's file.

A weight that is hung on an arm, or the voltage of its supply, is known of each log and differs from
log to log. Such a value is no free parameter, and a log that does not give it has the model's own.
"""

from __future__ import annotations

from collections.abc import Sequence

import mujoco

from identification.effects.effect import Effect, effect_parameters
from identification.effects.named import damping_of, means_effect, unknown_number
from identification.effects.plant.joint_plant import JointPlant
from identification.errors import InputError, told_of
from identification.logs.log import Log
from identification.model.parameter import Parameter
from identification.model.plant import start_place
from identification.robot.file.file import RobotFile
from identification.robot.file.parameters import free_parameter
from identification.storage.files import toml_key


def value_parameters(
    file: RobotFile, model: mujoco.MjModel, effects: Sequence[Effect], logs: Sequence[Log]
) -> list[Parameter]:
    """Returns the parameters of the model that some log gives a value, beside those of effects."""
    numbers = {p.name for e in effects for p in effect_parameters(e)}
    free = {str(file.records.get(n, {}).get("path", n)): n for n in file.free}
    found: dict[str, Parameter] = {}
    for log in logs:
        for name in log.values:
            where = f"values of log {log.name!r}"
            if name in file.free or name in free:
                raise InputError(
                    f"{where} give {name}, which {file.path} frees (as {free.get(name, name)!r});"
                    " keep one of both"
                )
            if start_place(name, model) is not None:
                raise InputError(
                    f"{where} give {name}, an entry of the start, which each log begins by itself;"
                    f" leave it out, or write it under [start] of {file.path}"
                )
            if name in file.held:
                raise InputError(f"{where} give {name}, which {file.path} holds; keep one of both")
            if name in numbers or name in found:
                continue
            with told_of(f"{where}, in its TOML or under log.values in {file.path}"):
                found[name] = free_parameter(file, name, model, effects, log).parameter
    return [*found.values()]


def held_parameters(
    file: RobotFile, model: mujoco.MjModel, effects: Sequence[Effect], log: Log
) -> list[Parameter]:
    """Returns the parameters of a robot's file that keep the value which stands there.

    Raises:
        InputError: one has no table [parameters.NAME] with a value, or is an entry of the start.
    """
    out = []
    for name in file.held:
        said = file.records.get(name, {})
        with told_of(f"held in {file.path}"):
            if "value" not in said:
                raise InputError(
                    f"{name} has no value; write value = ... under [parameters.{toml_key(name)}],"
                    " or leave it out: the model then keeps its own"
                )
            if start_place(str(said.get("path", name)), model) is not None:
                raise InputError(f"{name} is an entry of the start; write it under [start]")
            out.append(free_parameter(file, name, model, effects, log).parameter)
    return out


def with_fixed(file: RobotFile, plant: JointPlant, effects: Sequence[Effect]) -> JointPlant:
    """Returns the plant with the values of effects' parameters that are not free."""
    with told_of(f"fixed in {file.path}"):
        for name in file.fixed:
            if name in plant.parameters.values():
                continue
            if (path := damping_of(name, effects)) is not None:
                raise InputError(
                    f"{name!r} is no number of an effect; it is {path} in {file.model}: write its"
                    f" value there, or name {path} under free"
                )
            if means_effect(name, effects):
                raise unknown_number(name, effects, is_free=False)
            raise InputError(
                f"{name!r} is no number of an effect; write its value into {file.model}, or name"
                " it under free"
            )
        return plant.with_values(file.fixed)


def refuse_impossible(plant: JointPlant, logs: Sequence[Log]) -> None:
    """Refuses values of logs outside their bounds, and moving bodies without mass."""
    _refuse_massless(plant.model)
    for log in logs:
        with told_of(f"values of log {log.name!r}"):
            _refuse_massless(plant.with_values(log.values).model)


def _refuse_massless(model: mujoco.MjModel) -> None:
    """Refuses a model that MuJoCo would not compile: a value has taken the mass of a moving body.

    What is welded to a body moves with it, so that their masses count together.
    """
    for body in range(1, model.nbody):
        together = model.body_weldid == body
        if model.body_dofnum[body] and model.body_mass[together].sum() < mujoco.mjMINVAL:
            raise InputError(
                f"body/{model.body(body).name} moves, and its mass is"
                f" {model.body_mass[body]:g} kg; give it a value above zero"
            )
