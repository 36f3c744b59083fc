"""Ctrl-C at 20 random times of every command: exit code, seconds until the end, what was left.

    python benchmarks/interrupts.py [--times 20] [--command discover] [--latest 20] [--within 4]

A command that ends by itself before the interrupt is not counted, and another one is begun for it.
The time until the first line of the program runs is measured and left out, because the answer is
then Python's own. A command that had ended but for its process ends with 0. Right is that, or exit
code 130 within four seconds with "stopping" or "stopped" said once, and no draft left in the folder
of the results or beside it; what is there is whole, and the next run accepts it. A row for each
interrupt is added to results/interrupts.jsonl, of which benchmarks/robustness.py makes its page.
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

from identification.storage.made import list_content
from identification.sweep.work import commit

LATEST = 20.0  # [s] after the start; until then most commands read, fit, search, and draw
WITHIN = 4.0  # [s], on a machine that does other work too
TRIES = 5  # for each interrupt that is asked for
RECORD = Path(__file__).parent / "results" / "interrupts.jsonl"
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
    "fit, horizon": [*ROBOT, "fit", "{robot}/horizon.toml", "{robot}/log.csv"],
    "discover, horizon": [*ROBOT, "discover", "{robot}/horizon.toml", "{robot}/log.csv"],
}


def main() -> int:
    """Interrupt, print a line for each command, keep the rows; 1 where something was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--command", nargs="*", choices=[*COMMANDS], default=[*COMMANDS])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--latest", type=float, default=LATEST, help="of an interrupt [s]")
    parser.add_argument("--within", type=float, default=WITHIN, help="seconds until the end")
    parser.add_argument("--record", type=Path, default=RECORD)
    options = parser.parse_args()
    chance, wrong, earliest = random.Random(options.seed), 0, python_start()
    now = commit()
    with tempfile.TemporaryDirectory() as folder:
        write_robot(Path(folder))
        for name in options.command:
            line = [word.format(robot=folder) for word in COMMANDS[name]]
            stopped: list[dict[str, Any]] = []
            tries = 0
            while len(stopped) < options.times and tries < TRIES * options.times:
                tries += 1
                row = interrupted(line, chance.uniform(earliest, options.latest), options.within)
                if row is not None:
                    stopped.append({"command": name, "seed": options.seed, **row, "commit": now})
            with options.record.open("a") as record:
                record.writelines(json.dumps(row) + "\n" for row in stopped)
            right = sum(row["right"] for row in stopped)
            slowest = max((row["seconds"] for row in stopped), default=0.0)
            print(f"{name:<18}right {right} of {len(stopped)}, slowest {slowest:.2f} s,"
                  f" {tries - len(stopped)} ended before", flush=True)  # fmt: skip
            wrong += len(stopped) - right
    return int(wrong > 0)


def python_start() -> float:
    """Time that Python needs on this machine before it runs the first line of a program [s]."""
    seconds = []
    for _ in range(5):
        began = time.perf_counter()
        subprocess.run([sys.executable, "-c", "import runpy, inca_mj"], check=True)
        seconds.append(time.perf_counter() - began)
    return max(seconds)


def interrupted(line: list[str], after: float, within: float) -> dict[str, Any] | None:
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
        drafts = [p.name for p in Path(folder).iterdir() if p.name != "out"]
        result = json.loads((out / "result.json").read_text()) if "result.json" in left else None
        right = (
            (process.returncode, told) in ((130, 1), (0, 0))
            and seconds < within
            and "Traceback" not in said
            and (not left or result is not None)
            and not drafts
            and not list_content(out).foreign
        )
        return {"right": right, "after": round(after, 3), "seconds": round(seconds, 3),
                "code": process.returncode, "left": left + drafts,
                "said": said[-600:] if not right else ""}  # fmt: skip


def write_robot(folder: Path) -> None:
    """A robot with a log of it, long enough that the search takes seconds."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "cases"))
    from joint_cases import SLIDER
    from robot_cases import TOML, simulated

    from identification.logs.formats.csv_files import write_log

    (folder / "slider.xml").write_text(SLIDER)
    (folder / "robot.toml").write_text(TOML)
    (folder / "horizon.toml").write_text(f"horizon = 0.2\n{TOML}")
    write_log(simulated({"damping": 3.6, "mass": 1.8}, 2000), folder / "log.csv")


if __name__ == "__main__":
    sys.exit(main())
