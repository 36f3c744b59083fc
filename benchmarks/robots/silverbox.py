"""The Silverbox: an electronic circuit that behaves like a mass on a hardening spring.

    m ÿ + d ẏ + y + k₃ y³ = g u + f_0        u [V] -> y [V], 610.35 Hz; k = 1 by definition

The model lacks k₃. Of the ten realisations of a random-phase multisine two are fitted. The last
one, which is the official test, and the Gaussian "arrow", whose size grows beyond, confirm.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from identification import Log
from robots import needed
from robots.measured_robot import MODELS, Free, MeasuredRobot, PublishedSize

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
        time=SAMPLING_TIME * np.arange(len(voltages)), inputs=voltages[:, :1],
        outputs=voltages[:, 1:], input_names=("V1",), output_names=("V2",), name=name, hold="foh",
    )  # fmt: skip


def realisation(voltages: np.ndarray, k: int) -> Log:
    """The k-th realisation of the multisine, its transient left out."""
    end = FIRST_END + APART * k
    return log_of(voltages[end - PERIOD : end], f"multisine {k + 1}")


def read(data: Path) -> MeasuredRobot:
    """The circuit from the folder of all data."""
    voltages = read_voltages(data)
    fit = tuple(realisation(voltages, k) for k in FITTED)
    test = realisation(voltages, REALISATIONS - 1)
    return MeasuredRobot(
        name="silverbox", title="Silverbox, an electronic Duffing oscillator", source=SOURCE,
        model=MODELS / "silverbox.xml", free=FREE, horizon=HORIZON, fit=fit,
        confirm=(test, log_of(voltages[:ARROW], "arrow")),
        second=(tuple(realisation(voltages, k) for k in SECOND), (*fit, test)), expected=("hardening",),
        starts={"the mass begins a factor 2 off": {"m": 1.08e-5}}, published=PUBLISHED,
    )  # fmt: skip
