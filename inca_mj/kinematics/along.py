"""The pose along a log of motor angles and currents, with its std at each sample.

Each sample is a measurement of its own (`inca_mj.kinematics.balance`). Its drums are balanced with
the rates and accelerations that the angles themselves show: ω and ω̇ are derivatives of a
polynomial of degree 2 over five samples or 50 ms (Savitzky and Golay 1964), and the current is the
mean of the two that act just before and just after the sample. d₀ follows the path: first with the
mean strain of both ends, then by the integral of (2.30) with the tensions that were found. At the
last samples, where the rates are extrapolated, the balance of the drums is not used.

What this leaves open has std that the log itself shows, its variance components:

    σ_d² = max((R σ_φ)², σ_L²)      a length: the encoder, or what geometry and parameters get wrong
    σ_T                             the balance of a drum: friction, accelerations between samples
    σ_F, σ_M = σ_F k²/ρ             the balance of the platform: its acceleration is neglected
    σ² ← σ² Σ r²/Σ redundancy       over its group, until all three stay        (Förstner 1979)

k is the radius of gyration of the platform and ρ the mean distance of its connectors: it shakes as
much by turning as by moving. r are the residuals, each in units of its std. σ_L counts where it is
three times the std of the encoders or more. Below that it cannot be told from errors of the drums,
which change the lengths by T/λ, and is taken as zero. σ_T is at least what the noise of the
encoders makes of ω̇. The estimate takes the errors of the statements as independent. Those of
neighbouring samples and of drums and platform are not quite; docs/kinematics.md has how well the
std are met.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace
from functools import partial

import numpy as np
from scipy.signal import savgol_coeffs, savgol_filter

from identification.errors import InputError
from inca_mj.kinematics.balance import (
    DRUMS,
    LENGTHS,
    PLATFORM,
    Balance,
    Measured,
    NoLoad,
    Weights,
    balance,
    drum_tension,
    no_load_along,
    no_load_at_rest,
)
from inca_mj.kinematics.cables import cables_at
from inca_mj.kinematics.forward import find
from inca_mj.kinematics.rotations import rotation
from inca_mj.robot.elastic import Robot

LEAST = 1e-3  # smallest std of a tension or a force [N]
TOLD = 3.0  # times the std of the encoders: a smaller one of the lengths is not told from it
ROUNDS = 50
STILL = 0.01  # relative change of a std that counts as none

Array = np.ndarray
WINDOW = 0.05  # over which rates are taken, but at least five samples [s]
FEWEST = 5  # samples
UNUSED = 100.0  # std of a tension where the drum's balance is not used [N]
ENOUGH = 250  # samples by which the std are estimated
PATHS = 2  # times that d₀ is integrated along the path of the tensions
STRIDE = 5  # samples; the poses between begin at the same one
FAR = 0.05  # lengths that no pose meets better than that belong to no pose [m]


@dataclass(frozen=True)
class Components:
    """Std of what the statements leave open."""

    length: float  # σ_L, of lengths by geometry and parameters [m]
    tension: float  # σ_T, of the drums' balance [N]
    force: float  # σ_F, of the platform's balance [N]


FIRST = Components(length=1e-3, tension=1.0, force=0.3)  # where the search for them begins


@dataclass(frozen=True, kw_only=True)
class Along:
    """Poses along a log."""

    found: Balance  # poses, tensions and their covariance at each sample
    std: Components  # what the statements leave open, as the log shows it
    weights: Weights  # std of all statements


def measure(
    angles: Array, currents: Array, sampling_time: float, hold: str = "zoh"
) -> tuple[Measured, int]:
    """Returns a log with the rates that its angles show, and how many of them are extrapolated.

    Before its first sample the robot rests with all angles zero and no currents. Angles [rad] and
    currents [A] have shape (N, 8); `hold` is "zoh" or "foh". Raises InputError below five samples.
    """
    if len(angles) < FEWEST:
        raise InputError(
            f"{len(angles)} samples are too few to see rates in them; give {FEWEST} or more"
        )
    longest = len(angles) - 1 + len(angles) % 2
    window = min(max(FEWEST, 2 * round(WINDOW / sampling_time / 2) + 1), longest)
    still = np.zeros((window, angles.shape[1]))  # the rest before the log
    φ, i = np.concatenate([still, angles]), np.concatenate([still, currents])
    ω, ω_rate = (
        savgol_filter(φ, window, 2, deriv=k, delta=sampling_time, axis=0)[window:] for k in (1, 2)
    )
    if hold == "zoh":
        i[1:] = (i[1:] + i[:-1]) / 2
    measured = Measured(
        angles=np.asarray(angles),
        currents=i[window:],
        rates=ω,
        rate_changes=ω_rate,
        rate_noise=float(np.linalg.norm(savgol_coeffs(window, 2, deriv=2, delta=sampling_time))),
    )
    return measured, window // 2


def poses_along(robot: Robot, measured: Measured, encoder: Array, ends: int) -> Along:
    """Returns poses and tensions at each sample of a log that begins at rest with all angles zero.

    `encoder` is the std of each angle, shape (8,) [rad]; the balance of the drums is not used at
    the last `ends` samples. Raises InputError where no pose has such cable lengths.
    """
    used = np.arange(len(measured.angles)) < len(measured.angles) - ends
    σ = FIRST
    first: NoLoad = partial(no_load_at_rest, measured.angles)
    weights = weights_of(σ, robot, encoder)
    found = balance(robot, measured, weights, first, _rigid(robot, measured, weights.length))
    some = np.flatnonzero(used)[:: max(1, used.sum() // ENOUGH)]
    rows = {n: getattr(measured, n)[some] for n in ("angles", "currents", "rates", "rate_changes")}
    part = replace(measured, **rows)
    for _ in range(PATHS):
        d_0 = no_load_along(robot, measured.angles, found.tension)
        begin = found.position, found.R, found.tension
        of_some = begin[0][some], begin[1][some], begin[2][some]
        σ = components(robot, part, encoder, σ, partial(_fixed, d_0[some]), of_some)
        weights = weights_of(σ, robot, encoder)
        drums = np.where(used[:, None], weights.tension, UNUSED)
        weights = replace(weights, tension=drums)
        found = balance(robot, measured, weights, partial(_fixed, d_0), begin)
    missed = found.residual[:, LENGTHS] * weights.length
    _refuse_unreached(missed, np.arange(len(missed)))
    return Along(found=found, std=σ, weights=weights)


def no_load_path(angles: Array, path: Array, robot: Robot, T: Array) -> tuple[Array, Array]:
    """Returns d₀ of a robot with other numbers along the same path of tensions, and ∂d₀/∂T = 0."""
    return no_load_along(robot, angles, path), np.zeros_like(T)


def _fixed(d_0: Array, robot: Robot, T: Array) -> tuple[Array, Array]:
    return d_0, np.zeros_like(T)


def _rigid(robot: Robot, measured: Measured, σ: Array) -> tuple[Array, Array, Array]:
    """Returns poses from the lengths alone, one for every few samples, and tensions by drums."""
    T = np.maximum(drum_tension(robot, measured), 0)
    d_0, _ = no_load_at_rest(measured.angles, robot, T)
    lengths = d_0 * (1 + T / robot.lambda_)
    position, R = robot.start[:3], rotation(*robot.start[3:])
    positions, rotations = np.empty((len(T), 3)), np.empty((len(T), 3, 3))
    for k in range(0, len(T), STRIDE):
        position, R, _ = find(lengths[k], robot.geometry, (position, R), σ, tolerance=1e-6)
        missed = cables_at(position, R, robot.geometry).lengths - lengths[k]
        _refuse_unreached(missed[None], np.array([k]))
        positions[k : k + STRIDE], rotations[k : k + STRIDE] = position, R
    return positions, rotations, T


def _refuse_unreached(missed: Array, samples: Array) -> None:
    """Refuses lengths that no pose has, by their errors (n, 8) [m]."""
    n, k = np.unravel_index(np.abs(missed).argmax(), missed.shape)
    if abs(missed[n, k]) > FAR:
        raise InputError(
            f"no pose has the cable lengths of sample {samples[n]}: the nearest one misses cable"
            f" {k + 1} by {abs(missed[n, k]):.3g} m; check the geometry, the start pose and the"
            " sign of the angles (positive winds in)"
        )


def weights_of(σ: Components, robot: Robot, encoder: Array) -> Weights:
    """Returns the std of all statements; `encoder` is that of each angle, shape (8,) [rad]."""
    ρ = np.linalg.norm(robot.geometry.B, axis=1).mean()
    return Weights(
        length=np.maximum(robot.R * encoder, σ.length),
        tension=np.full(len(robot.R), σ.tension),
        force=σ.force,
        moment=σ.force * robot.gyration / ρ,
    )


def components(
    robot: Robot,
    measured: Measured,
    encoder: Array,
    σ: Components,
    no_load: NoLoad,
    begin: tuple[Array, Array, Array],
) -> Components:
    """Returns the std that the residuals show; the search begins at σ and at poses and tensions.

    The arguments are those of `balance`. Raises InputError where no pose agrees with a sample.
    """
    floor = (robot.R * encoder).mean()
    least = max(LEAST, float(np.mean(robot.J / robot.R * encoder)) * measured.rate_noise)
    for length in (max(σ.length, floor), 0.0):  # a std of the lengths that is zero stays zero
        σ, at = replace(σ, length=length), begin
        for _ in range(ROUNDS):
            weights = weights_of(σ, robot, encoder)
            now = balance(robot, measured, weights, no_load, at)
            at = now.position, now.R, now.tension
            square, remaining = now.residual**2, now.redundancy
            d, T, F = (
                float(np.sqrt(square[:, group].sum() / remaining[:, group].sum()))
                for group in (LENGTHS, DRUMS, PLATFORM)
            )
            rms = float(np.sqrt(np.mean(weights.length**2)))
            new = Components(
                length=d * rms if σ.length else 0.0,
                tension=max(least, T * σ.tension),
                force=max(LEAST, F * σ.force),
            )
            change = np.abs(np.subtract(astuple(new), astuple(σ))) > STILL * np.array(astuple(σ))
            σ = new
            if not change.any():
                break
        if σ.length >= TOLD * floor:
            break
    return σ
