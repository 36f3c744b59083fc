"""Are setpoint and encoder of a servo both turned in sign? Its weight and its neighbours tell.

    k (u - q) - k_v q̇ = f_0 + k_0 q + d q̇ + f sign q̇ + J q̈ + b u̇ + γ g(q) + μ h(q, q̇, q̈)
    ρ_j = Σ (left - right side)² / Σ (left - right side with γ = μ = 0)²,   0 <= γ, μ <= 4

A servo follows a turned setpoint to a turned position as well as the right one to the right one, so
that simulations err by little. But the small error that a servo holds has the wrong sign: it holds
up the weight g, and it gives the forces h with which other joints move its own. The terms before
are free: an offset, a spring, friction, a rotor or a delay say nothing of a sign. γ and μ may be 4
times too large, but not negative. A log is refused where the model's forces explain most of what
the free terms leave with a servo turned or two, and next to nothing as it is read. An arm that is
turned as a whole is its picture in a mirror, which no log tells. Samples in which a servo gives all
that it can are left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import mujoco
import numpy as np

from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.noise import noise_floor
from identification.model.predictor import output_columns, output_dofs
from identification.refusals.balance import SCALAR, solve_bounded
from identification.refusals.columns import Doubt
from identification.refusals.forces import Smooth, kernels, smoothed, widths
from identification.refusals.readings import NEARER
from identification.refusals.same_units import SERVO, wanted_units
from identification.runtime.engine import quiet
from identification.shares import percent

FACTOR = 4.0  # that a mass or a gain may be off
ROWS = 300  # samples that are used
LEAST, WIDEST = 4, 16  # half the length of ψ in samples: at least, and where noise hides all
FULL = 0.7  # of a servo's largest force, from which a sample is left out
FEWEST = 30  # samples of a servo that tell
FELT = 3.0  # times its noise, that what the free terms leave must be
ALIKE = 2.0  # times ρ of the best servos, within which others may be the turned ones
TINY = 1e-6  # of a force, below which what the free terms leave of it is rounding
MOST_SERVOS = 12  # of which two at once are asked


@dataclass(frozen=True)
class _Motion:
    """The motion of a log through ψ, and what of it tells of the signs of servos."""

    model: mujoco.MjModel
    smooth: Smooth
    u_rate: np.ndarray  # rates of the inputs, shape (n, nu)
    servos: tuple[int, ...]  # inputs that are wanted positions
    dofs: tuple[int, ...]  # of their joints
    rows: np.ndarray  # true where a servo does not give all that it can, shape (n, servos)
    noise: np.ndarray  # std of k (u - q) by that of the encoder, shape (servos,)

    def shares(self, turned: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
        """Returns what is left with and without γ and μ, mean squares (servos,), some turned."""
        force, weight, moved = self._forces(turned)
        left = np.zeros((2, len(self.servos)))
        for k, (i, j) in enumerate(zip(self.servos, self.dofs, strict=True)):
            rows, s = self.rows[:, k], self.smooth
            if rows.sum() < FEWEST:
                continue
            # A sign before a free term changes nothing.
            free = [s.q[:, j], s.v[:, j], np.sign(s.v[:, j]), s.a[:, j], self.u_rate[:, i]]
            X = np.column_stack([np.ones(len(s.q)), *free])[rows]
            X = X / np.maximum(np.linalg.norm(X, axis=0), np.finfo(float).tiny)
            Q, _ = np.linalg.qr(X)
            y, *known = (x[rows, j] - Q @ (Q.T @ x[rows, j]) for x in (force, weight, moved))
            A = np.column_stack(known)
            size = np.linalg.norm([weight[rows, j], moved[rows, j]], axis=1)
            A = A[:, np.linalg.norm(A, axis=0) > TINY * size]
            high = np.full(A.shape[1], FACTOR)
            found = A @ solve_bounded(A, y, 0 * high, high) if A.size else 0.0
            left[:, k] = np.mean((y - found) ** 2), np.mean(y**2)
        return left[0], left[1]

    @quiet()
    def _forces(self, turned: Sequence[int]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns the drives' forces, g, and h, (n, nv) each, as if some servos were turned."""
        model, s, data = self.model, self.smooth, mujoco.MjData(self.model)
        of_u, of_q = np.ones(model.nu), np.ones(model.nv)
        of_u[[self.servos[k] for k in turned]] = of_q[[self.dofs[k] for k in turned]] = -1.0
        force, weight, moved = (np.empty(s.q.shape) for _ in range(3))
        M = np.zeros((model.nv, model.nv))
        for k in range(len(s.q)):
            data.qpos, data.qvel, data.ctrl = of_q * s.q[k], of_q * s.v[k], of_u * s.u[k]
            mujoco.mj_forward(model, data)
            mujoco.mj_fullM(model, data, M)
            force[k], moved[k] = data.qfrc_actuator, data.qfrc_bias + M @ (of_q * s.a[k])
            data.qvel = 0.0
            mujoco.mj_forward(model, data)
            weight[k] = data.qfrc_bias - data.qfrc_gravcomp
            moved[k] -= data.qfrc_bias
        return force, weight, moved


