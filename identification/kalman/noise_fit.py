"""The level of the noise of sensors and inputs, by maximum likelihood.

    log L(ρ, τ) = -½ (n log(‖E - Φ c‖²/n) + log det S(ρ, τ)),     σ² = ‖E - Φ c‖²/n

E and Φ are the whitened residual and sensitivities; c is the small change of the parameters, held
by their priors, that fits best. ρ is searched on a scale that the plant gives: at ρ₀ the inputs'
error moves the outputs by as much as the sensors' noise. From there on c and the noise take turns:
c is held while ρ, τ and how the noise is shared out among the sensors (`noise_shares`) are found.
This never lowers L. Two turns are mostly enough, because c says little of a covariance, and the
columns are whitened once a turn and not for each noise. With one turn alone the noise of short logs
whose model lacks something stays so wrong that effects are neither refused nor proven. All inputs
have one ρ: where one errs by more, innovations would be white with a ρ of its own, but what follows
from another input would be taken for that error too (of 12 logs of crosstalk it is told in 7, and
else in 11).
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from math import isclose
from threading import Lock

import numpy as np

from identification.kalman.linear import LinearPlant
from identification.kalman.noise_model import (
    Noise,
    Whitened,
    augment,
    build_whitener,
    keep,
    whiten,
)
from identification.kalman.noise_shares import END_RISE, share_noise
from identification.kalman.recursion import propagate
from identification.runtime.pool import one_blas_thread, run_parts, split

START_CORRELATION_TIME = 0.03  # [s] of the inputs' error, at which the search for the noise begins
# [s] at most: a noise that lasts without limit would explain a constant force.
MAX_CORRELATION_TIME = 0.3
NOISES_AT_ONCE = 4  # each takes the memory of the sensitivities
MAX_TURNS = 4  # of c and of the noise
FIRST_FACTOR, LAST_FACTOR = 1.6, 1.15  # with which the pattern search begins and ends
# Multiples of the ρ of a point nearby that are tried; the last two where the second beats the first
NEARBY_FACTORS = (1.0, 0.3, 0.05, 0.0)
SILENT_LEVELS = (0.0, 0.1, 1.0)  # ρ/ρ₀ where a point nearby had no error of the inputs
# Levels ρ/ρ₀ that are tried where no noise is known.
FIRST_LEVELS = (0.0, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0)


@dataclass(frozen=True)
class NoiseLevel:
    """A noise and the likelihood of a residual under it."""

    noise: Noise  # ρ and τ, and the shares of the sensors
    sigma: float  # σ, rms of the sensors' noise over all outputs, in their unit
    log_likelihood: float  # of the residual, up to a constant that depends on the log only

    @property
    def input_std(self) -> float:
        """ρ σ: rms of the unlogged error over all inputs, in their unit."""
        return self.noise.ratio * self.sigma

    def of_outputs(self, ny: int) -> np.ndarray:
        """Returns σ s: std of the noise of each sensor, in its unit, shape (ny,)."""
        return self.sigma * self.noise.of_outputs(ny)

    def of_inputs(self, nu: int) -> np.ndarray:
        """Returns ρ σ: std of the unlogged error of each input, in its unit, shape (nu,)."""
        return self.sigma * self.noise.of_inputs(nu)


def compute_unit_ratio(plant: LinearPlant, sampling_time: float, time: float) -> float:
    """Returns ρ₀ at a correlation time [s]: input errors then move the outputs by σ, as an rms."""
    moved = propagate(augment(plant, Noise(1.0, time), sampling_time))
    return float(1 / np.sqrt(moved.mean()))


def evaluate_noise(white: Whitened, e: np.ndarray, prior: np.ndarray) -> NoiseLevel:
    """Returns the likelihood of a residual e (N, ny), the parameters adjusted to the noise.

    Args:
        white: the noise, and the sensitivities under it.
        e: shape (N, ny).
        prior: 1/std of each parameter's prior, shape (p,).
    """
    sigma, _ = _adjust(white, e, prior)
    log_likelihood = -0.5 * (2 * e.size * np.log(sigma) + white.filter.log_determinant)
    return NoiseLevel(white.noise, float(sigma), float(log_likelihood))


def _adjust(white: Whitened, e: np.ndarray, prior: np.ndarray) -> tuple[float, np.ndarray]:
    """Returns σ and c, the best small change of the parameters, shape (p,)."""
    E, F = white.filter(e).ravel(), white.F
    sigma, b = np.sqrt(E @ E / E.size), F.T @ E
    for _ in range(2):  # the weight of the prior depends on σ
        c = _solve(white.H + np.diag((prior * sigma) ** 2), b)
        sigma = np.sqrt(np.sum((E - F @ c) ** 2) / E.size)
    return float(sigma), c


def _solve(H: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Solves H c = b; returns the shortest c where outputs do not feel every direction of it."""
    try:
        return np.linalg.solve(H, b)
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.lstsq(H, b, rcond=1e-14)[0])


