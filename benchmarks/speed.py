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
from pathlib import Path
from statistics import median
from typing import Any

import fit_ratios
import step_ratios
from speed_page import write_page
from step_shares import SAMPLES, bare_times, lean, share_of

from identification.estimation.estimation import estimate
from identification.runtime.engine import untimed
from identification.sweep.work import commit
from inca_mj.robot.inputs import prbs
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


def measure_steps(robot: Twin) -> dict[str, dict]:
    """Ratios of a step, and what it takes at least."""
    as_fits, inputs = lean(robot), prbs(SAMPLES, 0.01)
    timed = bare_times(as_fits, inputs)
    with untimed():
        bare = bare_times(as_fits, inputs)
        law, drawn = step_ratios.law_ratios(as_fits), step_ratios.law_ratios(robot)
    return {
        "step_with_law_over_without": entry(law["law"], 1.03, "as fits simulate it"),
        "step_with_idle_callbacks_over_without": entry(law["idle"]),
        "step_with_exponentials_over_without": entry(law["exponentials"]),
        "step_with_law_over_without_drawn": entry(drawn["law"], None, "with shapes and sensors"),
        "step_with_clock_over_without": entry(timed.step / bare.step),
        "python_callback_over_native": entry(step_ratios.python_ratio(robot), 4.0),
        "batch_on_2_threads_over_loop_on_1": entry(step_ratios.batch_ratio(robot)),
        "reference_adaptive_over_twin": entry(step_ratios.reference_ratio(robot)),
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
        share_of(lambda: estimate(robot, log, fit_ratios.FREE), as_fits, log.inputs, median)[0]
        for _ in range(FITS)
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
    share, asked = share_of(
        lambda: found.append(discover([log])), lean(build_twin()), log.inputs, median
    )
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
