"""How fast a step of the twin is, beside others; `benchmarks/speed.py` prints the ratios.

Two things are compared by turns, many times, and the least time of each counts: other programs
only ever add to it. What a step with callbacks takes at least is that of callbacks that compute
less than the law: idle ones return at once, and others take the one exponential of each drive's
friction in the passive force.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from math import exp
from typing import Any

import mujoco
import numpy as np
from mujoco.batch import Batch

from identification.native import structs
from identification.native.cache import compile_once
from identification.native.memory import load_double, store_double
from identification.native.table import SIGNATURES, uninstall
from inca_mj.reference import simulate_reference
from inca_mj.robot import law
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import prbs
from inca_mj.twin import native
from inca_mj.twin.drives import FIELDS, D, M, double, drive, integer, word
from inca_mj.twin.twin import Twin

BURST = 50  # steps from the same moving state, so that both sides turn the same quaternions
KINDS = ("passive", "act_dyn", "act_bias")


def times(functions: list[Callable[[], None]], rounds: int) -> list[list[float]]:
    """Times of each of several functions that take turns [s]."""
    taken: list[list[float]] = [[] for _ in functions]
    for _ in range(rounds):
        for function, own in zip(functions, taken, strict=True):
            begin = time.perf_counter()
            function()
            own.append(time.perf_counter() - begin)
    return taken


def least(functions: list[Callable[[], None]], rounds: int) -> list[float]:
    """Least time of each of several functions that take turns [s]."""
    return [min(taken) for taken in times(functions, rounds)]


def stepper(robot: Twin, steps: int = BURST) -> Callable[[], None]:
    """A function that simulates some steps from a moving state."""
    data, at = mujoco.MjData(robot.model), robot.state()
    speed = np.random.default_rng(0).normal(0, 0.2, robot.model.nv)

    def run() -> None:
        data.qpos[:], data.qvel[:], data.act[:], data.ctrl[:] = at.qpos, speed, at.act, 0.7
        mujoco.mj_step(robot.model, data, steps)

    return run


def law_ratios(robot: Twin) -> dict[str, float]:
    """A step with the law, and with callbacks that compute less, over one without any."""
    native.install()
    step, law = stepper(robot), held_callbacks()
    callbacks = {
        "law": law,
        "idle": idle_callbacks(exponentials=False),
        "exponentials": idle_callbacks(exponentials=True),
        "none": dict.fromkeys(law),
    }
    best = dict.fromkeys(callbacks, float("inf"))
    for _ in range(2000):
        for name, held in callbacks.items():
            hold_callbacks(held)
            best[name] = min(best[name], least([step], 1)[0])
    hold_callbacks(law)
    return {name: seconds / best["none"] for name, seconds in best.items()}


def python_ratio(robot: Twin) -> float:
    """A step with the law as Python callbacks over one with the compiled law."""
    step = stepper(robot)
    (compiled,) = least([step], 50)
    uninstall()
    install_python_law(robot.model)
    (slow,) = least([step], 20)
    uninstall_python_law()
    native.install()
    return slow / compiled


def batch_ratio(robot: Twin, simulations: int = 32, steps: int = 200) -> float:
    """Throughput of a batch on two threads over a loop on one."""
    at = robot.state()
    batch = Batch(robot.model, simulations, 2)
    qpos, qvel, act = batch.bind("qpos"), batch.bind("qvel"), batch.bind("act")
    speed = np.random.default_rng(0).normal(0, 0.2, robot.model.nv)
    step = stepper(robot, steps)
    batch.bind("ctrl")[:] = 0.7

    def together() -> None:
        qpos[:], qvel[:], act[:] = at.qpos, speed, at.act
        batch.step(nstep=steps)

    def loop() -> None:
        for _ in range(simulations):
            step()

    threaded, single = least([together, loop], 8)
    return single / threaded


def reference_ratio(robot: Twin, seconds: float = 2.0) -> float:
    """Time of the reference over the twin's at 1 ms, for the same seconds of PRBS."""
    currents = prbs(round(100 * seconds) + 1, 0.01)
    clock = np.arange(len(currents)) * 0.01
    data, at = mujoco.MjData(robot.model), robot.state()

    def ours() -> None:
        data.qpos[:], data.qvel[:], data.act[:] = at.qpos, 0, at.act
        for current in currents[:-1]:
            data.ctrl[:] = current
            mujoco.mj_step(robot.model, data, 10)

    def theirs() -> None:
        simulate_reference(robot.parameters, INCA, clock, currents)

    theirs()  # compiles
    mine, other = least([ours, theirs], 3)
    return other / mine


