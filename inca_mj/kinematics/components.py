"""Variance components: the std of what lengths, drums and platform leave open along a log.

    σ_d² = max((R σ_φ)², σ_L²)      a length: the encoder, or what geometry and parameters get wrong
    σ_T                             the balance of a drum: friction, accelerations between samples
    σ_F, σ_M = σ_F k²/ρ             the balance of the platform: its acceleration is neglected

k is the radius of gyration of the platform and ρ the mean distance of its connectors: it shakes as
much by turning as by moving. The three std σ_L, σ_T and σ_F are estimated from the residuals r of
the whole log, each in units of its std (Förstner 1979):

    σ² ← σ² Σ r²/Σ redundancy       over its group, until all three stay

σ_L counts where it is three times the std of the encoders or more. Below that it is not told from
errors of the drums, which change the lengths by T/λ, and is taken as zero. σ_T is at least what
the noise of the encoders makes of ω̇.

The estimate takes the errors of the statements as independent. The errors of neighbouring samples
and those of drums and platform are not quite; how well the std are met is measured in
docs/kinematics.md."""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace

import numpy as np

from inca_mj.kinematics.balance import DRUMS, LENGTHS, PLATFORM, NoLoad, Weights, balance
from inca_mj.kinematics.elastic import ElasticRobot, Measured

Array = np.ndarray

LEAST = 1e-3  # smallest std of a tension or a force [N]
TOLD = 3.0  # times the std of the encoders: a smaller one of the lengths is not told from it
ROUNDS = 50
STILL = 0.01  # relative change of a std that counts as none


@dataclass(frozen=True)
class Components:
    """Std of what the statements leave open.

    Attributes:
        length: σ_L, of lengths by geometry and parameters [m].
        tension: σ_T, of the drums' balance [N].
        force: σ_F, of the platform's balance [N].
    """

    length: float
    tension: float
    force: float


FIRST = Components(length=1e-3, tension=1.0, force=0.3)  # where the search for them begins


def weights_of(σ: Components, robot: ElasticRobot, encoder: Array) -> Weights:
    """Returns the std of all statements; `encoder` is that of each angle, shape (8,) [rad]."""
    ρ = np.linalg.norm(robot.geometry.B, axis=1).mean()
    return Weights(
        length=np.maximum(robot.R * encoder, σ.length),
        tension=np.full(len(robot.R), σ.tension),
        force=σ.force,
        moment=σ.force * robot.gyration / ρ,
    )


def components(
    robot: ElasticRobot,
    measured: Measured,
    encoder: Array,
    σ: Components,
    no_load: NoLoad,
    begin: tuple[Array, Array, Array],
) -> Components:
    """Returns the std that the residuals show.

    Args:
        robot: its numbers.
        measured: angles and currents of some samples, N.
        encoder: std of each angle, shape (8,) [rad].
        σ: where to begin.
        no_load: d₀ and ∂d₀/∂T for a robot and tensions.
        begin: positions (N, 3) [m], rotations (N, 3, 3) and tensions (N, 8) [N] to begin at.

    Raises:
        InputError: no pose agrees with a sample.
    """
    floor = (robot.R * encoder).mean()
    found = _estimated(robot, measured, encoder, replace(σ, length=max(σ.length, floor)), no_load,
                       begin)  # fmt: skip
    if found.length < TOLD * floor:
        found = _estimated(robot, measured, encoder, replace(found, length=0.0), no_load, begin)
    return found


def _estimated(
    robot: ElasticRobot,
    measured: Measured,
    encoder: Array,
    σ: Components,
    no_load: NoLoad,
    begin: tuple[Array, Array, Array],
) -> Components:
    """Returns the std that the search finds; a std of the lengths that is zero stays zero."""
    least = max(LEAST, float(np.mean(robot.J / robot.R * encoder)) * measured.rate_noise)
    for _ in range(ROUNDS):
        weights = weights_of(σ, robot, encoder)
        now = balance(robot, measured, weights, no_load, begin)
        begin = now.position, now.R, now.tension
        square, left = now.residual**2, now.redundancy
        d, T, F = (
            float(np.sqrt(square[:, group].sum() / left[:, group].sum()))
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
    return σ
