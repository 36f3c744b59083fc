"""A double pendulum with two quasi-direct drives of gear 6 (design A.0), excited for 10 s.

    M(q) q̈ + C(q, q̇) q̇ + F_v q̇ + F_c sign q̇ = G(q) + τ + f_0       τ measured [N m] -> q₁, q₂ [rad]

q₂ is relative to link 1, τ acts at the joints, and M has the rotors (`models/double_pendulum.xml`).
The model begins at the authors' numbers from CAD, their model 1.0. Their model 2.0, which they
identified from these records and more, is what predictions are compared with.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

import mujoco
import numpy as np

from identification import Log, Parameter, axes, joint_plant, window_error
from identification.model.paths import resolve, write
from robots import needed
from robots.measured_robot import (
    MODELS,
    Free,
    MeasuredRobot,
    PublishedModel,
    PublishedSize,
    gridded,
)

MODEL = MODELS / "double_pendulum.xml"
STEP, WIDEST = 0.01, 0.02  # of the grid, and a gap that is still bridged [s]
FIT = ("00", "01", "04")
CONFIRM = ("02", "03", "05", "11")
UNPOWERED = ("12", "13")  # nothing is asked of motor 1
SOURCE = "DFKI, github.com/dfki-ric-underactuated-lab/double_pendulum, design A.0"
FREE = (
    Free(name="m_1", path="body/link_1.mass", value=0.608, known=0.3, unit="kg"),
    Free(name="I_1", path="body/link_1.inertia[1]", value=0.00874, known=0.5, unit="kg m^2"),
    Free(name="m_2", path="body/link_2.mass", value=0.63, known=0.3, unit="kg"),
    Free(name="I_2", path="body/link_2.inertia[1]", value=0.00786, known=0.5, unit="kg m^2"),
    Free(name="b_1", path="joint/shoulder.damping", value=0.081, known=1.0, unit="N m s/rad"),
    Free(name="b_2", path="joint/elbow.damping", value=0.001, known=1.0, unit="N m s/rad"),
    Free(name="coulomb_friction.f_c@shoulder", value=0.146, unit="N m"),
    Free(name="coulomb_friction.f_c@elbow", value=0.292, unit="N m"),
    Free(name="offset.f_0@shoulder", value=0.0, known=0.1, unit="N m", scale=0.05),
    Free(name="offset.f_0@elbow", value=0.0, known=0.1, unit="N m", scale=0.05),
)


def published_model(data: Path, version: str) -> dict[str, float]:
    """Numbers of a model of the authors by their names: m1, l1, r1, I1, b1, cf1, …, Ir, gr, g."""
    path = needed(data / "double_pendulum" / f"published_model_{version}.yml")
    lines = (line.split(":") for line in path.read_text().splitlines() if ":" in line)
    return {name.strip(): float(value) for name, value in lines}


def sizes_of(model: dict[str, float]) -> dict[str, float]:
    """A model of the authors in the parameters here; their Coulomb level is c_f atan(100 v)."""
    return {
        "m_1": model["m1"], "I_1": model["I1"] - model["m1"] * model["r1"] ** 2,
        "m_2": model["m2"], "I_2": model["I2"] - model["m2"] * model["r2"] ** 2,
        "b_1": model["b1"], "b_2": model["b2"],
        "coulomb_friction.f_c@shoulder": model["cf1"] * np.pi / 2,
        "coulomb_friction.f_c@elbow": model["cf2"] * np.pi / 2,
    }  # fmt: skip


def places_of(model: dict[str, float]) -> dict[str, float]:
    """The numbers of a model of the authors by their paths into the MJCF, friction aside."""
    found = {"joint/shoulder.armature": model["gr"] ** 2 * model["Ir"],
             "tendon/rotor_2.armature": model["Ir"]}  # fmt: skip
    for k in (1, 2):
        m, r, inertia = (model[f"{what}{k}"] for what in "mrI")
        found |= {f"body/link_{k}.mass": m, f"body/link_{k}.ipos[2]": -r}
        found |= {f"body/link_{k}.inertia[{axis}]": inertia - m * r**2 for axis in (0, 1)}
    return found


def changed(model: dict[str, float]) -> mujoco.MjModel:
    """The MJCF with the numbers of a model of the authors, friction aside."""
    here = mujoco.MjModel.from_xml_path(str(MODEL))
    for path, value in places_of(model).items():
        write(here, resolve(here, path), value)
    return here


def published_errors(model: dict[str, float], log: Log, horizon: float) -> np.ndarray:
    """Window errors of a model of the authors, each window from its best first state, (W, L, 2)."""
    paths = places_of(model) | {"joint/shoulder.damping": model["b1"],
                                "joint/elbow.damping": model["b2"]}  # fmt: skip
    records = [Parameter(name=path, value=v, unit="", where=path) for path, v in paths.items()]
    for k, joint in ((1, "shoulder"), (2, "elbow")):
        dry = model[f"cf{k}"] * np.pi / 2  # c_f atan(100 v) of a speed
        records.append(
            Parameter(name=f"coulomb_friction.f_c@{joint}", value=dry, unit="N m", where="effect")
        )
    plant = joint_plant(MODEL, records, log, joints=axes(changed(model), log))
    return window_error(plant, log, horizon)


def read_table(path: Path) -> dict[str, np.ndarray]:
    """The columns of a record by the authors' names, each (n,)."""
    with needed(path).open(encoding="utf-8") as file:
        names = file.readline().strip().split(",")
        table = np.loadtxt(file, delimiter=",")
    return dict(zip(names, table.T, strict=True))


def read_record(path: Path, torque: str = "tau_meas", step: float = STEP) -> Log:
    """A record on an even grid, torques as means over its steps.

    Args:
        path: of the CSV.
        torque: "tau_meas" or "tau_con", what was measured or what was commanded.
        step: of the grid [s].
    """
    column = read_table(path)
    inputs = {f"tau{k}": column[f"{torque}{k}"] for k in (1, 2)}
    outputs = {f"q{k}": column[f"pos_meas{k}"] for k in (1, 2)}
    units = {**dict.fromkeys(inputs, "N m"), **dict.fromkeys(outputs, "rad")}
    return gridded(
        column["time"], inputs, outputs, units=units, name=path.stem, step=step, widest=WIDEST,
        means=True,
    )  # fmt: skip


def evidence_of(data: Path) -> dict[str, object]:
    """What `robots.double_pendulum_evidence` measures."""
    from robots.double_pendulum_evidence import evidence

    return evidence(data)


def read(data: Path) -> MeasuredRobot:
    """The double pendulum from the folder of all data."""
    folder = needed(data / "double_pendulum")
    fit, confirm = (
        tuple(read_record(folder / f"sys_id_{k}.csv") for k in names) for names in (FIT, CONFIRM)
    )
    identified = published_model(data, "2.0")
    published = sizes_of(identified)
    return MeasuredRobot(
        name="double_pendulum", title="Double pendulum, two quasi-direct drives", source=SOURCE,
        model=MODEL, free=FREE, horizon=0.2, fit=fit, confirm=confirm,
        published=tuple(
            PublishedSize(name=p.name, value=published[p.name], unit=p.unit,
                          source=f"model 2.0, {SOURCE}")
            for p in FREE if p.name in published
        ),
        models=(PublishedModel(name="model 2.0", source=SOURCE,
                               errors=partial(published_errors, identified)),),
        lacking={"its model without friction": tuple(
            p.name for p in FREE if p.name.startswith("coulomb_friction")
        )},
        evidence=lambda _: evidence_of(data),
    )  # fmt: skip
