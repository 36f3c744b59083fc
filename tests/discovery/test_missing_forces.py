"""Missing forces: the smoother against dense algebra, and forces whose truth is known."""

import numpy as np
import pytest
from discovery_cases import (
    FREE,
    KNOWN,
    OPTIONS,
    STEP,
    coloured,
    covariance,
    linear_plant,
    record,
    response,
    slider,
)
from effect_cases import BY_NAME

from identification.discovery.missing_forces import estimate_missing_forces, locate_error
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.innovations.fit import fit_with_effects
from identification.kalman.noise_model import Noise, smooth
from identification.report.discovery.finding_words import describe_finding
from inca_mj.studies.worlds import HiddenSetting, effect, world
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.spread import KNOWN as KNOWN_INCA


@pytest.mark.parametrize("seed", range(4))
def test_the_smoother_is_the_conditional_mean(seed):
    rng = np.random.default_rng(seed)
    plant, noise = linear_plant(rng), Noise(0.7, 0.05, (1.2, 0.75))
    n, ny = len(plant.B) + 1, len(plant.C)
    e = rng.standard_normal((n, ny))
    T, W = response(plant), coloured(n, plant.B.shape[2], noise)
    dense = W @ T.T @ np.linalg.solve(covariance(plant, noise), e.ravel())
    w, part = smooth(plant, noise, e, STEP)
    np.testing.assert_allclose(w.ravel(), dense, atol=1e-8)
    np.testing.assert_allclose(part.ravel(), T @ dense, atol=1e-8)


def test_a_force_that_the_model_lacks_is_seen_in_newtons():
    n = 500
    push = 0.4 * np.sin(2 * np.pi * 0.7 * STEP * np.arange(n))[:, None]  # of 5 N per unit
    log = record(slider(), n, error=push)
    fit = fit_with_effects(NominalModel(slider(), FREE, KNOWN / 100), log, (), {}, OPTIONS)
    (missing,) = estimate_missing_forces(fit)
    assert missing.where == "the actuated joints"
    assert missing.names == ("slide",)
    assert missing.units == ("N",)
    assert missing.share > 0.99
    inner = slice(50, -50)
    assert np.corrcoef(missing.force[inner, 0], push[inner, 0])[0, 1] > 0.95
    slope = missing.force[inner, 0] @ push[inner, 0] / (push[inner, 0] @ push[inner, 0])
    assert slope == pytest.approx(5.0, rel=0.1)


def test_both_places_have_forces_in_their_units_and_sentences():
    log, _ = world(4, [effect("cogging")], ratio=20.0, setting=HiddenSetting(duration=1.5))
    plant = build_twin(timestep=2e-3, effects=(BY_NAME["delay"],))
    nominal_model, options = (
        NominalModel(plant, tuple(KNOWN_INCA), np.array([*KNOWN_INCA.values()])), DiscoveryOptions()
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
