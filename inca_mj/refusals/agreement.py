"""How a log agrees with the twin: its currents with its angles, and its angles with one another.

**Which currents make the twin follow a log?** They tell which logged current belongs to which
drive. This is a proposal; the verdict is a free run (`inca_mj.refusals.currents`).

    i_k = K_p (y_k - φ_k) + K_d (ẏ_k - ω_k),    K_p = J Ω²/K_t,    K_d = 2 J Ω/K_t          [A]
    i_k ≈ Σ_m W_km (F u_m) + c_k,               F = (2 Ω s + Ω²)/(s + Ω)² = 2 L - L²,
                                                L = Ω/(s + Ω)

Under this feedback the motors of the twin follow the measured angles y whatever the logged currents
u are. i_k is then the current that drive k had, smoothed by the filter F. W is a least-squares fit
over all samples, and the best one-to-one choice of its entries says in which columns the currents
stand, and with which signs. The twin cannot drift away from the log, so that more than its first
motion is of use.

**Do eight angles belong to poses of one platform, whatever moved it?**

    κ = Σ_k min_x ‖d(x) - d(x₀) + R y_k‖² / Σ_k ‖R y_k‖²           share of the cables' motion

Eight cables hold a platform that has six degrees of freedom, so that two statements are left which
every sample of a right log fulfils, but for the strain of the cables. Neither currents nor masses
nor friction have a say. `inca_mj.refusals.bounds` says how large κ is in right logs.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

import mujoco
import numpy as np

from identification import Log, Predictor
from identification.model.rollout import hold, rollout, substeps
from identification.runtime.engine import quiet
from inca_mj.kinematics.cables import cables_at
from inca_mj.kinematics.jacobians import jacobian
from inca_mj.kinematics.rotations import rotation, turn
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.twin import Twin

BANDWIDTH = 40.0  # Ω of the feedback [rad/s]; 80 makes more of the encoders' noise
SETTLED = 5  # samples until the feedback has settled
STEPS = 3  # of Gauss and Newton from the pose at rest
SAMPLES = 20  # that are looked at: the platform moves on smoothly between them
SMALL = 1e-6  # added to JᵀJ, where poses without a unique motion must not stop the search


def angles_under(plant: Twin, log: Log, currents: np.ndarray) -> np.ndarray:
    """Returns the twin's angles along a log under m other sequences of currents (m, n, 8) [A].

    They have the shape (m, n, k) [rad], and are NaN where they are not finite.
    """
    predictor, none = Predictor(plant, log, (), {}), np.zeros((len(currents), 0))
    start, numbers = predictor.settings(none)
    timestep = plant.model.opt.timestep
    every = substeps(log.sampling_time, timestep)
    reach = predictor.inputs(none[:1])  # effects of the twin may change what the motors get
    held = [reach(each).reshape(each.shape) for each in hold(currents, every, log.hold)]
    last = [each[-1:] for each in held]  # rollout takes an input more than it makes steps
    states = rollout(
        plant.model, start, np.concatenate([held, last], axis=1), timestep, numbers=numbers,
        record=predictor.recorded, time=log.begun, keeps_diverged=True,
    )  # fmt: skip
    return predictor.outputs(none, {name: part[:, ::every] for name, part in states.items()})


def follow(
    plant: Twin, log: Log, drives: Sequence[int] = range(DRIVES)
) -> tuple[np.ndarray, np.ndarray] | None:
    """Simulate the twin with feedback of some drives; the others have their logged currents.

    The log has all eight angles [rad].

    Returns:
        Currents between samples, shape (n - 1, 8) [A], and angles, shape (n, 8) [rad]; None where
        they are not finite.
    """
    state, model, which = plant.state(), plant.model, [*drives]
    every = substeps(log.sampling_time, model.opt.timestep)
    y = hold(log.outputs - log.outputs[0], every, "foh")
    y_dot = np.gradient(y, model.opt.timestep, axis=0)
    J, K_t = (plant.parameters[name].value for name in ("J", "K_t"))
    K_p, K_d = J * BANDWIDTH**2 / K_t, 2 * J * BANDWIDTH / K_t
    currents = hold(log.inputs, every, log.hold)
    data, angles = mujoco.MjData(model), np.zeros((len(y) + 1, DRIVES))
    data.qpos[:], data.qvel[:], data.act[:] = state.qpos, state.qvel, state.act
    φ, ω = data.qpos[-DRIVES:], data.qvel[-DRIVES:]
    with quiet():
        for k in range(len(y)):
            currents[k, which] = (K_p * (y[k] - φ) + K_d * (y_dot[k] - ω))[which]
            data.ctrl[:DRIVES] = currents[k]
            mujoco.mj_step(model, data)
            angles[k + 1] = φ
    if not (np.isfinite(currents).all() and np.isfinite(angles).all()):
        return None
    return currents.reshape(-1, every, DRIVES).mean(axis=1), angles[::every]


def places_of(log: Log, currents: np.ndarray) -> np.ndarray:
    """Returns which logged current each drive had, and its sign, as a signed permutation (8, 8)."""
    W = shares_of(log, currents)
    return signed(W, assigned(np.abs(W)))


def signed(W: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Returns a signed permutation: entry k, m is 1 or -1, the sign of W_km, if columns_k is m."""
    places, k = np.zeros_like(W), np.arange(len(W))
    places[k, columns] = np.where(W[k, columns] < 0, -1.0, 1.0)
    return places


