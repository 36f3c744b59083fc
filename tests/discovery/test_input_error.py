"""Errors of the inputs that follow from what was logged are told from those that are random."""

from functools import cache

import mujoco
import numpy as np
import pytest
from discovery_cases import OPTIONS, SENSOR, STEP, linear_plant, record, slider, steps, task, wander
from discovery_cases import response as dense

from identification import Log, Parameter, ParameterSet
from identification.discovery.findings.finding import FindingKind
from identification.discovery.nominal_model import NominalModel
from identification.effects.effect import Effect
from identification.effects.sizes import Size
from identification.estimation.residuals import innovation_tests
from identification.innovations.discovery import discover
from identification.innovations.fitted_model import fit_model
from identification.innovations.input_error import (
    ERROR_KNOTS,
    draw_curves,
    find_input_error,
    fit_families,
    list_families,
    separate_inputs,
    simulate_response,
)
from identification.innovations.moves.shapes import is_structured
from identification.kalman.noise_model import Noise, augment
from identification.model.plant import ModelPlant
from identification.model.predictor import Predictor
from identification.report.discovery.report import discovery_text

N = 1000

CARTS = """<mujoco>
  <option timestep="0.01" gravity="0 0 0" integrator="RK4"/>
  <worldbody>
    <body name="one"><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>
      <joint name="a" type="slide" axis="1 0 0" damping="3"/></body>
    <body name="two"><inertial pos="0 0 0" mass="3" diaginertia="1 1 1"/>
      <joint name="b" type="slide" axis="1 0 0" damping="4"/></body>
  </worldbody>
  <actuator><motor name="f" joint="a"/><motor name="g" joint="b"/></actuator>
  <sensor><jointpos name="x" joint="a"/><jointpos name="y" joint="b"/></sensor>
</mujoco>"""


SPRING = Effect("spring", "-k x", (Size("k", "N/m", 30.0, 1e-2, 1),), places={"joint": ""})


def carts(crosstalk, seed, sensors=(SENSOR, SENSOR), samples=N):
    """Two carts, the second of which feels a share of the force on the first, and their log."""
    records = tuple(
        Parameter(name=f"{n}_{w}", value=v, unit="", where=f"{kind}/{w}.{n}",
                  lower=0.0, upper=100.0)
        for w, n, v, kind in (("one", "mass", 2.2, "body"), ("two", "mass", 2.8, "body"),
                              ("a", "damping", 2.7, "joint"), ("b", "damping", 4.3, "joint"))
    )  # fmt: skip
    spring = Parameter(
        name="spring.k", value=0.0, unit="N/m", where="joint/a.stiffness", lower=0.0, upper=1e3
    )
    known = ParameterSet("carts", (*records, spring))
    plant = ModelPlant(mujoco.MjModel.from_xml_string(CARTS), known)
    time, u = STEP * np.arange(samples), 5 * np.hstack([steps(samples, 1), steps(samples, 2)])
    error = 0.1 * np.hstack([wander(samples, 1.0, 0.1, seed), wander(samples, 1.0, 0.1, seed + 50)])
    error[:, 1] += crosstalk * u[:, 0]
    names = {"input_names": ("f", "g"), "output_names": ("x", "y")}
    y = Predictor(plant, Log(time=time, inputs=u + error, outputs=0 * u, **names), ()).predict(
        np.empty((1, 0))
    )[0]
    y += sensors * np.random.default_rng(seed).standard_normal(y.shape)
    log = Log(
        time=time,
        inputs=u,
        outputs=y,
        **names,
        units=dict.fromkeys("fg", "N") | dict.fromkeys("xy", "m"),
    )
    free = tuple(p.name for p in records)
    return NominalModel(plant, free, np.full(len(free), 0.3)), log


def carts_task(crosstalk, seed):
    nominal_model, log = carts(crosstalk, seed)
    return task(log, model=nominal_model)


@cache
def crossed(seed):
    """The nominal model that is fitted to a log of carts with crosstalk."""
    return fit_model(carts_task(0.1, seed), (), {})


def test_the_response_is_that_of_the_dense_plant():
    rng = np.random.default_rng(3)
    plant = linear_plant(rng)
    n, _, nu = plant.B.shape
    r = rng.standard_normal((n + 1, nu, 4))
    expected = (dense(plant) @ r.reshape(-1, 4)).reshape(n + 1, -1, 4)
    found = simulate_response(augment(plant, Noise(0.3, 0.1), STEP), r)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9)


