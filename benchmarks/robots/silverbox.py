"""The Silverbox: an electronic circuit that behaves like a mass on a hardening spring.

    m ÿ + d ẏ + y + k₃ y³ = g u + f_0        u [V] -> y [V], 610.35 Hz; k = 1 by definition

The model lacks k₃. Of the ten realisations of a random-phase multisine two are fitted. The last
one, which is the official test, and the Gaussian "arrow", whose size grows beyond, confirm.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from identification import Log
from robots import needed
from robots.measured_robot import MODELS, Free, MeasuredRobot, Outcome, PublishedSize
from robots.unseen import free_run

SAMPLING_TIME = 2**14 / 1e7  # [s]
PERIOD = 8192  # samples of a realisation
# The input rests for about 100 samples between realisations. They end, counted in samples of the
# file, every 8692 samples from 49173 on; the 500 others are the rest and a transient.
FIRST_END, APART = 49173, 8692
REALISATIONS = 10
FITTED, SECOND = (0, 1), (2, 3)  # realisations, and those of the second split
HORIZON = 60 * SAMPLING_TIME  # 0.098 s, about 7 periods of the resonance
ARROW = 40400  # samples of the official test that extrapolates
SOURCE = "Wigren, Schoukens, ECC 2013, nonlinearbenchmark.org"
FREE = (
    Free(name="m", path="body/mass.mass", value=5.4e-6, unit="kg"),
    Free(name="d", path="joint/slide.damping", value=2.3e-4, unit="N s/m"),
    Free(name="g", path="actuator/V1.gear[0]", value=1.0, known=0.3),
    Free(name="offset.f_0@slide", value=0.0, known=0.02, unit="N", scale=0.01),
)
# Free-run rms of others on the official tests [mV]: multisine, arrow; Champneys, Beintema, Tóth,
# Schoukens, Rogers, arXiv 2405.10779.
OTHERS = {
    "linear state space": (6.96, 14.4), "polynomial NARX": (0.640, 2.25),
    "Gaussian process NARX": (0.301, 0.60), "LSTM": (1.50, 2.68), "SUBNET": (0.36, 1.4),
}  # fmt: skip
UNCOUNTED = 50  # samples at the beginning of a test, which give the first state
PUBLISHED = (
    PublishedSize(name="hardening.k_3@slide", value=4.0, unit="N/m^3", source="about, " + SOURCE),
)


def read_voltages(data: Path) -> np.ndarray:
    """Both voltages, shape (131072, 2) [V]."""
    path = needed(data / "silverbox" / "SNLS80mV.csv")
    return np.loadtxt(path, delimiter=",", skiprows=1, usecols=(0, 1))


def log_of(voltages: np.ndarray, name: str) -> Log:
    """A part of the file as a log that begins at 0 s."""
    return Log(
        time=np.arange(len(voltages), dtype=float) * SAMPLING_TIME, inputs=voltages[:, :1],
        outputs=voltages[:, 1:], input_names=("V1",), output_names=("V2",), name=name, hold="foh",
    )  # fmt: skip


def realisation(voltages: np.ndarray, k: int) -> Log:
    """The k-th realisation of the multisine, its transient left out."""
    end = FIRST_END + APART * k
    return log_of(voltages[end - PERIOD : end], f"multisine {k + 1}")


def official(outcome: Outcome, multisine: Log, arrow: Log) -> dict[str, Any]:
    """Free-run rms on the official tests [mV], beside those of others."""
    rows = {
        what: [1e3 * free_run(errors, log, UNCOUNTED) for log in (multisine, arrow)]
        for what, errors in (("nominal (linear)", outcome.nominal), ("with what is named",
                                                                     outcome.final))
    }  # fmt: skip
    return {"free_run_mV": rows, "published_mV": {n: list(v) for n, v in OTHERS.items()}}


def read(data: Path) -> MeasuredRobot:
    """The circuit from the folder of all data."""
    voltages = read_voltages(data)
    fit = tuple(realisation(voltages, k) for k in FITTED)
    test = realisation(voltages, REALISATIONS - 1)
    arrow = log_of(voltages[:ARROW], "arrow")
    return MeasuredRobot(
        name="silverbox", title="Silverbox, an electronic Duffing oscillator", source=SOURCE,
        model=MODELS / "silverbox.xml", free=FREE, horizon=HORIZON, fit=fit,
        confirm=(test, arrow), unit="V",
        second=(tuple(realisation(voltages, k) for k in SECOND), (*fit, test)),
        expected=("hardening",),
        starts={"the mass begins a factor 2 off": {"m": 1.08e-5}}, published=PUBLISHED,
        evidence=lambda outcome: official(outcome, test, arrow),
    )  # fmt: skip
