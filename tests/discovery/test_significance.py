"""Which scores are worth a refit, and which of the others a name must not hide."""

from dataclasses import replace

import numpy as np
import pytest
from discovery_cases import EFFECTS, OPTIONS, nominal_model, record, slider, wander

from identification import InputError, Parameter
from identification.discovery.findings.doubts import find_oversized_effect
from identification.discovery.scoring.scores import Score
from identification.discovery.scoring.significance import find_oversized, select_significant
from identification.discovery.search import discover
from identification.effects.effect import Candidate, Effect, Size
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise
from identification.report.finding_words import describe_finding


def scored(name, size, gain, p=1e-9, sign=0, largest=1.0):
    effect = Effect(name, "f", (Size("f", "N", largest, 1e-3, sign),), places={"joint": ""})
    level = NoiseLevel(Noise(0.0, 0.1), 1.0, 0.0)
    return Score(
        candidate=Candidate(effect, "joint", {}), size=np.array([size]), std=np.ones(1), gain=gain,
        p_value=p, block_p_value=p, identifiable=1.0, level=level,
    )  # fmt: skip


MILD = scored("mild", 0.5, 100.0)


@pytest.mark.parametrize(
    ("other", "hides"),
    [
        (scored("stiff", 6.0, 200.0), True),  # five times the largest is 5
        (scored("stiff", 4.0, 200.0), False),  # it was refitted
        (scored("stiff", 6.0, 110.0), False),  # no better than what is named
        (scored("stiff", 6.0, 200.0, p=0.2), False),  # luck
        (scored("stiff", -6.0, 200.0, sign=1), False),  # physics forbids it
    ],
)
def test_a_name_must_not_hide_what_explains_more_at_a_size_beyond_belief(other, hides):
    scores = (other, MILD)
    found = find_oversized(scores, ["mild"], OPTIONS)
    assert found is (other if hides else None)
    assert find_oversized(scores, [], OPTIONS) is None
    assert find_oversized(scores, ["mild", "stiff"], OPTIONS) is None
    if hides:
        assert [s.candidate.effect.name for s in select_significant(scores, OPTIONS)] == ["mild"]
        (finding,) = find_oversized_effect(scores, ["mild"], OPTIONS)
        assert finding.evidence.limits == {"f": 5.0}
        said = describe_finding(finding)
        assert "f = 6 N where 5 N is thought to be the most" in said
    else:
        assert find_oversized_effect(scores, ["mild"], OPTIONS) == ()


@pytest.mark.parametrize(("gain", "heard"), [(250.0, True), (150.0, False)])
def test_an_effect_of_another_shape_that_was_refitted_does_not_hide(gain, heard):
    beyond_belief, believed = scored("stiff", 6.0, 200.0), scored("stiff", 4.0, gain)
    found = find_oversized((beyond_belief, believed, MILD), ["mild"], OPTIONS)
    assert found is (None if heard else beyond_belief)


def test_one_that_explains_less_is_not_named_in_place_of_one_that_may_not_be_so_large():
    spring, *others = EFFECTS
    (k,) = spring.sizes
    weak = replace(spring, sizes=(replace(k, largest=0.2),))  # of which 1 N/m is believed
    log = record(slider(mass=2.2, damping=2.7, **{"spring.k": 5.0}), 500, seed=11,
                 error=wander(500, 0.03, 0.1, seed=8))  # fmt: skip
    answer = discover(nominal_model(), log, (weak, *others))
    assert answer.verdict != "nothing missing"
    assert "spring" not in {n.candidate.effect.name for n in answer.named}
    assert not answer.named
    free = discover(nominal_model(), log, EFFECTS)
    assert [n.candidate.effect.name for n in free.named] == ["spring"]


def test_a_free_parameter_that_no_output_feels_is_refused():
    idle = Parameter(
        name="width", value=1.0, unit="kg m^2", where="body/cart.inertia[1]", lower=0.0
    )
    plant = slider()
    own = replace(plant.parameters, records=(*plant.parameters, idle))
    robot = nominal_model()
    robot = replace(robot, plant=replace(plant, parameters=own),
                    names=(*robot.names, "width"), std=np.append(robot.std, 0.3))  # fmt: skip
    with pytest.raises(InputError, match="width has no effect on position"):
        discover(robot, record(slider(), 500), EFFECTS)
