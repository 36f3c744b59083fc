"""Rates and accelerations of measured positions, without delay, in a band that the motion chooses.

    q̂ = F⁻¹ H F q,   v = F⁻¹ iω H F q,   a = F⁻¹ (iω)² H F q        H = 1/(1 + (ω/ω_c)⁸)
    R(ω_c) = Σ_ω (1 - H)² (P - N) + H² N,   ω_c = argmin R          P, N: power of the accelerations

H is what a Butterworth filter of fourth order does that runs forward and backward (Gautier 1997;
Janot, Vandanjon, Gautier 2014). F is Fourier's series of the motion, continued oddly beyond both
ends without the line that joins them, so that it has no jump. The band is the one whose
accelerations have the least expected error: R is Mallows' criterion (1973) for H, with the power P
of second differences in Hann's window, and N that of white noise of the positions, whose level is
the one found from an eighth to a quarter of the sampling rate, where no motion is taken to be. It
is made narrower until noise makes no more than a ten-thousandth of the accelerations' power: least
squares make an inertia smaller by this share (errors in variables), and by a hundred times as much
where columns are nearly sums of others. What a band leaves out of a motion makes no inertia
smaller, as the torques go through the same filter. Near the ends the continued motion is none: its
acceleration jumps there, of which H leaves a tenth after `1/f_c` and a hundredth after twice that,
so that the caller cuts the ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

ORDER = 8  # of H
NOISE = (0.125, 0.25)  # of the sampling rate: a band without motion
WIDEST = 0.2  # band that is tried, of the sampling rate
SLOWEST = 4.0  # periods in a record of the narrowest band
BANDS = 48  # that are tried
ATTENUATION = 1e-4  # share of noise in the power of an acceleration
FREQUENCIES = 4096  # over which the power of filtered noise is summed
EDGES = (1.0, 2.0)  # periods of the band that are cut at each end: at least, and if long enough
LONG = 0.1  # share of a record that may be cut at each end beyond the least


@dataclass(frozen=True)
class Motion:
    """A smooth motion."""

    q: np.ndarray  # positions, shape (n, nv) [rad or m]
    v: np.ndarray  # rates, shape (n, nv)
    a: np.ndarray  # accelerations, shape (n, nv)
    band: float  # f_c [Hz]
    noise: np.ndarray  # std that the noise of the positions makes in the rates, shape (nv,)
    gain: float  # of white noise of positions in the rates [1/s]


def smooth(q: np.ndarray, h: float, band: float, noise: np.ndarray) -> Motion:
    """Returns the smooth motion, in a band [Hz], of positions (n, nv) measured every h [s].

    `noise` is the std of the white noise of the positions, shape (nv,).
    """
    omega = np.pi * np.arange(len(q)) / ((len(q) - 1) * h)
    gain = float(np.sqrt(np.mean((omega * _pass(omega, band)) ** 2)))
    return Motion(*_filtered(q, h, band), band, noise * gain, gain)


def noise_gains(band: float, h: float, width: int) -> tuple[float, float]:
    """Returns the std of means of accelerations, and of signals, that white noise of one makes.

    Means are of `width` samples, measured every h [s]; the band is in Hz.
    """
    omega = np.pi * np.arange(1, FREQUENCIES + 1) / (FREQUENCIES * h)
    mean = np.sin(omega * h * width / 2) / (width * np.sin(omega * h / 2))
    of = _pass(omega, band) * mean
    of_a, of_x = (float(np.sqrt(np.mean(x**2))) for x in (omega**2 * of, of))
    return of_a, of_x


def edge_of(n: int, h: float, band: float) -> int:
    """Returns how many of n samples are cut at each end, measured every h [s] in a band [Hz]."""
    least, most = (int(np.ceil(periods / (band * h))) for periods in EDGES)
    return max(least, min(most, int(LONG * n)))


def low_pass(x: np.ndarray, h: float, band: float) -> np.ndarray:
    """Returns signals (n, ...), measured every h [s], through the same filter of a band [Hz]."""
    return _filtered(x.reshape(len(x), -1), h, band)[0].reshape(x.shape)


def choose_band(q: np.ndarray, h: float) -> tuple[float, float]:
    """Returns the band [Hz] whose accelerations have the least expected error, and the noise's std.

    The positions q of one joint, shape (n,), are measured every h [s]; their noise is white.
    """
    bends = np.diff(q, 2) / h**2
    window = np.hanning(len(bends) + 2)[1:-1]
    window /= np.sqrt(np.mean(window**2))
    power = np.abs(np.fft.rfft(bends * window)) ** 2 / len(bends)
    frequency = np.fft.rfftfreq(len(bends), h)
    omega = 2 * np.pi * frequency
    of_one = (2 * np.sin(omega * h / 2) / h) ** 4
    quiet = (frequency * h >= NOISE[0]) & (frequency * h <= NOISE[1])
    variance = float(np.median(power[quiet] / of_one[quiet])) / np.log(2)  # of exponential numbers
    bands = np.geomspace(min(SLOWEST / (len(q) * h), WIDEST / h), WIDEST / h, BANDS)
    H = _pass(omega, bands[:, None])
    noisy, kept = H**2 @ (variance * of_one), H**2 @ power
    best = int(np.argmin(((1 - H) ** 2) @ (power - variance * of_one) + noisy))
    pure = np.flatnonzero(noisy[: best + 1] <= ATTENUATION * kept[: best + 1])
    return float(bands[pure[-1] if len(pure) else best]), float(np.sqrt(variance))


def _pass(omega: np.ndarray, band: float | np.ndarray) -> np.ndarray:
    return np.asarray(1 / (1 + (omega / (2 * np.pi * band)) ** ORDER))


def _filtered(x: np.ndarray, h: float, band: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns signals (n, k) through H, their rates and their accelerations, shape (n, k) each."""
    n = len(x)
    line, slope = np.linspace(x[0], x[-1], n), (x[-1] - x[0]) / ((n - 1) * h)
    odd = np.concatenate([x - line, (line - x)[-2:0:-1]])
    omega = 2 * np.pi * np.fft.rfftfreq(len(odd), h)[:, None]
    spectrum = np.fft.rfft(odd, axis=0) * _pass(omega, band)
    parts = (1.0, 1j * omega, -(omega**2))
    q, v, a = (np.fft.irfft(f * spectrum, len(odd), axis=0)[:n] for f in parts)
    return q + line, v + slope, a
