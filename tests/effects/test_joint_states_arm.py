"""Elastic gears in the joints of arms, against scipy's integration of other equations."""

from dataclasses import replace

import numpy as np
import pytest
from arm_cases import (
    ARMATURE,
    JOINTS,
    LOG,
    M2,
    SAMPLE,
    Arm,
    G,
    arm_plant,
    elastic,
    gap,
    inertias,
    mass,
    states_of,
    weighing,
)
from chain_cases import chain_log, chain_text, with_some
from joint_cases import run
from scipy.linalg import eigh

from identification import DivergenceError
from identification.model.rollout import State
from identification.native.joints.holding import MOST

FRICTION = {"coulomb_friction.f_c@shoulder": 0.5, "coulomb_friction.f_c@elbow": 0.2}
BOTH = {"shoulder": 0.02, "elbow": 0.03}
RHO = 0.3
C = tuple(BOTH.values())
IDLE = np.zeros((100, 2))


def state(x):
    """A state of `Arm` without p as MuJoCo has it."""
    q, v, theta, omega, _ = x.reshape(5, 2)
    return State(q, v, np.stack([theta, omega], axis=1).ravel())


@pytest.mark.parametrize("integrator", ["RK4", "Euler", "implicitfast"])
@pytest.mark.parametrize("joints", [2, 6, MOST + 1])
def test_sizes_of_zero_keep_the_arm_without_states_to_the_bit(integrator, joints):
    if joints == 2:
        plain, log, values = arm_plant(0.002, integrator), LOG, FRICTION
    else:
        log = chain_log(joints)
        plain, values = (
            with_some(chain_text(joints, integrator), log),
            {"coulomb_friction.f_c": 0.3},
        )
    every = plain.with_states_of(plain.needed_states)
    assert every.model.na == 3 * joints
    np.testing.assert_array_equal(run(every, log, **values), run(plain, log, **values))
    assert not np.array_equal(run(plain, log), run(plain, log, **values))


@pytest.mark.parametrize("c", [{"elbow": 0.03}, BOTH], ids=["one", "both"])
def test_an_arm_with_elastic_gears_is_that_of_another_integration_with_order_4(c):
    own, J = tuple(c.get(joint, 0.0) for joint in JOINTS), tuple(inertias(RHO))
    expected = Arm(c=own, J=J).moved(LOG.inputs)[:, :2]
    values = elastic(c, RHO)
    coarse, fine = (
        np.abs(run(arm_plant(h).with_states_of(values), LOG, **values) - expected).max()
        for h in (0.005, 0.0025)
    )
    assert np.abs(run(arm_plant(0.0025), LOG) - expected).max() > 0.01
    assert coarse < 1e-4
    assert coarse / fine > 12


def test_semi_implicit_steps_converge_too():
    expected = Arm(c=C, J=tuple(inertias(RHO))).moved(LOG.inputs)[:, :2]
    values = elastic(BOTH, RHO)
    coarse, fine = (
        np.abs(run(arm_plant(h, "Euler").with_states_of(values), LOG, **values) - expected).max()
        for h in (0.0025, 0.00125)
    )
    assert fine < 0.01
    assert coarse / fine == pytest.approx(2, rel=0.1)


def test_gears_that_get_stiff_together_tend_to_rigid_ones_in_proportion():
    plain, values = arm_plant(0.002), elastic(BOTH, RHO)
    plant, rigid = plain.with_states_of(values), run(plain, LOG)

    def apart(x):
        return np.abs(run(plant, LOG, **elastic(dict.fromkeys(JOINTS, x), RHO)) - rigid).max()

    far = apart(1e-6)
    assert 0 < far < 1e-5
    assert apart(1e-7) == pytest.approx(far / 10, rel=0.02)
    assert apart(1e-10) < 1e-8


@pytest.mark.parametrize("friction", [{}, FRICTION], ids=["free", "rubbing"])
def test_gaps_of_both_joints_that_close_tend_to_rigid_gears_in_proportion(friction):
    plain, values = arm_plant(0.002), gap(dict.fromkeys(JOINTS, 1e-4))
    plant, rigid = plain.with_states_of(values), run(plain, LOG, **friction)

    def apart(x):
        return np.abs(run(plant, LOG, **friction, **gap(dict.fromkeys(JOINTS, x))) - rigid).max()

    far = apart(1e-5)
    assert 0 < far < 1e-4
    assert apart(1e-7) == pytest.approx(far / 100, rel=0.02)


