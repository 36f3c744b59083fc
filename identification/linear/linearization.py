"""The linear model of a MuJoCo plant at operating points.

    A = ∂f/∂x,  B = ∂f/∂u,  C = ∂y/∂x,  D = ∂y/∂u        central differences, f by MuJoCo

x = (position in tangent space, velocity, activation), y = what the model's sensors say. Where the
law has a kink (a joint limit, a contact, dry friction that holds), the differences tell the slope
across it, over a distance of 1e-6. Effects that act on inputs before the model, and on readings
behind it, are no part of it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.linear.derivatives import CENTRAL, differences, position_rows
from identification.linear.names import input_names, output_places, state_names
from identification.linear.operating_points import OperatingPoints
from identification.linear.points import Points
from identification.linear.system import LinearSystem

RESULTS = ("qacc", "act_dot", "sensordata")


def linearize(points: OperatingPoints, outputs: Sequence[str] = ()) -> tuple[LinearSystem, ...]:
    """Returns the linear system at each operating point.

    Args:
        points: M operating points, as `at_rest` or `along_log` find them.
        outputs: names of sensors; all of the model's when empty.

    Returns:
        M systems, whose states are `identification.linear.names.state_names`.

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
