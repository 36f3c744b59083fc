"""Torque residuals of the UR10e, joint by joint: the fitted model, more friction, and the authors'.

    K i = M(q) q̈ + C q̇ + G + J_a q̈ + F_v q̇ + F_c s + μ |G| s - f_0         s = tanh(q̇/v₀)

Frictions that depend on the load are refitted by least squares to the fitted records, joint by
joint (F_v, F_c, f_0, and μ where it is asked for), and judged on the others. The authors' inertias
are the ten numbers of each link about the origin of its frame of the URDF, the frames of
`ur10e.xml`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from identification.model.paths import resolve, write
from robots.inverse_dynamics import Motion, gravity, rms, smoothed, torques
from robots.ur10e import CONFIRM, FIT, FRICTION, JOINTS, LINKS, ROTORS, read_columns

BAND = 5.0  # torques are compared below [Hz]
STEP = 0.01  # [s]
BLOCKS = 20  # of the fitted records, for a std
SLOW = 0.01  # v₀ [rad/s]


def evidence(folder: Path, values: Mapping[str, float]) -> dict[str, Any]:
    """Rms torque and residuals by record and joint [N m], and the load's share of friction.

    Args:
        folder: with the records and `ur10e.xml`.
        values: of the fitted model, by name.

    Returns:
        `records`: by record, `torque` and what is `left` of it by model; `mu`: share of gravity's
        load by joint, and its std over blocks of the fitted records.
    """
    here = mujoco.MjModel.from_xml_path(str(folder / "ur10e.xml"))
    gains = here.actuator_gear[:, 0].copy()
    theirs = published(folder / "ur10e.xml").compile()
    fitted = mujoco.MjModel.from_xml_path(str(folder / "ur10e.xml"))
    for name, value in values.items():
        if "@" not in name and "/" in name:
            write(fitted, resolve(fitted, name), value)
    motions = {name: _motion(folder / f"{name}.csv") for name in (*FIT, *CONFIRM)}
    rigid = {n: torques(fitted, m) for n, m in motions.items()}
    loads = {n: gravity(fitted, m) for n, m in motions.items()}
    own = np.array([[values.get(f"joint/{j}.damping", 0.0),
                     values.get(f"coulomb_friction.f_c@{j}", 0.0),
                     -values.get(f"offset.f_0@{j}", 0.0), 0.0] for j in JOINTS])  # fmt: skip
    plain, loaded = (
        _refitted([(motions[n], rigid[n], loads[n]) for n in FIT], gains, with_load)
        for with_load in (False, True)
    )
    records = {}
    for name, motion in motions.items():
        measured = motion.drive * gains
        models = {
            "fitted here": rigid[name] + _friction(own, motion, loads[name]),
            "friction refitted": rigid[name] + _friction(plain[0], motion, loads[name]),
            "and its share of the load": rigid[name] + _friction(loaded[0], motion, loads[name]),
            "the authors'": torques(theirs, motion) + _friction(
                np.column_stack([np.array(FRICTION), np.zeros(6)]), motion, loads[name]),
        }  # fmt: skip
        low = motion.low(measured, BAND)
        records[name] = {
            "torque": rms(low),
            "left": {n: rms(low - motion.low(x, BAND)) for n, x in models.items()},
        }
    return {
        "band_hz": BAND, "joints": list(JOINTS), "records": records,
        "mu": loaded[0][:, 3].tolist(), "mu_std": loaded[1][:, 3].tolist(),
    }  # fmt: skip


def published(path: Path) -> mujoco.MjSpec:
    """The arm with the authors' inertias and rotors."""
    spec = mujoco.MjSpec.from_file(str(path))
    bodies = [b for b in spec.bodies if b.name != "world"]
    for body, numbers, rotor in zip(bodies, LINKS, ROTORS, strict=True):
        xx, xy, xz, yy, yz, zz, *h, m = numbers
        c = np.array(h) / m
        about = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        central = about - m * (c @ c * np.eye(3) - np.outer(c, c))
        body.mass, body.ipos = m, c
        # MuJoCo takes no inertia that no body has; theirs is at most 1e-4 kg m² off that.
        size, axes = np.linalg.eigh(central)
        size = np.maximum(size, 1e-9)
        size[2] = min(size[2], size[0] + size[1])
        if np.linalg.det(axes) < 0:
            axes[:, 0] *= -1
        quat = np.zeros(4)
        mujoco.mju_mat2Quat(quat, axes.flatten())
        body.inertia, body.iquat = size, quat
        body.joints[0].armature = rotor
    return spec


def _motion(path: Path) -> Motion:
    table = read_columns(path)
    return smoothed(table[:, 0], table[:, 1:7], table[:, 13:19], STEP)


def _columns(motion: Motion, load: np.ndarray, joint: int) -> np.ndarray:
    """Columns of F_v, F_c, the constant, and μ, shape (n, 4)."""
    v = motion.v[:, joint]
    s = np.tanh(v / SLOW)
    return np.column_stack([v, s, np.ones_like(v), s * np.abs(load[:, joint])])


def _friction(x: np.ndarray, motion: Motion, load: np.ndarray) -> np.ndarray:
    """Friction of all joints, shape (n, 6), from F_v, F_c, constant and μ of each, shape (6, 4)."""
    return np.column_stack([_columns(motion, load, j) @ x[j] for j in range(len(x))])


def _refitted(
    records: Sequence[tuple[Motion, np.ndarray, np.ndarray]], gains: np.ndarray, with_load: bool
) -> tuple[np.ndarray, np.ndarray]:
    """F_v, F_c, constant and μ of each joint by least squares, and their std over blocks."""
    used = 4 if with_load else 3
    x, std = np.zeros((2, len(JOINTS), 4))
    for j in range(len(JOINTS)):
        parts = [
            (m.low(_columns(m, load, j)[:, :used], BAND),
             m.low((m.drive * gains - rigid)[:, j], BAND))
            for m, rigid, load in records
        ]  # fmt: skip
        A, b = (np.concatenate(part) for part in zip(*parts, strict=True))
        x[j, :used] = np.linalg.lstsq(A, b, rcond=None)[0]
        left = b - A @ x[j, :used]
        blocks = np.array(
            [
                a.T @ e
                for a, e in zip(
                    np.array_split(A, BLOCKS), np.array_split(left, BLOCKS), strict=True
                )
            ]
        )
        H = np.linalg.pinv(A.T @ A)  # joint 1 carries no load
        std[j, :used] = np.sqrt(np.diag(H @ (blocks.T @ blocks) @ H))
    return x, std
