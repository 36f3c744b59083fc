"""Ctrl-C at 20 random times of every command: exit code, seconds until the end, what was left.

    python benchmarks/interrupts.py [--times 20] [--command discover] [--out FILE.json]

A command that ends by itself before the interrupt is not counted, and another one is begun for it.
Python itself takes 0.05 s to start, which is left out: its answer is its own. A command that had
ended but for its process ends with 0. Right is that, or exit code 130 within two seconds with
"stopping" or "stopped" said once, and no draft left in the folder of the results.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

EARLIEST = 0.05  # [s]
LATEST = 6.0  # [s] after the start, when most commands are within their search
WITHIN = 2.0  # [s]
TRIES = 5  # for each interrupt that is asked for
ROBOT = [sys.executable, "-m", "identification"]
INCA = [sys.executable, "-m", "inca_mj"]
LOG = "examples/log.csv"
COMMANDS = {
    "simulate": [*INCA, "simulate", "--input", "prbs", "--duration", "60"],
    "compare": [*INCA, "compare", LOG],
    "crosscheck": [*INCA, "crosscheck"],
    "identify": [*INCA, "identify", LOG],
    "calibrate": [*INCA, "calibrate", LOG],
    "discover": [*INCA, "discover", LOG, "--spread", "none"],
    "discover, spread": [*INCA, "discover", LOG],
    "sensitivity": [*INCA, "sensitivity", LOG],
    "excite": [*INCA, "excite"],
    "trials": [*INCA, "trials"],
    "film": [*INCA, "film", LOG],
    "demo": [*INCA, "demo"],
    "fit": [*ROBOT, "fit", "{robot}/robot.toml", "{robot}/log.csv"],
    "discover, robot": [*ROBOT, "discover", "{robot}/robot.toml", "{robot}/log.csv"],
}


def main() -> int:
    """Interrupt, print a line per command, write the record; 1 where something was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--command", nargs="*", choices=[*COMMANDS], default=[*COMMANDS])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    chance, rows = random.Random(options.seed), {}
    with tempfile.TemporaryDirectory() as folder:
        write_robot(Path(folder))
        for name in options.command:
            line = [word.format(robot=folder) for word in COMMANDS[name]]
            stopped: list[dict[str, Any]] = []
            tries = 0
            while len(stopped) < options.times and tries < TRIES * options.times:
                tries += 1
                row = interrupted(line, chance.uniform(EARLIEST, LATEST))
                stopped += [row] if row is not None else []
            rows[name] = {
                "interrupts": len(stopped),
                "ended before": tries - len(stopped),
                "right": sum(row["right"] for row in stopped),
                "slowest": max((row["seconds"] for row in stopped), default=0.0),
                "wrong": [row for row in stopped if not row["right"]],
            }
            print(f"{name:<18}" + ", ".join(f"{k} {v}" for k, v in rows[name].items()), flush=True)
    if options.out is not None:
        options.out.write_text(json.dumps(rows, indent=1) + "\n")
    return int(any(row["wrong"] for row in rows.values()))


def interrupted(line: list[str], after: float) -> dict[str, Any] | None:
    """What a command did that was interrupted so many seconds after its start; None if nothing."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        process = subprocess.Popen(
            [*line, "--out", str(out)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            text=True, start_new_session=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )  # fmt: skip
        try:
            process.wait(after)
            return None
        except subprocess.TimeoutExpired:
            pass
        began = time.perf_counter()
        os.killpg(process.pid, signal.SIGINT)
        try:
            _, said = process.communicate(timeout=30)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            _, said = process.communicate()
        seconds = time.perf_counter() - began
        told = said.count("stopping") + said.count("stopped\n")
        left = sorted(p.name for p in out.iterdir()) if out.exists() else []
        result = json.loads((out / "result.json").read_text()) if "result.json" in left else None
        right = (
            (process.returncode, told) in ((130, 1), (0, 0))
            and seconds < WITHIN
            and "Traceback" not in said
            and (not left or result is not None)
        )
        return {"right": right, "after": after, "seconds": seconds, "code": process.returncode,
                "left": left, "said": said[-600:] if not right else ""}  # fmt: skip


def write_robot(folder: Path) -> None:
    """A robot with a log of it, long enough that the search takes seconds."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "cases"))
    from joint_cases import SLIDER
    from robot_cases import TOML, simulated

    from identification.logs.write import write_log

    (folder / "slider.xml").write_text(SLIDER)
    (folder / "robot.toml").write_text(TOML)
    write_log(simulated({"damping": 3.6, "mass": 1.8}, 2000), folder / "log.csv")


if __name__ == "__main__":
    sys.exit(main())