def _idle(m, d):  # type: ignore[no-untyped-def]
    return


def _zero(m, d, i):  # type: ignore[no-untyped-def]
    return 0.0


def _exponentials(m, d):  # type: ignore[no-untyped-def]
    for i in range(word(m, M.nactuator)):
        at = integer(m, M.jnt_dofadr, integer(m, M.actuator_trnid, 2 * i))
        x = exp(2.0 * drive(m, i, law.BETA) * double(d, D.qvel, at))
        force = word(d, D.qfrc_passive) + 8 * at
        store_double(force, load_double(force) + 0.0 * x)


def idle_callbacks(exponentials: bool) -> dict[str, Any]:
    """The callbacks by their kind, compiled."""
    structs.require(FIELDS)
    passive = _exponentials if exponentials else _idle
    functions = {"passive": passive, "act_dyn": _zero, "act_bias": _zero}
    return {kind: compile_once(functions[kind], SIGNATURES[kind]) for kind in KINDS}


def held_callbacks() -> dict[str, Any]:
    """The callbacks that MuJoCo holds now."""
    return {kind: getattr(mujoco, f"get_mjcb_{kind}")() for kind in KINDS}


def hold_callbacks(callbacks: dict[str, Any]) -> None:
    """Let MuJoCo hold callbacks, None for none."""
    for kind in KINDS:
        getattr(mujoco, f"set_mjcb_{kind}")(callbacks[kind])


def install_python_law(model: mujoco.MjModel) -> None:
    """Install Python callbacks that do for this model what `inca_mj.twin.native` does."""
    drives, cables = model.actuator_user, model.tendon_user
    R, R_s, k_s, b_c, beta, T_0 = (
        drives[:, c] for c in (law.R, law.R_S, law.K_S, law.B_C, law.BETA, law.T_0)
    )
    lambda_, b = cables[:, law.LAMBDA], cables[:, law.B]
    tension_at = model.sensor("tension_1").adr[0]
    no_load_at = model.sensor("no_load_length_1").adr[0]
    dense = np.zeros((len(cables), model.nv))

    def no_load_rate(d: mujoco.MjData) -> np.ndarray:
        return -R * d.qvel[6:] * d.act / d.ten_length

    def tension(d: mujoco.MjData) -> np.ndarray:
        strain = (d.ten_length - d.act) / d.act
        return np.maximum(0, lambda_ * strain + b * (d.ten_velocity - no_load_rate(d)))

    def passive(m: mujoco.MjModel, d: mujoco.MjData) -> None:
        T = tension(d)
        mujoco.mju_sparse2dense(dense, d.ten_J, m.ten_J_rownnz, m.ten_J_rowadr, m.ten_J_colind)
        d.qfrc_passive -= T @ dense
        F_s = np.maximum(0, R / R_s * T_0 - k_s * R_s * d.qpos[7:])
        d.qfrc_passive[6:] += -R * T + R_s * F_s - b_c * np.tanh(beta * d.qvel[6:])

    def act_dyn(m: mujoco.MjModel, d: mujoco.MjData, i: int) -> float:
        return -R[i] * d.qvel[6 + i] * d.act[i] / d.ten_length[i]

    def act_bias(m: mujoco.MjModel, d: mujoco.MjData, i: int) -> float:
        return d.ctrl[i]

    def sensor(m: mujoco.MjModel, d: mujoco.MjData, stage: int) -> None:
        if stage == mujoco.mjtStage.mjSTAGE_VEL:
            d.sensordata[tension_at : tension_at + len(T_0)] = tension(d)
            d.sensordata[no_load_at : no_load_at + len(T_0)] = d.act

    mujoco.set_mjcb_passive(passive)
    mujoco.set_mjcb_act_dyn(act_dyn)
    mujoco.set_mjcb_act_bias(act_bias)
    mujoco.set_mjcb_sensor(sensor)


def uninstall_python_law() -> None:
    """Release MuJoCo's callbacks."""
    for kind in ("passive", "act_dyn", "act_bias", "sensor"):
        getattr(mujoco, f"set_mjcb_{kind}")(None)
