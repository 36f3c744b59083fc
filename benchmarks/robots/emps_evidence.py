"""The protocol of others for EMPS: a free run of 25 s is fitted, and another one is predicted.

    rms of x - x̂ over DATA_EMPS_PULSES, begun at its first sample at rest; fitted to DATA_EMPS

A free run of an axis adds up every disturbance, so this says more of the record than of the law.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from identification import (
    JointPlant,
    Log,
    Parameter,
    Predictor,
    axes,
    estimate,
    joint_plant,
    window_error,
)
from identification.effects.rows import read_model
from robots.measured_robot import Outcome

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
