"""A UR10e arm: six joints in closed loop, motor currents in, joint angles out.

    M(q) q̈ + C(q, q̇) q̇ + G(q) + F_v q̇ + F_c sign q̇ = K i + f_0          i [A] -> q [rad]

K are the authors' drive gains [N m/A], and the links' inertias are those of their URDF. Two Fourier
excitations are fitted; another one and a motion from point to point confirm. Model and starts are
the files `ur10e.xml` and `full1.toml` beside the records.
"""

from __future__ import annotations

import tomllib
from pathlib import Path

import mujoco
import numpy as np

from identification import Log
from robots import needed
from robots.gridded import gridded
from robots.measured_robot import Free, MeasuredRobot, PublishedSize

STEP, WIDEST = 0.02, 0.05  # of the grid, and a gap that is still bridged [s]
FIT = ("ur-20_02_10-30sec_12harm", "ur-20_02_10-20sec_7harm")
CONFIRM = ("ur-20_02_06-20sec_10harm", "ur-20_01_17-ptp_10_points")
JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
SOURCE = "Mamedov, Mikhel 2020, Frontiers in Robotics and AI 571574, github.com/shamilmamedov"
ARMATURE = 0.5  # where the search begins [kg m^2]
# Their estimates (UR10E_parameters.txt of github.com/shamilmamedov/dynamic_calibration): viscous,
# Coulomb and constant friction of each joint, and the rotors' inertia at the joints.
FRICTION = (
    (21.256, 12.548, 0.1961), (20.221, 13.266, -0.7535), (10.378, 4.9943, 0.1979),
    (3.5751, 1.9979, 0.0548), (2.4909, 2.6905, -0.0096), (3.0256, 2.2979, 0.0425),
)  # fmt: skip
ROTORS = (0.0, 3.7434, 0.0, 0.0708, 0.2342, 0.4365)


def read_columns(path: Path) -> np.ndarray:
    """Time, q, q̇, motor current, desired current, desired torque; shape (n, 31), SI units."""
    return np.loadtxt(needed(path), delimiter=",")


def read_record(path: Path, step: float = STEP) -> Log:
    """A record on an even grid, currents as means over its steps."""
    table = read_columns(path)
    inputs = {f"i{k + 1}": table[:, 13 + k] for k in range(6)}
    outputs = {f"q{k + 1}": table[:, 1 + k] for k in range(6)}
    units = {**dict.fromkeys(inputs, "A"), **dict.fromkeys(outputs, "rad")}
    return gridded(
        table[:, 0], inputs, outputs, units=units, name=path.stem, step=step, widest=WIDEST,
        means=True,
    )  # fmt: skip


def read(data: Path) -> MeasuredRobot:
    """The arm from the folder of all data."""
    folder = needed(data / "ur10e")
    model = folder / "ur10e.xml"
    fit, confirm = (
        tuple(read_record(folder / f"{name}.csv") for name in names) for names in (FIT, CONFIRM)
    )
    return MeasuredRobot(
        name="ur10e", title="UR10e arm, six joints in closed loop", source=SOURCE, model=model,
        free=_free(folder / "full1.toml", mujoco.MjModel.from_xml_path(str(model))),
        horizon=0.2, fit=fit, confirm=confirm, expected=("load_dependent_friction",
        "transmitted_load_friction", "gravity_load_friction"), published=_published(),
    )  # fmt: skip


def _free(path: Path, model: mujoco.MjModel) -> tuple[Free, ...]:
    """The free parameters of the file beside the records."""
    said = tomllib.loads(path.read_text(encoding="utf-8"))
    free = []
    for name in said["free"]:
        own = said["parameters"].get(name, {})
        unit, value = _unit(name), own.get("value")
        if name.startswith("body/"):
            value = float(model.body(name[5:].split(".")[0]).mass[0])
        free.append(
            Free(name=name, value=float(value), path="" if "@" in name else name,
                 known=own["known"], unit=unit, scale=1.0 if name.startswith("offset") else None)
        )  # fmt: skip
    return tuple(free)


def _unit(name: str) -> str:
    ends = {"damping": "N m s/rad", "armature": "kg m^2", "mass": "kg"}
    return ends.get(name.rpartition(".")[2], "N m")


def _published() -> tuple[PublishedSize, ...]:
    sizes = []
    for joint, (viscous, coulomb, constant), rotor in zip(JOINTS, FRICTION, ROTORS, strict=True):
        sizes += [
            (f"joint/{joint}.damping", viscous, "N m s/rad"),
            (f"coulomb_friction.f_c@{joint}", coulomb, "N m"),
            (f"offset.f_0@{joint}", -constant, "N m"),  # theirs brakes, ours pushes
            (f"joint/{joint}.armature", rotor, "kg m^2"),
        ]
    return tuple(PublishedSize(name=n, value=v, unit=u, source=SOURCE) for n, v, u in sizes)
