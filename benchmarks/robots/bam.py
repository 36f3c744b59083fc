"""The friction models M1 to M6 of BAM for a servo with a pendulum, and their simulator.

    τ_m = K_t (V - K_t ω)/R                         the motor
    τ_e = -m 9.80665 l sin(q + q_0)                 gravity
    F   = f_b + e_s f_s + load, and friction is at most F + d |ω|;   e_s = exp(-|ω/ω_s|^α)
    load = (k_b + k_s e_s) |τ_e - τ_m|                                          M3, M4 (M1, M2: 0)
         = |k_e τ_e - k_m τ_m| + e_s |k_es τ_e - k_ms τ_m|                      M5
         + e_s (κ_e τ_e² where |τ_e| < |τ_m|, else κ_m τ_m²), where their signs differ    M6

A step of Euler: friction is the torque that would stop the joint within it, but at most that much.
Duclusaud, Passault, Padois, Ly, "Extended Friction Models for the Physics Simulation of Servo
Actuators", arXiv 2410.08650; parameters by their names in the JSON files of github.com/Rhoban/bam.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from identification import Log
from identification.windows.windows import Windows, windows
from robots.window_starts import best_errors

MASS, ARM, G = 0.49, 0.1, 9.80665  # [kg], [m], [m/s^2]
STEPS = 4  # of the simulator in a sample
DUTY = 4096 / (2 * np.pi) / (256 * 885)  # of a full bridge, for a gain of one and an error [1/rad]

Volts = Callable[[float, np.ndarray], np.ndarray]


def friction(
    p: Mapping[str, float], motor: np.ndarray, external: np.ndarray, speed: np.ndarray
) -> np.ndarray:
    """The largest friction at some speed [N m], viscous friction included.

    Args:
        p: parameters by the authors' names; what a model does not have is left out.
        motor: torque of the motor [N m].
        external: torque of gravity [N m].
        speed: of the joint [rad/s].
    """
    value = p.get
    slow = np.zeros_like(speed)
    if "dtheta_stribeck" in p:
        slow = np.exp(-(np.abs(speed / p["dtheta_stribeck"]) ** p["alpha"]))
    level = value("friction_base", 0.0) + slow * value("friction_stribeck", 0.0)
    load = np.abs(external - motor)
    level = level + (value("load_friction_base", 0.0)
                     + slow * value("load_friction_stribeck", 0.0)) * load  # fmt: skip
    for ending, weight in (("", 1.0), ("_stribeck", slow)):
        of_motor = value(f"load_friction_motor{ending}", 0.0) * motor
        of_load = value(f"load_friction_external{ending}", 0.0) * external
        level = level + weight * np.abs(of_load - of_motor)
    opposed = np.sign(external) != np.sign(motor)
    driven = np.abs(external) < np.abs(motor)
    held = np.abs(external) > np.abs(motor)
    level = level + slow * opposed * (
        driven * value("load_friction_external_quad", 0.0) * external**2
        + held * value("load_friction_motor_quad", 0.0) * motor**2
    )
    return level + value("friction_viscous", 0.0) * np.abs(speed)


def simulate(
    p: Mapping[str, float], volts: Volts, first: np.ndarray, samples: int, step: float
) -> np.ndarray:
    """Angles at the samples of windows, shape (W, L) [rad].

    Args:
        p: parameters by the authors' names.
        volts: of the motor, shape (W,) [V], at a time in samples and an angle (W,) [rad].
        first: angle [rad] and speed [rad/s] of each window, shape (W, 2).
        samples: L.
        step: between two samples [s].
    """
    q, w = first.T.copy()
    h, inertia = step / STEPS, MASS * ARM**2 + p["armature"]
    angles = [q]
    for k in range(STEPS * (samples - 1)):
        v = volts((k + 0.5) / STEPS, q)
        motor = p["kt"] * (v - p["kt"] * w) / p["R"]
        external = -MASS * G * ARM * np.sin(q + p["q_offset"])
        stop = inertia / h * w + motor + external
        most = friction(p, motor, external, w)
        a = (motor + external - np.sign(stop) * np.minimum(np.abs(stop), most)) / inertia
        w = w + h * a
        q = q + h * w
        if (k + 1) % STEPS == 0:
            angles.append(q)
    return np.stack(angles, axis=1)


def measured_volts(volts: np.ndarray) -> Volts:
    """Straight lines between the samples of windows, shape (W, L) [V]."""
    return lambda at, _: _between(volts, at)


def servo_volts(goals: np.ndarray, supply: np.ndarray, gain: float) -> Volts:
    """What the servo's own controller gives for an angle: duty, clipped, times supply.

    Args:
        goals: of the angle, shape (W, L) [rad].
        supply: shape (W, L) [V].
        gain: k_p of its registers.
    """

    def volts(at: float, q: np.ndarray) -> np.ndarray:
        duty = gain * DUTY * (_between(goals, at) - q)
        clipped: np.ndarray = np.clip(duty, -1, 1) * _between(supply, at)
        return clipped

    return volts


def _between(x: np.ndarray, at: float) -> np.ndarray:
    k = int(at)
    between: np.ndarray = (1 - at + k) * x[:, k] + (at - k) * x[:, k + 1]
    return between


def _first(log: Log, cut: Windows) -> np.ndarray:
    """Measured angles and rates at the beginning of windows, shape (W, 2)."""
    rate = np.gradient(log.outputs[:, 0], log.sampling_time)[cut.starts]
    return np.column_stack([cut.outputs[:, 0, 0], rate])


def errors(p: Mapping[str, float], log: Log, horizon: float) -> np.ndarray:
    """Window errors of a model under measured volts, from the best first states, (W, L, 1)."""
    cut = windows(log, horizon)
    volts, samples = measured_volts(cut.inputs[:, :, 0]), cut.inputs.shape[1]
    return best_errors(
        lambda x: simulate(p, volts, x, samples, log.sampling_time)[:, :, None],
        cut.outputs, _first(log, cut), np.array([0.1, 1.0]),
    )  # fmt: skip


def servo_errors(p: Mapping[str, float], log: Log, gain: float) -> np.ndarray:
    """Errors of a whole record as the authors judge it: the servo's controller in the loop.

    Args:
        p: parameters by the authors' names.
        log: its inputs are the goal [rad] and the supply [V].
        gain: k_p of its registers.

    Returns:
        Shape (L,) [rad], begun at the first sample at its measured rate.
    """
    cut = Windows(log.inputs[None], log.outputs[None], np.zeros(1, int))
    goals, supply = cut.inputs[:, :, 0], cut.inputs[:, :, 1]
    volts = servo_volts(goals, supply, gain)
    angles = simulate(p, volts, _first(log, cut), len(log), log.sampling_time)
    left: np.ndarray = log.outputs[:, 0] - angles[0]
    return left
