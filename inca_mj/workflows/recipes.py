"""Inputs made from numbers in [0, 1], so that a search can draw, compare and change them.

    multisine   i_d(t) = mean + amplitude Σ_j f_j^tilt sin(2π f_j t + θ_dj)/peak_d
    prbs        i_d(t) = low or high, for a bit time each, drive d at its own phase

The band of a multisine and the bit time of a PRBS decide how much fast motion (which shows cables
and inertia) and how much slow motion (which shows friction) a record has. The levels decide how
large both are.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.inputs import multisine, prbs, step
from inca_mj.workflows.limits import Limits

SAMPLING = 0.01  # of the robot [s]
TONES = 16
# The lowest tone of a multisine is below the corner frequency, and the highest above it [Hz].
SLOWEST, CORNER, FASTEST = 0.2, 3.0, 45.0
BIT = (0.02, 0.5)  # shortest and longest bit [s]
BITS = (4, 7)
_OWN = {"multisine": 5, "prbs": 4}  # numbers before the phases
_GUESS = {"multisine": (0.5, 1.0, 0.3, 0.95, 0.5), "prbs": (0.1, 0.5, 0.4, 1.0)}
_PHASES = {"multisine": DRIVES * TONES, "prbs": DRIVES}


@dataclass(frozen=True)
class Recipe:
    """An input in a few numbers."""

    kind: Literal["multisine", "prbs"]  # "multisine" or "prbs"
    numbers: np.ndarray  # in [0, 1], levels first, phases last
    scale: float = 1.0  # factor of the swing about the mean, at most 1

    def settings(self, limits: Limits) -> dict[str, float]:
        """Returns what the numbers mean, in units; without the phases."""
        count = self.numbers[: _OWN[self.kind]]
        width = limits.high - limits.low
        if self.kind == "prbs":
            a, b = sorted(limits.low + width * count[:2])
            middle, half = (a + b) / 2, self.scale * (b - a) / 2
            return {
                "low [A]": float(middle - half),
                "high [A]": float(middle + half),
                "bit time [s]": float(BIT[0] * (BIT[1] / BIT[0]) ** count[2]),
                "bits": float(BITS[0] + round((BITS[1] - BITS[0]) * count[3])),
            }
        room = min(count[0], 1 - count[0]) * width
        return {
            "mean [A]": float(limits.low + width * count[0]),
            "amplitude [A]": float(self.scale * room * count[1]),
            "lowest tone [Hz]": float(SLOWEST * (CORNER / SLOWEST) ** count[2]),
            "highest tone [Hz]": float(CORNER * (FASTEST / CORNER) ** count[3]),
            "tilt": float(2 * count[4] - 1),
        }

    def currents(self, n: int, sampling_time: float, limits: Limits) -> np.ndarray:
        """Returns the input [A], shape (n, 8)."""
        s = self.settings(limits)
        phases = self.numbers[_OWN[self.kind] :]
        if self.kind == "prbs":
            bits = int(s["bits"])
            shift = np.floor(phases * (2**bits - 1)).astype(int)
            bit = max(1, round(s["bit time [s]"] / sampling_time)) * sampling_time
            return prbs(
                n, sampling_time, bits=bits, bit_time=bit,
                low=s["low [A]"], high=s["high [A]"], phases=shift,
            )  # fmt: skip
        fastest = min(s["highest tone [Hz]"], 0.45 / sampling_time)
        f = np.geomspace(s["lowest tone [Hz]"], fastest, TONES)
        turns = f * np.arange(n)[:, None, None] * sampling_time + phases.reshape(DRIVES, TONES)
        waves = (f ** s["tilt"] * np.sin(2 * np.pi * turns)).sum(axis=-1)
        return s["mean [A]"] + s["amplitude [A]"] * waves / np.abs(waves).max(axis=0)


def draw(
    kind: Literal["multisine", "prbs"], rng: np.random.Generator, *, guess: bool = False
) -> Recipe:
    """Returns a random recipe; if it is a first guess, only its phases are random."""
    numbers = rng.random(_OWN[kind] + _PHASES[kind])
    if guess:
        numbers[: _OWN[kind]] = _GUESS[kind]
    return Recipe(kind, numbers)


def changed(recipe: Recipe, rng: np.random.Generator, size: float, share: float = 0.3) -> Recipe:
    """Returns a neighbour: a share of the numbers moves by about `size`; phases wrap around."""
    n = len(recipe.numbers)
    numbers = recipe.numbers + size * rng.standard_normal(n) * (rng.random(n) < share)
    count = _OWN[recipe.kind]
    numbers[:count] = numbers[:count].clip(0.0, 1.0)
    numbers[count:] %= 1.0
    return replace(recipe, numbers=numbers, scale=1.0)


def standard_inputs(n: int) -> list[tuple[str, np.ndarray]]:
    """Returns inputs that people try, the thesis' PRBS first: names and currents (n, 8) [A]."""
    levels = [(0.5, 1.0, 0.25), (0.5, 1.0, 0.1), (0.5, 1.0, 0.05), (0.25, 1.25, 0.1), (0, 2, 0.1)]
    return [
        *(
            (f"PRBS {a:g}-{b:g} A, {bit:g} s", prbs(n, SAMPLING, low=a, high=b, bit_time=bit))
            for a, b, bit in levels
        ),
        ("multisine 0.5-1 A, to 5 Hz", multisine(n, SAMPLING)),
        ("multisine 0-2 A, 0.1-40 Hz",
         multisine(n, SAMPLING, mean=1.0, amplitude=1.0, band=(0.1, 40.0))),
        ("step 2 A in motor 1", step(n)),
    ]  # fmt: skip
