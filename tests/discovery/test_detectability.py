"""What a log could have shown."""

import numpy as np
import pytest
from discovery_cases import OPTIONS, linear_plant, point_of, scored, sensitivity
from scipy.stats import f, ncf

from identification.discovery.scoring.detectability import DETECTION_NONCENTRALITY, list_detectable
from identification.discovery.scoring.scores import Score
from identification.effects.effect import Candidate, Effect, Size
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise

NONCENTRALITY, BLOCKS = DETECTION_NONCENTRALITY, OPTIONS.score_blocks
PLACES = {"all": "", "drive 1": "@1", "drive 2": "@2"}


def score_of(where, std, places=PLACES, largest=10.0):
    of = Effect("push", "f", (Size("a", "N", largest, 1e-3),), places=places)
    level = NoiseLevel(Noise(0.0, 0.1), 1.0, 0.0)
    return Score(
        candidate=Candidate(of, where, {}), size=np.zeros(1), std=np.array([std]), gain=0.0,
        p_value=1.0, block_p_value=1.0, identifiable=1.0, level=level,
    )  # fmt: skip


def test_the_noncentrality_is_that_of_nine_in_ten_by_blocks_over_two_hundred_candidates():
    demanded = f.isf(0.01 / 200, 1, BLOCKS - 1)
    assert 0.87 < ncf.sf(demanded, 1, BLOCKS - 1, NONCENTRALITY) < 0.93


def test_the_smallest_size_follows_the_std():
    (d,) = list_detectable([score_of("all", 0.1)], OPTIONS)
    assert d.smallest == pytest.approx(0.1 * np.sqrt(NONCENTRALITY))
    assert (d.size, d.unit, d.candidate.where) == ("a", "N", "all")


@pytest.mark.parametrize("std", [11.0, np.inf, 0.0])
def test_what_would_have_to_be_beyond_physics_is_never_seen(std):
    (d,) = list_detectable([score_of("all", std)], OPTIONS)
    assert d.smallest == np.inf


def test_everywhere_counts_before_single_places_and_the_worst_of_those():
    some = [score_of("drive 1", 0.1), score_of("all", 0.2), score_of("drive 2", 0.5)]
    assert list_detectable(some, OPTIONS)[0].smallest == pytest.approx(0.2 * np.sqrt(NONCENTRALITY))
    single = {k: v for k, v in PLACES.items() if v}
    some = [score_of(where, std, single) for where, std in (("drive 1", 0.1), ("drive 2", 0.5))]
    assert list_detectable(some, OPTIONS)[0].candidate.where == "drive 2"


def test_an_effect_of_that_size_is_found_in_nine_of_ten_logs():
    rng = np.random.default_rng(1)
    plant, level = linear_plant(rng, 80), NoiseLevel(Noise(0.0, 0.1), 1.0, 0.0)
    J, S = rng.standard_normal((80, 2, 3)), rng.standard_normal((80, 2, 1))
    (clean,) = scored(
        point_of(plant, rng.standard_normal((80, 2)), J), level, np.zeros(3), [sensitivity(S)]
    )
    size = np.sqrt(NONCENTRALITY) * clean.std[0] / clean.level.sigma
    found = 0
    for _ in range(200):
        e = rng.standard_normal((80, 2)) + size * S[..., 0]
        (s,) = scored(point_of(plant, e, J), level, np.zeros(3), [sensitivity(S)])
        found += s.p_value < 0.05 / 30
    assert 0.85 < found / 200 <= 1
