"""Robots as they are built: drives that differ, points off the drawing, several records of one."""

from dataclasses import replace

import numpy as np
import pytest

from identification.logs.joined import join_logs
from identification.model.predictor import Predictor
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.reference import layout as base
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import displacements, with_spread
from inca_mj.studies.worlds import (
    AS_BUILT,
    EVERY,
    EXACT,
    VARIED,
    HiddenSetting,
    make_currents,
    make_plant,
    records,
    simulate_world,
    world,
)
from inca_mj.studies.worlds import effect as hidden
from inca_mj.studies.worlds.ratio import HiddenAbsorbed
from inca_mj.studies.worlds.sensor import encode, noise_rms
from inca_mj.studies.worlds.setting import true_robot
from inca_mj.studies.worlds.tolerances import as_built, usual_std
from inca_mj.twin.twin import build_twin

SHORT = HiddenSetting(duration=1.0)
BUILT = replace(SHORT, tolerances=AS_BUILT)
NOMINAL = parameter_set("trial").values()
POSE = ("x", "y", "z", "roll", "pitch", "yaw")
TWIN = 1e-5  # limit of the cross-check of twin and reference at 1 ms [rad]


def test_without_tolerances_a_world_is_that_of_equal_drives_to_the_bit():
    """The draws of a seed are a promise: logs that were made before may be made again."""
    seed = 9
    draws = np.random.default_rng([seed, 1])
    factor = dict(zip(EVERY, 1 + 0.1 * draws.uniform(-1, 1, len(EVERY)), strict=True))
    values = {name: factor[name] * NOMINAL[name] for name in VARIED}
    for name, part in zip(("x", "y", "z"), draws.uniform(-1, 1, 3), strict=True):
        values[name] = NOMINAL[name] + 0.01 * part
    robot, u = parameter_set("trial", values), make_currents(seed, SHORT)
    angles = simulate_world(make_plant(robot, INCA), u)[:, base.ANGLES]
    expected = encode(angles, 4000, 5e-4, np.random.default_rng([seed, 3]))
    log, truth = world(seed, setting=SHORT)
    assert np.array_equal(log.inputs, u)
    assert np.array_equal(log.outputs, expected)
    assert dict(truth.parameters) == robot.values()
    assert as_built(robot, EXACT, draws) is robot


def test_a_seed_gives_one_robot_whatever_its_effects_are():
    one, same, other = (world(s, setting=BUILT) for s in (3, 3, 4))
    assert one.truth.parameters == same.truth.parameters
    assert np.array_equal(one.log.outputs, same.log.outputs)
    assert one.truth.parameters["lambda@1"] != other.truth.parameters["lambda@1"]
    more = world(3, [hidden("stribeck_friction")], setting=BUILT)
    assert more.truth.parameters == one.truth.parameters
    # Tolerances add to the robot of the seed: common values, start and input stay.
    plain = world(3, setting=SHORT)
    for name in (*VARIED, "R", "R_s", "k_s", "beta", *POSE):
        assert plain.truth.parameters[name] == one.truth.parameters[name]
    assert np.array_equal(plain.log.inputs, one.log.inputs)


def test_deviations_keep_their_widths():
    robots = [true_robot(seed, BUILT).values() for seed in range(40)]
    for name, largest in AS_BUILT.drives.items():
        own = np.array([[r[f"{name}@{k}"] for k in range(1, 9)] for r in robots])
        assert abs(own).max() <= largest
        # Uniform: a std of 1/√3 of the width, which 320 draws show to 3 %.
        assert own.std() == pytest.approx(largest / np.sqrt(3), rel=0.15)
        assert not largest or (own.std(axis=0) > 0).all()
    for point, std in AS_BUILT.points.items():
        names = [p.name for p in displacements() if p.name.startswith(point)]
        moved = np.array([[r[name] for name in names] for r in robots])
        assert moved.std() == pytest.approx(std, rel=0.1)
    for name, largest in (("I_x", 0.1), ("I_y", 0.1), ("I_z", 0.1), ("m", 0.02)):
        change = np.array([r[name] / NOMINAL[name] - 1 for r in robots])
        assert 0.8 * largest < abs(change).max() <= largest
    apart = {r["I_x"] / NOMINAL["I_x"] - r["I_y"] / NOMINAL["I_y"] for r in robots}
    assert 0 not in apart


def test_records_are_of_one_robot_and_each_has_a_start_input_and_noise_of_its_own():
    setting = replace(BUILT, error_rms=1e-3, tilt=0.01)
    made = records(8, [hidden("stribeck_friction")], setting=setting)
    first = world(8, [hidden("stribeck_friction")], setting=setting)
    assert np.array_equal(made[0].log.outputs, first.log.outputs)
    assert len(made) == 3
    for k, (log, truth) in enumerate(made):
        assert truth.effects == first.truth.effects
        for name, value in truth.parameters.items():
            if name not in POSE:
                assert value == first.truth.parameters[name]
            else:
                largest = 0.01 if name not in POSE[:3] or k == 0 else 0.03
                assert abs(value - NOMINAL[name]) <= largest
        for other, unlike in made[:k]:
            assert not np.array_equal(log.inputs, other.inputs)
            assert all(truth.parameters[name] != unlike.parameters[name] for name in POSE)
            assert abs(np.corrcoef(truth.error.ravel(), unlike.error.ravel())[0, 1]) < 0.3
            noise, others = (log.outputs - truth.angles, other.outputs - unlike.angles)
            assert abs(np.corrcoef(noise.ravel(), others.ravel())[0, 1]) < 0.2
    levels = [len(np.unique(log.inputs)) for log, _ in made]
    assert levels[0] == levels[2] == 2 < levels[1]
    assert len(join_logs([log for log, _ in made])) == 300
    again = records(8, [hidden("stribeck_friction")], n=2, setting=setting)
    assert np.array_equal(again[1].log.outputs, made[1].log.outputs)


