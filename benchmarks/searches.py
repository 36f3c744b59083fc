"""Searches by several commits side by side in one run: seconds, memory, and what each one names.

    python benchmarks/searches.py CASES.toml COMMIT... [--processors 2] [--at-once 1] [--limit 900]

A case is a line `name = "arguments of inca or identification"` of the table `[inca]` or
`[identification]`; paths in it are relative to the TOML file. Each commit answers from an archive
of its own, and the first case of each program once before all others, so that its laws are
compiled; that answer does not count. The rows are added to `benchmarks/results/searches.jsonl`,
from which `speed_page.py` makes a part of `docs/speed.md`.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import shlex
import subprocess
import sys
import tempfile
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from golden import checkout

ROOT = Path(__file__).resolve().parents[1]
ROWS = ROOT / "benchmarks" / "results" / "searches.jsonl"
PROGRAMS = {"inca": "inca_mj", "identification": "identification"}


def main() -> int:
    """Answer all cases with all commits, and add the rows."""
    given = parsed()
    tables = tomllib.loads(given.cases.read_text(encoding="utf-8"))
    cases = [(of, name, line) for of in PROGRAMS for name, line in tables.get(of, {}).items()]
    places: SimpleQueue[set[int]] = SimpleQueue()
    usable = sorted(os.sched_getaffinity(0))
    for k in range(given.at_once):
        places.put({*usable[k * given.processors : (k + 1) * given.processors]})
    with tempfile.TemporaryDirectory() as folder:
        names = [
            subprocess.run(
                ["git", "rev-parse", "--short", commit],
                cwd=ROOT, capture_output=True, check=True, text=True,
            ).stdout.strip()
            for commit in given.commits
        ]  # fmt: skip
        trees = {commit: checkout(commit, Path(folder, commit)) for commit in names}

        def work(of: str, name: str, line: str, commit: str) -> dict[str, Any]:
            place = places.get()
            try:
                run = (trees[commit], PROGRAMS[of], line, given.cases.parent, place, given.limit)
                row = answer(*run)
            finally:
                places.put(place)
            return {
                "commit": commit, "machine": platform.machine(),
                "processors": given.processors, "case": name, **row,
            }  # fmt: skip

        for of in tables.keys() & PROGRAMS.keys():
            line = next(iter(tables[of].values()))
            for tree in trees.values():
                answer(tree, PROGRAMS[of], line, given.cases.parent, {*usable}, given.limit)
        with ThreadPoolExecutor(given.at_once) as pool:
            jobs = [pool.submit(work, *case, commit) for case in cases for commit in trees]
            for job in jobs:
                with ROWS.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(job.result()) + "\n")
                print(json.dumps(job.result()), flush=True)
    return 0


def answer(
    tree: Path, program: str, line: str, near: Path, place: set[int], limit: float
) -> dict[str, Any]:
    """Returns seconds, memory, verdict and names of one search; no verdict where time ran out."""
    command = [sys.executable, "-m", program, *shlex.split(line), "--json", "--quiet"]
    environment = {**os.environ, "PYTHONPATH": str(tree), "XDG_CACHE_HOME": f"{tree}-cache"}
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(
            command, cwd=near, env=environment, stdout=said, stderr=subprocess.DEVNULL
        )
        os.sched_setaffinity(process.pid, place)
        begun = time.monotonic()
        while True:
            ended, status, used = os.wait4(process.pid, os.WNOHANG)
            seconds = time.monotonic() - begun
            if ended:
                break
            if seconds > limit:
                process.kill()
                process.wait()
                return {"seconds": None, "limit": limit}
            time.sleep(0.05)
        if status:
            raise RuntimeError(f"{shlex.join(command)} ended with status {status}")
        said.seek(0)
        found = json.load(said)
    return {
        "seconds": round(seconds, 1),
        "processor_seconds": round(used.ru_utime + used.ru_stime, 1),
        "megabytes": round(used.ru_maxrss / 1024),
        **what(found),
    }


def what(found: dict[str, Any]) -> dict[str, Any]:
    """Returns the verdict, and names, places and sizes of what a search found."""
    named = [
        {"name": e["name"], "where": e["where"],
         "values": {n: [p["value"], p["std"]] for n, p in e["parameters"].items()}}
        for e in found["effects"]
    ]  # fmt: skip
    return {"verdict": found["verdict"], "named": named}


def parsed() -> argparse.Namespace:
    """Returns the arguments."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", type=Path)
    parser.add_argument("commits", nargs="+")
    parser.add_argument("--processors", type=int, default=2)
    parser.add_argument("--at-once", type=int, default=1)
    parser.add_argument("--limit", type=float, default=900.0)
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
