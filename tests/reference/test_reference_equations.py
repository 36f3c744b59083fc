"""The right-hand side against the slow obvious way, and against its symmetries."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from reference_cases import (
    FORCE,
    FORCE_AT,
    currents,
    differing,
    plain_rotation,
    random_state,
    seeds,
    sets,
    states,
)

from inca_mj.reference import derivative, pack, rest
from inca_mj.reference import layout as at
from inca_mj.reference.equations import cables
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import EACH_DRIVE


def obvious(x, i, value, T_0, G, b_G, geometry=INCA):
    """f(x, i) with numpy vectors in the fixed frame O, written from the physics.

    Each value of a drive is one number, or an array of one for each drive.
    """
    p, v, ω = x[at.POSITION], x[at.VELOCITY], x[at.RATES]
    φ_m, ω_m, d_0 = x[at.ANGLES], x[at.SPEEDS], x[at.NO_LOAD]
    R_AB = plain_rotation(x[at.EULER])
    arms, v_O, ω_O = geometry.B @ R_AB.T, R_AB @ v, R_AB @ ω
    ds = p + arms - geometry.A
    d = np.linalg.norm(ds, axis=1)
    s = ds / d[:, None]
    d_rate = np.sum(s * (v_O + np.cross(ω_O, arms)), axis=1)
    d_0_rate = -value["R"] * ω_m * d_0 / d
    T = value["lambda"] * (d / d_0 - 1) + value["b"] * (d_rate - d_0_rate)
    T = np.where(T > 0, T, 0)
    force = -T @ s + np.array([0, 0, -9.81 * value["m"]]) + G
    torque = np.cross(arms, -T[:, None] * s).sum(axis=0) + np.cross(R_AB @ b_G, G)
    inertia = np.diag([value["I_x"], value["I_y"], value["I_z"]])
    spin = np.linalg.solve(inertia, R_AB.T @ torque - np.cross(ω, inertia @ ω))
    roll, pitch = x[at.EULER][:2]
    ω_of_euler_rates = np.column_stack(
        [
            [1, 0, 0],
            plain_rotation([roll, 0, 0]).T @ [0, 1, 0],
            plain_rotation([roll, pitch, 0]).T @ [0, 0, 1],
        ]
    )
    F_s = np.maximum(0, value["R"] / value["R_s"] * T_0 - value["k_s"] * value["R_s"] * φ_m)
    Γ = value["K_t"] * i - value["R"] * T + value["R_s"] * F_s
    friction = value["b_v"] * ω_m + value["b_c"] * np.tanh(value["beta"] * ω_m)
    return np.concatenate(
        [
            v_O,
            R_AB.T @ force / value["m"] - np.cross(ω, v),
            np.linalg.solve(ω_of_euler_rates, ω),
            spin,
            ω_m,
            (Γ - friction) / value["J"],
            d_0_rate,
        ]
    )


@settings(deadline=None)
@given(states, currents, sets)
def test_the_compiled_equations_are_the_obvious_ones(x, i, name):
    p = parameter_set(name)
    q = pack(p, INCA, force=FORCE, force_at=FORCE_AT)
    expected = obvious(x, i, p.values(), rest(p, INCA).tension, np.array(FORCE), FORCE_AT)
    np.testing.assert_allclose(derivative(x, i, q), expected, rtol=1e-9, atol=1e-7)


@settings(deadline=None)
@given(states, currents, seeds)
def test_so_are_those_of_drives_that_differ(x, i, seed):
    p = differing(seed)
    own = p.values()
    value = dict(own)
    for name in EACH_DRIVE:
        value[name] = own[name] * np.array([1 + own[f"{name}@{k}"] for k in range(1, 9)])
    moves = {
        point: np.array([[own[f"{point}_{axis}@{k}"] for axis in "xyz"] for k in range(1, 9)])
        for point in ("exit", "connector")
    }
    geometry = replace(INCA, exits=INCA.A + moves["exit"], connectors=INCA.B + moves["connector"])
    expected = obvious(x, i, value, rest(p, INCA).tension, np.array(FORCE), FORCE_AT, geometry)
    rate = derivative(x, i, pack(p, INCA, force=FORCE, force_at=FORCE_AT))
    np.testing.assert_allclose(rate, expected, rtol=1e-9, atol=1e-7)


# Mirrors of the geometry: the sign of a polar vector's entries, and where each drive lands.
MIRRORS = {
    "x": (np.array([-1, 1, 1]), np.array([2, 1, 4, 3, 6, 5, 8, 7]) - 1),
    "y": (np.array([1, -1, 1]), np.array([4, 3, 2, 1, 8, 7, 6, 5]) - 1),
}


def mirrored(x, sign, drives):
    """The mirrored state: p, v mirror; ω and (φ, θ, ψ) are axial and take det(M) M."""
    axial = np.prod(sign) * sign
    blocks = [
        sign * x[at.POSITION],
        sign * x[at.VELOCITY],
        axial * x[at.EULER],
        axial * x[at.RATES],
        x[at.ANGLES][drives],
        x[at.SPEEDS][drives],
        x[at.NO_LOAD][drives],
    ]
    return np.concatenate(blocks)


@pytest.mark.parametrize("axis", MIRRORS)
@settings(deadline=None)
@given(states, currents)
def test_the_equations_commute_with_a_mirror(axis, x, i):
    sign, drives = MIRRORS[axis]
    q = pack(parameter_set(), INCA, force=FORCE, force_at=FORCE_AT)
    q_mirror = pack(
        parameter_set(), INCA, force=sign * np.array(FORCE), force_at=sign * np.array(FORCE_AT)
    )
    rate = derivative(mirrored(x, sign, drives), i[drives], q_mirror)
    expected = mirrored(derivative(x, i, q), sign, drives)
    np.testing.assert_allclose(rate, expected, rtol=1e-9, atol=1e-7)


def accelerations(x, q):
    """The platform's acceleration along O without currents, and ω̇."""
    rate = derivative(x, np.zeros(8), q)
    along = rate[at.VELOCITY] + np.cross(x[at.RATES], x[at.VELOCITY])
    return plain_rotation(x[at.EULER]) @ along, rate[at.RATES]


