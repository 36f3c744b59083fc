"""EMPS: an electro-mechanical positioning system, one axis with a ball screw.

    M v̇ = g u - F_v v - f_c sign v + f_0            u [V] -> x [m]; g = 35.15 N/V is known

The files are DATA_EMPS.mat and DATA_EMPS_PULSES.mat (1 kHz), every tenth sample is kept. The first
half of the first record is fitted; its second half and the record with pulses confirm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import loadmat

from identification import (
    JointPlant,
    Log,
    Parameter,
    Predictor,
    axes,
    decimate,
    estimate,
    joint_plant,
    window_error,
)
from identification.effects.plant.rows import read_model
from robots import needed
from robots.measured_robot import (
    PROJECT_MODELS,
    Free,
    MeasuredRobot,
    Outcome,
    PublishedModel,
    PublishedSize,
)

# Free-run rms on the record with pulses [mm]: Champneys et al., arXiv 2405.10779, and dynoNet.
OTHERS = {
    "linear state space": 5.53, "linear ARX": 12.6, "polynomial NARX": 5.17, "SUBNET": 4.61,
    "dynoNet": 2.64,
}  # fmt: skip
F_C, F_0 = "coulomb_friction.f_c@slide", "offset.f_0@slide"
D_A = "asymmetric_viscous_friction.d_a@slide"
BEGUN = {"M": 95.11, "F_v": 203.5, F_C: 20.39, F_0: 3.16, D_A: -36.85}
MODELS = {
    "linear: M, F_v, f_0": ("M", "F_v", F_0),
    "and Coulomb friction": ("M", "F_v", F_0, F_C),
    "and asymmetric viscous friction": ("M", "F_v", F_0, F_C, D_A),
}
MODEL = PROJECT_MODELS / "emps.xml"
EVERY = 10  # samples of 1 ms
SOURCE = "Janot, Gautier, Brunot 2019, nonlinearbenchmark.org"
FREE = (
    Free(name="M", path="body/carriage.mass", value=95.11, known=0.3, unit="kg"),
    Free(name="F_v", path="joint/slide.damping", value=203.5, known=0.3, unit="N s/m"),
    Free(name="coulomb_friction.f_c@slide", value=20.39, known=0.3, unit="N"),
    Free(name="offset.f_0@slide", value=3.16, known=5.0, unit="N", scale=1.0),
)
PUBLISHED = tuple(
    PublishedSize(name=n, value=v, unit=u, source=SOURCE)
    for n, v, u in (
        ("M", 95.11, "kg"), ("F_v", 203.5, "N s/m"), ("coulomb_friction.f_c@slide", 20.39, "N"),
        ("offset.f_0@slide", 3.16, "N"),  # ours pushes: theirs is -3.16
        ("asymmetric_viscous_friction.d_a@slide", 0.5 * (166.7 - 240.4), "N s/m"),
    )
)  # fmt: skip


def read_record(path: Path, every: int = EVERY) -> Log:
    """A record with every n-th sample; the voltage between them as straight lines."""
    data = loadmat(needed(path))
    log = Log(
        time=np.arange(len(data["qm"]), dtype=float) * 1e-3, inputs=data["vir"], outputs=data["qm"],
        input_names=("drive",), output_names=("position",),
        units={"drive": "V", "position": "m"}, name=path.stem,
    )  # fmt: skip
    return decimate(log, every)


def read(data: Path) -> MeasuredRobot:
    """The axis from the folder of all data."""
    log, pulses = (read_record(data / "emps" / f"DATA_EMPS{s}.mat") for s in ("", "_PULSES"))
    first, second = _halves(log)
    return MeasuredRobot(
        name="emps", title="EMPS, one axis with a ball screw", source=SOURCE, model=MODEL,
        free=FREE, horizon=0.2, fit=(first,), confirm=(second, pulses),
        second=((second,), (first, pulses)),
        expected=("asymmetric_viscous_friction",), published=PUBLISHED,
        models=(PublishedModel(name="their values, symmetric friction", source=SOURCE,
                               errors=partial(published_errors, MODEL)),),
        evidence=lambda outcome: protocol(MODEL, log, pulses, outcome),
    )  # fmt: skip


def _halves(log: Log) -> tuple[Log, Log]:
    """The halves of a log, each a record of its own whose time begins at 0 s."""
    n = len(log) // 2
    halves = []
    for rows, what in ((slice(0, n), "first half"), (slice(n, None), "second half")):
        halves.append(
            replace(
                log, time=log.time[rows] - log.time[rows][0], inputs=log.inputs[rows],
                outputs=log.outputs[rows], name=f"{log.name}, {what}",
            )
        )  # fmt: skip
    return halves[0], halves[1]


def protocol(model: Path, log: Log, pulses: Log, outcome: Outcome) -> dict[str, Any]:
    """Free-run rms on the record with pulses [mm], by what was fitted, and of others."""
    plant = plant_of(model, log)
    rows = {}
    for what, names in MODELS.items():
        off = {n: 0.0 for n in (F_C, D_A) if n not in names}
        start = {n: BEGUN[n] for n in names}
        found = estimate(plant.with_values(off), log, (*names, "x_0", "v_0"), start)
        fitted = {**off, **{n: found.values[n] for n in names}}
        rows[what] = 1e3 * free_run(plant, pulses, fitted)
    known = {n: v for n, v in outcome.values.items() if n in plant.parameters.values()}
    rows["fitted over windows of 0.2 s, with what is named"] = 1e3 * free_run(plant, pulses, known)
    return {"free_run_mm": rows, "published_mm": OTHERS}


def published_errors(model: Path, log: Log, horizon: float) -> np.ndarray:
    """Window errors of the authors' values with symmetric friction, shape (W, L, 1)."""
    return window_error(plant_of(model, log), log, horizon)


def plant_of(model: Path, log: Log) -> JointPlant:
    """The axis with the parameters of every model, and its start."""
    records = (
        Parameter(name="M", value=95.11, unit="kg", where="body/carriage.mass", lower=0.0),
        Parameter(name="F_v", value=203.5, unit="N s/m", where="joint/slide.damping", lower=0.0),
        Parameter(name=F_C, value=20.39, unit="N", where="effect", lower=0.0),
        Parameter(name=F_0, value=3.16, unit="N", where="effect"),
        Parameter(name=D_A, value=0.0, unit="N s/m", where="effect", scale=10.0),
        Parameter(name="x_0", value=0.0, unit="m", where="qpos[0]", scale=1e-3),
        Parameter(name="v_0", value=0.0, unit="m/s", where="qvel[0]", scale=1e-2),
    )
    return joint_plant(model, records, log, joints=axes(read_model(model).compile(), log))


def free_run(plant: JointPlant, log: Log, values: Mapping[str, float]) -> float:
    """Rms error of a record [m], begun at its first sample at rest."""
    start = {"x_0": float(log.outputs[0, 0]), "v_0": 0.0}
    y = Predictor(plant, log, (), {**values, **start}).predict(np.empty((1, 0)))[0]
    return float(np.sqrt(np.mean((log.outputs - y) ** 2)))