def shares_of(log: Log, currents: np.ndarray) -> np.ndarray:
    """Returns W (8, 8): the share of each logged current in that (n - 1, 8) of each drive [A]."""
    once = _low_pass(log.inputs, log.sampling_time)
    smoothed = (2 * once - _low_pass(once, log.sampling_time))[1:]
    regressors = np.column_stack([smoothed, np.ones(len(smoothed))])[SETTLED:]
    W: np.ndarray = np.linalg.lstsq(regressors, currents[SETTLED:], rcond=None)[0][:DRIVES].T
    return W


def assigned(likeness: np.ndarray) -> np.ndarray:
    """Returns one column for each row, shape (n,), so that likenesses (n, n) add up to most."""
    first = likeness.argmax(axis=1)
    if np.isfinite(likeness).all() and len({*first.tolist()}) == len(first):
        return first  # no row can do better
    from scipy.optimize import linear_sum_assignment  # slow to import

    return np.asarray(linear_sum_assignment(-likeness)[1])


def _low_pass(signals: np.ndarray, sampling_time: float) -> np.ndarray:
    """Returns L of held signals, shape (n, 8), at their samples; at rest before the first one."""
    share, out = 1 - np.exp(-BANDWIDTH * sampling_time), signals.copy()
    for k in range(1, len(signals)):
        out[k] = out[k - 1] + share * (signals[k - 1] - out[k - 1])
    return out


def unreached_share(plant: Twin, angles: np.ndarray) -> np.ndarray:
    """Returns κ (m,) of m logs of angles (m, n, 8) [rad]; inf where no search ends."""
    wanted = -plant.parameters.values()["R"] * angles
    start = np.array(plant.start.pose, float)
    shape = angles.shape[:2]
    p = np.broadcast_to(start[:3], (*shape, 3))
    R = np.broadcast_to(rotation(*start[3:]), (*shape, 3, 3))
    cables = cables_at(p, R, plant.geometry)
    goal = cables.lengths + wanted
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            J = jacobian(cables)
            JT = np.swapaxes(J, -1, -2)
            rest = (goal - cables.lengths)[..., None]
            step = np.linalg.solve(JT @ J + SMALL * np.eye(6), JT @ rest)[..., 0]
            step /= np.maximum(1.0, np.linalg.norm(step, axis=-1, keepdims=True))
            p, R = p + step[..., :3], turn(step[..., 3:]) @ R
            cables = cables_at(p, R, plant.geometry)
        share = np.sum((goal - cables.lengths) ** 2, axis=(1, 2)) / np.sum(wanted**2, axis=(1, 2))
    return np.where(np.isfinite(share), share, np.inf)


def likely_orders(plant: Twin, angles: np.ndarray, most: int) -> np.ndarray:
    """Returns the orders of angles (n, 8) that have least κ near the pose at rest, shape (most, 8).

    All 40320 orders are compared, with the slopes of the cables' lengths at rest; column k of the
    angles in an order is that of drive order[k].
    """
    start = np.array(plant.start.pose, float)
    L = jacobian(cables_at(start[:3], rotation(*start[3:]), plant.geometry))
    no_pose = np.linalg.svd(L)[0][:, L.shape[1] :]  # what no motion of the platform does
    orders, squares = np.array([*permutations(range(DRIVES))]), angles.T @ angles
    rest = np.zeros(len(orders))
    weight = no_pose @ no_pose.T
    for i in range(DRIVES):
        for j in range(DRIVES):
            rest += weight[i, j] * squares[orders[:, i], orders[:, j]]
    return orders[np.argsort(rest, kind="stable")[:most]]


def some(angles: np.ndarray) -> np.ndarray:
    """Returns the first samples of angles that are enough to judge κ, shape (n, 8) [rad]."""
    rows = np.linspace(0, len(angles) - 1, min(SAMPLES, len(angles))).round().astype(int)
    return angles[rows] - angles[0]
