"""A position servo whose command has a unit of its own, such as 0 to 255 of a gripper.

    F = g u + b_0 + b_1 l + b_2 dl/dt = kp (s u + o - l) - kv dl/dt

    kp = -b_1,  kv = -b_2                   its gains
    s = g/kp,   o = b_0/kp                  the length that a command means, which is s u + o

g is gainprm[0], b_k is biasprm[k], u the command and l the length of the actuator: of a joint, or
of a tendon. A <position> has s = 1 and o = 0. A gain that is fitted leaves s and o as they are,
because what a command means is told by who built the servo.
"""

from __future__ import annotations

import mujoco

_FIXED, _AFFINE = int(mujoco.mjtGain.mjGAIN_FIXED), int(mujoco.mjtBias.mjBIAS_AFFINE)


def is_scaled_servo(model: mujoco.MjModel, row: int) -> bool:
    """Returns whether an actuator pulls its length to a multiple of its command that is not 1."""
    if (int(model.actuator_gaintype[row]), int(model.actuator_biastype[row])) != (_FIXED, _AFFINE):
        return False
    gain, bias = float(model.actuator_gainprm[row, 0]), model.actuator_biasprm[row]
    return bool(gain and bias[1] < 0 and bias[1] != -gain)


def scaling(model: mujoco.MjModel, row: int) -> tuple[float, float]:
    """Returns s and o, of the length s u + o that a command u of a scaled servo means."""
    gain, bias = float(model.actuator_gainprm[row, 0]), model.actuator_biasprm[row]
    return gain / -float(bias[1]), float(bias[0]) / -float(bias[1])
