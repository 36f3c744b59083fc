"""A gear that gives, a gap and presliding are named from records of another integration."""

from functools import cache

import numpy as np
import pytest
from state_cases import BACKLASH, COULOMB, ELASTIC, F_C, PRESLIDING, Truth, measured, pendulum

from identification.discovery.candidates import list_common
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.joint_plant import candidates
from identification.effects.joint_states import JointState
from identification.prediction.discovery import discover_records
from identification.prediction.joint_states import model_for, widened
from identification.prediction.nominal_fit import fit_nominal
from identification.prediction.records import as_records
from identification.prediction.scores import window_scores
from identification.report.discovery_json import discovery_to_json
from identification.report.discovery_text import discovery_text

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


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(ELASTIC, marks=pytest.mark.long),
        pytest.param(BACKLASH, marks=pytest.mark.long),
        PRESLIDING,
    ],
)
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


def test_an_answer_with_states_can_be_told_and_written():
    answer = found(PRESLIDING)
    assert "friction – gives before it slips" in discovery_text(answer)
    assert "presliding" in str(discovery_to_json(answer))


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
