"""A clock that torques have is told where it is true, and not where a force is missing."""

import mujoco
import numpy as np
import pytest
from bump_cases import MJCF, SMALL, cart, push, record, rub

from identification.effects.plant.joint_plant import candidates
from identification.report.torques.words import torque_verdict
from identification.torques.evidence import find_evidence
from identification.torques.fits import CLOCK
from identification.torques.scores import FAR

LATE = 0.02  # [s]
MODEL = mujoco.MjModel.from_xml_string(MJCF)


def evidence(seed, is_smooth=True, **how):
    """What the torques of three records say."""
    logs = [record(seed + k, is_smooth=is_smooth, **how) for k in range(3)]
    effects = [e for e in candidates(cart(), ("m", "d")) if e.is_curve]
    return find_evidence(MODEL, logs, confirm=1, effects=effects)


def words(found):
    """The sentences of the verdict on the clock."""
    return [said for said in torque_verdict(found, MODEL) if "than their stamps say" in said]


@pytest.mark.parametrize("force", [push, rub])
def test_a_bump_that_is_missing_is_no_shift_of_exact_stamps(force):
    """The fit has a clock of some 30 ms, five std from none."""
    found = evidence(1, force=force, size=2.0)
    fit, clock = found.whole.fit, found.whole.names.index(CLOCK)
    assert abs(fit.θ[clock]) > FAR * fit.std[clock]
    assert not found.clocks.shift.any()
    assert words(found) == []


def test_a_true_shift_is_told():
    found = evidence(1, size=0.0, late=LATE)
    assert found.clocks.shift == pytest.approx(LATE, abs=2 * SMALL)
    assert (found.clocks.std < 4e-4).all()
    (said,) = words(found)
    assert said.startswith("The inputs act 2")


def test_a_true_shift_is_told_beside_a_spring_that_is_missing():
    clocks = evidence(1, is_smooth=False, size=0.0, late=LATE, spring=3.0).clocks
    assert clocks.shift == pytest.approx(LATE, abs=2 * SMALL)
    assert (clocks.std < 1e-4).all()


def test_exact_stamps_have_no_shift():
    assert np.abs(evidence(1, size=0.0).clocks.shift).max() < 2 * SMALL
    told = evidence(1, is_smooth=False, size=0.0, spring=3.0)
    assert np.abs(told.clocks.shift).max() < 2 * SMALL
