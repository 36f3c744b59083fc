"""Distances of cables from each other and from the platform.

Cables, arms and the grip are straight segments p + t u, q + t' v with t, t' in [0, 1]. The nearest
points of two segments are either inside of both, where the connection is perpendicular to both, or
one of them is an end; the least of the five candidates is the distance.

Two cables that share a connector or an exit point touch there by design. What counts for them is
the angle between them: they lie on each other where it is zero. A cable and the arm that carries
its own connector are not compared either.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from inca_mj.kinematics.cables import inverse
from inca_mj.kinematics.rotations import pose_rotation
from inca_mj.robot.geometry import ARM_RADIUS, DRIVES, GRIP, GRIP_RADIUS, Geometry

SHARED = 1e-6  # anchors that are nearer than this are one point [m]
PARALLEL = 1e-12


def segment_distance(p: np.ndarray, u: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Returns distances [m] of segments p + t u and q + t' v, 0 ≤ t, t' ≤ 1, (..., 3) -> (...,)."""
    w = q - p
    uu, vv, uv = _dot(u, u), _dot(v, v), _dot(u, v)
    det = uu * vv - uv**2
    t = np.divide(_dot(w, u) * vv - _dot(w, v) * uv, det, where=det > PARALLEL * uu * vv,
                  out=np.full(np.shape(det), np.nan))  # fmt: skip
    t2 = (t * uv - _dot(w, v)) / vv
    inside = (t >= 0) & (t <= 1) & (t2 >= 0) & (t2 <= 1)  # NaN, where parallel, is not inside
    across = np.linalg.norm(w + t2[..., None] * v - t[..., None] * u, axis=-1)
    ends = [
        point_distance(p, q, v), point_distance(p + u, q, v),
        point_distance(q, p, u), point_distance(q + v, p, u),
    ]  # fmt: skip
    return np.minimum(np.where(inside, across, np.inf), np.min(ends, axis=0))


def point_distance(x: np.ndarray, p: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Returns distances [m] of points x from segments p + t u, (..., 3) -> (...,)."""
    t = np.clip(_dot(x - p, u) / _dot(u, u), 0.0, 1.0)
    return np.linalg.norm(x - p - t[..., None] * u, axis=-1)


@dataclass(frozen=True)
class Interference:
    """The smallest distances along some poses."""

    pairs: tuple[tuple[int, int], ...]  # cables that share no anchor, as numbers from 1
    between: np.ndarray  # their distances, shape (N, pairs) [m]
    angle: np.ndarray  # between those that share an anchor, shape (N, other pairs) [rad]
    # clearance of each cable from grip and arms, shape (N, 8) [m]; negative where it would run
    # through them
    platform: np.ndarray

    def nearest_pair(self) -> tuple[tuple[int, int], int]:
        """Returns the two cables that come nearest, and the number of the pose."""
        pose, pair = np.unravel_index(self.between.argmin(), self.between.shape)
        return self.pairs[pair], int(pose)

    def nearest_to_platform(self) -> tuple[int, int]:
        """Returns the cable that is nearest to the platform, from 1, and the number of the pose."""
        pose, cable = np.unravel_index(self.platform.argmin(), self.platform.shape)
        return int(cable) + 1, int(pose)


def interference(poses: np.ndarray, geometry: Geometry) -> Interference:
    """Returns distances between cables, and of cables from the platform, at poses.

    Args:
        poses: x, y, z [m], roll, pitch, yaw [rad], shape (N, 6).
        geometry: anchors of the cables; the platform is that of `inca_mj.robot.geometry`.

    Raises:
        InputError: a pose is not six finite numbers, or a cable has no length there.
    """
    poses = np.atleast_2d(np.asarray(poses, float))
    at = inverse(poses, geometry)
    u = at.directions * at.lengths[..., None]  # from exit to connector
    all_pairs = list(combinations(range(DRIVES), 2))
    shared = [_share(geometry, i, j) for i, j in all_pairs]
    apart = [pair for pair, one in zip(all_pairs, shared, strict=True) if not one]
    joined = [pair for pair, one in zip(all_pairs, shared, strict=True) if one]
    A = np.broadcast_to(geometry.A, u.shape)
    between = [segment_distance(A[:, i], u[:, i], A[:, j], u[:, j]) for i, j in apart]
    angles = [
        np.arccos(np.clip(_dot(at.directions[:, i], at.directions[:, j]), -1, 1)) for i, j in joined
    ]
    return Interference(
        tuple((i + 1, j + 1) for i, j in apart),
        np.reshape(between, (len(apart), len(poses))).T,
        np.reshape(angles, (len(joined), len(poses))).T,
        _clearance(poses, geometry, A, u),
    )


def _clearance(poses: np.ndarray, geometry: Geometry, A: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Returns the distance of each cable from the surface of grip and arms, shape (N, 8) [m]."""
    R, P = pose_rotation(poses), poses[:, :3]
    ends = [(np.array(GRIP[0]), np.array(GRIP[1]), GRIP_RADIUS, np.zeros(DRIVES, bool))]
    for b in np.unique(geometry.B, axis=0):
        shared = np.linalg.norm(geometry.B - b, axis=1) < SHARED
        if np.linalg.norm(b) > SHARED:
            ends.append((np.zeros(3), b, ARM_RADIUS, shared))
    clearance = np.full(u.shape[:2], np.inf)
    for begin, end, radius, shared in ends:
        q, v = P + R @ begin, R @ (end - begin)
        for k in np.flatnonzero(~shared):
            d = segment_distance(A[:, k], u[:, k], q, v) - radius
            clearance[:, k] = np.minimum(clearance[:, k], d)
    return clearance


def _share(geometry: Geometry, i: int, j: int) -> bool:
    ends = (geometry.A[i] - geometry.A[j], geometry.B[i] - geometry.B[j])
    return any(float(np.linalg.norm(end)) < SHARED for end in ends)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.asarray((a * b).sum(axis=-1))
