"""Laws of the cables, the geometry and the platform, beside those that the twin has too.

`test_worlds_base.py` compares what both have; `tests/kinematics/test_pulleys.py` has the pulleys.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from worlds_cases import FINE, plant, prbs, rate, simulate

from inca_mj.reference import layout as base
from inca_mj.studies.worlds import effect as hidden
from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.equations import sagging, shake


@pytest.mark.parametrize(
    "effect",
    [
        hidden("pulley_radius", r_p=0.03),
        hidden("anchor_offset", drive=2, x=0.05),
        hidden("com_offset", x=0.01, y=-0.01, z=0.02),
        hidden("drum_radius_mismatch", drive=7, delta=0.1),
        hidden("drum_eccentricity", a=0.05),
        hidden("drum_layering", h=1e-4),
        hidden("cable_hardening"),
        hidden("cable_hardening", kappa=4e5, exponent=2.0),
        hidden("cable_creep"),
        hidden("spring_hardening"),
        hidden("spring_hysteresis"),
        hidden("cable_weight", rho=5e-3, balanced=True),
        hidden("cable_weight", rho=5e-3, balanced=True, sag=True),
        hidden("external_force", x=0.2, z=0.1, balanced=True),
    ],
    ids=lambda e: e.name,
)
def test_a_world_starts_at_rest(effect):
    p = plant(effect)
    assert abs(rate(p, p.start, np.zeros(8))).max() < 1e-6


def test_forces_act_from_the_first_instant_where_nothing_balances_them():
    p = plant(
        hidden("external_force", x=0.1725, y=0.0), hidden("com_offset", x=0.0, y=0.0, z=-0.01)
    )
    start = rate(p, p.start, np.zeros(8))
    assert start[base.VELOCITY] == pytest.approx([1.0, 0.0, 0.0], abs=1e-9)
    # the force acts at the platform's origin, 0.01 m above the centre of mass
    assert start[base.RATES] == pytest.approx([0, 0.01 * 0.1725 / 1.5e-4, 0], abs=1e-6)
    hung = plant(hidden("cable_weight", rho=1e-3))
    d = (1 + hung.start[at.VISCOUS]) * hung.start[base.NO_LOAD]
    fall = rate(hung, hung.start, np.zeros(8))[base.VELOCITY]
    assert fall[2] == pytest.approx(-0.5e-3 * d.sum() * 9.81 / 0.1725, rel=1e-9)


def test_the_maxwell_branch_relaxes():
    u = np.ones((400, 8)) * np.array([1, 0, 0, 0, 1, 0, 0, 0])
    p = plant(hidden("cable_creep", fraction=0.5, tau=0.2))
    X = simulate(p, u)
    A, B = (p.q[part].reshape(8, 3) for part in (base.EXITS, base.CONNECTORS))
    from inca_mj.reference import rotation_matrix

    d = np.array(
        [np.linalg.norm(x[:3] + B @ rotation_matrix(x[base.EULER]).T - A, axis=1) for x in X]
    )
    ε = d / X[:, base.NO_LOAD] - 1
    branch = abs(ε - X[:, at.VISCOUS])
    assert branch[0].max() < 1e-12
    assert branch[-1].max() < 0.05 * branch.max()
    # ε_v follows ε as a low-pass does
    lag = np.gradient(X[:, at.VISCOUS], 0.01, axis=0) * 0.2 - (ε - X[:, at.VISCOUS])
    assert abs(lag[100:-1]).max() < 0.02 * branch.max()


@given(T=st.floats(-20.0, 50.0), K=st.floats(1e-9, 10.0))
def test_sag_solves_its_equation_and_holds_a_slack_cable(T, K):
    root = sagging(T, K)
    assert root > max(0.0, T)
    assert root - T - K / root**2 == pytest.approx(0, abs=1e-9 * max(1.0, abs(T), K / root**2))


def test_the_frame_shakes_one_exit_point_at_one_frequency():
    D = plant(hidden("frame_vibration", drive=6, x=1e-3, y=0.0, frequency=5.0)).D
    assert not D[[0, 1, 2, 3, 4, 6, 7], at.SHAKE_X].any()
    for t in (0.0, 0.013, 0.2):
        moved, moving = shake(t, D[5])
        assert moved[0] == pytest.approx(1e-3 * np.sin(10 * np.pi * t))
        slope = (shake(t + 1e-6, D[5])[0][0] - shake(t - 1e-6, D[5])[0][0]) / 2e-6
        assert moving[0] == pytest.approx(slope, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(
    "effect", [hidden("cable_weight", sag=True, rho=5e-3), hidden("cable_creep", tau=0.05)]
)
def test_the_step_is_small_enough(effect):
    p, u = plant(effect), prbs(0.5)
    coarse, small = simulate(p, u), simulate(p, u, step=FINE / 4)
    np.testing.assert_allclose(coarse[:, base.ANGLES], small[:, base.ANGLES], atol=1e-6)
