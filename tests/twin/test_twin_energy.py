"""Energy: over a run of the twin, what its motors, frictions and cables do is what it stores."""

import numpy as np
import pytest
from scipy.integrate import simpson
from twin_cases import every_step, forward, moving

from identification.model.rollout import State
from inca_mj.robot.parameters import GRAVITY, parameter_set
from inca_mj.twin.twin import build_twin

STEP = 2.5e-4
CURRENT = np.array([1.0, 0.5, 1.0, 0.5, 0.5, 1.0, 1.0, 0.5])


def ledger(p, start, T_0, steps=800):
    """Stored energy (N,), powers (5, N) and tensions (N, 8) along a run of the twin."""
    robot = build_twin(p, timestep=STEP)
    currents = np.tile(CURRENT, (steps + 1, 1))
    at = State(**every_step(robot, start, currents))
    d, d_rate, sensors = forward(
        robot.model, at, currents, ("ten_length", "ten_velocity", "sensordata")
    )
    first = robot.model.sensor("tension_1").adr[0]
    T = sensors[:, first : first + 8]
    v = p.values()
    φ, ω, d_0 = at.qpos[:, 7:], at.qvel[:, 6:], at.act
    ε = np.maximum(0, d / d_0 - 1)
    d_0_rate = -v["R"] * ω * d_0 / d

    inertia = np.array([v["m"]] * 3 + [v["I_x"], v["I_y"], v["I_z"]] + [v["J"]] * 8)
    s = v["R_s"] * φ
    stored = (
        0.5 * at.qvel**2 @ inertia
        + v["m"] * GRAVITY * at.qpos[:, 2]
        + np.sum(0.5 * v["lambda"] * ε**2 * d_0, axis=1)
        - np.sum((v["R"] / v["R_s"] * T_0 - 0.5 * v["k_s"] * s) * s, axis=1)
    )
    powers = np.array(
        [
            v["K_t"] * CURRENT * ω,
            -v["b_v"] * ω**2,
            -v["b_c"] * np.tanh(v["beta"] * ω) * ω,
            -(T - v["lambda"] * ε) * (d_rate - d / d_0 * d_0_rate),
            0.5 * v["lambda"] * ε**2 * d_0_rate,  # strain that is wound onto the rollers
        ]
    ).sum(axis=2)
    return stored, powers, T


@pytest.mark.parametrize("losses", [False, True])
def test_the_balance_closes(losses):
    p = parameter_set("trial", {} if losses else {"b": 0.0, "b_v": 0.0, "b_c": 0.0})
    stored, powers, T = ledger(p, moving(4), build_twin(p).start.tension)
    work = simpson(powers, dx=STEP, axis=1)
    exchanged = simpson(np.abs(powers).sum(axis=0), dx=STEP)
    assert T.min() > 0
    assert stored[-1] - stored[0] == pytest.approx(work.sum(), abs=1e-7 * exchanged)
    assert abs(work[4]) > 1e-6 * exchanged  # without the wound strain it would not close
    if losses:
        assert work[1:4].max() < 0
    else:
        np.testing.assert_allclose(work[1:4], 0, atol=1e-12 * exchanged)


def test_the_balance_closes_while_cables_turn_slack_and_taut():
    p, start = parameter_set(), build_twin().state()
    start.qvel[:3] = 0.5, 0.3, 0.4
    stored, powers, T = ledger(p, start, build_twin(p).start.tension, steps=400)
    work = simpson(powers, dx=STEP, axis=1).sum()
    assert (T == 0).any(axis=0).sum() >= 2
    # A kink within a step costs RK4 and Simpson their order.
    exchanged = simpson(np.abs(powers).sum(axis=0), dx=STEP)
    assert stored[-1] - stored[0] == pytest.approx(work, abs=1e-3 * exchanged)
