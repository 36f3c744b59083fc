"""How fast other ways to do a fit are; `benchmarks/speed.py` prints the ratios.

The fit frees all eleven parameters of the mechanics
and the start pose, from nominal values, on 10 s of PRBS with noise of 0.67 mrad (an encoder's),
simulated with parameters up to 10 % and a pose up to 1 cm and 1 degree away.

What an engineer writes first are the equations in numpy, solve_ivp, and a 2-point Jacobian:

    m v̇ = -Σ T_i s_i - m g e_z,   J ω̇ = K_t i - R T + R_s F_s - b_v ω - b_c tanh(β ω)
    T = max(0, λ ε + b (ḋ - ḋ₀)),   d₀' = -R ω d₀/d,   I ω̇_P = -Σ b_i × T_i s_i - ω_P × I ω_P

States: p, v (both in O), roll-pitch-yaw, body rates, φ, ω, d₀; the symbols are the thesis'.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass, replace
from unittest import mock

import numpy as np
from scipy.integrate import solve_ivp
from step_ratios import least

from identification import InputError, Log
from identification.bridge_sysid import from_sysid, sysid_residual, to_sysid_parameters
from identification.model import predictor
from identification.model.rollout import rollout
from inca_mj.kinematics.rotations import rotation
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import GRAVITY, parameter_set
from inca_mj.twin.logs import POSE, run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.statics import start_from
from inca_mj.twin.twin import Twin, build_twin
from inca_mj.workflows.identification import MECHANICS

FREE = (*MECHANICS, *POSE)
DURATION, NOISE = 10.0, 6.7e-4  # [s], [rad]
PATIENCE = 60.0  # longest wait for another program, in times of our fit
TOLERANCE = 1e-6  # relative, of solve_ivp


@dataclass
class Work:
    """What the simulator was asked for."""

    simulated: float = 0.0  # seconds of the robot, all columns together
    inside: float = 0.0  # wall time there [s]
    processor: float = 0.0  # time of all processors, there and elsewhere [s]


@contextmanager
def watched() -> Iterator[Work]:
    """Counts what predictors simulate."""
    work = Work()

    def counted(model, start, inputs, sampling_time, **rest):
        begin = time.perf_counter()
        found = rollout(model, start, inputs, sampling_time, **rest)
        work.inside += time.perf_counter() - begin
        work.simulated += len(np.atleast_2d(start.qpos)) * (len(inputs) - 1) * sampling_time
        return found

    begin = time.process_time()
    with mock.patch.object(predictor, "rollout", counted):
        yield work
    work.processor = time.process_time() - begin


def practice(seed: int = 0) -> Log:
    """The log to fit."""
    rng, own = np.random.default_rng(seed), parameter_set("trial").values()
    truth = {name: own[name] * np.exp(rng.uniform(-0.1, 0.1)) for name in MECHANICS}
    reach = np.repeat([0.01, 0.0175], 3)
    truth |= {n: own[n] + r * rng.uniform(-1, 1) for n, r in zip(POSE, reach, strict=True)}
    robot = build_twin(parameter_set("trial", truth))
    log = run_to_log(simulate(robot, make_input("prbs", DURATION)))
    noisy = log.outputs + rng.normal(0, NOISE, log.outputs.shape)
    return replace(log, outputs=noisy, extras={}, units={})


def rms(robot: Twin, log: Log, values: dict[str, float]) -> float:
    """Of the residual at some values [rad]."""
    row = np.array(list(values.values()))
    predicted = predictor.Predictor(robot, log, tuple(values)).predict(row)[0]
    return float(np.sqrt(np.mean((log.outputs - predicted) ** 2)))


class _OutOfPatienceError(Exception):
    """The other program has had its time."""


def sysid_seconds(robot: Twin, log: Log, ours: float) -> tuple[float | None, str]:
    """Wall time of `mujoco.sysid.optimize` [s] and how it went, beside the time of our fit [s]."""
    try:
        parameters = to_sysid_parameters(robot, FREE)
        residual = sysid_residual(robot, log, FREE)
    except InputError as error:
        return None, str(error)
    from mujoco import sysid

    begin = time.perf_counter()
    seen: list[tuple[float, dict[str, float]]] = []

    def watchful(x, values):
        if time.perf_counter() - begin > PATIENCE * ours:
            raise _OutOfPatienceError
        found = residual(x, values)
        if np.ndim(x) == 1 or x.shape[1] == 1:
            cost = float(np.sum(np.asarray(found[0]) ** 2))
            seen.append((cost, dict(zip(FREE, np.ravel(x).tolist(), strict=True))))
        return found

    try:
        with redirect_stdout(sys.stderr):  # it prints its steps
            values = from_sysid(sysid.optimize(parameters, watchful, verbose=False))
        end = "ended"
    except _OutOfPatienceError:
        values, end = min(seen, key=lambda pair: pair[0])[1], "was stopped, so at least this,"
    seconds = time.perf_counter() - begin
    error = 1e3 * rms(robot, log, values)
    return seconds, f"its default optimiser {end} after {seconds:.0f} s at {error:.4g} mrad"


def naive_seconds(robot: Twin, log: Log, simulated: float) -> float:
    """Wall time of the naive predictor [s] for as many seconds of the robot as our fit took."""
    part = log.inputs[:51]
    values = robot.parameters.values()
    (once,) = least([lambda: naive_predict(values, part, log.sampling_time)], 2)
    return once / ((len(part) - 1) * log.sampling_time) * simulated


def naive_rates(t: float, x: np.ndarray, u: np.ndarray, h: float, q: Mapping, T_0: np.ndarray):
    """ẋ of the robot under currents u (n, 8), each held for h."""
    v, (φ, θ, _), w = x[3:6], x[6:9], x[9:12]
    angle, speed, d_0 = x[12:20], x[20:28], x[28:36]
    A = rotation(*x[6:9])
    arm = INCA.B @ A.T
    span = x[:3] + arm - INCA.A
    d = np.linalg.norm(span, axis=1)
    s = span / d[:, None]
    d_0_rate = -q["R"] * speed * d_0 / d
    d_rate = (s * (v + np.cross(A @ w, arm))).sum(1)
    T = np.maximum(0, q["lambda"] * (d - d_0) / d_0 + q["b"] * (d_rate - d_0_rate))
    inertia = np.array([q["I_x"], q["I_y"], q["I_z"]])
    torque = -A.T @ np.cross(arm, T[:, None] * s).sum(0) - np.cross(w, inertia * w)
    turn = np.array(
        [
            [1, np.sin(φ) * np.tan(θ), np.cos(φ) * np.tan(θ)],
            [0, np.cos(φ), -np.sin(φ)],
            [0, np.sin(φ) / np.cos(θ), np.cos(φ) / np.cos(θ)],
        ]
    )
    spring = np.maximum(0, q["R"] / q["R_s"] * T_0 - q["k_s"] * q["R_s"] * angle)
    current = u[min(int(t / h + 1e-9), len(u) - 1)]
    motor = q["K_t"] * current - q["R"] * T + q["R_s"] * spring
    friction = q["b_v"] * speed + q["b_c"] * np.tanh(q["beta"] * speed)
    fall = np.array([0, 0, -GRAVITY])
    return np.concatenate(
        [v, -(T @ s) / q["m"] + fall, turn @ w, torque / inertia,
         speed, (motor - friction) / q["J"], d_0_rate]
    )  # fmt: skip


def naive_predict(values: Mapping[str, float], currents: np.ndarray, h: float) -> np.ndarray:
    """Motor angles (n, 8) [rad] under currents (n, 8) [A], one sample each h [s]."""
    begin = start_from(values, INCA)
    x = np.zeros(36)
    x[:3], x[6:9], x[28:] = begin.pose[:3], begin.pose[3:], begin.no_load_length
    clock = np.arange(len(currents)) * h
    solved = solve_ivp(
        naive_rates, clock[[0, -1]], x, t_eval=clock, args=(currents, h, values, begin.tension),
        rtol=TOLERANCE, atol=1e-3 * TOLERANCE, max_step=h,
    )  # fmt: skip
    return solved.y[12:20].T
