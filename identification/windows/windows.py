"""Windows of a log whose initial states are nuisances.

    x_w = x̄_w ⊕ d_w,   w = 1..W                     ⊕ in the tangent of qpos, in qvel and in act
    x̄_w  from the measured outputs and their rates; the other states from a free run
    s_j  = rms motion of state j, measured or on that run     std of the prior of x_w about x̄_w

In a free run the effects of all disturbances add up, and an unstable robot leaves the log after a
short time. A window starts again after its length. `identification.windows.shooting` says how
d_w is found.

States that no output measures are treated like the others: a pose, a rate, or an activation such as
the no-load length of a cable begins on the free run and is free within s_j. Some directions of the
states are hardly felt in a window, for example a platform and all its cables moved together. They
then stay near the free run and do not follow the noise.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import mujoco
import numpy as np

from identification.errors import DivergenceError, InputError
from identification.logs.log import Log
from identification.logs.noise import noise_floor
from identification.model.equalities import put_tied, tied_joints
from identification.model.predictor import (
    Predictor,
    measured_joints,
    output_columns,
    with_states,
)
from identification.model.rollout import State, rollout

MAX_LOST_SHARE = 0.2  # of the windows, for inputs at the ends that were not logged
MIN_SCALE_SHARE = 1e-3  # of the largest motion in its field, for the smallest s_j


@dataclass(frozen=True)
class Windows:
    """A log in W windows of L samples.

    A remainder shorter than a window is left out, and so are windows that touch a gap of the log.
    """

    inputs: np.ndarray  # shape (W, L, nu)
    outputs: np.ndarray  # shape (W, L, ny)
    starts: np.ndarray  # first sample of each window, shape (W,)

    @property
    def places(self) -> np.ndarray:
        """First sample of each window, and the one behind its last, shape (W, 2)."""
        return np.column_stack([self.starts, self.starts + self.inputs.shape[1]])

    def rows(self, keep: np.ndarray) -> Windows:
        """Returns some of the windows, by mask or by index."""
        return Windows(self.inputs[keep], self.outputs[keep], self.starts[keep])


def windows(log: Log, length: float, edge: float = 0.0) -> Windows:
    """Split a log into windows of a length [s].

    Args:
        log: any.
        length: of a window [s].
        edge: for how long at both ends of the log inputs act that it does not have [s]. Windows
            that feel them are left out (`logged`).

    Raises:
        InputError: a window has fewer than 3 samples, the log is shorter than one, or each of them
            touches a gap of the log.
    """
    samples = round(length / log.sampling_time) if np.isfinite(length) else 0
    if samples < 3 or samples > len(log):
        raise InputError(
            f"windows of {length:g} s do not fit a log of {log.duration:g} s sampled every"
            f" {log.sampling_time:g} s; take 3 samples or more, and no more than the log has"
        )
    starts = samples * np.arange(len(log) // samples)
    starts = starts[logged(log, np.column_stack([starts, starts + samples]), edge)]
    # The step before a window and the one behind it count: rates are taken from neighbours.
    h, begin, end = log.sampling_time, log.time[starts], log.time[starts + samples - 1]
    touched = [(begin < b + h) & (end > a - h) for a, b in log.gaps]
    starts = starts[~np.any(touched, axis=0)] if touched else starts
    if not starts.size:
        raise InputError(
            f"each window of {length:g} s of log {log.name!r} touches one of its {len(log.gaps)}"
            " gaps, in which nothing was measured; take a shorter horizon, or record again"
        )
    rows = starts[:, None] + np.arange(samples)
    return Windows(log.inputs[rows], log.outputs[rows], starts)


def logged(log: Log, places: np.ndarray, edge: float) -> np.ndarray:
    """Returns which windows feel only inputs that a log has, shape (W,); all where many would go.

    Args:
        log: any.
        places: first sample of each window, and the one behind its last, shape (W, 2).
        edge: for how long at both ends of the log inputs act that it does not have [s].
    """
    samples = round(np.ceil(edge / log.sampling_time))
    first, behind = places.T
    keep = (first >= samples) & (behind <= len(log) - samples)
    return np.asarray(keep if np.mean(~keep) <= MAX_LOST_SHARE else np.full(len(keep), True))


def noise_whitener(log: Log) -> np.ndarray:
    """Returns C = I/σ, shape (ny, ny), where σ is the rms of the noise floor of all outputs."""
    sigma = float(np.sqrt(np.mean(noise_floor(log.outputs) ** 2))) or 1.0
    return np.eye(log.outputs.shape[1]) / sigma


def spread(cut: Windows, most: int) -> Windows:
    """Returns at most `most` of some windows, evenly spread over the record."""
    n = len(cut.starts)
    return cut if n <= most else cut.rows(np.linspace(0, n - 1, most).astype(int))


def some(cut: Windows, part: float) -> Windows:
    """Returns about a share `part` of some windows, evenly spread; of one window its beginning."""
    n, samples = cut.inputs.shape[:2]
    if n > 1:
        return spread(cut, max(1, round(part * n)))
    first = slice(0, max(2, round(part * samples)))
    return Windows(cut.inputs[:, first], cut.outputs[:, first], cut.starts)


@dataclass(frozen=True)
class FirstStates:
    """The prior of the windows' initial states."""

    states: State  # x̄, W rows
    weight: np.ndarray  # 1/s of each tangent coordinate, 0 where nothing is known, shape (nx,)

    def rows(self, keep: np.ndarray) -> FirstStates:
        """Returns the prior of some of the windows, by mask or by index."""
        return FirstStates(self.states.rows(keep), self.weight)


