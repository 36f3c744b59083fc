"""A Dynamixel XL330 servo that swings 0.49 kg on an arm of 0.1 m.

    (m l² + J_a) ẇ = g u - D w - friction + f_0 - m 9.81 l sin q       u = duty × supply [V]

g = K_t/R, and D holds the back-EMF. Four trajectories, each under four gains: records of the gains
100 and 400 are fitted, those of 200 and 800 confirm.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from identification import Log
from robots import bam, needed
from robots.measured_robot import (
    PROJECT_MODELS,
    Free,
    MeasuredRobot,
    PublishedModel,
    PublishedSize,
    gridded,
)

MODEL = PROJECT_MODELS / "xl330.xml"
STEP, WIDEST = 0.01, 0.02  # of the grid, and a gap that is still bridged [s]
FULL = 885  # a load of 100 %
FITTED, HELD = (100, 400), (200, 800)  # gains
SOURCE = "Duclusaud, Passault, Padois, Ly 2024, github.com/Rhoban/bam"
FREE = (
    Free(name="g", path="actuator/motor.gear[0]", value=0.1, known=0.3, unit="N m/V"),
    Free(name="D", path="joint/hinge.damping", value=0.05, known=0.3, unit="N m s/rad"),
    Free(name="J_a", path="joint/hinge.armature", value=0.005, known=0.3, unit="kg m^2"),
    Free(name="coulomb_friction.f_c@hinge", value=0.05, unit="N m"),
    Free(name="offset.f_0@hinge", value=0.0, known=0.02, unit="N m", scale=0.01),
)


def read_columns(path: Path) -> tuple[str, dict[str, np.ndarray]]:
    """Its name, and the columns of a record while its torque is on, each (n,): time [s], angle and
    goal [rad], volts [V], duty."""
    raw = json.loads(path.read_text(encoding="utf-8"))
    on = [entry for entry in raw["entries"] if entry["torque_enable"]]
    keys = {"time": "timestamp", "angle": "position", "goal": "goal_position",
            "supply": "input_volts", "load": "load"}  # fmt: skip
    column = {name: np.array([entry[key] for entry in on], float) for name, key in keys.items()}
    load = column.pop("load")
    column["duty"] = np.where(load > 2**15 - 1, load - 2**16, load) / FULL  # two's complement
    return f"{raw['trajectory']}, k_p {raw['kp']}", column


def read_record(path: Path) -> Log:
    """A record while its torque is on: when it is off, the bridge may be open."""
    name, column = read_columns(path)
    return gridded(
        column["time"], {"motor": column["duty"] * column["supply"]}, {"angle": column["angle"]},
        units={"motor": "V", "angle": "rad"}, name=name, step=STEP, widest=WIDEST,
    )  # fmt: skip


def read_asked(path: Path) -> Log:
    """The same record with what the servo was asked for: goal [rad] and supply [V] as inputs."""
    name, column = read_columns(path)
    inputs = {n: column[n] for n in ("goal", "supply")}
    return gridded(
        column["time"], inputs, {"angle": column["angle"]}, units={"goal": "rad", "angle": "rad"},
        name=name, step=STEP, widest=WIDEST,
    )  # fmt: skip


def in_closed_loop(models: Mapping[str, Mapping[str, float]], folder: Path) -> dict[str, Any]:
    """Mean absolute errors of whole records [mrad], the servo's controller in the loop."""
    logs = [read_asked(path) for path in sorted(folder.glob("*.json"))]
    held = [log for log in logs if gain(log) in HELD]
    found = {
        name.upper(): {log.name: np.abs(bam.servo_errors(p, log, gain(log))).mean() for log in held}
        for name, p in models.items()
    }
    return {"mean_absolute_mrad": {
        name: {log: 1e3 * float(v) for log, v in each.items()} for name, each in found.items()
    }}  # fmt: skip


def gain(log: Log) -> int:
    """The gain k_p under which a record was made."""
    return int(log.name.split()[-1])


def read_model(data: Path, name: str) -> dict[str, float]:
    """The numbers of a friction model of the authors, "m1" to "m6", by their names."""
    path = needed(data / "xl330" / "published" / f"{name}.json")
    said = json.loads(path.read_text(encoding="utf-8"))
    return {key: value for key, value in said.items() if not isinstance(value, str)}


def read(data: Path) -> MeasuredRobot:
    """The servo from the folder of all data."""
    folder = needed(data / "xl330" / "raw")
    logs = [read_record(path) for path in sorted(folder.glob("*.json"))]
    models = {name: read_model(data, name) for name in ("m1", "m3", "m6")}
    published = models["m3"]
    sizes = {
        "g": (published["kt"] / published["R"], "N m/V"),
        "D": (published["kt"] ** 2 / published["R"] + published["friction_viscous"], "N m s/rad"),
        "J_a": (published["armature"], "kg m^2"),
        "coulomb_friction.f_c@hinge": (published["friction_base"], "N m"),
        "transmitted_load_friction.mu@hinge": (published["load_friction_base"], ""),
    }
    return MeasuredRobot(
        name="xl330", title="Dynamixel XL330 servo with a pendulum", source=SOURCE, model=MODEL,
        free=FREE, horizon=0.2, fit=tuple(x for x in logs if gain(x) in FITTED),
        confirm=tuple(x for x in logs if gain(x) in HELD),
        expected=("transmitted_load_friction",),
        models=tuple(
            PublishedModel(name=name.upper(), source=SOURCE, errors=partial(bam.errors, p))
            for name, p in models.items()
        ),
        evidence=lambda _: in_closed_loop(models, folder),
        published=tuple(PublishedSize(name=n, value=v, unit=u, source=f"M3 of {SOURCE}")
                        for n, (v, u) in sizes.items()),
    )  # fmt: skip
