"""The share of a work's processor time that its steps would take in a loop that does nothing else.

The motion counts: a step takes up to 4 % longer along a log than again and again from one state.
So bare steps are those of the motion that the log's inputs make.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any
from unittest import mock

import mujoco
import numpy as np
import step_ratios
from mujoco.batch import Batch

from identification.linear import points
from identification.model import rollout
from identification.native import forward
from identification.runtime.engine import untimed
from inca_mj.twin.twin import Twin, build_twin

SAMPLES, EVERY = 100, 10  # of the motion, and steps a sample

Summary = Callable[[list[float]], float]


@dataclass(frozen=True)
class Bare:
    """Seconds of a step, of an evaluation, and of one that shares its positions, and no more."""

    step: float
    evaluation: float
    shared: float


@dataclass
class Asked:
    """What the simulator was asked for, and the processor time of the whole [s]."""

    steps: int = 0
    evaluations: int = 0
    shared: int = 0
    processor: float = 0.0

    def share(self, bare: Bare) -> float:
        """Bare time of what was asked over the processor time that it took."""
        return (
            self.steps * bare.step + self.evaluations * bare.evaluation + self.shared * bare.shared
        ) / self.processor


@contextmanager
def counted() -> Iterator[Asked]:
    """Counts the steps of all batches, and the evaluations at all points."""
    asked = Asked()

    class Counted(Batch):
        def __init__(self, model: Any, n: int, *rest: Any) -> None:
            super().__init__(model, n, *rest)
            self.many = n

        def rollout(self, steps: int, *rest: Any, **more: Any) -> Any:
            asked.steps += steps * self.many
            return super().rollout(steps, *rest, **more)

    def evaluate(base: Any, cases: Any, *rest: Any) -> Any:
        # The base is evaluated at each point; the share of an actuator is no evaluation.
        others = [case for case in cases if not case.actuators]
        whole = sum(case.keeps == "nothing" for case in others)
        asked.evaluations += len(base.states) * (1 + whole)
        asked.shared += len(base.states) * (len(others) - whole)
        return forward.evaluate(base, cases, *rest)

    begin = time.process_time()
    with (
        mock.patch.object(rollout, "Batch", Counted),
        mock.patch.object(points, "evaluate", evaluate),
    ):
        yield asked
    asked.processor = time.process_time() - begin


def lean(robot: Twin) -> Twin:
    """The robot as fits simulate it: without shapes to draw, and without sensors."""
    bare = build_twin(robot.parameters, visual=False)
    return replace(bare, model=rollout.without_sensors(bare.model))


def bare_times(robot: Twin, inputs: np.ndarray, of: Summary = min) -> Bare:
    """What each takes in a loop that does nothing else: the least time, or what `of` makes of all.

    The least time is the program's own. Beside another program's time, which has the machine's
    pauses in it, stands the median.

    Args:
        robot: what is simulated.
        inputs: of the motion, shape (N, 8), of which the first `SAMPLES` count [A].
        of: what is made of the times.
    """
    model, at = robot.model, robot.state()
    data, moving = mujoco.MjData(model), mujoco.MjData(model)
    data.qpos[:], data.act[:] = at.qpos, at.act
    inputs = inputs[:SAMPLES]

    def steps() -> None:
        moving.qpos[:], moving.qvel[:], moving.act[:] = at.qpos, 0, at.act
        for u in inputs:
            moving.ctrl[:] = u
            mujoco.mj_step(model, moving, EVERY)

    def evaluations() -> None:
        for _ in range(step_ratios.BURST):
            mujoco.mj_forward(model, data)

    def shared() -> None:
        for _ in range(step_ratios.BURST):
            mujoco.mj_forwardSkip(model, data, mujoco.mjtStage.mjSTAGE_POS, 0)

    evaluations()
    along, whole, part = step_ratios.times([steps, evaluations, shared], 60)
    return Bare(
        of(along) / (EVERY * len(inputs)),
        of(whole) / step_ratios.BURST,
        of(part) / step_ratios.BURST,
    )


def share_of(
    work: Callable[[], object], robot: Twin, inputs: np.ndarray, of: Summary
) -> tuple[float, Asked]:
    """Bare time of what some work asks of the simulator over its processor time.

    The speed of a machine changes within a minute by more than what is looked for, so bare times
    are taken just before the work and just after it.

    Args:
        work: what is done.
        robot: what it simulates.
        inputs: of its log, shape (N, 8) [A].
        of: what is made of the bare times of each kind.
    """

    def bare() -> Bare:
        with untimed():
            return bare_times(robot, inputs, of)

    before = bare()
    with counted() as asked:
        work()
    shares = [asked.share(each) for each in (before, bare())]
    return sum(shares) / 2, asked
