"""Of the robot: torques at the rollers and a wrench on the platform, each alone."""

import numpy as np

from identification.discovery.findings.location import locate_error
from identification.discovery.missing_forces import estimate_missing_forces
from identification.discovery.nominal_model import NominalModel, fit_with_effects
from identification.discovery.options import DiscoveryOptions
from identification.report.finding_words import describe_finding
from inca_mj.effects.motor import DELAY
from inca_mj.studies.worlds import HiddenSetting, effect, world
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.spread import KNOWN


def test_both_places_have_forces_in_their_units_and_sentences():
    log, _ = world(4, [effect("cogging")], ratio=20.0, setting=HiddenSetting(duration=1.5))
    plant = build_twin(timestep=2e-3, effects=(DELAY,))
    nominal_model, options = (
        NominalModel(plant, tuple(KNOWN), np.array([*KNOWN.values()])), DiscoveryOptions()
    )  # fmt: skip
    fit = fit_with_effects(nominal_model, log.part("estimation"), (), {}, options)
    drives, platform = estimate_missing_forces(fit)
    assert (drives.where, platform.where) == ("the actuated joints", "platform")
    assert set(drives.units) == {"N m"}
    assert platform.units == ("N",) * 3 + ("N m",) * 3
    for missing in (drives, platform):
        assert missing.gain > 100
        assert 0.8 < missing.share <= 1
    said = " ".join(map(describe_finding, locate_error(fit, (drives, platform))))
    assert "rms on the actuated joints would explain" in said
    assert "N and" in said
    assert "N m rms on platform would explain" in said
