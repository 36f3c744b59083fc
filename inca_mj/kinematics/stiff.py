"""Poses along a log as if the cables did not stretch: quick, and good to a tenth of a millimetre.

    d_i = d_i(0) - R φ_i          the change of the cables' strain is neglected

The platform's pose is the one whose cable lengths come nearest to these. (`along` knows the
strain, and gives the std of each pose.)
"""

from __future__ import annotations

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.cables import cables_at
from inca_mj.kinematics.forward import FAR, find
from inca_mj.kinematics.jacobians import jacobian
from inca_mj.kinematics.rotations import euler_of, rotation, turn
from inca_mj.robot.geometry import DRIVES, Geometry

FINE = 1e-7  # last step of a search that has ended [m, rad]
STRIDE = 16  # samples of which one is searched for in turn; those behind it begin at its pose
TURNS = 8  # steps of the samples between: three are usual, and who needs more is searched in turn
LOST = 1.0  # by which exchanged or turned angles still miss no length, in a frame of 3 m [m]


def poses_with_stiff_cables(
    angles: np.ndarray, R: float | np.ndarray, start: np.ndarray, geometry: Geometry
) -> np.ndarray:
    """Returns poses (N, 6) [m, rad] from motor angles (N, 8) [rad], which are zero at `start`.

    R is the radius of all rollers or of each [m]. Raises InputError if no pose has nearly such
    cable lengths.
    """
    position, turned = np.array(start[:3], float), rotation(*start[3:])
    lengths = cables_at(position, turned, geometry).lengths - R * np.asarray(angles)
    begin, samples = (position, turned), range(0, len(lengths), STRIDE)
    in_turn = []
    for k in samples:
        begin = _searched(lengths, k, begin, geometry)
        in_turn.append(begin)
    blocks = np.arange(len(lengths)) // STRIDE
    positions = np.array([p for p, _ in in_turn]).reshape(-1, 3)[blocks]
    rotations = np.array([r for _, r in in_turn]).reshape(-1, 3, 3)[blocks]
    for k in _settle(lengths, positions, rotations, geometry):
        before = max(k - 1, 0)
        begin = positions[before], rotations[before]
        positions[k], rotations[k] = _searched(lengths, k, begin, geometry)
    return np.hstack([positions, euler_of(rotations)])


def _searched(
    lengths: np.ndarray, k: int, begin: tuple[np.ndarray, np.ndarray], geometry: Geometry
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the position and rotation of sample k, by the search that may halve its steps."""
    position, turned, last = find(lengths[k], geometry, begin, np.ones(DRIVES), tolerance=FINE)
    if last >= FINE:  # the search took all its steps, as it would at each sample that follows
        _refuse_lost(cables_at(position, turned, geometry).lengths - lengths[k], k)
    return position, turned


def _settle(
    lengths: np.ndarray, positions: np.ndarray, rotations: np.ndarray, geometry: Geometry
) -> list[int]:
    """Takes unhalved steps of `find` for all samples at once; returns those they do not end.

    Positions (N, 3) [m] and rotations (N, 3, 3) change in place where a search ends.
    """
    rows = np.arange(len(lengths))
    at, turned = positions.copy(), rotations.copy()
    cables = cables_at(at, turned, geometry)
    error = lengths - cables.lengths
    good = np.abs(error).max(axis=1, initial=0.0) <= FAR
    lost = [*rows[~good].tolist()]
    rows, error = rows[good], error[good]
    L = jacobian(cables)[good]
    for _ in range(TURNS):
        if not len(rows):
            break
        step = (np.linalg.pinv(L, rcond=1e-12) @ error[..., None])[..., 0]
        last = np.abs(step).max(axis=1)
        at[rows] += step[:, :3]
        turned[rows] = turn(step[:, 3:]) @ turned[rows]
        cables = cables_at(at[rows], turned[rows], geometry)
        new = lengths[rows] - cables.lengths
        lower = (last < FINE) | (np.sum(new**2, axis=1) <= np.sum(error**2, axis=1))
        lost += rows[~lower].tolist()
        ended = lower & (last < FINE)
        positions[rows[ended]], rotations[rows[ended]] = at[rows[ended]], turned[rows[ended]]
        on = lower & ~ended
        rows, error, L = rows[on], new[on], jacobian(cables)[on]
    return sorted([*lost, *rows.tolist()])


def _refuse_lost(missed: np.ndarray, sample: int) -> None:
    """Refuses angles whose nearest pose misses lengths (8,) [m] by more than a log's errors do."""
    worst = int(np.abs(missed).argmax())
    if abs(missed[worst]) > LOST:
        raise InputError(
            f"no pose of the platform has the cable lengths that the motor angles of sample"
            f" {sample + 1} give: the nearest one misses cable {worst + 1} by"
            f" {abs(missed[worst]):.3g} m; check the unit of the angles (rad), and their signs"
            " (positive winds in)"
        )
