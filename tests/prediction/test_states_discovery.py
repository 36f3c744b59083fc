"""A gear that gives, a gap and presliding are named from records of another integration."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from arm_cases import DAMPING, FULL, SAMPLE, Arm, inertias, text
from chain_cases import WANTED
from joint_cases import arm_log
from state_cases import BACKLASH, COULOMB, ELASTIC, F_C, PRESLIDING, Truth, measured, pendulum

from identification import Parameter
from identification.discovery.candidates import list_common
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.plant.joint_plant import candidates, joint_plant
from identification.effects.plant.joint_states import JointState
from identification.prediction.discovery import discover_records
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.scoring.joint_states import model_for, widened
from identification.prediction.scoring.scores import window_scores
from identification.prediction.scoring.screening import score_all
from identification.windows.records import as_records

FREE = ("J", "d", COULOMB.name)
OTHERS = ("stribeck_friction",)
NAMES = ("joint_elasticity", "gear_backlash", "presliding")
CASES = {
    ELASTIC: (Truth(c=0.05, f_c=F_C), 0.05),
    BACKLASH: (Truth(c=1e-5, gap=0.012, zeta=1.0, f_c=F_C), 0.012),
    PRESLIDING: (Truth(slip=0.1, f_c=F_C), 0.1),
}
# of each record: what gives at all times shows in fewer than a gap, where teeth must part
SAMPLES = {"": 80, ELASTIC: 100}


def nominal():
    plant = pendulum(F_C, 0.0025).with_values({"J": 1.5e-3, "d": 0.03})
    return NominalModel(plant, FREE, np.full(3, 0.5), 0.2)


@cache
def found(name):
    truth = CASES[name][0] if name else Truth(slip=3e-3, f_c=F_C)
    logs = [measured(truth, k, samples=SAMPLES.get(name, 120)) for k in range(4)]
    model = nominal()
    names = (*OTHERS, *(("presliding",) if name == PRESLIDING else NAMES))  # the long ones have all
    effects = [e for e in candidates(model.plant, FREE) if e.name in names]
    options = DiscoveryOptions(max_effects=1)
    return discover_records(model, logs[:2], logs[2:], effects, options=options)


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_what_is_missing_is_named_first_with_its_size(name):
    answer = found(name)
    assert answer.verdict == "named"
    first = answer.named[0]
    assert first.candidate.effect.name == name.partition(".")[0]
    value, std, _ = next(iter(first.parameters.values()))
    assert value == pytest.approx(CASES[name][1], rel=0.15)
    assert std < 0.1 * value
    if "rho" in first.parameters:
        assert first.parameters["rho"][0] == pytest.approx(1 / 3, rel=0.15)
        assert first.parameters["link"][0] == 0.0
    assert answer.after.rms < 0.5 * answer.before.rms


def test_a_record_of_the_nominal_robot_stays_silent():
    """Friction gives by less than steps resolve: it holds."""
    answer = found("")
    assert not {n.candidate.effect.name for n in answer.named} & {*NAMES}


@pytest.mark.parametrize("name", CASES)
def test_windows_in_a_plant_with_states_are_those_without_while_sizes_are_zero(name):
    model = nominal()
    truth = CASES[name][0]
    logs = [measured(truth, k, samples=120) for k in range(2)]
    old = fit_nominal(model, as_records(logs))
    effects = [e for e in candidates(model.plant, FREE) if e.name == name.partition(".")[0]]
    score = window_scores(old.fit, list_common(effects))[0]
    new = model_for(old, score.candidate)
    assert new.plant.states == (
        JointState("grip" if name == PRESLIDING else "motor", "hinge"),
    )  # fmt: skip
    assert old.plant.states == ()
    for before, after, d, e in zip(
        old.fit.problem.parts, new.fit.problem.parts, old.fit.moves, new.fit.moves, strict=True
    ):
        np.testing.assert_array_equal(widened(d, after), e)
        np.testing.assert_array_equal(
            before.outputs(old.fit.q[None], [d])[0], after.outputs(new.fit.q[None], [e])[0]
        )
    costs = [
        m.fit.problem.cost_of(m.fit.q, m.fit.problem.held(m.fit.q).residuals(m.fit.moves))
        for m in (old, new)
    ]
    assert costs[0] == pytest.approx(costs[1], rel=1e-14)  # a sum with more zeros


TRUTH = {"m2": 0.7, "d1": DAMPING[0], "d2": DAMPING[1]}
PATHS = {"m2": "body/lower.mass", "d1": "joint/shoulder.damping", "d2": "joint/elbow.damping"}
KNOWN = (*WANTED, "delay", "lag")
C, RHO, ZETA = 0.05, 0.3, 0.05


@cache
def measured_arm(seed):
    """A record of the arm, whose second encoder sits on the motor's side."""
    rng = np.random.default_rng(seed)
    t = SAMPLE * np.arange(300)
    size, f, phase = (rng.uniform(a, b, (8, 2)) for a, b in ((0.3, 1), (0.2, 6), (0, 6.3)))
    u = 0.6 * FULL * np.sum(size * np.sin(2 * np.pi * f * t[:, None, None] + phase), axis=1)
    x = Arm(c=(0.0, C), J=tuple(inertias(RHO)), zeta=ZETA).moved(u, tight=1e-7)
    y = x[:, [0, 5]] + 1e-4 * rng.standard_normal((300, 2))
    return replace(arm_log(u), outputs=y, name=f"record {seed}")


def model(**more):
    """The arm without it, its parameters wrong; or with it, from wrong values."""
    start = {"m2": 0.6, "d1": 0.15, "d2": 0.03}
    given = [Parameter(name=n, value=x, unit="", where=PATHS[n], lower=0.0, upper=10.0)
             for n, x in start.items()]  # fmt: skip
    whole = joint_plant(text(0.005, "RK4"), given, measured_arm(0))
    effects = [e for e in whole.effects if e.name in KNOWN]
    plant = joint_plant(text(0.005, "RK4"), given, measured_arm(0), effects=effects)
    names = (*start, *more)
    return NominalModel(plant.with_values(more), names, np.full(len(names), 0.5), 0.2)


def test_a_gear_that_gives_in_one_joint_of_an_arm_is_scored_first():
    task = model()
    fitted = fit_nominal(task, as_records([measured_arm(0), measured_arm(1)]))
    best, *others = score_all(fitted, candidates(task.plant, task.names), DiscoveryOptions())
    assert (best.candidate.effect.name, best.candidate.where) == ("joint_elasticity", "joint elbow")
    assert best.candidate.fixed["joint_elasticity.link"] == 0.0
    assert best.fall > 0.7
    assert best.size[0] == pytest.approx(C, rel=0.3)
    for score in others:
        assert score.candidate.effect.name == "joint_elasticity" or score.fall < 0.8 * best.fall


def test_a_fit_of_windows_has_its_numbers():
    names = {"joint_elasticity.c@elbow": (0.07, C), "joint_elasticity.rho": (0.4, RHO),
             "joint_elasticity.zeta": (0.1, ZETA)}  # fmt: skip
    begun = {name: start for name, (start, _) in names.items()}
    found = fit_nominal(model(**begun), as_records([measured_arm(0), measured_arm(1)])).values
    for name, value in {**TRUTH, **{n: right for n, (_, right) in names.items()}}.items():
        assert found[name] == pytest.approx(value, rel=0.15 if "zeta" in name else 0.03)
