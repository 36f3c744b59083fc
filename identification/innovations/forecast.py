"""A forecast of the memory and time of a search, told before it takes them.

    bytes   = BASE_BYTES + MODEL_COPIES b + (1 + KEPT_SHARE) D
    D       = 8 max(N L,  n (n_y (p + m) + L + c F + c_u n_u (s + P))),     L = LINEAR_MATRICES n_x²
    F       = max(2 I n_f, 2 I n_v + OUTPUT_COPIES n_y)
    seconds = BASE_SECONDS + t₁ (SEARCH_RUNS + PARAMETER_RUNS p + SIZE_RUNS m)

of N samples, n of them fitted, with n_y outputs, n_u inputs, p parameters, m sizes of effects, c
columns that all threads compute at once, at most c_u of them for effects of inputs, n_v
velocities, n_f velocities and activations, n_x states, s steps of the simulation in a sample, P
points and I intervals of the trajectory in one, a model of b bytes, and one simulation that takes
the processor time t₁. A sensitivity of each output to each size is kept. The model is linearised at
n samples in a fit, and at N where it is validated. The forcings of c columns lie in memory twice
while they are put together; after that only those that outputs feel, beside what the columns do to
the outputs. Inputs are kept at each step and at each point.

The constants follow the arrays that a search allocates, and were compared with the peak memory and
the processor time of searches of the INCA and of chains of bodies (benchmarks/forecast.py). The
time is that of a search that finds nothing; each effect that is found is refitted, beside others.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from identification.discovery.candidates import list_common, list_single
from identification.errors import InputError
from identification.innovations.scoring.sensitivities import MAX_BATCH_COLUMNS
from identification.innovations.task import DiscoveryTask
from identification.kalman.trajectory import FINE_POINTS, INTERVALS
from identification.logs.joined import rows_of
from identification.model.predictor import Predictor
from identification.model.rollout import substeps
from identification.runtime.pool import threads
from identification.storage.files import read_text

BASE_BYTES = 28e6  # of compiled code and libraries that only a search loads
MODEL_COPIES = 96  # for changes of the model that are evaluated together
LINEAR_MATRICES = 4  # of n_x² for a sample: transitions and effects of rates over the intervals
OUTPUT_COPIES = 6  # of the outputs of c columns: of sensors, of q and v, and what they sum up to
# The C library keeps freed arrays below 32 MiB for the process (M_MMAP_THRESHOLD of glibc): the
# share is as measured of what was in use, and no more than three arrays of that size.
KEPT_SHARE = 0.7
MAX_KEPT_BYTES = 3 * 32 * 2.0**20  # three arrays of 32 MiB
BASE_SECONDS = 1.5  # of a search, however short the log
# Simulations that fits cost: each linearises the model, whitens its residuals, and evaluates each
# parameter. A search that finds nothing makes one fit, and one of each candidate that it rejects.
SEARCH_RUNS, PARAMETER_RUNS = 43.0, 1.7
SIZE_RUNS = 0.07  # simulations that a size of a candidate costs; it shares the linearisation
_TIMED_SAMPLES = 400  # of the simulation that is timed
_TIMED_RUNS = 6  # of which the fastest counts: programs beside it make others slower
_MIN_TOLD = 60.0, 2.0**30  # [s] and [bytes] from which a forecast is worth a line


@dataclass(frozen=True)
class Forecast:
    """The memory and time that a search will take."""

    samples: int  # of the log
    memory: float  # [bytes], beside those of the program
    seconds: float  # of processor time, of a search that finds nothing [s]
    fixed: float = 0.0  # part of the memory that does not depend on the samples [bytes]

    def __str__(self) -> str:
        return (
            f"{self.samples} samples need about {self.memory / 2**30:.2g} GB of memory and"
            f" {_duration(self.seconds)} of processor time, and more with every effect that is"
            " found"
        )

    @property
    def is_large(self) -> bool:
        """Tells whether it is worth a line."""
        seconds, memory = _MIN_TOLD
        return self.seconds > seconds or self.memory > memory


def forecast(task: DiscoveryTask) -> Forecast:
    """Computes what a search will take, from one short simulation.

    Args:
        task: what is asked.

    Raises:
        DivergenceError: the nominal model cannot be simulated.
    """
    log, model = task.log, task.nominal_model.plant.model
    common = list_common(task.effects)
    first = {c.effect.name: c for c in common}
    every = (*common, *list_single([*first.values()]))
    sizes = sum(len(c.sizes) for c in every)
    on_inputs = sum(len(c.sizes) for c in every if "input" in c.effect.hooks)
    parameters = len(task.nominal_model.names)
    numbers = _numbers(task, sizes, on_inputs)
    runs = SEARCH_RUNS + PARAMETER_RUNS * parameters + SIZE_RUNS * sizes
    seconds = BASE_SECONDS + runs * _simulated(task)
    kept = min(KEPT_SHARE * 8 * numbers, MAX_KEPT_BYTES)
    fixed = BASE_BYTES + MODEL_COPIES * float(model.nbuffer)
    memory = fixed + 8 * numbers + kept
    # A log that is a little shorter keeps no less, where it keeps as much as it can.
    fixed += kept if kept == MAX_KEPT_BYTES else 0.0
    return Forecast(len(log), memory, seconds, fixed)


def _numbers(task: DiscoveryTask, sizes: int, on_inputs: int) -> float:
    """Returns how many numbers are in memory at once, for effects of so many sizes."""
    log, model = task.log, task.nominal_model.plant.model
    fitted, outputs = int(rows_of(log, "estimation").sum()), log.outputs.shape[1]
    steps = substeps(log.sampling_time, model.opt.timestep)
    intervals, points = min(INTERVALS, steps), min(FINE_POINTS, steps)
    forced = 2 * intervals * (model.nv + model.na)
    felt = 2 * intervals * model.nv + OUTPUT_COPIES * outputs
    inputs = log.inputs.shape[1] * (steps + points)
    linear = LINEAR_MATRICES * (2 * model.nv + model.na) ** 2
    kept = outputs * (len(task.nominal_model.names) + sizes)
    together = threads() * MAX_BATCH_COLUMNS
    batch, of_inputs = min(sizes, together), min(on_inputs, together)
    columns = batch * max(forced, felt) + of_inputs * inputs
    return float(max(len(log) * linear, fitted * (kept + linear + columns)))


def refuse_large(found: Forecast, share: float, least: int) -> None:
    """Refuse a search for which this machine has no memory.

    Args:
        found: what it will take.
        share: of the free memory that it may take.
        least: samples that a search needs, to fit and to confirm.

    Raises:
        InputError: it will take more.
    """
    free = free_memory()
    if found.memory > share * free:
        room, needed = share * free - found.fixed, found.memory - found.fixed
        most = int(found.samples * room / needed) if needed > 0 else 0
        thin = -(-found.samples // max(most, 1))
        cut = (
            f"cut the log to {most} samples, or keep one sample of {thin} (every = {thin} in a"
            " robot's TOML, or an export at that rate), or"
        )
        cure = cut if most >= least else "close other programs, or"
        raise InputError(
            f"{found.samples} samples need about {found.memory / 2**30:.2g} GB of memory and"
            f" {_duration(found.seconds)} of processor time, and {free / 2**30:.2g} GB are free;"
            f" {cure} allow more by the option max_memory_share"
        )


def free_memory() -> float:
    """Returns the memory that programs may still take [bytes]; infinite where it is not known."""
    try:
        lines = read_text(Path("/proc/meminfo")).splitlines()
        table = dict(line.split(":", 1) for line in lines)
        return 1024.0 * float(table["MemAvailable"].split()[0])
    except (OSError, KeyError, ValueError):
        try:
            return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
        except (AttributeError, ValueError, OSError):
            return np.inf


def _simulated(task: DiscoveryTask) -> float:
    """Returns the processor time to simulate the log once [s], from that of its first samples."""
    names = task.nominal_model.names
    own = task.nominal_model.plant.parameters
    values = np.array([[own[name].value for name in names]])
    predictor = Predictor(task.nominal_model.plant, task.log, names)
    samples = min(_TIMED_SAMPLES, len(task.log))
    seconds = []
    for _ in range(_TIMED_RUNS):
        began = time.process_time()  # other programs may have the processor meanwhile
        predictor.predict(values, samples)
        seconds.append(time.process_time() - began)
    return min(seconds) * len(task.log) / samples


def _duration(seconds: float) -> str:
    for unit, length in (("h", 3600.0), ("min", 60.0)):
        if seconds >= length:
            return f"{seconds / length:.2g} {unit}"
    return f"{seconds:.2g} s"
