"""Operating points of a MuJoCo model: given states, a rest, or points along a log.

A rest is a state that does not change: v = 0 and

    r(q, a) = (v̇, ȧ) = 0        at inputs ū

It is found from a given start by Newton steps of least norm, δ(q, a) = -(∂r/∂(q, a))⁺ r, so that
what has no place of its own, such as a slider without a spring, stays where it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from identification.errors import DivergenceError, InputError
from identification.linear.derivatives import CENTRAL, differences
from identification.linear.points import AtPoints, Points
from identification.model.predictor import Predictor
from identification.model.protocol import with_numbers
from identification.model.rollout import State, substeps

AT_REST = 1e-9  # of the largest acceleration that the terms of the law could give alone
STEPS = 50
SMALLEST = 2.0**-20  # share of a Newton step


@dataclass(frozen=True, kw_only=True)
class OperatingPoints(AtPoints):
    """M states of one model with the inputs that act there.

    Attributes:
        model: with its numbers.
        qpos: positions, shape (M, nq) [m, rad, quaternions].
        qvel: velocities, shape (M, nv) [m/s, rad/s].
        act: activations, shape (M, na), in the units of their actuators.
        inputs: shape (M, nu), in the units of the model's controls.
        time: shape (M,) [s].

    Raises:
        InputError: a shape does not fit the model.
    """

    def __post_init__(self) -> None:
        m, count = self.model, len(self.time)
        sizes = {"qpos": m.nq, "qvel": m.nv, "act": m.na, "inputs": m.nu}
        for field, size in sizes.items():
            if getattr(self, field).shape != (count, size):
                raise InputError(
                    f"{field} of the operating points has shape {getattr(self, field).shape}; the"
                    f" model takes ({count}, {size})"
                )


def at_rest(
    model: mujoco.MjModel, start: State, inputs: np.ndarray | None = None
) -> OperatingPoints:
    """Returns the rest that Newton steps reach from a start, as one operating point.

    Args:
        model: with its numbers.
        start: where the search begins; its velocities are taken for zero.
        inputs: that act at rest, shape (nu,), in the units of the model's controls; zero when None.

    Raises:
        InputError: the inputs have another shape, or no rest is near the start.
        DivergenceError: the accelerations at the start are not finite.
    """
    u = np.zeros(model.nu) if inputs is None else np.asarray(inputs, float)
    if u.shape != (model.nu,) or not np.isfinite(u).all():
        raise InputError(f"inputs at rest must be {model.nu} finite numbers, got {u.tolist()}")
    point = OperatingPoints(
        model=model,
        qpos=np.array(start.qpos, float).reshape(1, -1),
        qvel=np.zeros((1, model.nv)),
        act=np.array(start.act, float).reshape(1, -1),
        inputs=u[None],
        time=np.zeros(1),
    )
    for _ in range(STEPS):
        r = Points(point).rates()[0]
        J, _ = differences(point, Points(point), CENTRAL)
        J = np.delete(J[0], np.s_[model.nv : 2 * model.nv], axis=1)
        size = np.abs(J).sum(axis=1) + _unit(model)
        if (np.abs(r) <= AT_REST * size).all():
            return point
        # Rows are weighed alike: a light and a heavy body are at rest to the same share.
        step = -np.linalg.lstsq(J / size[:, None], r / size, rcond=1e-10)[0]
        point = _nearer(point, step, r, size)
    raise _no_rest(model, Points(point).rates()[0])


def along_log(predictor: Predictor, times: Sequence[float]) -> OperatingPoints:
    """Returns the states of the free run of a plant under a log at some times.

    Args:
        predictor: plant and log, without free parameters.
        times: of the log [s]; each is taken at the nearest sample.

    Raises:
        InputError: a time is outside the log.
        DivergenceError: the simulation left the finite numbers.
    """
    log, model, none = predictor.log, predictor.plant.model, np.empty((1, 0))
    rows = samples_at(log.time, times)
    count = int(rows.max()) + 1
    states = predictor.simulated(none, ("qpos", "qvel", "act"), count)
    every = substeps(log.sampling_time, model.opt.timestep)
    reach = predictor.inputs(none)(np.repeat(log.inputs[:count], every, axis=0))
    reach = reach[0] if reach.ndim == 3 else reach
    inputs = np.zeros((len(rows), model.nu))
    inputs[:, : reach.shape[1]] = reach[every * rows]
    return OperatingPoints(
        model=with_numbers(model, predictor.settings(none)[1], 0),
        **{field: states[field][0][rows] for field in ("qpos", "qvel", "act")},
        inputs=inputs,
        time=log.begun + log.sampling_time * rows,
    )


def samples_at(time: np.ndarray, wanted: Sequence[float]) -> np.ndarray:
    """Returns the samples nearest to wanted times [s], or refuses a time outside of them."""
    first, last = float(time[0]), float(time[-1])
    half = (last - first) / (len(time) - 1) / 2
    for t in wanted:
        if not first - half <= t <= last + half:
            raise InputError(
                f"a time of {t:g} s is outside the log, which lasts from {first:g} to {last:g} s"
            )
    return np.array([int(np.abs(time - t).argmin()) for t in wanted], int)


def _unit(model: mujoco.MjModel) -> np.ndarray:
    """Returns gravity's acceleration per degree of freedom, 1 per activation, shape (nv + na,)."""
    g = max(float(np.linalg.norm(model.opt.gravity)), 1.0)
    return np.concatenate([np.full(model.nv, g), np.ones(model.na)])


def _nearer(
    point: OperatingPoints, step: np.ndarray, r: np.ndarray, size: np.ndarray
) -> OperatingPoints:
    """Returns the point after a step, shortened until it is nearer to a rest."""
    model, now = point.model, float(np.linalg.norm(r / size))
    share = 1.0
    while share > SMALLEST:
        qpos = point.qpos.copy()
        mujoco.mj_integratePos(model, qpos[0], share * step[: model.nv], 1.0)
        moved = replace(point, qpos=qpos, act=point.act + share * step[model.nv :])
        try:
            if float(np.linalg.norm(Points(moved).rates()[0] / size)) < now:
                return moved
        except DivergenceError:
            pass  # too far
        share /= 2
    raise _no_rest(model, r)


def _no_rest(model: mujoco.MjModel, r: np.ndarray) -> InputError:
    worst = int(np.abs(r[: model.nv]).argmax()) if model.nv else 0
    joint = model.joint(int(model.dof_jntid[worst])).name
    return InputError(
        f"the model does not rest near its start: joint {joint!r} keeps an acceleration of"
        f" {r[worst]:.3g}; give inputs that hold it, another start, or a log and a time"
    )
