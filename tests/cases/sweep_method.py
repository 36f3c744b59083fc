"""A method that costs nothing: what sweeps are tested with. Workers load this file by its path."""

import os
import signal
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from identification.errors import InputError
from identification.sweep.method import Column, Findings, Method


@dataclass(frozen=True, kw_only=True)
class Toss:
    """What is tossed, and what goes wrong."""

    size: float = 1.0
    word: str = "a"
    mass: float | None = None
    seconds: float = 0.0
    bad: bool = False
    marker: Path | None = None  # the first worker that finds no such file makes it, and dies

    def __post_init__(self):
        if self.size < 0:
            raise InputError(f"size {self.size:g} is negative; give 0 or more")


def toss(settings, seed):
    """Numbers of every kind from the seed; a product of matrices, whose last bits need care."""
    time.sleep(settings.seconds)
    if settings.marker is not None:
        try:
            settings.marker.open("x").close()
        except FileExistsError:
            pass
        else:
            os.kill(os.getpid(), signal.SIGKILL)
    if settings.bad:
        raise ValueError("this task\nis bad")
    rng = seed.generator()
    a, b = rng.normal(size=(2, 120, 120))
    return {
        "found": bool(rng.random() < settings.size / (1 + settings.size)),
        "count": rng.integers(10),
        "total": float(np.sum(a @ b)),
        "unknown": float("nan"),
        "names": ["x", settings.word] * (seed.key[-1] % 2),
        "values": rng.normal(size=3),
        "threads": os.environ["OMP_NUM_THREADS"],
    }


COLUMNS = {
    "found": Column(bool, "heads"),
    "count": Column(int, "a digit"),
    "total": Column(float, "sum of a product of matrices"),
    "unknown": Column(float, "no number"),
    "names": Column(list[str], "words"),
    "values": Column(list[float], "numbers"),
    "threads": Column(str, "what a library would read"),
}


def findings(records):
    """A sentence of its own."""
    return Findings({"heads": sum(r["found"] for r in records)}, [], ["tossed."])


TOSS = Method(
    about="tosses a coin",
    settings=Toss,
    columns=COLUMNS,
    run=toss,
    success="found",
    against="size",
    summary=findings,
)
