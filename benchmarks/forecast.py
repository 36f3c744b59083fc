"""What a discovery said that it would take, and what it took then: memory and processor time.

    python benchmarks/forecast.py [--samples 500 1000 2000] [--spread none usual]

Each log is simulated by the twin with other values than those of its drawing and with the noise of
its encoders, so that nothing is missing. Each search is a process of its own, whose memory is what
it holds at most beyond what it held when it began to search. A row is added to
results/forecast.jsonl; benchmarks/robustness.py makes the page.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

from identification.sweep.code import commit

RECORD = Path(__file__).parent / "results" / "forecast.jsonl"
RATE = 100.0  # [Hz]
NOISE = 5e-4  # [rad]
VALUES = {"m": 0.18, "lambda": 24_000.0, "b_c": 0.0055, "K_t": 0.079}
UNIT = 1024 if sys.platform != "darwin" else 1  # [bytes] of ru_maxrss


def main() -> int:
    """Search, a process after the other, and keep what each tells."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, nargs="*", default=[500, 1000, 2000])
    parser.add_argument("--spread", nargs="*", default=["none"])
    parser.add_argument("--record", type=Path, default=RECORD)
    parser.add_argument("--one", action="store_true", help="search in this process, print the row")
    options = parser.parse_args()
    for spread in options.spread:
        for samples in options.samples:
            if options.one:
                print(json.dumps(measured(samples, spread)))
                continue
            line = [sys.executable, __file__, "--one", "--samples", str(samples)]
            alone = {**os.environ, "OMP_NUM_THREADS": "1"}
            done = subprocess.run([*line, "--spread", spread], stdout=subprocess.PIPE, text=True,
                                  check=True, env=alone)  # fmt: skip
            row = done.stdout.splitlines()[-1]
            print(row, flush=True)
            with options.record.open("a") as record:
                record.write(row + "\n")
    return 0


def measured(samples: int, spread: str) -> dict[str, object]:
    """Forecast and measurement of one search."""
    import numpy as np

    from identification.discovery import search
    from identification.discovery.forecast import Forecast
    from identification.discovery.task import DiscoveryTask
    from inca_mj import build_twin, discover, make_input, simulate
    from inca_mj.twin.logs import run_to_log
    from inca_mj.workflows.spread import spread_of

    robot = build_twin().with_values(VALUES)
    run = simulate(robot, make_input("prbs", duration=(samples - 1) / RATE))
    noise = NOISE * np.random.default_rng(samples).standard_normal((samples, 8))
    clean = run_to_log(run)
    log = replace(clean, outputs=clean.outputs + noise)
    told: list[tuple[Forecast, float, float]] = []
    own = search.forecast

    def forecast(task: DiscoveryTask) -> Forecast:
        told.append((own(task), peak(), time.process_time()))
        return told[-1][0]

    search.forecast = forecast
    found = discover(log, spread=spread_of(spread))
    needs, before, began = told[0]
    return {
        "samples": len(log), "spread": spread, "verdict": found.verdict,
        "memory": {"forecast": needs.memory, "measured": peak() - before},
        "seconds": {"forecast": needs.seconds, "measured": time.process_time() - began},
        "commit": commit(),
    }  # fmt: skip


def peak() -> float:
    """The most memory that this process has held [bytes]."""
    return float(UNIT * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


if __name__ == "__main__":
    sys.exit(main())
