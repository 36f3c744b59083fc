"""The drives of a robot that an experiment may use, and the torques that move it as wanted.

τ = M(q) q̈ + c(q, q̇) + g(q) - springs and dampers,      u = (τ/gear - bias)/gain
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np


@dataclass(frozen=True)
class Drive:
    """An actuator that pushes one joint: force = gain u + constant + along q + against q̇."""

    dof: int
    qpos: int  # its position's place
    gear: float
    gain: float
    bias: tuple[float, float, float]

    @property
    def is_servo(self) -> bool:
        """Tells whether its input is a position."""
        return self.bias[1] != 0

    def input(self, torque: float, q: float, v: float) -> float:
        """Returns the input that makes a torque."""
        constant, along, against = self.bias
        bias = constant + self.gear * (along * q + against * v)
        return (torque / self.gear - bias) / self.gain


def drives_of(model: mujoco.MjModel, count: int) -> tuple[Drive | None, ...]:
    """Returns the drives of the first actuators; None where an actuator is anything else."""
    out: list[Drive | None] = []
    for i in range(count):
        j, gain = int(model.actuator_trnid[i, 0]), float(model.actuator_gainprm[i, 0])
        is_plain = (
            model.actuator_trntype[i] == mujoco.mjtTrn.mjTRN_JOINT
            and model.actuator_dyntype[i] == mujoco.mjtDyn.mjDYN_NONE
            and model.actuator_gaintype[i] == mujoco.mjtGain.mjGAIN_FIXED
            and model.actuator_biastype[i] <= int(mujoco.mjtBias.mjBIAS_AFFINE)
            and model.jnt_type[j] >= int(mujoco.mjtJoint.mjJNT_SLIDE)
        )
        gear = float(model.actuator_gear[i, 0])
        if not (is_plain and gain and gear):
            out.append(None)
            continue
        affine = model.actuator_biastype[i] == mujoco.mjtBias.mjBIAS_AFFINE
        b = model.actuator_biasprm[i, :3] if affine else np.zeros(3)
        bias = (float(b[0]), float(b[1]), float(b[2]))
        dof, place = int(model.jnt_dofadr[j]), int(model.jnt_qposadr[j])
        out.append(Drive(dof, place, gear, gain, bias))
    return tuple(out)


def torque_for(model: mujoco.MjModel, data: mujoco.MjData, wanted: np.ndarray) -> np.ndarray:
    """Returns the torques (nv,) that accelerate a model as wanted, but for friction."""
    mujoco.mj_fwdPosition(model, data)
    mujoco.mj_fwdVelocity(model, data)
    torque = np.zeros(model.nv)
    mujoco.mj_mulM(model, data, torque, wanted)
    helped = data.qfrc_spring + data.qfrc_damper + data.qfrc_gravcomp
    return np.asarray(torque + data.qfrc_bias - helped)
