"""How fast the twin is, as ratios measured in one run; prints one JSON object.

    python benchmarks/twin.py

Every entry is {"value", "goal", "met"}; a goal of null is information. Two things are compared
by turns, many times, and the least time of each counts: other programs only ever add to it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np
import python_law
from mujoco.batch import Batch

from inca_mj.reference import simulate_reference
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import prbs
from inca_mj.twin import native
from inca_mj.twin.twin import Twin, build_twin

ROOT = Path(__file__).resolve().parents[1]
BURST = 50  # steps from the same moving state, so that both sides turn the same quaternions


def least(functions: list[Callable[[], None]], rounds: int) -> list[float]:
    """Least time of each of several functions that take turns [s]."""
    best = [float("inf")] * len(functions)
    for _ in range(rounds):
        for k, function in enumerate(functions):
            begin = time.perf_counter()
            function()
            best[k] = min(best[k], time.perf_counter() - begin)
    return best


def stepper(robot: Twin, steps: int = BURST) -> Callable[[], None]:
    """A function that simulates some steps from a moving state."""
    data, at = mujoco.MjData(robot.model), robot.state()
    speed = np.random.default_rng(0).normal(0, 0.2, robot.model.nv)

    def run() -> None:
        data.qpos[:], data.qvel[:], data.act[:], data.ctrl[:] = at.qpos, speed, at.act, 0.7
        mujoco.mj_step(robot.model, data, steps)

    return run


def law_ratio(robot: Twin) -> float:
    """A step with the law over one without it."""
    step = stepper(robot)
    best = [float("inf")] * 2
    for _ in range(2000):
        for k, switch in enumerate((native.install, native.uninstall)):
            switch()
            best[k] = min(best[k], least([step], 1)[0])
    native.install()
    return best[0] / best[1]


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


def cold_start(*arguments: str) -> tuple[float | None, str]:
    """Least seconds of five runs of the program, or None and why there is none."""
    command = [sys.executable, "-m", "inca_mj.cli", *arguments]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    best = float("inf")
    for _ in range(5):
        begin = time.perf_counter()
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["no message"])[-1]
            return None, f"exit code {done.returncode}: {last}"
        best = min(best, time.perf_counter() - begin)
    return best, ""


def entry(value: float | None, goal: float | None = None, *, most: bool = True, why: str = ""):
    """One measurement beside its goal: at most it, or at least it."""
    met = None
    if goal is not None:
        met = value is not None and (value <= goal if most else value >= goal)
    shown = None if value is None else round(value, 4)
    return {"value": shown, "goal": goal, "met": met} | ({"why": why} if why else {})


def main() -> None:
    """Measure everything and print it."""
    begin = time.perf_counter()
    robot = build_twin()
    compiled = time.perf_counter() - begin
    (burst,) = least([stepper(robot)], 200)
    help_time, help_why = cold_start("--help")
    compare_time, compare_why = cold_start("compare", "examples/log.csv", "--json")
    result = {
        "step_with_law_over_without": entry(law_ratio(robot), 1.05),
        "python_callback_over_native": entry(python_ratio(robot), 4.0, most=False),
        "batch_on_2_threads_over_loop_on_1": entry(batch_ratio(robot)),
        "reference_rk4_over_twin": entry(reference_ratio(robot, "rk4")),
        "reference_adaptive_over_twin": entry(reference_ratio(robot, "adaptive")),
        "step_microseconds": entry(1e6 * burst / BURST),
        "first_twin_seconds": entry(compiled),
        "inca_help_seconds": entry(help_time, 0.4, why=help_why),
        "inca_compare_seconds": entry(compare_time, why=compare_why),
    }
    print(json.dumps(result, indent=2))


if __name__ == "__main__":
    main()
