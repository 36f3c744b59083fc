"""Laws of the drives: frictions only brake, currents arrive as they should, drums play.

What the twin has too is compared with it in `test_worlds_base.py`.
"""

import numpy as np
import pytest
from worlds_cases import FINE, angles, fine, plant, prbs, simulate

from inca_mj.reference import layout as base
from inca_mj.reference import rotation_matrix
from inca_mj.studies.worlds import effect as hidden
from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.equations import friction, spring

SAME = 1e-9  # two ways to one trajectory [rad]


@pytest.mark.parametrize(
    "effect",
    [
        hidden("stribeck_friction"),
        hidden("stribeck_friction", exponent=1.0),
        hidden("asymmetric_friction"),
        hidden("load_dependent_friction"),
        hidden("quadratic_friction"),
        hidden("quadratic_friction", exponent=1.5),
        hidden("friction_mismatch", delta=-0.5),
        hidden("position_dependent_friction", a=0.5, b=0.5),
    ],
)
def test_friction_takes_energy_and_never_gives(effect):
    p, rng = plant(effect), np.random.default_rng(1)
    for _ in range(200):
        ω, φ, T = rng.normal(0, 20), rng.normal(0, 30), rng.uniform(0, 20)
        assert ω * friction(ω, φ, 0.0175 * T, p.q, p.D[0]) > 0
    assert friction(0.0, 1.0, 0.1, p.q, p.D[0]) == 0


def test_a_friction_by_the_angle_follows_it():
    p, none = plant(hidden("position_dependent_friction", a=0.2, b=0.1)), plant()
    σ = np.tanh(none.q[base.BETA] * -3.0)
    gain = friction(-3.0, 2.0, 0.05, p.q, p.D[0]) - friction(-3.0, 2.0, 0.05, p.q, none.D[0])
    more = none.q[base.B_C] * (0.2 * np.cos(2) + 0.1 * np.sin(2)) * σ
    assert gain == pytest.approx(more, rel=1e-9)


def test_a_delay_shifts_and_gives_nothing_before():
    u = prbs()
    late, now = angles([hidden("delay", delay=0.03)], u), angles([], u)
    np.testing.assert_allclose(late[3:], now[:-3], atol=SAME)
    np.testing.assert_allclose(late[:4], 0, atol=SAME)


def test_a_delay_inside_a_sample_is_exact():
    u = prbs()
    quarter = np.repeat(u, 4, axis=0)
    shifted = np.vstack([np.zeros((5, 8)), quarter[:-5]])  # 1.25 samples
    np.testing.assert_allclose(
        angles([hidden("delay", delay=0.0125)], u), angles([], shifted, 0.0025)[::4], atol=SAME
    )


def test_a_lagging_current_starts_at_the_first_and_rises_as_an_exponential():
    u = np.ones((40, 8))
    steady = simulate(plant(hidden("current_lag", tau=5e-3)), u)[:, at.HEAT]
    np.testing.assert_allclose(steady[:, 0], np.arange(40) * 0.01, rtol=1e-12)
    u[0], τ, t = 0.0, 5e-3, np.arange(39) * 0.01
    heat = simulate(plant(hidden("current_lag", tau=τ)), u)[1:, at.HEAT]
    e = np.exp(-t / τ)
    expected = t - 2 * τ * (1 - e) + τ / 2 * (1 - e**2)  # ∫ (1 − e^(−t/τ))² dt
    np.testing.assert_allclose(heat[:, 2], expected, atol=1e-9)


def test_saturation_is_another_input():
    u = prbs()
    clipped = angles([hidden("current_saturation", i_max=0.9)], u)
    assert np.array_equal(clipped, angles([], np.clip(u, -0.9, 0.9)))
    soft = angles([hidden("current_saturation", i_max=2.0, soft=True)], u)
    np.testing.assert_allclose(soft, angles([], 2.0 * np.tanh(u / 2.0)), atol=SAME)
    assert hidden("current_saturation", i_max=0.9).scaled(0.5).i_max == pytest.approx(0.95)


def test_a_drift_is_an_input_that_fades():
    u, α = fine(prbs(0.5)), 0.1
    middle = (np.arange(len(u)) + 0.5)[:, None] * FINE
    for drift, loss in (
        (hidden("torque_constant_drift", alpha=α), α * middle),
        (
            hidden("torque_constant_drift", alpha=α, settle=0.2),
            α * 0.2 * (1 - np.exp(-middle / 0.2)),
        ),
    ):
        got = angles([drift], u, FINE)
        np.testing.assert_allclose(got, angles([], u * (1 - loss), FINE), atol=1e-6)
    ones = np.ones((50, 8))
    hot = angles([hidden("torque_constant_drift", alpha=α, heat=True)], 2 * ones)
    np.testing.assert_allclose(
        hot, angles([hidden("torque_constant_drift", alpha=4 * α)], 2 * ones), atol=SAME
    )


def test_a_ripple_in_time_is_another_input():
    u = fine(prbs(0.5))
    middle = (np.arange(len(u)) + 0.5)[:, None] * FINE
    more = 2e-3 * np.sin(2 * np.pi * 5 * middle + 1) / plant().q[base.K_T]
    got = angles([hidden("torque_ripple_time", a=2e-3, frequency=5.0, phase=1.0)], u, FINE)
    np.testing.assert_allclose(got, angles([], u + more, FINE), atol=1e-6)


@pytest.mark.parametrize("h", [0.01, 0.1])
def test_the_drum_plays_behind_the_rotor(h):
    u = fine(prbs())
    X = simulate(plant(hidden("backlash", h=h)), u, FINE, FINE)
    φ, ψ = X[:, base.ANGLES], np.zeros((len(u), 8))
    for k in range(1, len(u)):  # the play operator, sample by sample
        ψ[k] = np.clip(ψ[k - 1], φ[k] - h, φ[k] + h)
    np.testing.assert_allclose(X[:, at.DRUM], ψ, atol=1e-6)
    assert abs(φ - ψ).max() == pytest.approx(h)
    assert (np.diff(φ, axis=0) < 0).any()  # the gap was crossed, so there is a loop
    # R dψ is what leaves the free cable, whatever the rotor did inside the gap
    p = X[:, base.POSITION]
    A, B = plant().q[base.EXITS].reshape(8, 3), plant().q[base.CONNECTORS].reshape(8, 3)
    R_AB = [rotation_matrix(e) for e in X[:, base.EULER]]
    d = np.array([np.linalg.norm(x + B @ R.T - A, axis=1) for x, R in zip(p, R_AB, strict=True)])
    share = X[:, base.NO_LOAD] / d
    wound = np.diff(ψ, axis=0) * 0.0175 * (share[1:] + share[:-1]) / 2
    np.testing.assert_allclose(X[-1, base.NO_LOAD] - X[0, base.NO_LOAD], -wound.sum(0), atol=1e-6)


def test_a_spring_with_hysteresis_loses_what_a_loop_encloses():
    p = plant(hidden("spring_hysteresis", eta=-0.1))
    t = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    work = sum(np.cos(a) * spring(np.sin(a), np.cos(a), 0.1, p.q, p.D[0]) for a in t)
    assert work < 0
