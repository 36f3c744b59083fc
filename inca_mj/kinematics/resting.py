"""The pose of a robot at rest from its motor angles, through elastic cables.

The statements of `inca_mj.kinematics.balance` with ω = ω̇ = 0: lengths with the std of the
encoders, drums with the std b_c/(√3 R) that dry friction at rest leaves open, and the platform in
exact balance."""

from __future__ import annotations

from functools import partial

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.along import FIRST, ROUNDS, STILL, TOLD
from inca_mj.kinematics.balance import (
    LENGTHS,
    Balance,
    Measured,
    NoLoad,
    Weights,
    balance,
    drum_tension,
    no_load_at_rest,
)
from inca_mj.kinematics.forward import REACH, find
from inca_mj.kinematics.rotations import rotation
from inca_mj.robot.elastic import Robot
from inca_mj.robot.geometry import DRIVES

Array = np.ndarray

ENCODER = 6.7e-4  # std of an encoder of 4000 counts a turn and its 0.5 mrad of noise [rad]
FORCE, MOMENT = 1e-4, 1e-5  # the platform's balance is exact; numbers that are small enough
LEAST = 1e-3  # a drum without friction is in exact balance [N]


def at_rest(angles: Array, currents: Array) -> Measured:
    """Returns a measurement at rest of finite angles (8,) [rad] and currents (8,) [A]."""
    rows = {}
    for name, values, unit in (("angles", angles, "rad"), ("currents", currents, "A")):
        row = np.asarray(values, float)
        if row.shape != (DRIVES,) or not np.isfinite(row).all():
            raise InputError(f"motor {name} must be {DRIVES} finite numbers [{unit}]")
        rows[name] = row[None]
    zero = np.zeros((1, DRIVES))
    return Measured(angles=rows["angles"], currents=rows["currents"], rates=zero, rate_changes=zero)


def rest_weights(robot: Robot, encoder: float, length: float = 0.0) -> Weights:
    """Returns the std of the statements at rest, by that of angles [rad] and wrong geometry [m]."""
    return Weights(
        length=np.maximum(robot.R * encoder, length),
        tension=np.maximum(robot.friction_std, LEAST),
        force=FORCE,
        moment=MOMENT,
    )


def rest_pose(
    robot: Robot, measured: Measured, encoder: float = ENCODER
) -> tuple[Balance, Weights]:
    """Returns pose and tensions at rest of a measurement by `at_rest`, and the std of statements.

    Where the lengths disagree by more than the encoders explain, their std is what they show.
    Raises InputError if no pose has such cable lengths, or a cable is slack there.
    """
    φ, σ = measured.angles, robot.R * encoder
    balanced = drum_tension(robot, measured)
    weakest = int((balanced + 3 * robot.friction_std)[0].argmin())
    if balanced[0, weakest] + 3 * robot.friction_std[weakest] < 0:
        raise InputError(
            f"cable {weakest + 1} is slack at rest: its motor and spring would have to push with"
            f" {-balanced[0, weakest]:.3g} N; give angles and currents that keep all cables taut"
        )
    T = np.maximum(balanced, 0)
    d_0, _ = no_load_at_rest(φ, robot, T)
    lengths = d_0[0] * (1 + T[0] / robot.lambda_)
    if lengths.min() <= 0:
        k = int(lengths.argmin())
        raise InputError(
            f"motor {k + 1} at {φ[0, k]:.3g} rad would have wound more than its whole cable; check"
            " the sign of the motor angles (positive winds in) and their unit [rad]"
        )
    position, R, _ = find(lengths, robot.geometry, (robot.start[:3], rotation(*robot.start[3:])), σ)
    no_load = partial(no_load_at_rest, φ)
    found, weights = _weighted(robot, measured, encoder, no_load, (position[None], R[None], T))
    missed = found.residual[0, :DRIVES] * weights.length
    if not found.taut.all():
        k = int(np.flatnonzero(~found.taut[0])[0]) + 1
        raise InputError(
            f"cable {k} is slack at rest with these angles and currents, so that its motor says"
            " nothing of the pose; give currents that keep all cables taut"
        )
    if np.abs(missed).max() > REACH:
        k = int(np.abs(missed).argmax())
        raise InputError(
            f"no pose at rest has these motor angles: the nearest one misses cable {k + 1} by"
            f" {abs(missed[k]):.3g} m; check the geometry, the start pose and the sign of the"
            " angles (positive winds in)"
        )
    return found, weights


def _weighted(
    robot: Robot,
    measured: Measured,
    encoder: float,
    no_load: NoLoad,
    begin: tuple[Array, Array, Array],
) -> tuple[Balance, Weights]:
    """Returns the balance with the std of the lengths that their residuals show (Förstner 1979)."""
    floor, length = float((robot.R * encoder).mean()), FIRST.length
    for _ in range(ROUNDS):
        weights = rest_weights(robot, encoder, max(length, floor))
        found = balance(robot, measured, weights, no_load, begin)
        r, remaining = found.residual[:, LENGTHS], found.redundancy[:, LENGTHS]
        scale = float(np.sqrt((r**2).sum() / remaining.sum()))
        length = scale * float(np.sqrt(np.mean(weights.length**2)))
        if abs(scale - 1) < STILL or length < floor:
            break
    if length < TOLD * floor:
        weights = rest_weights(robot, encoder)
        found = balance(robot, measured, weights, no_load, begin)
    return found, weights
