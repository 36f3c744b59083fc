"""Accelerations, no-load rates and tensions of the two models at random states.

An error is relative to the sum of the magnitudes of the terms that make up the quantity, since
cancellation of terms limits what floating point can give:

    platform, linear     Σ T_i/m + g
    platform, angular    Σ |b_i| T_i/I + |ω × I ω|/I       (per axis, of that axis' inertia)
    motor                (K_t |i| + R T + R_s F_s + b_v |ω_m| + b_c)/J
    no-load rate         |ḋ₀| itself, a product
    tension              T

with the pretension of 4 N for T where T is less: a cable of 2 m that is stretched by 10⁻¹² m
pulls with 10⁻⁸ N, which is equal to none.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from mujoco.batch import Batch

from identification.model.parameter import ParameterSet
from identification.model.rollout import State, threads
from inca_mj.kinematics.cables import cables_at
from inca_mj.kinematics.rotations import quaternion, rotation
from inca_mj.reference import derivative, pack, rotation_matrix
from inca_mj.reference import layout as at
from inca_mj.reference.equations import cables
from inca_mj.robot.geometry import DRIVES, INCA, Geometry
from inca_mj.robot.parameters import GRAVITY, PRETENSION, SETS, parameter_set
from inca_mj.robot.spread import at_drives, displaced
from inca_mj.twin.twin import Twin, build_twin

STRETCH = 1e-3  # cables are strained and slackened up to this strain: tensions of some 10 N
RANDOM_SETS = 6  # parameter sets of random values, beside the two of the thesis
_SPREAD = 1.5  # random values lie within this factor of the nominal ones
# All but the start pose, which is a state and no law.
_VARIED = ("R", "R_s", "k_s", "lambda", "b", "J", "b_v", "b_c", "beta", "K_t", "m",
           "I_x", "I_y", "I_z")  # fmt: skip

QUANTITIES = ("linear", "angular", "motor", "no_load", "tension")  # of which errors are taken


@dataclass(frozen=True, kw_only=True)
class DerivativeErrors:
    """Largest relative errors over all states; what they are relative to, see the module."""

    linear: float  # of the platform's linear acceleration
    angular: float  # of its angular acceleration
    # of the motors' accelerations. MuJoCo demands an inertia of the drum's body beside the armature
    # J; that share of J (7e-11 of the thesis') is seen here.
    motor: float
    no_load: float  # of the rates of the no-load lengths
    tension: float  # of the tensions
    states: int  # number of states
    slack: float  # share of slack cables in them

    @property
    def largest(self) -> float:
        """The largest of the errors; NaN when one is."""
        return float(np.max([getattr(self, name) for name in QUANTITIES]))


def compare_derivatives(
    n: int = 10_000,
    seed: int = 0,
    base: ParameterSet | None = None,
    geometry: Geometry = INCA,
) -> DerivativeErrors:
    """Compare the two models at n random states, under both parameter sets and random values.

    `base` is a further parameter set to compare under, and the one that random values vary.
    """
    rng = np.random.default_rng(seed)
    base = base or parameter_set()
    robots = [build_twin(parameter_set(name), geometry) for name in SETS] + [
        build_twin(base, geometry)
    ]
    robots += [robots[-1].with_values(_random_values(base, rng)) for _ in range(RANDOM_SETS)]
    # One state at least under each set, so that a small n leaves none unseen.
    counts = [len(part) for part in np.array_split(np.arange(max(n, len(robots))), len(robots))]
    errors, slack = zip(
        *(_compare(robot, count, rng) for robot, count in zip(robots, counts, strict=True)),
        strict=True,
    )
    largest = dict(zip(QUANTITIES, np.max(errors, axis=0).tolist(), strict=True))
    return DerivativeErrors(
        **largest, states=sum(counts), slack=float(np.average(slack, weights=counts))
    )


def _random_values(base: ParameterSet, rng: np.random.Generator) -> dict[str, float]:
    factor = np.exp(rng.uniform(-np.log(_SPREAD), np.log(_SPREAD), len(_VARIED)))
    values = {name: base[name].value * f for name, f in zip(_VARIED, factor, strict=True)}
    inertias = [name for name in values if name.startswith("I_")]
    while inertias and max(values[n] for n in inertias) > 0.5 * sum(values[n] for n in inertias):
        values |= {n: base[n].value * _SPREAD ** rng.uniform(-1, 1) for n in inertias}
    return {k: float(np.clip(v, base[k].lower, base[k].upper)) for k, v in values.items()}


def _compare(robot: Twin, n: int, rng: np.random.Generator) -> tuple[list[float], float]:
    """Returns the largest relative errors of `QUANTITIES`, and the share of slack cables."""
    x = random_states(n, displaced(robot.geometry, robot.parameters.values()), rng)
    i = rng.normal(0, 2, (n, DRIVES))
    q = pack(robot.parameters, robot.geometry)
    rate = np.array([derivative(*row, q) for row in zip(x, i, strict=True)])
    tension = np.array([cables(row, q)[0] for row in x])
    body = rate[:, at.VELOCITY] + np.cross(x[:, at.RATES], x[:, at.VELOCITY])  # along body axes
    turns = (rotation_matrix(euler) for euler in x[:, at.EULER])
    linear = np.array([R_AB @ a for R_AB, a in zip(turns, body, strict=True)])
    qacc, act_dot, pulls = _twin_outputs(robot, x, i)
    of_linear, of_angular, of_motor = _magnitudes(robot, x, i, tension)
    errors = [
        (qacc[:, :3] - linear) / of_linear[:, None],
        (qacc[:, 3:6] - rate[:, at.RATES]) / of_angular,
        (qacc[:, 6:] - rate[:, at.SPEEDS]) / of_motor,
        (act_dot - rate[:, at.NO_LOAD]) / np.abs(rate[:, at.NO_LOAD]),
        (pulls - tension) / np.maximum(tension, PRETENSION),
    ]
    return [float(np.abs(e).max()) for e in errors], float(np.mean(tension == 0))


def _twin_outputs(robot: Twin, x: np.ndarray, i: np.ndarray) -> tuple[np.ndarray, ...]:
    """Returns qacc (n, 14), act_dot (n, 8) and tensions (n, 8) of the twin."""
    batch = Batch(robot.model, len(x), min(threads(), len(x)))
    state = to_mujoco(x)
    batch.bind("qpos")[:], batch.bind("qvel")[:] = state.qpos, state.qvel
    batch.bind("act")[:], batch.bind("ctrl")[:] = state.act, i
    found = [batch.bind(field) for field in ("qacc", "act_dot", "sensordata")]
    batch.forward(stage=mujoco.mjtStage.mjSTAGE_ACC)
    qacc, act_dot, sensors = map(np.array, found)
    first = robot.model.sensor("tension_1").adr[0]
    return qacc, act_dot, sensors[:, first : first + DRIVES]


def _magnitudes(
    robot: Twin, x: np.ndarray, i: np.ndarray, tension: np.ndarray
) -> tuple[np.ndarray, ...]:
    """Returns sizes of terms in the accelerations: linear (n,), angular (n, 3), motor (n, 8)."""
    p = robot.parameters.values()
    T = np.maximum(tension, PRETENSION)
    I_P = np.array([p["I_x"], p["I_y"], p["I_z"]])
    ω, φ, ω_m = x[:, at.RATES], x[:, at.ANGLES], x[:, at.SPEEDS]
    linear = T.sum(axis=1) / p["m"] + GRAVITY
    moments = T @ np.linalg.norm(displaced(robot.geometry, p).B, axis=1)
    angular = (moments[:, None] + np.abs(np.cross(ω, I_P * ω))) / I_P
    R, R_s, k_s, J, b_v, b_c, K_t = (
        at_drives(name, p) for name in ("R", "R_s", "k_s", "J", "b_v", "b_c", "K_t")
    )
    spring = np.abs(R * robot.start.tension - k_s * R_s**2 * φ)
    driven = K_t * np.abs(i) + R * T + spring
    motor = (driven + b_v * np.abs(ω_m) + b_c) / J
    return linear, angular, motor


def to_mujoco(x: np.ndarray) -> State:
    """Returns states of the reference, shape (n, 36), as states of the twin.

        reference (36)     p, v along BODY axes, Euler angles, ω, φ, ω_m, d₀
        MuJoCo             qpos = p, quaternion, φ    qvel = v along O, ω, ω_m    act = d₀

    MuJoCo's free joint, too, has its angular velocity along the body axes.
    """
    rows = np.atleast_2d(x)
    v = [rotation(*row[at.EULER]) @ row[at.VELOCITY] for row in rows]
    q = [quaternion(*row[at.EULER]) for row in rows]
    return State(
        qpos=np.hstack([rows[:, at.POSITION], q, rows[:, at.ANGLES]]),
        qvel=np.hstack([v, rows[:, at.RATES], rows[:, at.SPEEDS]]),
        act=rows[:, at.NO_LOAD].copy(),
    )


def random_states(n: int, geometry: Geometry, rng: np.random.Generator) -> np.ndarray:
    """Returns states far from rest, shape (n, 36); about half of the cables are slack.

    Positions within the middle two thirds of the frame, angles to 60°, and velocities as the
    robot's fastest motions have them.
    """
    x = np.empty((n, at.STATES))
    low, high = geometry.A.min(axis=0), geometry.A.max(axis=0)
    middle, half = (low + high) / 2, (high - low) / 3
    x[:, at.POSITION] = rng.uniform(middle - half, middle + half, (n, 3))
    x[:, at.VELOCITY] = rng.normal(0, 1, (n, 3))
    x[:, at.EULER] = rng.uniform(-np.pi / 3, np.pi / 3, (n, 3))
    x[:, at.RATES] = rng.normal(0, 5, (n, 3))
    x[:, at.ANGLES] = rng.normal(0, 50, (n, DRIVES))
    x[:, at.SPEEDS] = rng.normal(0, 20, (n, DRIVES))
    d = [cables_at(row[at.POSITION], rotation(*row[at.EULER]), geometry).lengths for row in x]
    x[:, at.NO_LOAD] = d / (1 + rng.uniform(-STRETCH, STRETCH, (n, DRIVES)))
    return x