def fit_noise(
    plant: LinearPlant,
    e: np.ndarray,
    J: np.ndarray,
    prior: np.ndarray,
    sampling_time: float,
    near: NoiseLevel | None = None,
    fine: bool = True,
    levels: Sequence[float] = FIRST_LEVELS,
    largest: float = np.inf,
    outputs: tuple[float, ...] = (),
    kinds: Sequence[Hashable] = (),
) -> NoiseLevel:
    """Returns the most likely noise of a residual; what it whitens of J is kept (see `whiten`).

    Args:
        plant: the linearised plant.
        e: residual, shape (N, ny).
        J: sensitivities, shape (N, ny, p).
        prior: 1/std of each parameter's prior, shape (p,).
        sampling_time: [s].
        near: the noise of a point nearby, to begin at, where one is known.
        fine: whether shares are estimated and ρ and τ refined by a pattern search, or ρ is only
            chosen from the grid. A model far from the data would else take an output that it fails
            to predict for one of much noise, and stay far from it.
        levels: the grid of ρ/ρ₀ where no noise is known.
        largest: largest error of the inputs that is believed on the grid, in the inputs' unit.
        outputs: shares of the sensors where no noise is known.
        kinds: see `share_noise`.
    """
    outputs = outputs if near is None else near.noise.outputs
    likeliest = _Likeliest()
    with one_blas_thread():

        def at(noise: Noise) -> NoiseLevel:
            white = whiten(plant, J, noise, sampling_time)
            level = evaluate_noise(white, e, prior)
            if level.input_std <= largest or fine:
                likeliest.update(level, white)
            return level

        def believed(noise: Noise, factors: Sequence[float]) -> list[NoiseLevel]:
            each = [noise.scaled(f) for f in factors]
            some = split(len(each), NOISES_AT_ONCE)
            tried = [level for few in some for level in run_parts(at, each[few])]
            return [level for level in tried if level.input_std <= largest]

        found: list[NoiseLevel] = []
        if near is not None and near.noise.ratio:
            found = believed(near.noise, NEARBY_FACTORS[:2])
            if len(found) < 2 or found[1].log_likelihood > found[0].log_likelihood:
                found += believed(near.noise, NEARBY_FACTORS[2:])
        if len(found) < 2:  # no noise is known nearby, or only that of ρ = 0 is believed
            time = START_CORRELATION_TIME
            unit = Noise(compute_unit_ratio(plant, sampling_time, time), time, outputs)
            silent = near is not None and not near.noise.ratio
            found = believed(unit, SILENT_LEVELS if silent and not fine else levels)
        best = _best(found)
        times = sampling_time / 3, MAX_CORRELATION_TIME  # below the first it is white
        for _ in range(MAX_TURNS if fine else 0):
            white = likeliest.find(best.noise) or whiten(plant, J, best.noise, sampling_time)
            rest = e - white.J @ _adjust(white, e, prior)[1]
            held = _refine(plant, best, rest, sampling_time, times, kinds)
            new = at(held.noise)
            best = _best([best, new])
            if best is not new or new.log_likelihood - held.log_likelihood < END_RISE:
                break
    likeliest.keep(best)
    return best


