"""The robot's own discovery on logs of the independent reference; some seconds each.

Logs of 4 s and five candidates: enough to name what is large, at a tenth of the price.
"""

from dataclasses import replace

import numpy as np
import pytest

from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.studies.worlds import HiddenSetting, effect, world
from inca_mj.workflows.discovery import discover
from inca_mj.workflows.spread import spread_of

FEW = ("load_dependent_friction", "stribeck_friction", "air_drag", "external_force", "com_offset")
FIVE = tuple(e for e in CATALOGUE if e.name in FEW)
SHORT = HiddenSetting(duration=4.0)
ALIKE = spread_of("none")
MIRRORED = np.array([2, 1, 4, 3, 6, 5, 8, 7]) - 1  # where each drive lands in the plane x = 0


@pytest.mark.long
def test_load_dependent_friction_is_named():
    log, truth = world(3, [effect("load_dependent_friction")], ratio=6.0, setting=SHORT)
    answer = discover(log, effects=FIVE, spread=ALIKE)
    assert answer.verdict == "named"
    named = answer.named[0]
    assert named.candidate.effect.name == "load_dependent_friction"
    assert named.candidate.where == "all drives"
    value, std, _ = named.parameters["mu"]
    assert value == pytest.approx(truth.effects[0].mu, abs=max(4 * std, 0.01))
    assert answer.after.rms < 0.7 * answer.before.rms


@pytest.fixture(scope="module")
def jumped():
    """A log in which the encoder of drive 3 jumps, and candidates of which some are at a drive."""
    still = world(4, setting=SHORT).log
    jump = np.zeros_like(still.outputs)
    jump[:, 2] = 0.02 * np.clip(0.5 + (still.time - 1.3) / 0.1, 0.0, 1.0)
    effects = tuple(e for e in CATALOGUE if e.name in ("encoder_jump", "external_force"))
    return replace(still, outputs=still.outputs + jump), effects


@pytest.fixture(scope="module")
def answer_to_jump(jumped):
    log, effects = jumped
    return discover(log, effects=effects, spread=ALIKE)


@pytest.mark.long  # test_sharpen tests the times that are scored, test_sensor_effects their fit
def test_a_jump_between_the_times_that_are_scored_is_named_with_its_time(answer_to_jump):
    (named,) = answer_to_jump.named
    assert (named.candidate.effect.name, named.candidate.where) == ("encoder_jump", "drive 3")
    value, std, _ = named.parameters["c"]
    assert value == pytest.approx(0.02, abs=4 * std)
    assert named.parameters["t_s"][0] == pytest.approx(1.3, abs=0.05)


@pytest.mark.long
def test_the_order_of_drives_changes_nothing(jumped, answer_to_jump):
    """In a mirror, drive 3 is drive 4: the robot is its own image, and so is the answer."""
    log, effects = jumped
    image = replace(log, inputs=log.inputs[:, MIRRORED], outputs=log.outputs[:, MIRRORED])
    answer = discover(image, effects=effects, spread=ALIKE)
    (one,), (other,) = answer_to_jump.named, answer.named
    assert (other.candidate.effect.name, other.candidate.where) == ("encoder_jump", "drive 4")
    assert other.parameters["c"][:2] == pytest.approx(one.parameters["c"][:2], rel=1e-3)
    assert other.bic_gain == pytest.approx(one.bic_gain, rel=1e-3)
    assert other.confidence == pytest.approx(one.confidence, abs=1e-3)


def test_where_nothing_is_missing_nothing_is_named():
    answer = discover(world(4, setting=SHORT).log, effects=FIVE, spread=ALIKE)
    assert answer.verdict == "nothing missing"
    assert {d.candidate.effect.name for d in answer.detectable} == set(FEW)
