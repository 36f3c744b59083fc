"""Names of the states, inputs and outputs of a model.

A state is called `JOINT.position`, `JOINT.rate` or `ACTUATOR.activation`; the axes of a ball or a
free joint follow as `JOINT.position_x` … and `JOINT.turn_x` …, where a turn is a small rotation
about an axis of the body. Sensors of several numbers are counted: `SENSOR_1` … .
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import mujoco
import numpy as np

from identification.errors import InputError, unknown_name
from identification.linear.derivatives import BALL, FREE

_MOVED = tuple(f"position_{axis}" for axis in "xyz")
_TURNED = tuple(f"turn_{axis}" for axis in "xyz")
_VELOCITY = tuple(f"velocity_{axis}" for axis in "xyz")
_TURNING = tuple(f"rate_{axis}" for axis in "xyz")


def state_names(model: mujoco.MjModel) -> tuple[str, ...]:
    """Returns names of position (nv), velocity (nv) and activations (na), in this order."""
    return (*_of_joints(model, 0), *_of_joints(model, 1), *_of_activations(model))


def input_names(model: mujoco.MjModel) -> tuple[str, ...]:
    """Returns names of the actuators that have an input, in the order of the controls."""
    named = (model.actuator(i) for i in range(len(model.actuator_trntype)))
    return tuple(a.name or f"actuator {a.id}" for a in named)[: model.nu]


def _of_joints(model: mujoco.MjModel, order: int) -> Iterator[str]:
    for joint, kind in enumerate(model.jnt_type):
        name = model.joint(joint).name or f"joint {joint}"
        free = ((*_MOVED, *_TURNED), (*_VELOCITY, *_TURNING))[order]
        parts = {FREE: free, BALL: (_TURNED, _TURNING)[order]}
        for part in parts.get(int(kind), (("position",), ("rate",))[order]):
            yield f"{name}.{part}"


def _of_activations(model: mujoco.MjModel) -> Iterator[str]:
    for i, size in enumerate(model.actuator_actnum):
        name = model.actuator(i).name or f"actuator {i}"
        for k in range(int(size)):
            yield f"{name}.activation" + (f"_{k + 1}" if size > 1 else "")


def output_places(
    model: mujoco.MjModel, outputs: Sequence[str]
) -> tuple[tuple[str, ...], np.ndarray]:
    """Returns names of single outputs, and where each stands among the numbers of the sensors.

    Args:
        model: the model.
        outputs: names of sensors; all of the model's when empty.

    Returns:
        ny names, and places of shape (ny,), whole numbers.

    Raises:
        InputError: a name is no sensor of the model, or it has none.
    """
    sensors = {model.sensor(i).name or f"sensor {i}": i for i in range(model.nsensor)}
    if not sensors:
        raise InputError("the model has no sensors, so it has no outputs; give it a jointpos")
    names: list[str] = []
    places: list[int] = []
    for name in outputs or sensors:
        if name not in sensors:
            raise unknown_name("sensor", name, sensors)
        first, size = int(model.sensor_adr[sensors[name]]), int(model.sensor_dim[sensors[name]])
        names += [name] if size == 1 else [f"{name}_{k + 1}" for k in range(size)]
        places += range(first, first + size)
    return tuple(names), np.array(places, int)