def _refine(
    plant: LinearPlant, best: NoiseLevel, rest: np.ndarray, sampling_time: float,
    times: tuple[float, float], kinds: Sequence[Hashable],
) -> NoiseLevel:  # fmt: skip
    """Returns the likeliest noise of what the parameters leave (N, ny), τ between two times [s]."""

    def at(noise: Noise) -> NoiseLevel:
        filter_ = build_whitener(plant, noise, sampling_time)
        sigma = float(np.sqrt(np.mean(filter_(rest) ** 2)))
        log_likelihood = -0.5 * (2 * rest.size * np.log(sigma) + filter_.log_determinant)
        return NoiseLevel(noise, sigma, float(log_likelihood))

    def shared(best: NoiseLevel) -> NoiseLevel:
        if rest.shape[1] == 1:
            return best
        new = share_noise(plant, best.noise, rest, sampling_time, kinds)
        return at(new.noise) if new.log_likelihood > best.log_likelihood else best

    best = shared(best)
    return shared(refine_noise(best, at, times)) if best.noise.ratio else best


class _Likeliest:
    """The whitened sensitivities of the likeliest noise that was tried yet, from any thread."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._level: NoiseLevel | None = None
        self._white: Whitened | None = None

    def update(self, level: NoiseLevel, white: Whitened) -> None:
        """Take those of a noise if it is likelier."""
        with self._lock:
            if self._level is None or level.log_likelihood > self._level.log_likelihood:
                self._level, self._white = level, white

    def find(self, noise: Noise) -> Whitened | None:
        """Returns them if they are those of a noise."""
        white = self._white
        return white if white is not None and white.noise == noise else None

    def keep(self, best: NoiseLevel) -> None:
        """Keep them if they are those of the noise that was chosen."""
        if (white := self.find(best.noise)) is not None:
            keep(white)


def share_level(
    white: Whitened, e: np.ndarray, prior: np.ndarray, sampling_time: float,
    kinds: Sequence[Hashable] = (),
) -> Noise:  # fmt: skip
    """Returns the noise of whitened sensitivities with its likeliest shares; see `share_noise`."""
    rest = e - white.J @ _adjust(white, e, prior)[1]
    return share_noise(white.plant, white.noise, rest, sampling_time, kinds).noise


def refine_noise(
    best: NoiseLevel, at: Callable[[Noise], NoiseLevel], times: tuple[float, float]
) -> NoiseLevel:
    """Returns the most likely noise near a level, by a pattern search over ln ρ√τ and ln τ."""
    step, alone = FIRST_FACTOR, True  # first ρ alone, because at a wrong ρ a wrong τ is likely
    known = [best]
    while step > LAST_FACTOR:
        near = [(step, 1.0), (1 / step, 1.0)]
        near += [] if alone else [(1.0, step**2), (1.0, step**-2)]
        moved = [_moved(best.noise, r, τ, times) for r, τ in near]
        known += run_parts(at, [m for m in moved if not any(_is_same(m, k.noise) for k in known)])
        new = _best(known)
        if new is best:
            step, alone = (step, False) if alone else (step**0.5, False)
        best = new
    return best


def _is_same(one: Noise, other: Noise) -> bool:
    """Returns whether two noises differ by rounding only."""
    return isclose(one.ratio, other.ratio) and isclose(one.time, other.time)


def _moved(noise: Noise, felt: float, time: float, times: tuple[float, float]) -> Noise:
    """Returns a noise whose ρ√τ is multiplied by `felt` and whose τ is multiplied by `time`."""
    other = float(np.clip(noise.time * time, *times))
    return noise.lasting(other).scaled(felt)


def _best(levels: list[NoiseLevel]) -> NoiseLevel:
    return max(levels, key=lambda level: level.log_likelihood)
