"""The pose that belongs to measured cable lengths (forward geometry), with its covariance.

    min Σ_i ((d_i(pose) - d̂_i)/σ_i)²         eight lengths, six unknowns
    δ = (Lᵀ Σ⁻¹ L)⁻¹ Lᵀ Σ⁻¹ (d̂ - d(pose))    step of Gauss and Newton, a twist times a unit of time
    cov(pose) = E (Lᵀ Σ⁻¹ L)⁻¹ Eᵀ            E maps twists to rates of x … yaw (thesis 2.5)

Two lengths are redundant, so that the residual says whether the lengths fit the geometry. The
thesis has no forward geometry; its lengths are (2.8) and L are the rows of (2.15). Where L has a
rank below six, a motion of the platform changes no length: the pose is not unique, and the std of
what that motion moves is infinite. A pose far from the start may have the same lengths even where
the rank is six; the search ends at the one that belongs to its start."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.cables import Cables, Pulleys, cables_at
from inca_mj.kinematics.jacobians import condition, jacobian, rank
from inca_mj.kinematics.rotations import euler_of, pose_rate_matrix, rotation, turn
from inca_mj.robot.geometry import DRIVES, Geometry

Array = np.ndarray

STD = 1.2e-5  # of a length: an encoder of 6.7e-4 rad at a roller of 17.5 mm [m]
REACH = 0.01  # lengths that no pose meets better than that belong to no pose [m]
STEPS = 100
HALVINGS = 30
FAR = 0.1  # lengths that are farther off are met by the position alone first [m]
MOVED = 1e-6  # a larger part in a motion that changes no length is not known


@dataclass(frozen=True, kw_only=True)
class ForwardPose:
    """A pose from cable lengths.

    Attributes:
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (6,).
        covariance: of the pose by the std of the lengths, shape (6, 6) [m, rad]; infinite variance
            where the lengths do not say it.
        residual: lengths of the pose minus the measured ones, shape (8,) [m].
        rank: of the Jacobian; below 6 the pose is not unique.
        condition: of the Jacobian, angles counted at the distance of the connectors.
    """

    pose: Array
    covariance: Array
    residual: Array
    rank: int
    condition: float

    @property
    def std(self) -> Array:
        """Std of the pose, shape (6,) [m, rad]."""
        return np.sqrt(np.diag(self.covariance))


def pose_from_lengths(
    lengths: Array,
    geometry: Geometry,
    start: Array,
    *,
    std: float | Array = STD,
    pulleys: Pulleys | None = None,
    reach: float = REACH,
    tolerance: float = 1e-10,
) -> ForwardPose:
    """Returns the pose whose cable lengths come nearest (weighted least squares) to measured ones.

    Args:
        lengths: measured cable lengths, shape (8,) [m].
        geometry: exit points and connectors.
        start: pose to begin at: x, y, z [m], roll, pitch, yaw [rad], shape (6,).
        std: of each length, one for all or shape (8,) [m].
        pulleys: at the exit points; straight cables without.
        reach: largest difference to a measured length that is accepted [m].
        tolerance: largest last step [m, rad].

    Raises:
        InputError: the lengths, their std or the start are no such numbers; no pose has such
            lengths; or the search passes a pose where a cable has no length.
    """
    lengths, start, σ = _checked(lengths, start, std)
    begin = start[:3], rotation(*start[3:])
    position, R, last = find(lengths, geometry, begin, σ, pulleys, tolerance)
    cables = cables_at(position, R, geometry, pulleys)
    residual = cables.lengths - lengths
    worst = int(np.abs(residual).argmax())
    if last >= tolerance or abs(residual[worst]) > reach:
        raise InputError(
            f"no pose of the platform has cable lengths {np.round(lengths, 3).tolist()} m: the"
            f" nearest one misses cable {worst + 1} by {abs(residual[worst]):.3g} m; check the"
            " geometry and the sign of the motor angles (positive winds in)"
        )
    pose = np.concatenate([position, euler_of(R)])
    return ForwardPose(
        pose=pose,
        covariance=_covariance(cables, pose, σ),
        residual=residual,
        rank=rank(cables),
        condition=condition(cables),
    )


def find(
    lengths: Array,
    geometry: Geometry,
    begin: tuple[Array, Array],
    σ: Array,
    pulleys: Pulleys | None = None,
    tolerance: float = 1e-10,
) -> tuple[Array, Array, float]:
    """Returns position (3,) [m], rotation (3, 3) and the largest part of the last step [m, rad].

    This is the search of `pose_from_lengths` alone, from a position and a rotation; σ is the std of
    the lengths, shape (8,) [m].
    """
    position, R = begin
    away = np.abs(lengths - cables_at(position, R, geometry, pulleys).lengths).max()
    if away > FAR:
        position, R, _ = _search(lengths, geometry, begin, σ, pulleys, FAR / 10, free=3)
    return _search(lengths, geometry, (position, R), σ, pulleys, tolerance)


def _search(
    lengths: Array,
    geometry: Geometry,
    begin: tuple[Array, Array],
    σ: Array,
    pulleys: Pulleys | None,
    tolerance: float,
    free: int = 6,
) -> tuple[Array, Array, float]:
    """Takes Gauss-Newton steps, halved where the error grows; moves the first `free` of a twist."""
    position, R = begin
    cables = cables_at(position, R, geometry, pulleys)
    error, last = (lengths - cables.lengths) / σ, np.inf
    for _ in range(STEPS):
        step = np.zeros(6)
        L = jacobian(cables)[:, :free] / σ[:, None]
        step[:free] = np.linalg.lstsq(L, error, rcond=1e-12)[0]
        for _ in range(HALVINGS):
            moved, turned = position + step[:3], turn(step[3:]) @ R
            cables = cables_at(moved, turned, geometry, pulleys)
            new = (lengths - cables.lengths) / σ
            last = float(np.abs(step).max())
            if new @ new <= error @ error or last < tolerance:
                break
            step = step / 2
        position, R, error = moved, turned, new
        if last < tolerance:
            break
    return position, R, last


def _covariance(there: Cables, pose: Array, σ: Array) -> Array:
    """Returns E (Lᵀ Σ⁻¹ L)⁺ Eᵀ, with infinite variances where a motion changes no length."""
    L = jacobian(there) / σ[:, None]
    ρ = np.linalg.norm(there.arms, axis=1).mean()
    scale = np.array([1, 1, 1, 1 / ρ, 1 / ρ, 1 / ρ])
    _, values, V = np.linalg.svd(L * scale)
    E = pose_rate_matrix(pose)
    known = np.arange(6) < rank(there)
    half = E @ (scale[:, None] * V[known].T / values[known])
    unknown = np.abs(E @ (scale[:, None] * V[~known].T)).max(axis=1, initial=0.0) > MOVED
    covariance = half @ half.T
    covariance[unknown] = covariance[:, unknown] = 0.0
    covariance[unknown, unknown] = np.inf
    return covariance


def _checked(lengths: Array, start: Array, std: float | Array) -> tuple[Array, Array, Array]:
    lengths, start = np.asarray(lengths, float), np.asarray(start, float)
    if lengths.shape != (DRIVES,) or not np.isfinite(lengths).all() or lengths.min() <= 0:
        raise InputError(
            f"cable lengths must be {DRIVES} numbers above zero [m], not {lengths.tolist()}"
        )
    if start.shape != (6,) or not np.isfinite(start).all():
        raise InputError("a start pose is six finite numbers: x, y, z [m], roll, pitch, yaw [rad]")
    σ = np.asarray(std, float)
    if σ.shape not in ((), (DRIVES,)) or not np.isfinite(σ).all() or σ.min() <= 0:
        raise InputError(
            f"the std of lengths must be one number above zero, or {DRIVES} [m], not {σ.tolist()}"
        )
    return lengths, start, np.broadcast_to(σ, (DRIVES,))
