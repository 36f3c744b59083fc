"""Linear models of small mechanisms against what is known of them on paper."""

import numpy as np
import pytest
from linear_cases import (
    DAMPER,
    GEAR,
    INERTIA,
    MASS,
    OSCILLATOR,
    PENDULUM,
    SATELLITE,
    SPRING,
    compiled,
    padded,
    point,
    random_system,
)
from scipy.linalg import expm

from identification import InputError
from identification.linear.linearization import linearize
from identification.linear.modes import minimal, modes
from identification.linear.operating_points import at_rest, samples_at
from identification.model.rollout import State


def oscillator():
    model = compiled(OSCILLATOR)
    return linearize(at_rest(model, State(np.array([0.3]), np.zeros(1), np.zeros(0))))[0]


def test_a_mass_with_spring_and_damper_is_the_one_of_the_textbook():
    s = oscillator()
    assert (s.states, s.inputs) == (("slide.position", "slide.rate"), ("force",))
    assert s.outputs == ("position", "pull")
    np.testing.assert_allclose(s.A, [[0, 1], [-SPRING / MASS, -DAMPER / MASS]], atol=1e-7)
    np.testing.assert_allclose(s.B, [[0], [GEAR / MASS]], atol=1e-8)
    np.testing.assert_allclose(s.C, [[1, 0], [0, 0]], atol=1e-9)
    np.testing.assert_allclose(s.D, [[0], [1]], atol=1e-9)
    (mode,) = modes(s)
    assert mode.swings
    assert mode.frequency == pytest.approx(np.sqrt(SPRING / MASS) / 2 / np.pi, rel=1e-7)
    assert mode.damping == pytest.approx(DAMPER / 2 / np.sqrt(SPRING * MASS), rel=1e-7)


def test_a_mode_is_a_motion_of_the_system():
    s = oscillator()
    (mode,) = modes(s)
    np.testing.assert_allclose(s.A @ mode.shape, mode.eigenvalue * mode.shape, atol=1e-6)
    assert mode.participation.sum() == pytest.approx(1)


@pytest.mark.parametrize("torque", [0.0, 1.0, 2.0])
def test_a_pendulum_hangs_where_gravity_balances_the_torque(torque):
    model, weight = compiled(PENDULUM), 0.5 * 9.81 * 0.5
    rest = at_rest(model, State(np.array([0.1]), np.zeros(1), np.zeros(0)), np.array([torque]))
    assert np.sin(rest.qpos[0, 0]) == pytest.approx(torque / weight, abs=1e-8)
    (mode,) = modes(linearize(rest)[0])
    stiffness, inertia = weight * np.cos(rest.qpos[0, 0]), 0.01 + 0.5 * 0.5**2
    assert mode.frequency == pytest.approx(np.sqrt(stiffness / inertia) / 2 / np.pi, rel=1e-6)


def test_the_upper_rest_of_a_pendulum_grows():
    rest = at_rest(compiled(PENDULUM), State(np.array([3.1]), np.zeros(1), np.zeros(0)))
    assert rest.qpos[0, 0] == pytest.approx(np.pi, abs=1e-8)
    assert min(m.damping for m in modes(linearize(rest)[0])) == -1


def test_a_spinning_body_turns_as_eulers_equations_say():
    """About z: I₁ δω̇₁ = (I₂ - I₃) ω δω₂, I₂ δω̇₂ = (I₃ - I₁) ω δω₁, δθ̇ = δω - ω × δθ."""
    ω, (I1, I2, I3) = 4.0, INERTIA
    quaternion = np.array([0.5, 0.1, -0.7, 0.2])
    qpos = [1, 2, 3, *(quaternion / np.linalg.norm(quaternion))]
    (s,) = linearize(point(compiled(SATELLITE), qpos, [0.3, 0.1, 0.2, 0, 0, ω]))
    A = np.zeros((12, 12))
    A[:6, 6:] = np.eye(6)
    A[3, 4], A[4, 3] = ω, -ω
    A[9, 10], A[10, 9] = (I2 - I3) * ω / I1, (I3 - I1) * ω / I2
    np.testing.assert_allclose(s.A, A, atol=1e-8)
    np.testing.assert_allclose(s.C, np.eye(12)[9:], atol=1e-8)
    assert s.outputs == ("gyro_1", "gyro_2", "gyro_3")
    assert s.states[3:6] == ("free.turn_x", "free.turn_y", "free.turn_z")


@pytest.mark.parametrize("seed", range(3))
def test_the_discrete_system_is_the_matrix_exponential(seed):
    s, h = random_system(seed), 0.01
    held = s.discrete(1 / h)
    block = expm(np.block([[s.A, s.B], [np.zeros((2, 8))]]) * h)
    np.testing.assert_allclose(held.A, block[:6, :6], atol=1e-13)
    np.testing.assert_allclose(held.B, block[:6, 6:], atol=1e-13)
    twice = s.discrete(0.5 / h)
    np.testing.assert_allclose(twice.A, held.A @ held.A, atol=1e-12)
    np.testing.assert_allclose(twice.B, held.A @ held.B + held.B, atol=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_the_order_of_the_states_changes_nothing(seed):
    s = random_system(seed)
    other = s.ordered(tuple(np.random.default_rng(seed).permutation(s.states).tolist()))
    ours, theirs = ([m.eigenvalue for m in modes(of)] for of in (s, other))
    np.testing.assert_allclose(ours, theirs, rtol=1e-9)
    f = np.geomspace(1e-2, 10, 20)
    np.testing.assert_allclose(s.response(f), other.response(f), rtol=1e-9)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda: random_system(0).discrete(0), "rate of 0 Hz"),
        (lambda: random_system(0).simulate(np.zeros((3, 2))), "no samples"),
        (lambda: samples_at(np.arange(5.0), [7.0]), "outside the log"),
        (lambda: point(compiled(OSCILLATOR), [0.0, 1.0]), "the model takes"),
        (lambda: at_rest(compiled(PENDULUM), resting(), np.array([9.0])), "does not rest"),
    ],
)
def test_what_cannot_be_is_refused(wrong, words):
    with pytest.raises(InputError, match=words):
        wrong()


def resting():
    return State(np.zeros(1), np.zeros(1), np.zeros(0))


F = np.geomspace(1e-3, 10, 30)


@pytest.mark.parametrize("seed", range(3))
def test_hidden_states_are_found_and_the_transfer_function_stays(seed):
    """Also where the system is unstable, and the units of its states differ by decades."""
    small = random_system(seed, n=4)
    whole = padded(small, unreached=3, unfelt=2, seed=seed)
    found = minimal(whole)
    assert (found.unreached, found.unfelt, len(found.system.A)) == (3, 2, 4)
    scale = np.abs(small.response(F)).max()
    np.testing.assert_allclose(found.system.response(F), small.response(F), atol=1e-6 * scale)


def test_the_minimal_states_say_what_the_states_do():
    """δx = V δz satisfies the system's own equations for what inputs reach."""
    whole = padded(random_system(3, n=4), unreached=2, unfelt=0, seed=3)
    found = minimal(whole)
    V = found.to_states
    scale = np.linalg.norm(V, axis=1, keepdims=True)
    np.testing.assert_allclose(whole.A @ V / scale, V @ found.system.A / scale, atol=1e-6)
    np.testing.assert_allclose(V @ found.system.B / scale, whole.B / scale, atol=1e-6)
