"""How much memory and time a search will take, told before it takes them.

    bytes   = BASE + MODELS b + 8 n (n_y (p + m) + COLUMNS c (2 n_f + 3 n_y)) + 8 N STATES n_z²
    seconds = BEGUN + t₁ (FITS p + SCORES m)     t₁ the processor time of one simulation of the log

of N samples, n of them fitted, with n_y outputs, p parameters, m sizes of effects, c = min(m, 128)
columns that are computed at once, n_f velocities and activations, n_z states of the plant and of
its inputs' errors, and a model of b bytes.

The constants are fitted to processor time and peak memory of searches of the INCA and of chains of
bodies, with up to 200 000 samples (benchmarks/forecast.py). The time is that of a search that finds
nothing; each effect that is found is refitted, beside others, and adds to it.
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
from identification.logs.joined import rows_of
from identification.model.predictor import Predictor

BASE = 28e6  # [bytes] of compiled code and libraries that only a search loads
MODELS = 96  # copies of the model, for changes of it that are evaluated together
COLUMNS = 1.77  # copies of the forcings and responses of the columns that are computed at once
STATES = 1.75  # squares of n_z for each sample: transitions, and filters of several noises
BEGUN = 2.0  # [s] that a search takes, however short the log
FITS = 1.0  # simulations that a parameter costs
SCORES = 0.15  # simulations that a size of a candidate costs; many are simulated at once
_SHORT = 400  # samples of the simulation that is timed
_TOLD = 60.0, 2.0**30  # [s] and [bytes] from which a forecast is worth a line


@dataclass(frozen=True)
class Forecast:
    """What a search will take.

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
    """What a search will take, from one short simulation.

    Args:
        task: what is asked.

    Raises:
        DivergenceError: the nominal model cannot be simulated.
    """
    log, model = task.log, task.nominal_model.plant.model
    common = list_common(task.effects)
    first = {c.effect.name: c for c in common}
    sizes = sum(len(c.sizes) for c in (*common, *list_single([*first.values()])))
    parameters = len(task.nominal_model.names)
    fitted, outputs = int(rows_of(log, "estimation").sum()), log.outputs.shape[1]
    forced, states = model.nv + model.na, 2 * model.nv + model.na + log.inputs.shape[1]
    columns = COLUMNS * min(sizes, BATCH) * (2 * forced + 3 * outputs)
    a_fitted_one = outputs * (parameters + sizes) + columns
    numbers = fitted * a_fitted_one + len(log) * STATES * states**2
    fixed = BASE + MODELS * float(model.nbuffer)
    seconds = BEGUN + (FITS * parameters + SCORES * sizes) * _simulated(task)
    return Forecast(len(log), fixed + 8 * numbers, seconds, fixed)


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
        cut = f"cut the log to {most} samples, or export it at a lower rate, or"
        cure = cut if most >= least else "close other programs, or"
        raise InputError(
            f"{found.samples} samples need about {found.memory / 2**30:.2g} GB of memory, and"
            f" {free / 2**30:.2g} GB are free; {cure} allow more by the option max_memory_share"
        )


def free_memory() -> float:
    """Memory that programs may still take [bytes]; infinite where the system does not say."""
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
    """Processor time of one simulation of the log [s], from that of its first samples."""
    names = task.nominal_model.names
    own = task.nominal_model.plant.parameters
    values = np.array([[own[name].value for name in names]])
    predictor = Predictor(task.nominal_model.plant, task.log, names)
    samples = min(_SHORT, len(task.log))
    seconds = []
    for _ in range(3):
        began = time.process_time()  # other programs may have the processor meanwhile
        predictor.predict(values, samples)
        seconds.append(time.process_time() - began)
    return min(seconds) * len(task.log) / samples


def _duration(seconds: float) -> str:
    for unit, length in (("h", 3600.0), ("min", 60.0)):
        if seconds >= length:
            return f"{seconds / length:.2g} {unit}"
    return f"{seconds:.2g} s"
