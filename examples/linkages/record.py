"""Record two logs of each robot of this folder, with an effect that its model does not have.

A robot is simulated with a quarter of its model's step. Dry friction is MuJoCo's, springs and
forces are added to the joint. Run it: python examples/linkages/record.py FOLDER
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

HERE = Path(__file__).parent
SAMPLING, SECONDS, FINER = 0.01, 8.0, 4  # [s], [s], steps of the simulation in one of the model
STIFF = (0.002, 1.0)  # how dry friction holds: time constant [s] and damping ratio


@dataclass(frozen=True)
class Truth:
    """What a robot is driven with, and what its model lacks."""

    joint: str  # where
    effect: str  # as a search calls it
    size: float  # of it, in SI units
    columns: tuple[str, ...]  # of outputs: joints or tendons
    noise: float  # std of the outputs [m or rad]
    middle: float  # of the inputs; NaN for the lengths that hold the load
    reach: float  # of the inputs about the middle


ROBOTS = {
    "leg": Truth("knee", "coulomb_friction", 0.6, ("hip", "knee"), 3e-4, -0.3, 0.6),
    "cart": Truth("rail", "coulomb_friction", 1.2, ("x",), 2e-4, 0.0, 6.0),
    "four_bar": Truth(
        "crank", "coulomb_friction", 0.04, ("crank_angle", "pin_angle", "rocker_angle"), 3e-4, 0.0,
        0.25,
    ),
    "crane": Truth(
        "x", "coulomb_friction", 3.0, ("rope_left", "rope_right"), 1e-4, np.nan, 0.25
    ),
}  # fmt: skip


def compiled(path, truth):
    """The robot with a finer step, and with its dry friction where it has some."""
    spec = mujoco.MjSpec.from_file(str(path))
    spec.option.timestep /= FINER
    if truth.effect == "coulomb_friction":
        joint = spec.joint(truth.joint)
        joint.frictionloss, joint.solref_friction[:] = truth.size, STIFF
    return spec.compile()


def force(truth, q):
    """The force of a hidden spring at its joint [N m]; dry friction is in the model."""
    if truth.effect == "hardening":
        return -truth.size * q**3
    if truth.effect != "coulomb_friction":
        raise ValueError(f"unknown effect {truth.effect!r}; known: coulomb_friction, hardening")
    return 0.0


def measured(model, data, name):
    """What a joint or a tendon of that name is at [rad or m]."""
    names = [model.sensor(k).name for k in range(model.nsensor)]
    if name in names:
        return data.sensordata[model.sensor_adr[names.index(name)]]
    return data.qpos[model.joint(name).qposadr[0]]


def record(path, truth, seed):
    """One log: times, inputs and outputs in SI units, shape (N, 1 + nu + ny), and its header."""
    model, chance = compiled(path, truth), np.random.default_rng(seed)
    data, time = mujoco.MjData(model), np.arange(round(SECONDS / SAMPLING)) * SAMPLING
    mujoco.mj_forward(model, data)
    middle = data.ten_length if np.isnan(truth.middle) else truth.middle
    waves = chance.uniform(0.1, 1.6, (5, model.nu)), chance.uniform(0, 2 * np.pi, (5, model.nu))
    shape = np.sin(2 * np.pi * waves[0] * time[:, None, None] + waves[1]).sum(1) / 2.5
    inputs = np.round(middle + truth.reach * shape, 4)
    joint, rows = model.joint(truth.joint), []
    for u in inputs:
        mujoco.mj_forward(model, data)
        rows.append([measured(model, data, c) for c in truth.columns])
        data.ctrl[:] = u
        for _ in range(round(SAMPLING / model.opt.timestep)):
            data.qfrc_applied[joint.dofadr[0]] = force(truth, data.qpos[joint.qposadr[0]])
            mujoco.mj_step(model, data)
    outputs = np.array(rows) + truth.noise * chance.standard_normal((len(time), len(rows[0])))
    drives = [model.actuator(k).name for k in range(model.nu)]
    header = ",".join(("time", *drives, *truth.columns))
    return np.column_stack([time, inputs, np.round(outputs, 6)]), header


def write(folder):
    """Write both logs of each robot into the folder of the robot there."""
    for name in ROBOTS:
        (Path(folder) / name).mkdir(exist_ok=True)
        for log, seed in (("first", 1), ("second", 2)):
            table, header = record(HERE / name / "model.xml", ROBOTS[name], seed)
            path = Path(folder) / name / f"{log}.csv"
            np.savetxt(path, table, "%.7g", ",", header=header, comments="")


if __name__ == "__main__":
    write(sys.argv[1])