def first_states(predictor: Predictor, values: np.ndarray, cut: Windows) -> FirstStates:
    """Returns states at windows' starts: as measured, and from a free run where something is not.

    Where the free run diverges, states that are not measured begin at the plant's start and are
    free without limit. Where all positions are measured, no free run is simulated.
    """
    plant, log = predictor.plant, predictor.log
    model, known = plant.model, with_states(plant)
    if known is not None:
        plain = replace(predictor, plant=known.without_states())
        return extended(predictor, values, cut, first_states(plain, values, cut))
    measured = _measured(model, log)
    if measured is not None:
        return FirstStates(measured.rows(cut.starts), 1 / _motion(model, measured))
    start, numbers = predictor.settings(values)
    fields = ("qpos", "qvel", "act")
    try:
        run = rollout(
            model, start, log.inputs, log.sampling_time, numbers=numbers, record=fields,
            hold_kind=log.hold, before=predictor.inputs(values), time=log.begun,
        )  # fmt: skip
        rows = {f: np.array(run[f][0, cut.starts]) for f in fields}
        weight = 1 / _motion(model, State(*(run[f][0] for f in fields)))
    except DivergenceError:
        rows = {f: np.repeat(np.atleast_2d(getattr(start, f)), len(cut.starts), 0) for f in fields}
        weight = np.zeros(2 * model.nv + model.na)
    _put_measured(model, log, rows, cut.starts)
    return FirstStates(State(**rows), weight)


def extended(
    predictor: Predictor, values: np.ndarray, cut: Windows, first: FirstStates
) -> FirstStates:
    """Returns first states, extended by those that a plant has beside its model's."""
    known, more = predictor.first_loads(values, first.states, cut.starts)
    have = first.states.act.shape[1] + known.shape[1] - predictor.plant.model.na
    act = np.hstack([first.states.act, known[:, have:]])
    states = State(first.states.qpos, first.states.qvel, act)
    return FirstStates(states, np.concatenate([first.weight, 1 / more[have:]]))


def _measured(model: mujoco.MjModel, log: Log) -> State | None:
    """Returns the states of all samples; None where some states are not measured positions."""
    known = measured_joints(model, log.output_names)
    told = {*known, *(joint for joint, _, _ in tied_joints(model, known))}
    if model.na or model.nq != model.nv or len(told) < model.njnt:
        return None
    n = len(log)
    rows = {"qpos": np.zeros((n, model.nq)), "qvel": np.zeros((n, model.nv))}
    _put_measured(model, log, rows, np.arange(n))
    return State(rows["qpos"], rows["qvel"], np.zeros((n, 0)))


def _put_measured(
    model: mujoco.MjModel, log: Log, rows: dict[str, np.ndarray], at: np.ndarray
) -> None:
    """Write the positions and rates of some samples that are measured, or tied, into states."""
    rate = np.gradient(log.outputs, log.sampling_time, axis=0)[at]
    columns = list(enumerate(output_columns(model, log.output_names)))
    for k, (field, i) in sorted(columns, key=lambda item: item[1][0]):  # rates last
        rows[field][:, i] = log.outputs[at, k]
        if field == "qpos":
            joint = int(np.flatnonzero(model.jnt_qposadr == i)[0])
            rows["qvel"][:, model.jnt_dofadr[joint]] = rate[:, k]
    known = measured_joints(model, log.output_names)
    put_tied(model, known, rows["qpos"], rows["qvel"])


def _motion(model: mujoco.MjModel, run: State) -> np.ndarray:
    """Returns the rms distance of each tangent coordinate from the start of a run, shape (nx,)."""
    first = State(*(np.broadcast_to(x[0], x.shape) for x in (run.qpos, run.qvel, run.act)))
    far = apart(model, first, run)
    parts = []
    for part in np.split(far, [model.nv, 2 * model.nv], axis=1):
        size = np.sqrt(np.mean(part**2, axis=0))
        parts.append(np.maximum(size, MIN_SCALE_SHARE * size.max(initial=0.0)))
    size = np.concatenate(parts)
    return np.where(size > 0, size, np.inf)  # a field at rest does not show how far it may move


def moved(model: mujoco.MjModel, states: State, step: np.ndarray) -> State:
    """Returns states moved along their tangent (qpos, qvel, act), by one step for all or each."""
    W, nv = len(states.qpos), model.nv
    steps = np.broadcast_to(step, (W, 2 * nv + model.na))
    if model.nq == nv:  # no quaternion
        qpos = states.qpos + steps[:, :nv]
    else:
        qpos = np.array(states.qpos)
        for row, d in zip(qpos, steps, strict=True):
            mujoco.mj_integratePos(model, row, np.ascontiguousarray(d[:nv]), 1.0)
    return State(qpos, states.qvel + steps[:, nv : 2 * nv], states.act + steps[:, 2 * nv :])


def apart(model: mujoco.MjModel, states: State, others: State) -> np.ndarray:
    """Returns the steps that move states to others, the inverse of `moved`, shape (W, nx)."""
    if model.nq == model.nv:  # no quaternion
        turned = others.qpos - states.qpos
    else:
        turned = np.zeros((len(states.qpos), model.nv))
        for row, qpos, other in zip(turned, states.qpos, others.qpos, strict=True):
            mujoco.mj_differentiatePos(model, row, 1.0, qpos, other)
    return np.hstack([turned, others.qvel - states.qvel, others.act - states.act])
