"""How near the limit the project runs, all in one run; prints one JSON object.

    python benchmarks/speed.py [--out benchmarks/results/speed.jsonl] [--quick]

Nearly all entries are ratios of two times that were measured by turns in this run, because seconds
tell more of the machine than of the program. The limit of a fit or a discovery is the simulator
itself: steps and evaluations that were asked for, times what each takes in a loop that does nothing
else, over the processor time of the whole. A row of `--out` has the commit and the machine too.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest import mock

import fit_ratios
import mujoco
import step_ratios
from mujoco.batch import Batch

from identification.estimation.estimation import estimate
from identification.linear import derivatives
from identification.model import rollout
from identification.sweep.code import commit
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.twin import Twin, build_twin

ROOT = Path(__file__).resolve().parents[1]
LOG = "examples/log.csv"
COMMANDS = (  # whose starts are measured: no help, a simulation, a comparison, a figure
    ("--help",),
    ("simulate", "--duration", "1"),
    ("compare", LOG),
    ("sensitivity", LOG, "--free", "J", "K_t"),
)
DISCOVERY = ("discover", LOG, "--spread", "none")


@dataclass
class Asked:
    """What the simulator was asked for, and the processor time of the whole [s]."""

    steps: int = 0
    evaluations: int = 0
    processor: float = 0.0


@contextmanager
def counted() -> Iterator[Asked]:
    """Counts the steps and evaluations of all batches."""
    asked = Asked()

    class Counted(Batch):
        def __init__(self, model: Any, n: int, *rest: Any) -> None:
            super().__init__(model, n, *rest)
            self.many = n

        def rollout(self, steps: int, *rest: Any, **more: Any) -> Any:
            asked.steps += steps * self.many
            return super().rollout(steps, *rest, **more)

        def forward(self) -> Any:
            asked.evaluations += self.many
            return super().forward()

    begin = time.process_time()
    with (
        mock.patch.object(rollout, "Batch", Counted),
        mock.patch.object(derivatives, "Batch", Counted),
    ):
        yield asked
    asked.processor = time.process_time() - begin


def bare_times(robot: Twin) -> tuple[float, float]:
    """Seconds of a step and of an evaluation in loops that do nothing else."""
    model = rollout.without_sensors(robot.model)
    data, at = mujoco.MjData(model), robot.state()
    data.qpos[:], data.act[:] = at.qpos, at.act

    def evaluations() -> None:
        for _ in range(step_ratios.BURST):
            mujoco.mj_forward(model, data)

    step, evaluation = step_ratios.least([step_ratios.stepper(robot), evaluations], 200)
    return step / step_ratios.BURST, evaluation / step_ratios.BURST


def share_of_limit(asked: Asked, step: float, evaluation: float) -> float:
    """Bare time of what was asked over the processor time that it took."""
    return (asked.steps * step + asked.evaluations * evaluation) / asked.processor


def measure_fit(step: float, evaluation: float) -> dict[str, dict]:
    """A fit of seventeen parameters, beside `mujoco.sysid` and what an engineer writes first."""
    robot, log = build_twin(parameter_set("trial")), fit_ratios.practice()
    with counted() as asked, fit_ratios.watched() as work:
        found = estimate(robot, log, fit_ratios.FREE)
    other, why = fit_ratios.sysid_seconds(robot, log, found.seconds)
    naive = fit_ratios.naive_seconds(robot, log, work.simulated)
    return {
        "fit_share_of_bare_steps": entry(share_of_limit(asked, step, evaluation), 0.93),
        "sysid_over_fit": entry(other and other / found.seconds, 15.0, why),
        "solve_ivp_over_fit": entry(naive / found.seconds, 50.0),
        "fit_processors_used": entry(work.processor / found.seconds),
    }


def measure_discovery(step: float, evaluation: float) -> dict[str, dict]:
    """A discovery on the shipped log, in this process."""
    from inca_mj.twin.logs import read_inca_log
    from inca_mj.workflows.discovery import discover

    with counted() as asked:
        found = discover([read_inca_log(ROOT / LOG)])
    total = sum(found.seconds.values())
    stages = {name: round(seconds / total, 3) for name, seconds in found.seconds.items()}
    return {
        "discovery_share_of_bare_steps": entry(
            share_of_limit(asked, step, evaluation), None,
            f"processor time {asked.processor:.1f} s; stages {stages}",
        ),
    }  # fmt: skip


def run(words: tuple[str, ...], cache: Path, out: Path) -> tuple[float, float]:
    """Wall seconds of a command and the most memory that it had [MB]."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(cache)}
    command = [sys.executable, "-m", "inca_mj", *words]
    if words != ("--help",):
        command += ["--out", str(out)]
    before = time.perf_counter()
    process = subprocess.Popen(
        command, cwd=ROOT, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    told = process.stderr.read().decode() if process.stderr else ""
    _, status, used = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"inca {' '.join(words)} failed: {told}")
    return time.perf_counter() - before, used.ru_maxrss / 1024


