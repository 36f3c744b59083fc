"""How fast a step of the twin is, beside others; `benchmarks/speed.py` prints the ratios.

Two things are compared by turns, many times, and the least time of each counts: other programs
only ever add to it.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import idle_law
import mujoco
import numpy as np
import python_law
from mujoco.batch import Batch

from inca_mj.reference import simulate_reference
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import prbs
from inca_mj.twin import native
from inca_mj.twin.twin import Twin

BURST = 50  # steps from the same moving state, so that both sides turn the same quaternions


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
    step, law = stepper(robot), idle_law.held()
    callbacks = {
        "law": law,
        "idle": idle_law.compiled(exponentials=False),
        "exponentials": idle_law.compiled(exponentials=True),
        "none": dict.fromkeys(law),
    }
    best = dict.fromkeys(callbacks, float("inf"))
    for _ in range(2000):
        for name, held in callbacks.items():
            idle_law.hold(held)
            best[name] = min(best[name], least([step], 1)[0])
    idle_law.hold(law)
    return {name: seconds / best["none"] for name, seconds in best.items()}


def python_ratio(robot: Twin) -> float:
    """A step with the law as Python callbacks over one with the compiled law."""
    step = stepper(robot)
    (compiled,) = least([step], 50)
    native.uninstall()
    python_law.install(robot.model)
    (slow,) = least([step], 20)
    python_law.uninstall()
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


def reference_ratio(robot: Twin, method: str, seconds: float = 2.0) -> float:
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
        simulate_reference(robot.parameters, INCA, clock, currents, method=method)

    theirs()  # compiles
    mine, other = least([ours, theirs], 3)
    return other / mine
