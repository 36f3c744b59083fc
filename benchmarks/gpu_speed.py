"""What a GPU does to the steps of the twin: times beside a processor's, and accuracy.

    python benchmarks/gpu_speed.py [--out benchmarks/results/gpu.jsonl] [--seconds 400] [--parts …]
    python benchmarks/gpu_speed.py --only-page            the page anew, from its rows

Each measurement is a row that is printed and, with `--out`, appended when it is there:

- `processor`: MuJoCo's batch on 1, 2 and all threads, with the law of the drives and without it;
- `kernel`: the robot with its law as one CUDA kernel in float64, see `gpu/kernel.py`;
- `mjx`, `mjx_bare`: MJX in float64 and float32, see `gpu/mjx.py`;
- `warp`, `warp_bare`: MuJoCo Warp in float32, see `gpu/warp.py`.

A row of 32 worlds has the accuracy too: worlds of a fit, nominal and with each parameter moved,
simulated for two seconds of PRBS, beside the twin on the processor. The project does not depend on
what this needs beside an NVIDIA GPU; each part that is not there is left out with a sentence:

    pip install "jax[cuda13]" mujoco-mjx==3.17.0 mujoco-warp==3.17.0 "numba-cuda[cu13]" "numpy<2.5"
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from datetime import UTC, datetime
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np
from gpu.page import ROWS, write_page
from gpu.processor import Processor, accuracy, seconds
from gpu.worlds import Worlds, drawn, moved

NEEDS = {"processor": "mujoco", "kernel": "numba-cuda", "mjx": "mujoco-mjx", "warp": "mujoco-warp"}
PACKAGES = ("mujoco", "jax", "mujoco-mjx", "mujoco-warp", "warp-lang", "numba", "numba-cuda")
WIDTHS = (1, 32, 256, 2048, 16384)
WATCHED = 32  # worlds whose accuracy is measured
SECONDS = 2.0  # of PRBS, of the accuracy

Row = dict[str, Any]


def device() -> str | None:
    """The name of the first NVIDIA GPU, None where there is none."""
    command = ["nvidia-smi", "--query-gpu=name", "--format=csv,noheader"]
    try:
        said = subprocess.run(command, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return said.stdout.splitlines()[0].strip() if said.stdout.strip() else None


def versions() -> dict[str, str]:
    """Versions of the packages that are there."""
    found = {}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def host() -> str:
    """The processor's name."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    return next((x.split(":")[1].strip() for x in lines if x.startswith("model name")), "")


def worlds_of(width: int, steps: int) -> Worlds:
    """So many worlds; those whose accuracy is measured run for their own number of steps."""
    if width == WATCHED:
        watched = moved(SECONDS)
        return watched.widened(width, len(watched.currents))
    return drawn().widened(width, steps)


def processor(widths: Sequence[int]) -> Iterator[Row]:
    """Rows of MuJoCo's batch."""
    for threads in sorted({1, 2, os.cpu_count() or 1}):
        for law in (True, False):
            for width in widths:
                worlds = worlds_of(width, int(np.clip(20000 // width, 5, 1000)))
                took = seconds(Processor(worlds, threads, law).run)
                yield {"threads": threads, "bits": 64, **timed(worlds, took, law)}


def kernel(widths: Sequence[int]) -> Iterator[Row]:
    """Rows of the robot as one kernel."""
    from gpu.kernel import Simulator

    yield from simulated(widths, 1000, True, 64, Simulator)


def mjx(widths: Sequence[int], law: bool = True) -> Iterator[Row]:
    """Rows of MJX."""
    from gpu.mjx import Simulator

    for bits in (64, 32):

        def make(worlds: Any, bits: int = bits) -> Any:
            return Simulator(worlds, bits, law)

        yield from simulated(widths, 100, law, bits, make)


def warp(widths: Sequence[int], law: bool = True) -> Iterator[Row]:
    """Rows of MuJoCo Warp."""
    from gpu.warp import Simulator

    yield from simulated(widths, 200, law, 32, lambda worlds: Simulator(worlds, law))


def simulated(
    widths: Sequence[int], steps: int, law: bool, bits: int, make: Callable[..., Any]
) -> Iterator[Row]:
    """Rows of a simulator at some widths, one kept at a time."""
    for width in widths:
        worlds, begin = worlds_of(width, steps), time.perf_counter()
        simulator = make(worlds)
        compiled = time.perf_counter() - begin
        row = {"bits": bits, "compile_seconds": round(compiled, 2)}
        row |= timed(worlds, seconds(simulator.run), law)
        if law and width == WATCHED:
            row |= accuracy(worlds, simulator())
        yield row


def timed(worlds: Worlds, took: float, law: bool) -> Row:
    """The times of a row."""
    steps = len(worlds.currents)
    return {
        "law": law,
        "worlds": len(worlds),
        "steps": steps,
        "microseconds_per_step_of_all": 1e6 * took / steps,
        "steps_per_second": len(worlds) * steps / took,
    }


PARTS: dict[str, Callable[[Sequence[int]], Iterator[Row]]] = {
    "processor": processor,
    "kernel": kernel,
    "mjx": mjx,
    "warp": warp,
    "mjx_bare": partial(mjx, law=False),
    "warp_bare": partial(warp, law=False),
}


def main() -> int:
    """Measure and print; 2 where there is no GPU."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, help="append the rows to this file")
    parser.add_argument("--seconds", type=float, default=400, help="nothing begins after these")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=tuple(PARTS))
    parser.add_argument("--widths", nargs="+", type=int, default=WIDTHS)
    parser.add_argument("--anyway", action="store_true", help="without a GPU, to try the program")
    parser.add_argument("--only-page", action="store_true", help="docs/gpu.md from the rows")
    options = parser.parse_args()
    if options.only_page:
        write_page()
        return 0
    name = device()
    if name is None and not options.anyway:
        print("No NVIDIA GPU was found (nvidia-smi names none), so nothing was measured.")
        return 2
    about = {
        "date": datetime.now(UTC).date().isoformat(), "device": name, "host": host(),
        "cores": os.cpu_count(), "versions": versions(),
    }  # fmt: skip
    begin = time.perf_counter()
    for part in options.parts:
        if time.perf_counter() - begin > options.seconds:
            break
        try:
            for row in PARTS[part](options.widths):
                said = json.dumps({"simulator": part.split("_")[0], **row, **about})
                print(said, flush=True)
                if options.out:
                    with options.out.open("a", encoding="utf-8") as file:
                        file.write(said + "\n")
                if time.perf_counter() - begin > options.seconds:
                    break
        except ImportError as error:
            need = NEEDS[part.split("_")[0]]
            print(f"{part}: {need} cannot be imported ({error}), so it was left out.")
    if options.out and options.out.resolve() == ROWS:
        write_page()
    return 0


if __name__ == "__main__":
    sys.exit(main())