def test_curves_sum_to_one_and_each_is_of_one_input():
    x = np.random.default_rng(1).standard_normal((50, 3))
    np.testing.assert_allclose(draw_curves(x, ERROR_KNOTS).sum(axis=2), 1)
    r = separate_inputs(draw_curves(x, ERROR_KNOTS)).reshape(50, 3, 3, -1)
    for i in range(3):
        assert not np.delete(r[:, i], i, axis=1).any()
        np.testing.assert_allclose(np.sqrt(np.mean(r[:, i, i] ** 2, axis=0)), 1)
        np.testing.assert_allclose(r[:, i, i].mean(axis=0), 0, atol=1e-12)


def test_a_random_error_goes_along_with_nothing():
    seed = 0
    error = wander(N, 0.05, 0.1, seed=seed)
    model = fit_model(task(record(slider(mass=2.2, damping=2.7), N, seed, error)), (), {})
    assert model.refit.level.input_std > 0
    assert {len(fits) for fits in fit_families(model.validation, OPTIONS).values()} == {4}
    assert find_input_error(model.validation, OPTIONS) == ()
    assert find_input_error(fit_model(carts_task(0.0, seed), (), {}).validation, OPTIONS) == ()
    assert not is_structured(model, OPTIONS)


def test_crosstalk_is_told_with_its_size_and_the_input_that_feels_it():
    model = crossed(2)
    (finding,) = find_input_error(model.validation, OPTIONS)
    assert finding.evidence.regressor == "other inputs"
    assert finding.evidence.input == "g"
    best = max(fit_families(model.validation, OPTIONS)["select"], key=lambda f: f.share)
    felt = 0.1 * np.std(model.validation.log.inputs[:, 0])
    assert best.error[1] == pytest.approx(felt, rel=0.2)
    assert best.error[0] < 0.5 * best.error[1]
    others = next(iter(list_families(model.validation, ERROR_KNOTS))).r.reshape(-1, 2, 2, 2)
    assert not np.einsum("niii->ni", others).any()  # its own input is not among them
    assert others[:, 0, 0, 1].any()


def test_crosstalk_is_an_unknown_effect_and_no_noise():
    # What is told is of a third of the unseen half: in 20 s that is too little to be sure.
    answer = discover(*carts(0.1, 2, samples=2 * N), (SPRING,))
    assert answer.verdict == "unknown effect"
    assert answer.disturbance_rms == 0.0
    (finding,) = (f for f in answer.findings if f.kind is FindingKind.STRUCTURED_INPUT_ERROR)
    assert finding.evidence.regressor == "other inputs"
    quiet = discover(*carts(0.0, 2, samples=2 * N), (SPRING,))
    assert quiet.verdict == "nothing missing"
    assert quiet.disturbance_rms > 0


def test_a_noisy_sensor_is_told_with_its_noise_and_no_effect_is_missing():
    sensors = SENSOR * np.array([1.0, 2.4])
    answer = discover(*carts(0.0, 2, sensors), (SPRING,))
    assert answer.verdict == "nothing missing"
    # log σ of 500 samples has the std 0.03, of which errors of the inputs take a part.
    assert [*answer.noise_by_output.values()] == pytest.approx(sensors, rel=0.12)
    assert "The noise of y is 2." in discovery_text(answer)


def moved_along(robot, samples, law, seed=2):
    """A log of a slider whose input errs by a law of its position and rate, beside noise."""
    random = error = wander(samples, 0.02, 0.1, seed=seed)
    for _ in range(30):  # the force follows from the motion that it makes
        y = record(robot, samples, seed, error, noise=0.0).outputs
        error = (error + random + law(y, np.gradient(y, STEP, axis=0))) / 2
    return record(robot, samples, seed, error)


@pytest.mark.parametrize(
    ("law", "regressor"),
    [
        (lambda y, v: 0.15 * np.sin(5 * v), "output rate"),
        (lambda y, v: 0.1 * np.sin(1.5 * y) * np.tanh(20 * v), "output and direction"),
    ],
)
def test_an_error_along_the_motion_is_told_as_that(law, regressor):
    model = fit_model(task(moved_along(slider(mass=2.2, damping=2.7), 2000, law)), (), {})
    (finding,) = find_input_error(model.validation, OPTIONS)
    assert finding.evidence.regressor == regressor
    assert not innovation_tests(model.innovations, STEP).is_correlated(1e-4, 0.03)
    assert is_structured(model, OPTIONS)
