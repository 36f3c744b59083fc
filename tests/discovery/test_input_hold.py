"""A forgotten hold is told as such, and the right one is not doubted."""

from dataclasses import replace

import numpy as np
import pytest
from discovery_cases import task
from joint_cases import DAMPING, MASS, SLIDER, run, slider_log
from scipy.signal import lfilter

from identification.discovery.findings.finding import FindingKind
from identification.discovery.nominal_model import NominalModel
from identification.effects.plant.joint_plant import joint_plant
from identification.innovations.fitted_model import fit_model
from identification.innovations.input_error import find_input_hold

NOISE = 2e-5  # std of the sensor [m]


def moving(hold, samples=800):
    """A slider under a smooth random input that is held so."""
    white = np.random.default_rng(3).standard_normal(samples)
    u = lfilter([0.15], [1, -0.85], white)[:, None]
    log = replace(slider_log(u), hold=hold)
    y = run(joint_plant(SLIDER, (MASS, DAMPING), log), log, mass=2.1, damping=2.8)
    return replace(log, outputs=y + NOISE * np.random.default_rng(4).standard_normal(y.shape))


def found(log):
    plant = joint_plant(SLIDER, (MASS, DAMPING), log)
    model = NominalModel(plant, ("mass", "damping"), np.array([0.3, 0.3]))
    return find_input_hold(fit_model(task(log, model=model), (), {}).refit)


@pytest.mark.parametrize(("true", "other"), [("foh", "zoh"), ("zoh", "foh")])
def test_the_other_hold_is_told_where_it_is_the_right_one(true, other):
    log = moving(true)
    assert found(log) == ()
    (finding,) = found(replace(log, hold=other))
    assert finding.kind is FindingKind.INPUT_HOLD
    assert finding.evidence.hold == true
    assert finding.evidence.unit == "V"
    assert finding.evidence.rms < 0.5 * finding.evidence.rms_now
