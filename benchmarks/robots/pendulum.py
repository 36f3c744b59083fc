"""A pendulum with a quasi-direct drive that swings up under six controllers; and once with 1 kg.

    (m l² + J_a) q̈ = τ - F_v q̇ - F_c sign q̇ + f_0 - m g l sin q       τ measured [N m] -> q [rad]

l = 0.5 m is nominal. Each controller has a loop of its own; `robots.pendulum_evidence` measures by
how much torque and motion are shifted against each other.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from identification import Log
from identification.windows.windows import windows
from robots import needed
from robots.measured_robot import (
    MODELS,
    Apart,
    Free,
    MeasuredRobot,
    PublishedModel,
    PublishedSize,
    gridded,
)
from robots.window_starts import best_errors

STEP, SLOW = 0.01, 0.02  # of the grid, and of the one record that is no faster [s]
WIDEST = 0.05  # gap that is still bridged [s]
FIT = ("ddp", "direct_collocation", "energy_shaping")
CONFIRM = ("system_identification", "ilqr", "sac")
HEAVY = "energy_shaping_1kg"
# Seconds before a hand pushes the pendulum, to show that its controller holds it: from then on the
# drive gives up to 0.8 N m and nothing moves. All of a record is used where nothing is said.
UNTOUCHED = {"energy_shaping": 6.0, "sac": 6.5, "ilqr": 2.7, HEAVY: 8.0}
SOURCE = "DFKI, github.com/dfki-ric-underactuated-lab/torque_limited_simple_pendulum"
LENGTH, G = 0.5, 9.81  # [m], [m/s^2]
SIMULATED = 2.5e-4  # step in which their model is simulated; their friction is steep [s]
FREE = (
    Free(name="m", path="body/arm.mass", value=0.5, unit="kg"),
    Free(name="J_a", path="joint/hinge.armature", value=0.01, known=1.0, unit="kg m^2"),
    Free(name="F_v", path="joint/hinge.damping", value=0.02, known=1.0, unit="N m s/rad"),
    Free(name="coulomb_friction.f_c@hinge", value=0.15, unit="N m"),
    Free(name="offset.f_0@hinge", value=0.0, known=0.1, unit="N m", scale=0.05),
)
# Their fit of one record: J, m l, F_v, the Coulomb level (F_c atan(100 v), so times π/2), offset.
PUBLISHED_FIT = {"J": 0.06259, "ml": 0.1022, "F_v": 0.04707, "F_c": 0.1839, "offset": -0.07586}
PUBLISHED = (
    PublishedSize(name="m l^2 + J_a", value=0.06259, unit="kg m^2", source=SOURCE),
    PublishedSize(name="m l", value=0.1022, unit="kg m", source=SOURCE),
    PublishedSize(name="F_v", value=0.04707, unit="N m s/rad", source=SOURCE),
    PublishedSize(name="coulomb_friction.f_c@hinge", value=0.1839 * np.pi / 2, unit="N m",
                  source=SOURCE),
    PublishedSize(name="offset.f_0@hinge", value=0.07586, unit="N m", source=SOURCE),
)  # fmt: skip


def read_columns(path: Path) -> np.ndarray:
    """Time [s], angle [rad], speed [rad/s] and torque [N m] as they were measured, shape (n, 4)."""
    return np.loadtxt(needed(path), delimiter=",", skiprows=1)


def read_record(path: Path) -> Log:
    """A record on an even grid; where the grid is coarser, its torque is the mean over a step."""
    table = read_columns(path)
    time, angle, _, torque = table[table[:, 0] <= UNTOUCHED.get(path.stem, np.inf)].T
    slow = np.median(np.diff(time)) > STEP
    return gridded(
        time, {"torque": torque}, {"angle": angle}, units={"torque": "N m", "angle": "rad"},
        name=path.stem, step=SLOW if slow else STEP, widest=WIDEST, means=not slow,
    )  # fmt: skip


def published_errors(log: Log, horizon: float) -> np.ndarray:
    """Window errors of the authors' fit, each window from its best first state, (W, L, 1)."""
    cut, p, h = windows(log, horizon), PUBLISHED_FIT, log.sampling_time
    rate = np.gradient(log.outputs[:, 0], h)[cut.starts]

    def acceleration(q: np.ndarray, v: np.ndarray, torque: np.ndarray) -> np.ndarray:
        friction = p["F_v"] * v + p["F_c"] * np.arctan(100 * v) + p["offset"]
        return (torque - friction - G * p["ml"] * np.sin(q)) / p["J"]

    def angles(first: np.ndarray) -> np.ndarray:
        q, v = first.T.copy()
        found, n = [q], round(h / SIMULATED)
        for k in range(cut.inputs.shape[1] - 1):
            for i in range(n):
                s = (i + 0.5) / n
                torque = (1 - s) * cut.inputs[:, k, 0] + s * cut.inputs[:, k + 1, 0]
                v = v + h / n * acceleration(q, v, torque)
                q = q + h / n * v
            found.append(q)
        return np.stack(found, axis=1)[:, :, None]

    first = np.column_stack([cut.outputs[:, 0, 0], rate])
    return best_errors(angles, cut.outputs, first, np.array([0.1, 1.0]))


def evidence_of(folder: Path) -> dict[str, object]:
    """What `robots.pendulum_evidence` measures."""
    from robots.pendulum_evidence import evidence

    return evidence(folder)


def read(data: Path) -> MeasuredRobot:
    """The pendulum from the folder of all data."""
    folder = needed(data / "pendulum")
    fit, confirm, heavy = (
        tuple(read_record(folder / f"{name}.csv") for name in names)
        for names in (FIT, CONFIRM, (HEAVY,))
    )
    return MeasuredRobot(
        name="pendulum", title="Torque-limited pendulum, quasi-direct drive", source=SOURCE,
        model=MODELS / "pendulum.xml", free=FREE, horizon=0.2, fit=fit, confirm=confirm,
        apart=(Apart(what="1 kg instead of 0.5 kg", logs=heavy, refit=("m", "J_a")),),
        published=PUBLISHED,
        models=(PublishedModel(name="their fit", source=SOURCE, errors=published_errors),),
        evidence=lambda _: evidence_of(folder),
    )  # fmt: skip
