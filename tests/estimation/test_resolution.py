"""What differences cannot resolve is not information: only what exceeds their error is felt."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from estimation_plants import positive, record, slider

from identification import ParameterSet
from identification.estimation.estimation import Options, estimate
from identification.estimation.experiment import Experiment, information
from identification.estimation.fit import assess
from identification.estimation.identifiability import identifiability
from identification.estimation.resolution import RESOLVED_STEPS, resolve_columns
from identification.kalman.estimate import estimate_innovations
from identification.model.plant import ModelPlant
from identification.report.fit.verdict import fit_verdict
from identification.windows.window_estimate import estimate_windows
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.logs import ANGLES, read_inca_log
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.identification import MECHANICS, POSE

NAMES = ("a", "b", "c", "d")
BLIND = np.array([2.0, -1.0, 0.0, 0.0]) / 5**0.5


def rough(seed, roughness, n=400, curvature=1e-3):
    """Sensitivities of a simulation whose outputs jump by `roughness`, blind along BLIND."""
    rng = np.random.default_rng(seed)
    exact = rng.standard_normal((n, 4))
    exact -= np.outer(exact @ BLIND, BLIND)
    bent = rng.standard_normal((n, 4))

    def at(step):
        jumps = (rng.standard_normal((n, 4)) for _ in range(2))
        return tuple(
            exact + curvature * (k * step) ** 2 * bent + roughness / (2**0.5 * k * step) * jump
            for k, jump in zip((1, 2), jumps, strict=True)
        )

    return exact, at


@pytest.mark.parametrize("roughness", [0.0, 1e-6, 1e-2])
def test_no_direction_is_felt_that_is_blind(roughness):
    for seed in range(40):
        _, at = rough(seed, roughness)
        assert resolve_columns(NAMES, at, 1e-12, RESOLVED_STEPS).found.rank <= 3


@pytest.mark.parametrize("roughness", [0.0, 1e-9, 1e-6, 1e-4])
def test_the_blind_direction_is_the_one_that_is_found(roughness):
    """And of its parameters alone there is no std, although it is only known roughly."""
    for seed in range(20):
        _, at = rough(seed, roughness)
        found = resolve_columns(NAMES, at, 1e-12, RESOLVED_STEPS).found
        assert found.rank == 3
        assert abs(found.blind[0] @ BLIND) > 0.99
        assert found.undetermined.tolist() == [True, True, False, False]
        assert not found.moved(np.array([[1.0, 2.0, 0.0, 0.0]]))[0]  # a b² can be known


def test_the_estimated_error_is_the_error():
    short, long = RESOLVED_STEPS
    for roughness, step in ((1e-3, short), (0.0, short), (1e-3, long)):
        for seed in range(10):
            exact, at = rough(seed, roughness, curvature=1.0)
            resolved = resolve_columns(NAMES, at, 1e-300, (step,))
            true = np.linalg.norm(resolved.S - exact, axis=0)
            assert (resolved.errors > 0.9 * true).all()
            assert (resolved.errors < 4 * true).all()


def test_what_is_felt_does_not_depend_on_units():
    for seed in range(20):
        _, at = rough(seed, 1e-6)
        resolved = resolve_columns(NAMES, at, 1e-12, RESOLVED_STEPS[:1])
        units = np.array([1.0, 1e4, 1e-5, 30.0])
        scaled = identifiability(resolved.S * units, NAMES, resolved.E * units, 0.0)
        assert scaled.rank == resolved.found.rank == 3
        same = scaled.blind[0] * units / np.linalg.norm(scaled.blind[0] * units)
        assert abs(same @ resolved.found.blind[0]) == pytest.approx(1.0, abs=1e-9)


ALL = ("mass", "damping", "stiffness", "gear")


def test_windows_and_innovations_give_no_std_to_a_common_factor():
    log = record(slider(x0=0.0), ("position",), noise=1e-3)
    windows = estimate_windows(slider(x0=0.0), log, ALL, 1.0, {"damping": 2.5})
    assert windows.found.rank == 3
    assert np.isinf(windows.std).all()
    fewer = estimate_windows(slider(x0=0.0), log, ALL[:3], 1.0, {"damping": 2.5})
    assert np.isfinite(fewer.std).all()
    predicted = estimate_innovations(slider(x0=0.0), log, ALL, {"damping": 2.5}).fit
    assert predicted.found.rank == 3
    assert np.isinf(predicted.std).all()
    assert len(predicted.combinations) == 3


@dataclass(frozen=True)
class Curved:
    """A slider whose stiffness is a b^1.37: a trade-off that is no product of small powers."""

    plant: ModelPlant
    parameters: ParameterSet

    @property
    def model(self):
        return self.plant.model

    def settings(self, names, values):
        own = self.parameters.values()
        a, b = (
            values[:, names.index(n)] if n in names else np.full(len(values), own[n])
            for n in ("a", "b")
        )
        return self.plant.settings(("stiffness",), (a * b**1.37)[:, None])

    def inputs(self, names, values, held, timestep, begun=0.0):
        return held

    def outputs(self, names, values, sensors, readings):
        return readings[0]


def test_a_trade_off_that_is_no_product_of_small_powers_is_not_called_one():
    records = tuple(positive(n, v, "", "start") for n, v in (("a", 20.0), ("b", 1.0)))
    plant = Curved(slider(x0=0.0), ParameterSet("curved", records))
    log = record(slider(x0=0.0), ("position",), noise=1e-3)
    fit = assess(estimate(plant, log, ("a", "b"), {"a": 18.0}, options=Options()))
    assert fit.found.rank == 1
    assert np.isinf(fit.std).all()
    assert not fit.combinations
    said = " ".join(fit_verdict(fit))
    assert "depend on 1 of 2 directions of the parameters; 1 is lost" in said
    assert "a and b have no std" in said
    assert "rough" not in said


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
    assert "R_s and k_s trade off along (k_s -0.89, R_s +0.45), and no output changes" in said
    assert "Of k_s and R_s only k_s R_s^2 can be known from this log" in said
    assert "The simulation is rough at these values" in said


@pytest.mark.parametrize("beta", [0.8, 500.0])
def test_an_experiment_is_judged_as_a_fit_is(beta):
    robot = build_twin(parameter_set("trial", {"beta": beta}), visual=False)
    trial = Experiment(
        plant=robot, inputs=make_input("prbs", 1.0), sampling_time=0.01, outputs=ANGLES, sigma=NOISE
    )
    found = information(trial, ("R_s", "k_s", "b_v", "K_t"))
    assert np.isinf(found.std[:2]).all()
    assert [str(c) for c in found.combinations] == ["k_s R_s^2"]
    assert found.e_value == 0
