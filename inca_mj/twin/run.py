"""A run: what the twin did under some currents; it can be saved and replayed."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from mujoco.batch import Batch

from identification.effects.effect import Effect
from identification.errors import InputError
from identification.model.rollout import State, rollout
from identification.storage.files import read_archive, whole_file
from inca_mj.effects.catalogue import EVERY
from inca_mj.kinematics.rotations import euler
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.saved import twin_from_record, twin_to_record
from inca_mj.twin.twin import Twin

_STAGE = mujoco.mjtStage.mjSTAGE_VEL
_WIDTHS = {
    "currents": 8, "qpos": 15, "qvel": 14, "act": 8, "tension": 8, "length": 8, "asked": 3,
}  # fmt: skip
FEWEST = 2  # samples
UNEVEN = 1e-6  # of a step, by which steps may differ
LONGEST = 86400.0  # [s]
OLDER = {"effects": (), "settled": False}  # of a run that was saved before runs had effects
_ARRAYS = ("time", *_WIDTHS)


@dataclass(frozen=True, kw_only=True)
class Run:
    """N samples of a simulation.

    Attributes:
        twin: the twin that ran.
        time: sample times, shape (N,) [s].
        currents: inputs, shape (N, 8) [A]; sample k is held until k+1.
        qpos: MuJoCo positions, shape (N, 15) [m, -, rad].
        qvel: MuJoCo velocities, shape (N, 14) [m/s, rad/s].
        act: no-load lengths d₀, shape (N, 8) [m].
        tension: cable tensions T, shape (N, 8) [N].
        length: cable lengths d, shape (N, 8) [m].
        asked: positions in O that a controller asked of the platform, shape (N, 3) [m]; None where
            nothing was asked.
    """

    twin: Twin
    time: np.ndarray
    currents: np.ndarray
    qpos: np.ndarray
    qvel: np.ndarray
    act: np.ndarray
    tension: np.ndarray
    length: np.ndarray
    asked: np.ndarray | None = None

    @property
    def position(self) -> np.ndarray:
        """Platform position in O, shape (N, 3) [m]."""
        return self.qpos[:, :3]

    @property
    def angles(self) -> np.ndarray:
        """Roll, pitch, yaw of the platform, shape (N, 3) [rad]."""
        return euler(self.qpos[:, 3:7])

    @property
    def motor_angle(self) -> np.ndarray:
        """Motor angles φ, shape (N, 8) [rad]; a positive angle winds the cable in."""
        return self.qpos[:, 7:]

    @property
    def motor_rate(self) -> np.ndarray:
        """Motor rates ω, shape (N, 8) [rad/s]."""
        return self.qvel[:, 6:]

    def between(self, start: float, end: float) -> Run:
        """Returns the samples from `start` to `end` [s], both included.

        Raises:
            InputError: fewer than two samples are left.
        """
        rows = rows_of(self.time, start, end)
        return replace(self, **{name: array[rows] for name, array in _arrays(self).items()})


def rows_of(time: np.ndarray, start: float, end: float) -> slice:
    """Returns the samples from `start` to `end` [s], both included; refuses fewer than two."""
    rows = slice(
        int(np.searchsorted(time, start, side="left")),
        int(np.searchsorted(time, end, side="right")),
    )
    if rows.stop - rows.start < 2:
        first = "" if start == float("-inf") else f"from {start:g} s "
        raise InputError(f"{first}{end:g} s holds less than two samples; give a longer time")
    return rows


def simulate(
    robot: Twin,
    currents: np.ndarray,
    sampling_time: float = 0.01,
    *,
    start: State | None = None,
    hold_kind: str = "zoh",
) -> Run:
    """Run the twin from its start (or another state) under sampled currents.

    Args:
        robot: the twin.
        currents: shape (N, 8) [A]; sample k is held until sample k+1.
        sampling_time: between samples, a whole number of the model's steps [s].
        start: initial state; the twin's pretensioned start when None.
        hold_kind: "zoh" or "foh".

    Raises:
        InputError: the currents have another shape, or the model's step does not divide the
            sampling time.
        DivergenceError: the simulation left the finite numbers.
    """
    currents = np.asarray(currents, float)
    states = rollout(
        robot.model,
        start or robot.state(),
        currents,
        sampling_time,
        record=("qpos", "qvel", "act"),
        hold_kind=hold_kind,
        before=lambda held: robot.inputs((), np.empty((1, 0)), held, robot.model.opt.timestep),
    )
    at = State(*(states[name][0] for name in ("qpos", "qvel", "act")))
    tension, length = readings(robot, at)
    return Run(
        twin=robot, time=np.arange(len(currents)) * sampling_time, currents=currents,
        qpos=at.qpos, qvel=at.qvel, act=at.act[:, :: robot.layout.states], tension=tension,
        length=length,
    )  # fmt: skip


def readings(robot: Twin, at: State) -> tuple[np.ndarray, np.ndarray]:
    """Returns tensions [N] and cable lengths [m] in given states, each of shape (N, 8)."""
    batch = Batch(robot.model, len(at.qpos), 1)
    for name in ("qpos", "qvel", "act"):
        batch.bind(name)[:] = getattr(at, name)
    sensors = batch.bind("sensordata")
    batch.forward(stage=_STAGE)
    model = robot.model
    first = {name: model.sensor(f"{name}_1").adr[0] for name in ("tension", "length")}
    return tuple(np.array(sensors[:, a : a + DRIVES]) for a in first.values())  # type: ignore[return-value]


def save_run(run: Run, path: str | Path) -> Path:
    """Write a run to one .npz file: arrays, and the robot with its effects as JSON.

    Args:
        run: the result of `simulate`.
        path: where to write; the name ends in .npz.

    Returns:
        The path.

    Raises:
        InputError: the file cannot be written.
    """
    header = twin_to_record(run.twin)
    with whole_file(path) as draft, draft.open("wb") as stream:
        np.savez_compressed(stream, header=json.dumps(header), **_arrays(run))
    return Path(path)


def load_run(path: str | Path, effects: Sequence[Effect] = EVERY) -> Run:
    """Read a run written by `save_run`.

    Args:
        path: of the file.
        effects: the effects that its twin may have; the law of an effect is code and is not saved.

    Raises:
        InputError: the file is missing or is not a run, or its twin has an effect that is not among
            `effects`.
    """
    try:
        file = read_archive(Path(path), "run of inca simulate")
        header: dict[str, Any] = {**OLDER, **json.loads(str(file["header"]))}
        arrays = {name: file[name] for name in _ARRAYS if name != "asked" or name in file}
        _refuse_damaged(arrays, Path(path))
        return Run(twin=twin_from_record(header, effects, Path(path)), **arrays)
    except InputError:
        raise
    except Exception as error:  # zip, JSON and numpy raise different errors
        raise InputError(
            f"{path} is not a run of inca simulate, or is damaged ({type(error).__name__});"
            " write it again"
        ) from error


def _arrays(run: Run) -> dict[str, Any]:
    """Returns the arrays that a run has, by name."""
    every = {name: getattr(run, name) for name in _ARRAYS}
    return {name: array for name, array in every.items() if array is not None}


def _refuse_damaged(arrays: Mapping[str, np.ndarray], path: Path) -> None:
    """Refuses arrays that no simulation gives: another shape, what is not finite, uneven times."""
    n = len(np.atleast_1d(arrays["time"]))
    for name, array in arrays.items():
        shape = (n, _WIDTHS[name]) if name in _WIDTHS else (n,)
        real = array.dtype.kind in "fiu" and array.shape == shape and n >= FEWEST
        if not (real and np.isfinite(array).all()):
            raise InputError(
                f"{path}: {name} is not {n} samples of finite numbers; write the run again"
            )
    steps = np.diff(arrays["time"])
    if not (steps[0] > 0 and np.ptp(steps) < UNEVEN * steps[0] and n * steps[0] < LONGEST):
        raise InputError(
            f"{path}: its times are not evenly apart within a day; write the run again"
        )
