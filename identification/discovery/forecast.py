"""A forecast of the memory and time of a search, told before it takes them.

    bytes   = BASE + MODELS b + (1 + KEPT) D
    D       = 8 max(N LINEAR n_x²,  n (n_y (p + m) + LINEAR n_x² + c F + c_u n_u (s + P)))
    F       = max(2 I n_f, 2 I n_v + OUTPUTS n_y)
    seconds = BEGUN + t₁ (FIT + FITS p + SCORES m)        t₁ the processor time of one simulation

of N samples, n of them fitted, with n_y outputs, n_u inputs, p parameters, m sizes of effects,
c = min(m, 128) columns that are computed at once, at most c_u of them for effects of inputs, n_v
velocities, n_f velocities and activations, n_x states, s steps of the simulation in a sample, P
points and I intervals of the trajectory in one, and a model of b bytes. A sensitivity of each
output to each size is kept. The model is linearised at n samples in a fit, and at N where it is
validated. The forcings of c columns lie in memory twice while they are put together; after that
only those that outputs feel, beside what the columns do to the outputs. Inputs are kept at each
step and at each point.

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

from identification.discovery.scoring.sensitivities import BATCH, list_common, list_single
from identification.discovery.task import DiscoveryTask
from identification.errors import InputError
from identification.files import read_text
from identification.kalman.trajectory import FINE, INTERVALS
from identification.logs.joined import rows_of
from identification.model.predictor import Predictor
from identification.model.rollout import substeps

BASE = 28e6  # [bytes] of compiled code and libraries that only a search loads
MODELS = 96  # copies of the model, for changes of it that are evaluated together
LINEAR = 4  # matrices of n_x² for a sample: transitions and effects of rates over the intervals
OUTPUTS = 6  # copies of the outputs of c columns: of sensors, of q and v, and what they sum up to
# The C library keeps freed arrays below 32 MiB for the process (M_MMAP_THRESHOLD of glibc): the
# share is as measured of what was in use, and no more than three arrays of that size.
KEPT = 0.7
MOST_KEPT = 3 * 32 * 2.0**20  # [bytes]
BEGUN = 1.5  # [s] that a search takes, however short the log
# Simulations that fits cost: each linearises the model, whitens its residuals, and evaluates each
# parameter. A search that finds nothing makes one fit, and one of each candidate that it rejects.
FIT, FITS = 43.0, 1.7
SCORES = 0.07  # simulations that a size of a candidate costs; it shares the linearisation
_SHORT = 400  # samples of the simulation that is timed
_TRIES = 6  # simulations, of which the fastest counts: programs beside it make others slower
_TOLD = 60.0, 2.0**30  # [s] and [bytes] from which a forecast is worth a line


@dataclass(frozen=True)
class Forecast:
    """The memory and time that a search will take.

    Attributes:
        samples: of the log.
        memory: [bytes], beside those of the program.
        seconds: of processor time, of a search that finds nothing [s].
        fixed: part of the memory that does not depend on the samples [bytes].
    """

    samples: int
    memory: float
    seconds: float
    fixed: float = 0.0

    def __str__(self) -> str:
        return (
            f"{self.samples} samples need about {self.memory / 2**30:.2g} GB of memory and"
            f" {_duration(self.seconds)} of processor time, and more with every effect that is"
            " found"
        )

    @property
    def is_large(self) -> bool:
        """Whether it is worth a line."""
        seconds, memory = _TOLD
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
    seconds = BEGUN + (FIT + FITS * parameters + SCORES * sizes) * _simulated(task)
    kept = min(KEPT * 8 * numbers, MOST_KEPT)
    fixed = BASE + MODELS * float(model.nbuffer)
    memory = fixed + 8 * numbers + kept
    # A log that is a little shorter keeps no less, where it keeps as much as it can.
    fixed += kept if kept == MOST_KEPT else 0.0
    return Forecast(len(log), memory, seconds, fixed)


def _numbers(task: DiscoveryTask, sizes: int, on_inputs: int) -> float:
    """Returns how many numbers are in memory at once, for effects of so many sizes."""
    log, model = task.log, task.nominal_model.plant.model
    fitted, outputs = int(rows_of(log, "estimation").sum()), log.outputs.shape[1]
    steps = substeps(log.sampling_time, model.opt.timestep)
    intervals, points = min(INTERVALS, steps), min(FINE, steps)
    forced = 2 * intervals * (model.nv + model.na)
    felt = 2 * intervals * model.nv + OUTPUTS * outputs
    inputs = log.inputs.shape[1] * (steps + points)
    linear = LINEAR * (2 * model.nv + model.na) ** 2
    kept = outputs * (len(task.nominal_model.names) + sizes)
    columns = min(sizes, BATCH) * max(forced, felt) + min(on_inputs, BATCH) * inputs
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
    samples = min(_SHORT, len(task.log))
    seconds = []
    for _ in range(_TRIES):
        began = time.process_time()  # other programs may have the processor meanwhile
        predictor.predict(values, samples)
        seconds.append(time.process_time() - began)
    return min(seconds) * len(task.log) / samples


def _duration(seconds: float) -> str:
    for unit, length in (("h", 3600.0), ("min", 60.0)):
        if seconds >= length:
            return f"{seconds / length:.2g} {unit}"
    return f"{seconds:.2g} s"