def test_a_ratio_is_that_of_the_robot_as_built():
    setting = replace(BUILT, duration=0.5)
    log, truth = world(6, [hidden("stribeck_friction")], ratio=6.0, setting=setting)
    robot = with_spread(parameter_set("trial")).with_values(truth.parameters)
    names = (*VARIED, "R", "k_s", "beta")
    absorbed = HiddenAbsorbed(robot, log.inputs, 0.01, names, AS_BUILT, truth.noise_rms)
    assert absorbed.rms(truth.effects) / truth.noise_rms == pytest.approx(6.0, rel=0.02)


def test_what_parts_absorb_is_the_least_squares_of_noise_and_tolerances():
    """The slow way: one least-squares problem in which every deviation has a row of its own."""
    setting, σ = replace(BUILT, duration=0.3), 1e-3
    robot, u = true_robot(3, setting), make_currents(3, setting)

    def angles(values, effects=()):
        plant = make_plant(robot.with_values(values), INCA, effects)
        return simulate_world(plant, u, 0.01, 1e-3)[:, base.ANGLES].ravel()

    effects, without = [hidden("drum_eccentricity")], angles({})
    e = angles({}, effects) - without
    std = usual_std(robot, AS_BUILT)
    steps = {n: 1e-5 if n in POSE else 1e-4 * robot[n].value for n in (*VARIED, *POSE)}
    steps |= {n: 0.1 * s for n, s in std.items()}
    columns = [(angles({n: robot[n].value + h}) - without) / h for n, h in steps.items()]
    scale = [1 / np.linalg.norm(c) for c in columns[: len(VARIED) + 6]]
    J = np.stack(columns, axis=1) * np.array([*scale, *std.values()]) / σ
    priors = np.hstack([np.zeros((len(std), len(scale))), np.eye(len(std))])
    A, b = np.vstack([J, priors]), np.concatenate([e / σ, np.zeros(len(std))])
    left = b - A @ np.linalg.lstsq(A, b, rcond=1e-9)[0]
    expected = σ * np.sqrt(left @ left / e.size)
    mine = HiddenAbsorbed(robot, u, 0.01, VARIED, AS_BUILT, σ)
    assert mine.rms(effects) == pytest.approx(expected, rel=1e-4)
    assert mine.rms(effects) < HiddenAbsorbed(robot, u, 0.01, VARIED).rms(effects)


@pytest.fixture(scope="module")
def twin():
    return build_twin(with_spread(parameter_set()), effects=CATALOGUE, settled=True)


def predicted(twin, log, values):
    return Predictor(twin, log, tuple(values)).predict(np.array([[*values.values()]]))[0]


def test_the_twin_at_the_true_values_explains_every_record_to_its_noise(twin):
    for log, truth in records(1, setting=replace(BUILT, duration=3.0)):
        model = predicted(twin, log, dict(truth.parameters))
        assert abs(model - truth.angles).max() < TWIN
        # 2400 samples show an rms to 1.4 %.
        left = log.outputs - model
        assert np.sqrt(np.mean(left**2)) == pytest.approx(truth.noise_rms, rel=0.06)
        # Equal drives leave much more: it is the deviations that explain the log.
        alike = {name: v for name, v in truth.parameters.items() if "@" not in name}
        assert abs(predicted(twin, log, alike) - truth.angles).max() > 1e-2


def test_an_effect_acts_on_drives_that_differ_as_the_twin_says(twin):
    drawn = hidden("drum_eccentricity")
    log, truth = world(4, [drawn], setting=BUILT)
    effect = next(e for e in CATALOGUE if e.name == drawn.name)
    sizes = {effect.parameter(n, drawn.where): getattr(drawn, n) for n in drawn.sizes}
    without = predicted(twin, log, dict(truth.parameters))
    model = predicted(twin, log, {**truth.parameters, **sizes})
    answer = np.linalg.norm(truth.angles - without)
    assert answer > 0
    assert np.linalg.norm(model - truth.angles) < 0.02 * answer


def test_what_other_parameters_do_as_well_is_no_effect():
    """A hysteresis that is friction and stiffness to first order gives its place to another one."""
    setting = replace(BUILT, duration=1.0)
    robot, u = true_robot(6, setting), make_currents(6, setting)
    names, σ = setting.absorbed, noise_rms(setting.counts, setting.noise)
    absorbed = HiddenAbsorbed(robot, u, 0.01, names, AS_BUILT, σ)
    hysteresis, cogging = hidden("spring_hysteresis", eta=0.05), hidden("cogging")
    assert absorbed.is_absorbed(hysteresis)
    assert not absorbed.is_absorbed(cogging)
    assert not absorbed.is_absorbed(hidden("friction_mismatch", drive=2, delta=0.5))  # a part
    assert not absorbed.is_absorbed(hidden("current_saturation", i_max=0.99))  # it is not linear
    exact = HiddenAbsorbed(robot, u, 0.01, names, noise=σ)
    assert not exact.is_absorbed(hysteresis)  # where drives are alike the ratio is what it says
    ratio = absorbed.rms([hysteresis]) / σ
    (made,) = records(6, [hysteresis], n=1, ratio=ratio, setting=setting, others=[cogging])
    assert made.truth.effects[0].name == "cogging"