def measure_starts() -> dict[str, dict]:
    """First start of each command, with an empty cache of compiled laws, and the second."""
    out = {}
    with tempfile.TemporaryDirectory() as folder:
        for words in COMMANDS:
            cache = Path(folder, f"cache_{words[0].strip('-')}")
            first, second = (run(words, cache, Path(folder, "out"))[0] for _ in range(2))
            name = words[0].strip("-")
            out[f"{name}_first_seconds"] = entry(first)
            out[f"{name}_second_seconds"] = entry(second, 0.4 if name == "help" else None)
        seconds, memory = run((*DISCOVERY, "--no-film"), Path(folder, "cache"), Path(folder, "out"))
        out["discover_seconds"] = entry(seconds)
        out["discover_peak_megabytes"] = entry(memory)
        seconds, _ = run(("film", LOG, "--seconds", "4"), Path(folder, "cache"), Path(folder, "o"))
        out["film_seconds_per_second"] = entry(seconds / 4, None, "start of the program included")
    return out


def entry(value: float | None, goal: float | None = None, how: str = "") -> dict:
    """One measurement beside its goal; times and steps are to be below it, the rest above."""
    return {"value": None if value is None else round(value, 4), "goal": goal} | (
        {"how": how} if how else {}
    )


def main() -> None:
    """Measure everything and print it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, help="append the result as a row")
    parser.add_argument("--quick", action="store_true", help="the ratios of a step only")
    options = parser.parse_args()
    robot = build_twin()
    step, evaluation = bare_times(robot)
    found: dict[str, dict] = {
        "step_with_law_over_without": entry(step_ratios.law_ratio(robot), 1.03),
        "python_callback_over_native": entry(step_ratios.python_ratio(robot), 4.0),
        "batch_on_2_threads_over_loop_on_1": entry(step_ratios.batch_ratio(robot)),
        "reference_adaptive_over_twin": entry(step_ratios.reference_ratio(robot, "adaptive")),
        "step_microseconds": entry(1e6 * step),
        "evaluation_microseconds": entry(1e6 * evaluation),
    }
    parts: list[Callable[[], dict[str, dict]]] = [
        lambda: measure_fit(step, evaluation),
        lambda: measure_discovery(step, evaluation),
        measure_starts,
    ]
    for part in () if options.quick else parts:
        found |= (more := part())
        for name, of in more.items():  # minutes pass between the parts
            print(f"{name}: {of['value']}", file=sys.stderr, flush=True)
    print(json.dumps(found, indent=2, ensure_ascii=False))
    if options.out:
        row = {
            "commit": commit(), "machine": platform.machine(), "processors": os.cpu_count(),
            "load": os.getloadavg()[0],
            "peak_megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
            **found,
        }  # fmt: skip
        with options.out.open("a") as file:
            file.write(json.dumps(row, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