@settings(deadline=None)
@given(seeds)
def test_with_slack_cables_the_platform_falls_freely(seed):
    x = random_state(seed)
    x[at.NO_LOAD] *= 2
    q = pack(parameter_set(), INCA)
    np.testing.assert_array_equal(cables(x, q)[0], 0)
    np.testing.assert_allclose(accelerations(x, q)[0], [0, 0, -9.81], atol=1e-12)


def test_a_force_acts_once_and_at_its_point():
    x = rest(parameter_set(), INCA).state.copy()
    x[at.NO_LOAD] *= 2
    x[at.EULER] = 0.3, -0.4, 0.5
    q = pack(parameter_set(), INCA, force=(0, 0, 0.1725 * 9.81), force_at=(0, 0.02, 0))
    held, spin = accelerations(x, q)
    np.testing.assert_allclose(held, 0, atol=1e-12)
    R_AB = plain_rotation(x[at.EULER])
    torque = R_AB.T @ np.cross(R_AB @ [0, 0.02, 0], [0, 0, 0.1725 * 9.81])
    np.testing.assert_allclose(spin * [0.8e-4, 1.5e-4, 1.8e-4], torque, atol=1e-15)


def test_current_winds_in_and_the_drum_spring_cannot_push():
    x, q = rest(parameter_set(), INCA).state.copy(), pack(parameter_set(), INCA)
    wound = derivative(x, np.ones(8), q)[at.SPEEDS]
    np.testing.assert_allclose(wound, 0.08 / 8e-5, rtol=1e-9)
    # F_s = (R/R_s) T(0) − k_s R_s φ is zero from φ = 118 to 126 rad on.
    x[at.ANGLES], x[at.NO_LOAD] = 200, 2 * x[at.NO_LOAD]
    np.testing.assert_array_equal(derivative(x, np.zeros(8), q)[at.SPEEDS], 0)