def turned_servos(model: mujoco.MjModel, doubt: Doubt) -> str | None:
    """Returns in words which servos' setpoints and encoders are turned, and the cure, or None."""
    if (motion := _motion(model, doubt.log)) is None:
        return None
    left, free = motion.shares(())
    felt = free > (FELT * motion.noise) ** 2
    if not felt.any():
        return None

    def share(turned: Sequence[int]) -> float:
        rest, of = (left, free) if not turned else motion.shares(turned)
        return float(np.mean(rest[felt] / of[felt]))

    as_read = share(())
    for found in ({turned: share(turned) for turned in some} for some in _sets(motion)):
        least = min(found.values())
        if least < NEARER * min(1.0, as_read):
            best = sorted(found, key=lambda turned: found[turned])
            alike = [turned for turned in best if found[turned] <= ALIKE * least]
            return _words(doubt, motion, alike, (as_read, least))
    return None


def _sets(motion: _Motion) -> Iterator[list[tuple[int, ...]]]:
    """Yields each servo alone, and then two of several."""
    each = range(len(motion.servos))
    yield [(k,) for k in each]
    if 2 < len(each) <= MOST_SERVOS:
        yield [*combinations(each, 2)]


def _motion(model: mujoco.MjModel, log: Log) -> _Motion | None:
    """Returns the motion of a log; None where it has no servo, or a joint is not measured."""
    columns, wanted = output_columns(model, log.output_names), wanted_units(model, log)
    at = {i: k for k, (field, i) in enumerate(columns) if field == "qpos"}
    plain = np.isin(model.jnt_type, SCALAR).all() and not (model.neq or model.na)
    servos = [i for i, n in enumerate(log.input_names) if wanted.get(n) in SERVO["qpos"]]
    if not (plain and servos) or sorted(at) != [*range(model.nq)]:
        return None
    q, h, u = log.outputs[:, [at[i] for i in range(model.nq)]], log.sampling_time, log.inputs
    dofs = [int(model.jnt_dofadr[model.actuator_trnid[i, 0]]) for i in servos]
    kp, gear = model.actuator_gainprm[servos, 0], model.actuator_gear[servos, 0]
    error = kp * (u[:, servos] - gear * q[:, dofs])
    most = np.where(
        model.actuator_forcelimited[servos], model.actuator_forcerange[servos, 1], np.inf
    )
    full = (np.abs(error) > FULL * most).astype(float)
    w = max(LEAST, next(widths(q, h), WIDEST))
    if 8 * w > len(q):
        return None
    held = (np.vstack([u[:1], u[:-1]]) + u) / 2 if log.hold == "zoh" else u
    every = smoothed(np.hstack([q, held, full]), log, w, ROWS)
    nq, nu = q.shape[1], u.shape[1]
    smooth = Smooth(every.q[:, :nq], every.v[:, :nq], every.a[:, :nq], every.u)
    noise = kp * gear**2 * noise_floor(q)[dofs] * np.linalg.norm(kernels(w, h)[0])
    return _Motion(
        model, smooth, every.v[:, nq : nq + nu], tuple(servos), tuple(dofs),
        every.q[:, nq + nu :] == 0, noise,
    )  # fmt: skip


def _words(
    doubt: Doubt,
    motion: _Motion,
    alike: Sequence[Sequence[int]],
    shares: tuple[float, float],
) -> str:
    """Returns what the signs of some servos explain, with what to write, in words."""
    names, dofs = doubt.outputs, output_dofs(motion.model, doubt.log.output_names)

    def columns(turned: Sequence[int]) -> list[str]:
        outputs = [
            n for n, j in zip(names, dofs, strict=True) if j in [motion.dofs[k] for k in turned]
        ]
        return [*outputs, *(doubt.inputs[motion.servos[k]] for k in turned)]

    first, *others = map(columns, alike)
    also = "".join(f", or those of {listed(each)} alike" for each in others)
    before, after = (percent(max(0.0, 1 - share)) for share in shares)
    return (
        f"explains {before} of the forces that servos hold beside friction and their own inertia,"
        f" and {after} with the other sign of both setpoint and encoder; {doubt.how_to_turn(first)}"
        f"{also}, or correct the model where a link weighs the other way (gravity, a zero that is"
        " half a turn off, a counterweight)"
    )
