"""A UR10e arm: six joints in closed loop, motor currents in, joint angles out.

    M(q) q̈ + C(q, q̇) q̇ + G(q) + F_v q̇ + F_c sign q̇ = K i + f_0          i [A] -> q [rad]

K are the authors' drive gains [N m/A], and the links' inertias are those of their URDF. Two Fourier
excitations are fitted; another one and a motion from point to point confirm. Model and starts are
the files `ur10e.xml` and `full1.toml` beside the records.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import mujoco
import numpy as np

from identification import Log, Parameter, axes, joint_plant, window_error
from robots import needed
from robots.measured_robot import Free, MeasuredRobot, PublishedModel, PublishedSize, gridded

STEP, WIDEST = 0.02, 0.05  # of the grid, and a gap that is still bridged [s]
FIT = ("ur-20_02_10-30sec_12harm", "ur-20_02_10-20sec_7harm")
CONFIRM = ("ur-20_02_06-20sec_10harm", "ur-20_01_17-ptp_10_points")
JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
SOURCE = "Mamedov, Mikhel 2020, Frontiers in Robotics and AI 571574, github.com/shamilmamedov"
# Their estimates (UR10E_parameters.txt of github.com/shamilmamedov/dynamic_calibration): viscous,
# Coulomb and constant friction of each joint, and the rotors' inertia at the joints.
FRICTION = (
    (21.256, 12.548, 0.1961), (20.221, 13.266, -0.7535), (10.378, 4.9943, 0.1979),
    (3.5751, 1.9979, 0.0548), (2.4909, 2.6905, -0.0096), (3.0256, 2.2979, 0.0425),
)  # fmt: skip
ROTORS = (0.0, 3.7434, 0.0, 0.0708, 0.2342, 0.4365)
# Their rigid bodies, link by link: I_xx, I_xy, I_xz, I_yy, I_yz, I_zz about the origin of the
# link's frame [kg m^2]; first moments h_x, h_y, h_z [kg m], mass [kg].
LINKS = (
    (16.0177, 0.0, 0.0, 16.0177, 0.0, 9.43727e-07,
     0.0, 0.0, 0.0, 4.82736),
    (3.93252, 0.852873, 0.151907, 3.72056, -0.594538, 1.90316,
     0.0499515, -0.275934, 3.26327, 7.92589),
    (2.22453, -0.536564, -0.176607, 1.38899, -0.216689, 1.38868,
     0.0239479, 0.242903, 0.893879, 2.48086),
    (1.02974, 0.23281, -0.0122593, 0.0751258, 0.074354, 1.06527,
     -0.000582815, -0.253394, 0.191763, 2.156),
    (0.0286149, -0.0338327, -0.0256613, 0.108051, -0.0138456, 0.111089,
     0.00787524, 0.0934251, 0.114659, 2.15599),
    (0.0283844, -0.00207559, -0.0139815, 0.0353598, -0.00400838, 0.00814486,
     0.00266612, -0.00108021, -0.0158006, 0.22217),
)  # fmt: skip


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


def evidence_of(folder: Path, values: Mapping[str, float]) -> dict[str, object]:
    """What `robots.ur10e_evidence` measures."""
    from robots.ur10e_evidence import evidence

    return evidence(folder, values)


def published_errors(path: Path, whole: Log, log: Log, horizon: float) -> np.ndarray:
    """Window errors of the authors' parameters, from the best first states, shape (W, L, 6).

    Args:
        path: of the arm's model.
        whole: a record in which all joints move.
        log: a record, or a part of one.
        horizon: of the windows [s].
    """
    from robots.ur10e_evidence import published

    spec = published(path)
    records = []
    for joint, (viscous, coulomb, constant) in zip(JOINTS, FRICTION, strict=True):
        path_of = f"joint/{joint}.damping"
        records.append(Parameter(name=path_of, value=viscous, unit="N m s/rad", where=path_of))
        for name, value in (("coulomb_friction.f_c", coulomb), ("offset.f_0", -constant)):
            records.append(
                Parameter(name=f"{name}@{joint}", value=value, unit="N m", where="effect")
            )
    with TemporaryDirectory() as folder:
        file = Path(folder) / path.name
        file.write_text(spec.to_xml(), encoding="utf-8")
        plant = joint_plant(file, records, whole, joints=axes(spec.compile(), whole))
    return window_error(plant, log, horizon)


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
        evidence=lambda outcome: evidence_of(folder, outcome.values),
        models=(PublishedModel(name="their parameters", source=SOURCE,
                               errors=partial(published_errors, model, fit[0])),),
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
