"""Steps of the twin on the processor, beside which `benchmarks/gpu_speed.py` puts the others."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from mujoco.batch import Batch

from gpu.worlds import FREE, Worlds, columns, motors
from identification.model import rollout
from identification.native.table import uninstall
from identification.runtime.engine import quiet, untimed
from inca_mj.robot.parameters import TIMESTEP
from inca_mj.twin import native

ENOUGH = 0.5  # a measurement is repeated until it took so long [s]


def on_processor(worlds: Worlds, threads: int, law: bool = True) -> np.ndarray:
    """Angles of the drums after each step, shape (n, steps, 8) [rad], as fits simulate them."""
    (native.install if law else uninstall)()
    model, start = worlds.model, worlds.start
    if not law:
        model, start = motors(), replace(start, act=np.zeros((len(worlds), 0)))
    try:
        inputs = np.concatenate([worlds.currents, worlds.currents[-1:]])
        found = rollout.rollout(
            model, start, inputs, TIMESTEP, numbers=worlds.numbers,
            nthread=threads, keeps_diverged=True,
        )  # fmt: skip
    finally:
        native.install()
    return np.asarray(found["qpos"][:, 1:, 7:])


class Processor:
    """Steps of worlds side by side on the processor: MuJoCo's batch, as fits use it.

    Args:
        worlds: what is simulated.
        threads: of the batch.
        law: whether the drives have their law.
    """

    def __init__(self, worlds: Worlds, threads: int, law: bool = True) -> None:
        self.law, n = law, len(worlds)
        self.batch = Batch(worlds.model if law else motors(), n, threads)
        for slot, values in worlds.numbers:
            column = () if slot.column is None else (slot.column,)
            entries = self.batch.expand(slot.field)
            entries[(slice(None), list(slot.rows), *column)] = np.asarray(values)[:, None]
        self.batch.set_const()
        self.start = {
            f: getattr(worlds.start, f) for f in ("qpos", "qvel", *(("act",) if law else ()))
        }
        self.bound = {name: self.batch.bind(name) for name in self.start}
        self.currents = np.broadcast_to(worlds.currents, (n, *worlds.currents.shape)).copy()

    def run(self) -> None:
        """All steps of all worlds."""
        (native.install if self.law else uninstall)()
        for name, rows in self.start.items():
            self.bound[name][:] = rows
        with quiet(), untimed():
            self.batch.rollout(self.currents.shape[1], self.currents, record=("qpos",))
        native.install()


def seconds(run: Callable[[], object]) -> float:
    """The least time of a function that is called a few times [s]."""
    best, spent, calls = float("inf"), 0.0, 0
    while calls < 2 or (spent < ENOUGH and calls < 50):
        begin = time.perf_counter()
        run()
        took = time.perf_counter() - begin
        best, spent, calls = min(best, took), spent + took, calls + 1
    return best


def accuracy(worlds: Worlds, angles: np.ndarray) -> dict[str, Any]:
    """How far angles of the worlds of a fit, and their columns, are from the twin's.

    Args:
        worlds: those of `gpu.worlds.moved`, or more.
        angles: after each step, shape (n, steps, 8) [rad].
    """
    truth = on_processor(worlds, os.cpu_count() or 1)
    every = slice(9, None, 10)  # samples each 10 ms
    seen, truth = angles[:, every].astype(float), truth[:, every]
    own = (columns(seen), columns(truth))
    size = np.sqrt(np.mean(own[1][0] ** 2, axis=(1, 2)))
    central, forward = (np.sqrt(np.mean((a - own[1][0]) ** 2, axis=(1, 2))) / size for a in own[0])
    return {
        "free_run_largest_rad": float(np.abs(seen[0] - truth[0]).max()),
        "free_run_rms_rad": float(np.sqrt(np.mean((seen[0] - truth[0]) ** 2))),
        "central_columns": dict(zip(FREE, map(float, central), strict=True)),
        "forward_columns": dict(zip(FREE, map(float, forward), strict=True)),
    }
