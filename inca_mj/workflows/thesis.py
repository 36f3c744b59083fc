"""The four identification trials of the thesis, on data of its own model (Tables 3.3 to 3.6).

The data are five seconds of PRBS at 100 Hz, simulated with Table 3.2. Trial 1 estimates everything,
from starting values that are 25 % off. Trial 2 estimates only the parameters that no data sheet
gives, from the same starting values. Trial 3 does the same from values that are 5 % off. Trial 4
adds a random error of up to ±5 % of each sample to the outputs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from identification import Log
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import Twin

DURATION = 5.0  # of the data [s]
NOISE = 0.05  # largest error of a sample, relative to it

LARGE = {"lambda": 31250.0, "b": 16.0, "J": 1e-4, "b_v": 1.7e-4, "b_c": 0.004, "beta": 1.0}
SMALL = {"lambda": 26250.0, "b": 7.2, "J": 8.4e-5, "b_v": 1.9e-4, "b_c": 0.00475, "beta": 0.84}
ALL = {
    "R": 0.0175, "R_s": 0.006, "k_s": 16.0, **LARGE, "K_t": 0.08, "m": 0.1725,
    "x": 0.025, "y": 0.025, "z": 1.5,
}  # fmt: skip


@dataclass(frozen=True)
class Trial:
    """A trial: its starting values, its noise, and what the thesis found.

    Attributes:
        number: 1 to 4.
        start: starting values of the free parameters.
        noisy: whether the outputs carry noise.
        thesis: the thesis' estimates.
        thesis_fit: the thesis' mean output fit [%].
    """

    number: int
    start: Mapping[str, float]
    noisy: bool
    thesis: Mapping[str, float]
    thesis_fit: float


TRIALS = (
    Trial(1, ALL, False, {
        "R": 0.0199, "R_s": 0.0070, "k_s": 17.189, "lambda": 36171.1, "b": 2.2650, "J": 1.1e-4,
        "b_v": 2.7e-4, "b_c": 0.00697, "beta": 0.8075, "K_t": 0.1099, "m": 0.1725, "x": 0.003,
        "y": 0.0, "z": 1.421,
    }, 97.74),
    Trial(2, LARGE, False, {
        "lambda": 29177.9, "b": 13.35, "J": 7.79e-5, "b_v": 1.97e-4, "b_c": 0.00505,
        "beta": 0.7396,
    }, 97.82),
    Trial(3, SMALL, False, {
        "lambda": 25598.3, "b": 17.036, "J": 7.78e-5, "b_v": 1.97e-4, "b_c": 0.00506,
        "beta": 0.7374,
    }, 97.83),
    Trial(4, SMALL, True, {
        "lambda": 25392.6, "b": 19.0473, "J": 7.78e-5, "b_v": 1.97e-4, "b_c": 0.00506,
        "beta": 0.741,
    }, 97.85),
)  # fmt: skip


def trial_data(robot: Twin, seed: int = 0) -> Log:
    """Returns the data of the trials, without noise: 5 s of the thesis' PRBS."""
    return run_to_log(simulate(robot, make_input("prbs", DURATION, seed=seed)), "trial data")


def with_noise(log: Log, seed: int) -> Log:
    """Returns a log with outputs times 1 + e, e uniform in ±5 % (thesis, footnote of 3.2.3)."""
    error = np.random.default_rng(seed).uniform(-NOISE, NOISE, log.outputs.shape)
    return replace(log, outputs=log.outputs * (1 + error))