@pytest.mark.parametrize("mode", range(4))
def test_each_mode_of_the_arm_with_two_elastic_gears_has_its_frequency(mode):
    J, K, e = np.diag(inertias(RHO)), np.diag(1 / np.array(C)), 1e-6
    still = mass(np.zeros(2)) + np.diag(ARMATURE) - J
    slope = np.array([weighing(e * step) for step in np.eye(2)]) / e
    whole = np.block([[still, np.zeros((2, 2))], [np.zeros((2, 2)), J]])
    squares, shapes = eigh(np.block([[K + slope, -K], [-K, K]]), whole)
    shape = 1e-5 * shapes[:, mode] / np.abs(shapes[:, mode]).max()
    start = state(np.concatenate([shape[:2], [0, 0], shape[2:], [0, 0, 0, 0]]))
    got = states_of(arm_plant(damped=False), elastic(BOTH, RHO, 0.0), start, IDLE)
    t = SAMPLE * np.arange(len(IDLE))
    expected = shape * np.cos(np.sqrt(squares[mode]) * t)[:, None]
    np.testing.assert_allclose(got["qpos"], expected[:, :2], atol=1e-3 * 1e-5)
    np.testing.assert_allclose(got["act"][:, ::2], expected[:, 2:], atol=1e-3 * 1e-5)


def test_elastic_gears_keep_the_energy_of_an_arm_with_the_order_of_the_integrator():
    truth = Arm(c=C, J=tuple(inertias(RHO)), zeta=0.0)
    begun = np.array([0.8, -0.5, 1.0, 2.0, 0.81, -0.53, 1.5, -1.0, 0, 0])
    lost = []
    for h in (0.005, 0.0025):
        got = states_of(arm_plant(h, damped=False), elastic(BOTH, RHO, 0.0), state(begun), IDLE)
        x = np.stack([got["qpos"], got["qvel"], got["act"][:, ::2], got["act"][:, 1::2],
                      0 * got["qpos"]], axis=1)  # fmt: skip
        energies = np.array([truth.energy(row.ravel()) for row in x])
        assert energies[0] == pytest.approx(truth.energy(begun), rel=1e-12)
        lost.append(np.abs(energies - energies[0]).max())
    assert lost[0] < 1e-3 * M2 * G
    assert lost[0] / lost[1] > 12


def test_windows_begin_at_what_the_gears_and_frictions_of_an_arm_carry():
    """s = u - J dv/dt of each joint, dv/dt of both together, and p what its friction does."""
    values = {**elastic(BOTH, RHO), **FRICTION, "presliding.c": 0.1}
    plant = arm_plant().with_states_of(values)
    q, v, u = np.array([0.4, -0.9]), np.array([1.5, -2.0]), np.array([2.0, -0.7])
    known = State(q[None], v[None], np.zeros((1, 0)))
    names, row = tuple(values), np.array([[*values.values()]])
    log = replace(LOG, inputs=np.vstack([u, LOG.inputs[1:]]))
    first, far = plant.first_loads(names, row, known, log, np.zeros(1, int))
    p = np.array([*FRICTION.values()]) * np.sign(v)
    x = np.concatenate([q, v, q, v, p])
    a = Arm(f_c=tuple(FRICTION.values())).rate(x, u)[2:4]
    s = u - inertias(RHO) * a
    kinds = [(state.kind, state.joint) for state in plant.states]
    assert kinds == [("motor", j) for j in JOINTS] + [("grip", j) for j in JOINTS]
    np.testing.assert_allclose(first[0], [s[0], 0, s[1], 0, *p], rtol=1e-9)
    assert np.all(far > 0)


def test_motors_of_several_joints_have_no_more_inertia_than_the_arm():
    plant = arm_plant().with_states_of(elastic(BOTH))
    M = mass(np.zeros(2)) + np.diag(ARMATURE)
    assert np.linalg.eigvalsh(M - np.diag(inertias(0.9)))[0] < 0
    with pytest.raises(DivergenceError, match="smaller share rho"):
        run(plant, LOG, **elastic(BOTH, 0.9))
    run(plant, LOG, **elastic({"shoulder": 0.0, "elbow": 0.03}, 0.9))
