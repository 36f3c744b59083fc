"""Missing forces: which forces would have to act, and where, for the nominal model to be right.

    M δv̇ = … + r w,    w: a first-order process of the level that makes the residual most likely

r scales each force by how much it moves the outputs, so that newtons and newton metres compare. One
group of degrees of freedom is taken at a time: the actuated joints, or a free body. Each group may
explain all of the residual. Where few outputs are measured, forces at another place have nearly the
same effect, and only the law of an effect tells the place.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from identification.kalman.linear import LinearPlant, linearise
from identification.kalman.noise_fit import START_CORRELATION_TIME, compute_unit_ratio, fit_noise
from identification.kalman.noise_model import smooth
from identification.kalman.refit import Refit
from identification.pool import one_blas_thread

AXES = ("x", "y", "z")
FREE, SLIDE = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_SLIDE)


@dataclass(frozen=True, kw_only=True)
class MissingForce:
    """Forces on some degrees of freedom that would explain a residual.

    Attributes:
        where: "the actuated joints", or the name of a free body.
        names: of the degrees of freedom, k of them.
        units: N or N m, k of them.
        force: the smoothed estimate over the fitted samples, shape (N, k), in their units.
        gain: twice the log likelihood that they add to a model without them.
        share: of the residual's mean square that they explain, 0 to 1.
    """

    where: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    force: np.ndarray
    gain: float
    share: float


def estimate_missing_forces(fit: Refit) -> tuple[MissingForce, ...]:
    """Returns the missing forces of every group of degrees of freedom.

    Args:
        fit: the nominal model, fitted.

    Raises:
        DivergenceError: the model cannot be simulated.
    """
    point = fit.point
    groups = _groups(point.predictor.plant.model)
    dofs = [d for _, of, _, _ in groups for d in of]
    plant = linearise(point.predictor, point.space.decode(point.q), forces=dofs)
    Ts, time, out, done = point.log.sampling_time, START_CORRELATION_TIME, [], 0
    known = point.e, point.J, fit.priors.weight, Ts
    with one_blas_thread():
        none = fit_noise(plant, *known, levels=(0.0,), fine=False)
        for where, of, names, units in groups:
            B = plant.B[:, :, done : done + len(of)]
            done += len(of)
            if not B.any():
                continue
            each = [compute_unit_ratio(LinearPlant(plant.A, b[:, :, None], plant.C), Ts, time)
                    for b in np.moveaxis(B, 2, 0)]  # fmt: skip
            mine = LinearPlant(plant.A, B * each, plant.C)
            level = fit_noise(mine, *known, fine=False)
            force, part = smooth(mine, level.noise, point.e, Ts)
            out.append(
                MissingForce(
                    where=where,
                    names=names,
                    units=units,
                    force=force * each,
                    gain=2 * (level.log_likelihood - none.log_likelihood),
                    share=1 - float(np.mean((point.e - part) ** 2) / np.mean(point.e**2)),
                )
            )
    return tuple(out)


def list_actuated_joints(model: mujoco.MjModel) -> dict[int, int]:
    """Returns joints (not free) on which actuators act directly, and the first actuator of each."""
    transmission = int(mujoco.mjtTrn.mjTRN_JOINT)
    out: dict[int, int] = {}
    for i in range(model.nu):
        joint = int(model.actuator_trnid[i, 0])
        if model.actuator_trntype[i] == transmission and model.jnt_type[joint] != FREE:
            out.setdefault(joint, i)
    return out


def _groups(
    model: mujoco.MjModel,
) -> list[tuple[str, list[int], tuple[str, ...], tuple[str, ...]]]:
    """Returns name, degrees of freedom, their names and units: joints first, then free bodies."""
    joints = [*list_actuated_joints(model)]
    out = []
    if joints:
        out.append((
            "the actuated joints",
            [int(model.jnt_dofadr[j]) for j in joints],
            tuple(model.joint(j).name for j in joints),
            tuple("N" if model.jnt_type[j] == SLIDE else "N m" for j in joints),
        ))  # fmt: skip
    for j in np.flatnonzero(model.jnt_type == FREE):
        first = int(model.jnt_dofadr[j])
        names = tuple(f"{kind} {axis}" for kind in ("force", "torque") for axis in AXES)
        body = model.body(int(model.jnt_bodyid[j])).name
        out.append((body, list(range(first, first + 6)), names, ("N",) * 3 + ("N m",) * 3))
    return out
