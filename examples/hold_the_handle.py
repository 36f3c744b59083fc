"""Hold the platform against a hand: a PID law on the pose, shared among eight pulling cables.

    w = K_p e + K_i ∫e dt - K_d v + (0, 0, m g, 0, 0, 0)      wrench to give [N, N m]
    T = t₀ + W⁺ (w - W t₀)                                    tensions nearest to t₀
    i = (R T - R_s F_s) / K_t                                 currents; the drum spring helps

Run it: python examples/hold_the_handle.py
"""

import numpy as np

from inca_mj import (
    CONTROL_TIMESTEP,
    GRAVITY,
    INCA,
    build_twin,
    euler,
    length_jacobian,
    load_environment,
    parameter_set,
    rotation,
    spring_force,
)

p = parameter_set().values()
WEIGHT = np.array([0, 0, p["m"] * GRAVITY, 0, 0, 0])
SPRING_BALANCE = build_twin().start.tension  # T(0) of the drum springs [N]
T_0 = 7.0  # tension to stay near to [N]: above the springs' 4 N, so that all motors pull
K_P = np.array([150.0] * 3 + [0.5] * 3)  # [N/m, N m/rad]
K_I = np.array([250.0] * 3 + [0.5] * 3)  # [N/(m s), N m/(rad s)]
K_D = np.array([20.0] * 3 + [0.05] * 3)  # [N s/m, N m s/rad]


class Controller:
    """From an observation to eight currents [A]."""

    def __init__(self):
        self.sum = np.zeros(6)  # ∫e dt

    def __call__(self, seen):
        """One control step."""
        angles = euler(seen["orientation"])
        error = np.concatenate([seen["target"] - seen["position"], -angles])
        self.sum += error * CONTROL_TIMESTEP
        J = length_jacobian(seen["position"], rotation(*angles), INCA)
        velocity = np.linalg.pinv(J) @ (-p["R"] * seen["motor_rate"])  # stiff cables
        wrench = K_P * error + K_I * self.sum - K_D * velocity + WEIGHT
        tension = T_0 + np.linalg.pinv(-J.T) @ (wrench + J.T @ np.full(8, T_0))
        spring = [
            spring_force(phi, p["R"], p["R_s"], p["k_s"], T)
            for phi, T in zip(seen["motor_angle"], SPRING_BALANCE, strict=True)
        ]
        return (p["R"] * tension - p["R_s"] * np.array(spring)) / p["K_t"]


def hold(seconds=5.0, seed=0, task="hold"):
    """Distance of the platform from its target [m] and reward, one each control step."""
    env = load_environment(task, random=seed, privileged=True)  # the pose is given to it
    control, step, history = Controller(), env.reset(), []
    for _ in range(round(seconds / CONTROL_TIMESTEP)):
        step = env.step(control(step.observation))
        miss = np.linalg.norm(step.observation["position"] - step.observation["target"])
        history.append((miss, step.reward))
    return np.array(history).T


if __name__ == "__main__":
    for task in ("hold", "reach"):
        miss, reward = hold(task=task)
        print(f"{task}: at most {1e3 * miss.max():.0f} mm away, {1e3 * miss[-1]:.1f} mm at the end,"
              f" mean reward {reward.mean():.2f}")  # fmt: skip
