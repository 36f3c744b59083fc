"""Outputs of whose motion a model explains nothing: of another robot, or moved by another drive.

    ε = Σ ‖e - ē‖² / Σ ‖y - ȳ‖²,  e = y - ŷ       ȳ: mean of the window; ē: of all windows, by time

A fit always ends with some values, also where the log is that of another robot with columns of the
same names, or where a motor moves a joint for which the model has none. What such a fit leaves is
no small error: a constant would do as well. The mean error ē is left out, because a load that the
model lacks makes much of it, also where the model follows each motion. Along a free run the fit in
per cent tells the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from identification.discovery.result import Discovery
from identification.effects.axes import drives_of
from identification.estimation.fit import Fit
from identification.logs.names import listed
from identification.logs.noise import noise_floor
from identification.model.predictor import output_dofs
from identification.model.rollout import UNLOGGED
from identification.prediction.fits.model import WindowModel
from identification.refusals.far_angles import far_sentence
from identification.robot.results.results import RobotFit
from identification.robot.robot import Robot
from identification.shares import percent

# ε of an output of which next to nothing is explained; a fit always explains a little.
NOTHING = 0.8
# ε of an output whose joint has no drive, in a log with columns that nothing reads.
UNDRIVEN = 0.3
NOISE = 3.0  # times the noise, that an error must be, and the motion
LARGE = 0.02  # of the variance over the whole log, that an error must be
_DIRECT = int(mujoco.mjtTrn.mjTRN_JOINT)


@dataclass(frozen=True)
class Unexplained:
    """An output of whose motion a model explains nothing, or little where no drive moves it."""

    output: str
    joint: str
    share: float  # of its motion that is explained, 1 - ε, at least 0
    over: str  # what ε is of, in words
    model: str  # the file of the model
    is_driven: bool  # whether an actuator of the model moves the joint
    unread: tuple[str, ...] = ()  # columns of the log that nothing reads
    hint: str = ""  # what its numbers may be

    def __str__(self) -> str:
        less = f"explains {percent(self.share)} of the motion of {self.output} {self.over}"
        if not self.is_driven:
            unread = f" (nothing reads {listed(self.unread)} of the log)" if self.unread else ""
            return (
                f"No actuator of {self.model} moves joint {self.joint}, and the model {less}: if a"
                f" motor moves it, add that actuator to the model{unread}."
            )
        hint = f" {self.hint[:1].upper()}{self.hint[1:]}." if self.hint else ""
        return (
            f"The model {less}, hardly more than a constant would. Either the log is of another"
            f" robot, or {self.output} of another joint or in another unit, or the model lacks a"
            f" large force at joint {self.joint}, such as a friction that holds it: do not use the"
            f" values that belong to this joint.{hint}"
        )

    @property
    def finding(self) -> dict[str, str | float]:
        """It as a finding of JSON."""
        return {"kind": "unexplained output", "output": self.output, "share": self.share}


def find_unexplained(robot: Robot, found: RobotFit | Discovery) -> tuple[Unexplained, ...]:
    """Returns the outputs of whose motion a fit, or the model with what is named, explains nothing.

    Where no drive moves a joint, an effect may have been named in its place: there the model
    without effects is asked.
    """
    final, first = _shares(found)
    model, log = robot.plant.model, robot.log
    unread, hint = log.unread, far_sentence(model, log, robot.file.columns)
    out = []
    for k, dof in enumerate(output_dofs(model, log.output_names)):
        joint, is_driven = int(model.dof_jntid[dof]), _is_driven(model, int(model.dof_jntid[dof]))
        share, most = (final[k], NOTHING) if is_driven or not unread else (first[k], UNDRIVEN)
        if share < most:
            continue
        out.append(Unexplained(
            log.output_names[k], model.joint(joint).name, max(0.0, 1 - float(share)), _over(found),
            robot.file.model.name, is_driven, unread, hint,
        ))  # fmt: skip
    return tuple(out)


def _shares(found: RobotFit | Discovery) -> tuple[np.ndarray, np.ndarray]:
    """Returns ε (ny,) of the last model and of that without effects; zero for what may be noise."""
    if isinstance(found, RobotFit):
        fit = found.found
        if isinstance(fit, Fit):
            is_clear = np.sqrt(np.mean(fit.residual**2, axis=0)) > NOISE * fit.floor
            both = np.where(is_clear, (1 - fit.fit_percent / 100) ** 2, 0.0)
        else:
            both = _of_windows(fit.model)
        return both, both
    each = [_of_windows(m) if isinstance(m, WindowModel) else None
            for m in (found.final, found.nominal)]  # fmt: skip
    none = np.zeros(len(found.outputs))
    last, first = (none if share is None else share for share in each)
    return last, first


def _of_windows(model: WindowModel) -> np.ndarray:
    parts, errors = model.fit.problem.parts, model.fit.errors
    each = [part.cut.outputs for part in parts]
    moved, left, whole = (
        np.mean(np.concatenate([np.mean(x**2, axis=1) for x in of]), axis=0)
        for of in (
            [y - y.mean(axis=1, keepdims=True) for y in each],
            [e - e.mean(axis=0) for e in errors],
            [y - y.mean(axis=(0, 1)) for y in each],
        )
    )
    noise = np.max([noise_floor(part.predictor.log.outputs) for part in parts], axis=0)
    is_clear = (np.sqrt(np.minimum(moved, left)) > NOISE * noise) & (left > LARGE * whole)
    return np.where(is_clear, left / np.where(moved > 0, moved, 1.0), 0.0)


def _over(found: RobotFit | Discovery) -> str:
    horizon = found.found.horizon if isinstance(found, RobotFit) else found.horizon
    return "along its free run" if horizon is None else f"within windows of {horizon:g} s"


def _is_driven(model: mujoco.MjModel, joint: int) -> bool:
    """Returns whether an actuator moves a joint, or may: over a tendon, or over tied bodies."""
    kinds = {int(kind) for i, kind in enumerate(model.actuator_trntype)
             if not model.actuator(i).name.startswith(UNLOGGED)}  # fmt: skip
    return bool(model.neq) or kinds > {_DIRECT} or bool(drives_of(model, joint))
