"""A world: its log, its truth, its noise, and how large its effects are."""

import pickle

import numpy as np
import pytest

from identification.errors import InputError
from inca_mj.robot.parameters import parameter_set
from inca_mj.studies.worlds import EVERY, VARIED, HiddenSetting, make_currents, world
from inca_mj.studies.worlds import effect as hidden
from inca_mj.studies.worlds.ratio import HiddenAbsorbed
from inca_mj.studies.worlds.sensor import coloured, encode, noise_rms

SHORT = HiddenSetting(duration=1.0)


def test_the_log_holds_nothing_of_the_truth():
    log, truth = world(5, [hidden("anchor_offset", drive=4)], setting=SHORT)
    assert log.inputs.shape == log.outputs.shape == (100, 8)
    assert not log.extras
    assert not log.notes
    assert list(log.columns) == [f"{c}_{k}" for c in ("current", "angle") for k in range(1, 9)]
    text = pickle.dumps(log)
    for secret in (b"anchor", b"drive", b"seed", b"truth", b"Truth"):
        assert secret not in text
    (made,) = truth.effects
    assert (made.name, made.where, made.x) == ("anchor_offset", "drive 4", 0.01)
    with pytest.raises(TypeError):
        truth.parameters["J"] = 1.0


def test_the_robot_is_near_the_trial_set():
    nominal = parameter_set("trial").values()
    for seed in range(5):
        value = world(seed, setting=HiddenSetting(duration=0.1)).truth.parameters
        for name in EVERY:
            change = abs(value[name] / nominal[name] - 1)
            assert (0 < change <= 0.1) == (name in VARIED)
        assert 0 < max(abs(value[n] - nominal[n]) for n in "xyz") <= 0.01
    turned = world(1, setting=HiddenSetting(duration=0.1, tilt=0.02)).truth.parameters
    assert all(turned[name] != nominal[name] for name in ("roll", "pitch", "yaw"))


def test_encoders_round_to_their_counts():
    rng = np.random.default_rng(0)
    φ = np.cumsum(rng.normal(size=(20000, 2)), axis=0)
    y, Δ = encode(φ, 4000, 5e-4, rng), 2 * np.pi / 4000
    np.testing.assert_allclose(y / Δ, np.round(y / Δ), atol=1e-7)
    assert np.sqrt(np.mean((y - φ) ** 2)) == pytest.approx(noise_rms(4000, 5e-4), rel=0.02)
    assert np.array_equal(encode(φ, 0, 0.0, rng), φ)


def test_the_current_error_is_coloured_and_not_logged():
    e = coloured((100000, 2), 0.01, 5e-4, 0.05, np.random.default_rng(0))
    assert e.std() == pytest.approx(5e-4, rel=0.05)
    assert np.mean(e[1:] * e[:-1]) / np.mean(e**2) == pytest.approx(np.exp(-0.2), abs=0.01)
    quiet, loud = (
        world(2, setting=SHORT),
        world(2, setting=HiddenSetting(duration=1.0, error_rms=5e-3)),
    )
    assert np.array_equal(quiet.log.inputs, loud.log.inputs)
    assert abs(quiet.truth.angles - loud.truth.angles).max() > 1e-3
    assert not quiet.truth.error.any()


def test_inputs_stay_between_their_levels():
    for kind in ("prbs", "multisine"):
        u = make_currents(7, HiddenSetting(input=kind))
        assert u.shape == (2000, 8)
        assert 0.5 - 1e-12 < u.min() < 0.55
        assert 0.95 < u.max() < 1 + 1e-12


def test_what_the_base_can_say_is_absorbed():
    robot, u = parameter_set("trial"), make_currents(1, SHORT)
    absorbed = HiddenAbsorbed(robot, u, 0.01, VARIED)
    all_drives = [hidden("torque_constant_mismatch", drive=k, delta=1e-3) for k in range(1, 9)]
    assert absorbed.rms(all_drives) < 1e-2 * absorbed.rms(all_drives[:1])
    assert absorbed.rms([]) == 0


@pytest.mark.parametrize(
    "effect", [hidden("torque_constant_mismatch", drive=2), hidden("backlash")]
)
def test_a_ratio_is_reached(effect):
    log, truth = world(6, [effect], ratio=6.0, setting=SHORT)
    robot = parameter_set("trial").with_values(truth.parameters)
    left = HiddenAbsorbed(robot, log.inputs, 0.01, VARIED).rms(truth.effects)
    assert left / truth.noise_rms == pytest.approx(6.0, rel=0.02)


def test_an_effect_is_not_larger_than_a_robot_may_have_it():
    line = hidden("cable_weight", balanced=True)
    assert line.scaled(line.most).rho == pytest.approx(line.largest)
    offset = hidden("anchor_offset")
    largest = offset.scaled(offset.most)
    assert np.linalg.norm([largest.x, largest.y, largest.z]) == pytest.approx(offset.largest)
    cubic, square = hidden("cable_hardening", exponent=2.0), hidden("cable_hardening", exponent=1.0)
    κ_2, κ_1 = cubic.scaled(cubic.most).kappa, square.scaled(square.most).kappa
    assert κ_2 * 1e-3**2 == pytest.approx(κ_1 * 1e-3)
    assert np.isinf(hidden("current_saturation").most)
    with pytest.raises(InputError, match=r"rho = 0\.005\).* cannot be absorbed"):
        world(6, [line], ratio=1e4, setting=SHORT)
