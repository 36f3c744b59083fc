"""Friction that is nearly a jump makes simulations rough: what that hides is not called known.

At constant k_s R_s² nothing that the motors' angles show depends on R_s. Differences of a rough
simulation seem to show that it does.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from identification.estimation.estimation import Options, estimate
from identification.estimation.experiment import Experiment, information
from identification.estimation.fit import assess
from identification.report.fit_verdict import fit_verdict
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.logs import ANGLES, read_inca_log, run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.identification import MECHANICS, POSE

NOISE = 6.7e-4  # [rad]
ONCE = Options(horizons=(1.0,), max_evaluations=1)
# where `inca identify examples/log.csv` ends, rounded
FAR = {
    "R": 0.0176, "R_s": 0.0062, "k_s": 15.26, "lambda": 23130.0, "b": 9.76, "J": 8.65e-5,
    "b_v": 1.94e-4, "b_c": 0.00489, "beta": 390.0, "K_t": 0.0868, "m": 0.175, "x": -0.0089,
    "y": -0.0084, "z": 1.4216, "roll": 0.0032, "pitch": 0.0006, "yaw": -0.0006,
}  # fmt: skip


def std_of(fit):
    return dict(zip(fit.found.names, fit.std, strict=True))


def test_the_example_log_does_not_know_what_its_first_fit_claimed():
    log = read_inca_log(Path(__file__).parents[2] / "examples" / "log.csv")
    part = replace(log.part("estimation"), splits={})
    part = replace(part, time=part.time[:80], inputs=part.inputs[:80],
                   outputs=part.outputs[:80], extras={})  # fmt: skip
    plant = build_twin(parameter_set("trial"), visual=False)
    fit = assess(estimate(plant, part, (*MECHANICS, *POSE), FAR, ONCE))
    std = std_of(fit)
    assert np.isinf(std["R_s"])
    assert np.isinf(std["k_s"])
    assert np.isinf(std["beta"])
    assert [str(c) for c, _, _ in fit.combinations] == ["k_s R_s^2"]
    said = " ".join(fit_verdict(fit))
    assert "R_s and k_s trade off along (k_s -0.89, R_s +0.45) without any output" in said
    assert "Of k_s and R_s only k_s R_s^2 can be known from this log" in said
    assert "The simulation is rough at these values" in said


@pytest.mark.parametrize("beta", [500.0])
def test_only_the_product_is_known_however_steep_the_friction(beta):
    robot = build_twin(parameter_set("trial", {"beta": beta}), visual=False)
    log = run_to_log(simulate(robot, make_input("prbs", 0.6, seed=0)), "steep")
    noise = NOISE * np.random.default_rng(3).standard_normal(log.outputs.shape)
    log = replace(log, outputs=log.outputs + noise, extras={}, units={})
    fit = assess(estimate(robot, log, MECHANICS, options=ONCE))
    std = std_of(fit)
    assert np.isinf(std["R_s"])
    assert np.isinf(std["k_s"])
    assert [str(c) for c, _, _ in fit.combinations] == ["k_s R_s^2"]
    assert "Of k_s and R_s only k_s R_s^2 can be known" in " ".join(fit_verdict(fit))


@pytest.mark.parametrize("beta", [0.8, 50.0, 500.0])
def test_an_experiment_is_judged_as_a_fit_is(beta):
    robot = build_twin(parameter_set("trial", {"beta": beta}), visual=False)
    trial = Experiment(
        plant=robot, inputs=make_input("prbs", 1.0), sampling_time=0.01, outputs=ANGLES, sigma=NOISE
    )
    found = information(trial, ("R_s", "k_s", "b_v", "K_t"))
    assert np.isinf(found.std[:2]).all()
    assert [str(c) for c in found.combinations] == ["k_s R_s^2"]
    assert found.e_value == 0
