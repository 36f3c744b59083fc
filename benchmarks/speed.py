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
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median
from typing import Any
from unittest import mock

import fit_ratios
import mujoco
import step_ratios
from mujoco.batch import Batch
from speed_page import write_page

from identification.engine import untimed
from identification.estimation.estimation import estimate
from identification.linear import points
from identification.model import rollout
from identification.native import forward
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
FITS = 5  # of which the median share counts
DISCOVERY = ("discover", LOG, "--spread", "none")


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

    def evaluate(base: Any, cases: Any, results: Any, *, shares: bool, threads: int) -> Any:
        many = len(base.states) * len(cases)
        asked.shared += many if shares else 0
        asked.evaluations += 0 if shares else many
        return forward.evaluate(base, cases, results, shares=shares, threads=threads)

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


def bare_times(robot: Twin, of: Callable[[list[float]], float] = min) -> Bare:
    """What each takes in a loop that does nothing else: the least time, or what `of` makes of all.

    The least time is the program's own. Beside another program's time, which has the machine's
    pauses in it, stands the median.
    """
    model, at = robot.model, robot.state()
    data = mujoco.MjData(model)
    data.qpos[:], data.act[:] = at.qpos, at.act

    def evaluations() -> None:
        for _ in range(step_ratios.BURST):
            mujoco.mj_forward(model, data)

    def shared() -> None:
        for _ in range(step_ratios.BURST):
            mujoco.mj_forwardSkip(model, data, mujoco.mjtStage.mjSTAGE_POS, 0)

    evaluations()
    each = step_ratios.times([step_ratios.stepper(robot), evaluations, shared], 200)
    return Bare(*(of(seconds) / step_ratios.BURST for seconds in each))


def share_of(work: Callable[[], object], robot: Twin) -> tuple[float, Asked]:
    """Bare time of what some work asks of the simulator over its processor time.

    The speed of a machine changes within a minute by more than what is looked for, so bare times
    are taken just before the work and just after it.
    """

    def bare() -> Bare:
        with untimed():
            return bare_times(robot, median)

    before = bare()
    with counted() as asked:
        work()
    shares = [asked.share(each) for each in (before, bare())]
    return sum(shares) / 2, asked


def measure_steps(robot: Twin) -> dict[str, dict]:
    """Ratios of a step, and what it takes at least."""
    as_fits = lean(robot)
    timed = bare_times(as_fits)
    with untimed():
        bare = bare_times(as_fits)
        law, drawn = step_ratios.law_ratio(as_fits), step_ratios.law_ratio(robot)
    return {
        "step_with_law_over_without": entry(law, 1.03, "as fits simulate it"),
        "step_with_law_over_without_drawn": entry(drawn, None, "with shapes and sensors"),
        "step_with_clock_over_without": entry(timed.step / bare.step),
        "python_callback_over_native": entry(step_ratios.python_ratio(robot), 4.0),
        "batch_on_2_threads_over_loop_on_1": entry(step_ratios.batch_ratio(robot)),
        "reference_adaptive_over_twin": entry(step_ratios.reference_ratio(robot, "adaptive")),
        "step_microseconds": entry(1e6 * bare.step),
        "evaluation_microseconds": entry(1e6 * bare.evaluation),
        "shared_evaluation_microseconds": entry(1e6 * bare.shared),
    }


def measure_fit() -> dict[str, dict]:
    """A fit of seventeen parameters, beside `mujoco.sysid` and what an engineer writes first."""
    robot, log = build_twin(parameter_set("trial"), visual=False), fit_ratios.practice()
    with fit_ratios.watched() as work:
        found = estimate(robot, log, fit_ratios.FREE)
    as_fits = lean(robot)
    shares = sorted(
        share_of(lambda: estimate(robot, log, fit_ratios.FREE), as_fits)[0] for _ in range(FITS)
    )
    other, why = fit_ratios.sysid_seconds(robot, log, found.seconds)
    naive = fit_ratios.naive_seconds(robot, log, work.simulated)
    return {
        "fit_share_of_bare_steps": entry(
            median(shares), 0.93, f"median of {FITS} fits, {shares[0]:.3f} to {shares[-1]:.3f}"
        ),
        "sysid_over_fit": entry(other and other / found.seconds, 15.0, why),
        "solve_ivp_over_fit": entry(naive / found.seconds, 50.0),
        "fit_processors_used": entry(work.processor / found.seconds),
    }


def measure_discovery() -> dict[str, dict]:
    """A discovery on the shipped log, in this process."""
    from inca_mj.twin.logs import read_inca_log
    from inca_mj.workflows.discovery import discover

    found: list[Any] = []
    log = read_inca_log(ROOT / LOG)
    share, asked = share_of(lambda: found.append(discover([log])), lean(build_twin()))
    total = sum(found[0].seconds.values())
    stages = {name: round(seconds / total, 3) for name, seconds in found[0].seconds.items()}
    return {
        "discovery_share_of_bare_steps": entry(
            share, None,
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
    found = measure_steps(build_twin())
    for part in () if options.quick else (measure_fit, measure_discovery, measure_starts):
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
        write_page()


if __name__ == "__main__":
    main()
