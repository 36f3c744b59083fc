"""The linear model of a MuJoCo plant at operating points, with names.

    A = ∂f/∂x,  B = ∂f/∂u,  C = ∂y/∂x,  D = ∂y/∂u        central differences, f by MuJoCo

x = (position in tangent space, velocity, activation), y = what the model's sensors say. Where the
law has a kink (a joint limit, a contact, dry friction that holds), the differences tell the slope
across it, over a distance of 1e-6. Effects that act on inputs before the model, and on readings
behind it, are no part of it.

A state is called `JOINT.position`, `JOINT.rate` or `ACTUATOR.activation`; the axes of a ball or a
free joint follow as `JOINT.position_x` … and `JOINT.turn_x` …, where a turn is a small rotation
about an axis of the body. Sensors of several numbers are counted: `SENSOR_1` … .
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import mujoco
import numpy as np

from identification.errors import InputError, unknown_name
from identification.linear.derivatives import BALL, CENTRAL, FREE, differences, position_rows
from identification.linear.operating_points import OperatingPoints
from identification.linear.points import Points
from identification.linear.system import LinearSystem

RESULTS = ("qacc", "act_dot", "sensordata")
_MOVED = tuple(f"position_{axis}" for axis in "xyz")
_TURNED = tuple(f"turn_{axis}" for axis in "xyz")
_VELOCITY = tuple(f"velocity_{axis}" for axis in "xyz")
_TURNING = tuple(f"rate_{axis}" for axis in "xyz")


def linearize(points: OperatingPoints, outputs: Sequence[str] = ()) -> tuple[LinearSystem, ...]:
    """Returns the linear system at each operating point.

    Args:
        points: M operating points, as `at_rest` or `along_log` find them.
        outputs: names of sensors; all of the model's when empty.

    Returns:
        M systems, whose states are `identification.linear.linearization.state_names`.

    Raises:
        InputError: an output is no sensor of the model.
        DivergenceError: the accelerations are not finite.
    """
    model = points.model
    names, places = output_places(model, outputs)
    nv, nf = model.nv, model.nv + model.na
    evaluated = Points(points, results=RESULTS)
    now = evaluated.rates()
    of_state, of_inputs = differences(points, evaluated, CENTRAL)
    A = np.concatenate([position_rows(model, points.qvel), of_state[:, :nf]], axis=1)
    still = np.zeros((len(A), nv, model.nu))
    B = np.concatenate([still, of_inputs[:, :nf]], axis=1)
    rate = np.concatenate([points.qvel, now[:, :nf]], axis=1)
    x = np.concatenate([_positions(points), points.qvel, points.act], axis=1)
    return tuple(
        LinearSystem(
            A=A[k], B=B[k], C=of_state[k, nf + places], D=of_inputs[k, nf + places],
            states=state_names(model), inputs=input_names(model), outputs=names,
            x=x[k], u=points.inputs[k], y=now[k, nf + places], rate=rate[k],
        )
        for k in range(len(A))
    )  # fmt: skip


def _positions(points: OperatingPoints) -> np.ndarray:
    """Returns positions in tangent space, shape (M, nv); rotations of ball or free joints are 0."""
    model = points.model
    out = np.zeros((len(points.time), model.nv))
    for joint, dof in enumerate(model.jnt_dofadr):
        of_joint = np.flatnonzero(model.dof_jntid == joint)
        place, size = int(model.jnt_qposadr[joint]), {6: 3, 3: 0, 1: 1}[len(of_joint)]
        out[:, dof : dof + size] = points.qpos[:, place : place + size]
    return out


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
    """Returns names of single outputs, and where each stands among the numbers of the sensors."""
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
