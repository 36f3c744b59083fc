"""A measured pose as three places and three angles: position, yaw, pitch and roll.

    R = R_z(yaw) R_y(pitch) R_x(roll)        the rotation of the body in the world
    R = R_m R_s',   p = p_m - R p_s          of a measured frame (p_s, R_s) on the body

A quaternion (w, x, y, z) and its negative are the same rotation, and so the same angles: products
of two of its numbers are all that enters. Yaw and roll go on beyond half a turn. At a pitch of 90
degrees they turn about one axis, so that a log in which the pitch comes near is refused.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.errors import InputError
from identification.logs.names import listed
from identification.logs.sampling import FloatArray
from identification.logs.table import Table

AXES = ("x", "y", "z", "yaw", "pitch", "roll")
STEEPEST = 75.0  # pitch [deg]; yaw and roll have there four times the noise of the measured angles
NORM = 0.02  # largest deviation of a quaternion's norm from one
_ORDER = "wxyz"


@dataclass(frozen=True)
class Pose:
    """Columns of a log that hold the pose of a body."""

    name: str  # of what is measured; its positions are NAME_x, ..., NAME_roll
    columns: tuple[str, ...]  # of position x, y, z and of the quaternion w, x, y, z, seven names
    # of the measured frame in the body: p_s [m], and R_s as w, x, y, z
    position: tuple[float, ...] = (0.0, 0.0, 0.0)
    quaternion: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        place, turn = self.columns[:3], self.columns[3:]
        last = [name[-1:].lower() for name in turn]
        if sorted(last) == sorted(_ORDER):  # ROS writes w last, and the names say so
            turn = tuple(turn[last.index(letter)] for letter in _ORDER)
        object.__setattr__(self, "columns", (*place, *turn))

    @property
    def names(self) -> tuple[str, ...]:
        """The six names of its positions and angles."""
        return tuple(f"{self.name}_{axis}" for axis in AXES)


def measured_columns(outputs: Sequence[str], poses: Sequence[Pose]) -> tuple[str, ...]:
    """Returns the columns of a file of which the outputs are made, in the order of the outputs."""
    made = {name: pose.columns for pose in poses for name in pose.names}
    return tuple(dict.fromkeys(c for name in outputs for c in made.get(name, (name,))))


def with_angles(table: Table, poses: Sequence[Pose]) -> Table:
    """Returns a table with positions [m] and angles [rad] in the place of measured poses.

    Raises:
        InputError: four numbers are no quaternion, or a pitch comes near 90 degrees.
    """
    for pose in poses:
        rest = [k for k, name in enumerate(table.names) if name not in pose.columns]
        every = np.stack([table[name] for name in pose.columns], axis=1)
        table = replace(
            table,
            names=(*(table.names[k] for k in rest), *pose.names),
            data=np.column_stack([table.data[:, rest], _positions(table, pose, every)]),
        )
    return table


def angles(q: FloatArray) -> FloatArray:
    """Returns yaw, pitch and roll [rad] of quaternions w, x, y, z, shape (n, 4), as (n, 3)."""
    w, x, y, z = q.T
    yaw = np.arctan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z)
    pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))
    roll = np.arctan2(2 * (w * x + y * z), w * w - x * x - y * y + z * z)
    return np.stack([yaw, pitch, roll], axis=1)


def _positions(table: Table, pose: Pose, every: FloatArray) -> FloatArray:
    """Returns x, y, z, yaw, pitch and roll of each row, shape (n, 6); NaN where a cell is empty."""
    out = np.full((len(every), 6), np.nan)
    rows = np.flatnonzero(np.isfinite(every).all(axis=1))
    p, q = every[rows, :3], every[rows, 3:]
    norm = np.linalg.norm(q, axis=1)
    if (np.abs(norm - 1) > NORM).any():
        k = int(np.argmax(np.abs(norm - 1)))
        raise InputError(
            f"{table.place(int(rows[k]))}: {listed(pose.columns[3:])} have the norm {norm[k]:.4g},"
            f" and a quaternion has 1; name the columns of its w, x, y and z in this order, behind"
            f" those of the position, for {pose.name!r}"
        )
    s = np.array(pose.quaternion) * (1, -1, -1, -1)
    q = _product(q / norm[:, None], s)
    turned = angles(q)
    steep = np.abs(np.rad2deg(turned[:, 1]))
    if (steep > STEEPEST).any():
        k = int(np.argmax(steep > STEEPEST))
        raise InputError(
            f"{table.place(int(rows[k]))}: the pitch of {pose.name!r} is beyond {STEEPEST:g}"
            " degrees, near which yaw and roll are one rotation; cut the log before, or turn the"
            " frame of the body in the model so that its x axis stays away from the vertical"
        )
    out[rows, :3] = p - _turned(q, np.array(pose.position))
    out[rows, 3:] = np.unwrap(turned, axis=0)
    return out


def _product(a: FloatArray, b: FloatArray) -> FloatArray:
    """Returns the product of quaternions (n, 4) with another (4,)."""
    w, v = a[:, :1], a[:, 1:]
    return np.hstack([w * b[0] - v @ b[1:, None], w * b[1:] + b[0] * v + np.cross(v, b[1:])])


def _turned(q: FloatArray, p: FloatArray) -> FloatArray:
    """Returns a vector (3,) turned by quaternions (n, 4), shape (n, 3)."""
    t = 2 * np.cross(q[:, 1:], p)
    return np.asarray(p + q[:, :1] * t + np.cross(q[:, 1:], t))
