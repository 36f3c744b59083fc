"""Currents to drive the robot with: the thesis' step and PRBS, a multisine, none."""

from __future__ import annotations

import numpy as np

from identification.errors import InputError, refuse_negative, unknown_name
from inca_mj.robot.geometry import DRIVES

LONGEST = 3600.0  # an hour of all states at every step is a gigabyte [s]
SLOWEST, FASTEST = 10.0, 2000.0  # [Hz]: below, a cable's swing is lost; above, so is the memory
INPUTS = ("zero", "step", "prbs", "multisine")


def make_input(
    kind: str, duration: float, sampling_time: float = 0.01, *, seed: int = 0
) -> np.ndarray:
    """Returns currents of all drives [A], shape (N, 8) with N = duration / sampling_time + 1.

    Args:
        kind: "zero"; "step": 2 A in motor 1, none in the others (thesis Figure 2.16);
            "prbs": the thesis' identification input; "multisine".
        duration: of the input [s].
        sampling_time: between samples [s].
        seed: of the generator's phases.

    Raises:
        InputError: the kind is unknown, or the duration shorter than two samples or over an hour.
    """
    if kind not in INPUTS:
        raise unknown_name("input", kind, INPUTS)
    refuse_negative("seed", seed)
    refuse_duration(duration, sampling_time)
    n = round(duration / sampling_time) + 1
    if kind == "zero":
        return np.zeros((n, DRIVES))
    if kind == "step":
        return step(n)
    if kind == "prbs":
        return prbs(n, sampling_time, seed=seed)
    return multisine(n, sampling_time, seed=seed)


def refuse_duration(duration: float, sampling_time: float) -> None:
    """Refuses a duration [s] of fewer than two samples [s] or more than an hour."""
    if not 2 * sampling_time <= duration <= LONGEST:
        raise InputError(
            f"a duration of {duration:g} s is not between two samples of {sampling_time:g} s and"
            f" {LONGEST:g} s; give one that is"
        )


def sampling_time_of(rate: float) -> float:
    """Returns the sampling time [s] of a rate [Hz]; refuses one at which no robot is sampled."""
    if not SLOWEST <= rate <= FASTEST:
        raise InputError(
            f"a rate of {rate:g} Hz is not between {SLOWEST:g} and {FASTEST:g} Hz; give one that is"
        )
    return 1 / rate


def step(n: int, level: float = 2.0) -> np.ndarray:
    """Returns a constant current in motor 1 [A], shape (n, 8) (thesis section 2.4)."""
    currents = np.zeros((n, DRIVES))
    currents[:, 0] = level
    return currents


def prbs(
    n: int,
    sampling_time: float,
    *,
    seed: int = 0,
    bits: int = 4,
    bit_time: float = 0.25,
    low: float = 0.5,
    high: float = 1.0,
    phases: np.ndarray | None = None,
) -> np.ndarray:
    """Returns pseudo-random binary currents [A], shape (n, 8) (thesis section 3.2.1).

    A maximum-length sequence of 2^bits - 1 bits, each `bit_time` [s] long, between `low` and
    `high` [A]; the drives get the same sequence at different phases [bits], drawn
    from `seed` unless given, shape (8,).
    """
    register, sequence = np.ones(bits, int), []
    taps = {2: (0, 1), 3: (1, 2), 4: (2, 3), 5: (2, 4), 6: (4, 5), 7: (5, 6)}
    if bits not in taps:
        raise InputError(f"no PRBS of {bits} bits; known: {', '.join(map(str, taps))}")
    for _ in range(2**bits - 1):
        sequence.append(register[-1])
        register = np.concatenate([[register[taps[bits][0]] ^ register[taps[bits][1]]],
                                   register[:-1]])  # fmt: skip
    period = len(sequence)
    if phases is None:
        phases = np.random.default_rng(seed).permutation(period)[np.arange(DRIVES) % period]
    # The small offset keeps a bit edge that falls on a sample on that sample.
    bit = np.floor(np.arange(n) * sampling_time / bit_time + 1e-9).astype(int)
    return low + (high - low) * np.array(sequence)[(bit[:, None] + phases) % period].astype(float)


def multisine(
    n: int,
    sampling_time: float,
    *,
    seed: int = 0,
    mean: float = 0.75,
    amplitude: float = 0.25,
    band: tuple[float, float] = (0.1, 5.0),
    tones: int = 20,
) -> np.ndarray:
    """Returns sums of sines with random phases [A], shape (n, 8), within mean ± amplitude.

    The tones [Hz] are spread over `band` on a logarithmic scale, so that one record shows slow
    motion (friction) and fast motion (inertia).
    """
    rng = np.random.default_rng(seed)
    frequency = np.geomspace(*band, tones)
    phase = rng.uniform(0, 2 * np.pi, (DRIVES, tones))
    time = np.arange(n) * sampling_time
    waves = np.sin(2 * np.pi * frequency * time[:, None, None] + phase).sum(-1)
    return mean + amplitude * waves / np.abs(waves).max(axis=0)
