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

from collections.abc import Mapping

import numpy as np

from identification import Log
from identification.windows.windows import windows
from robots.window_starts import best_errors

MASS, ARM, G = 0.49, 0.1, 9.80665  # [kg], [m], [m/s^2]
STEPS = 4  # of the simulator in a sample


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
    p: Mapping[str, float], volts: np.ndarray, first: np.ndarray, step: float
) -> np.ndarray:
    """Angles at the samples of windows, shape (W, L) [rad].

    Args:
        p: parameters by the authors' names.
        volts: at the samples, straight lines between them, shape (W, L) [V].
        first: angle [rad] and speed [rad/s] of each window, shape (W, 2).
        step: between two samples [s].
    """
    q, w = first.T.copy()
    h, inertia = step / STEPS, MASS * ARM**2 + p["armature"]
    angles = [q]
    for k in range(volts.shape[1] - 1):
        for n in range(STEPS):
            share = (n + 0.5) / STEPS
            v = (1 - share) * volts[:, k] + share * volts[:, k + 1]
            motor = p["kt"] * (v - p["kt"] * w) / p["R"]
            external = -MASS * G * ARM * np.sin(q + p["q_offset"])
            stop = inertia / h * w + motor + external
            most = friction(p, motor, external, w)
            a = (motor + external - np.sign(stop) * np.minimum(np.abs(stop), most)) / inertia
            w = w + h * a
            q = q + h * w
        angles.append(q)
    return np.stack(angles, axis=1)


def errors(p: Mapping[str, float], log: Log, horizon: float) -> np.ndarray:
    """Window errors of a model on a record, each window from its best first state, (W, L, 1)."""
    cut = windows(log, horizon)
    rate = np.gradient(log.outputs[:, 0], log.sampling_time)[cut.starts]
    first = np.column_stack([cut.outputs[:, 0, 0], rate])
    return best_errors(
        lambda x: simulate(p, cut.inputs[:, :, 0], x, log.sampling_time)[:, :, None],
        cut.outputs, first, np.array([0.1, 1.0]),
    )  # fmt: skip
