"""How large an effect may be that the fitted noise hides."""

from dataclasses import replace

import numpy as np
import pytest
from discovery_cases import OPTIONS, linear_plant, point_of, scored, sensitivity
from scipy.stats import norm

from identification.discovery.scoring.hidden import list_hidden
from identification.discovery.scoring.scores import Score
from identification.effects.effect import Candidate, Effect, Size
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise

PLACES = {"all": "", "drive 1": "@1"}
LEVEL = NoiseLevel(Noise(2.0, 0.1), 0.5, 0.0)


def score_of(name, where="all", *, size=1.0, std=0.1, gain=3.0, sign=0, ratio=2.0):
    of = Effect(name, "f", (Size("a", "N", 2.0, 1e-3, sign=sign),), places=PLACES)
    return Score(
        candidate=Candidate(of, where, {}), size=np.array([size]), std=np.array([std]), gain=gain,
        p_value=0.1, block_p_value=0.1, identifiable=1.0,
        level=replace(LEVEL, noise=Noise(ratio, 0.1)),
    )  # fmt: skip


def test_the_interval_ends_where_a_normal_one_does():
    (h,) = list_hidden([score_of("push", size=-1.0)], LEVEL, OPTIONS)
    value, most, unit = h.sizes["a"]
    assert (value, unit, h.gain) == (-1.0, "N", 3.0)
    assert most == pytest.approx(1 + norm.isf(0.025) * 0.1)


def test_an_effect_is_told_once_where_it_explains_most():
    some = [score_of("push", "drive 1", gain=5.0), score_of("pull", gain=4.0), score_of("push")]
    told = [(h.candidate.effect.name, h.candidate.where) for h in list_hidden(some, LEVEL, OPTIONS)]
    assert told == [("push", "drive 1"), ("pull", "all")]


def test_what_cannot_be_or_explains_nothing_is_not_told():
    some = [
        score_of("nothing", gain=0.0),
        score_of("backward", sign=-1),
        score_of("huge", size=1.01 * OPTIONS.size_factor * 2.0),
        score_of("anything", std=100.0),
    ]
    assert list_hidden(some, LEVEL, OPTIONS) == ()


@pytest.mark.parametrize(("ratio", "taken"), [(2.0, 0.0), (1.0, 0.75), (0.0, 1.0), (3.0, 0.0)])
def test_what_it_takes_is_a_share_of_the_power_of_the_input_error(ratio, taken):
    (h,) = list_hidden([score_of("push", ratio=ratio)], LEVEL, OPTIONS)
    assert h.taken == pytest.approx(taken)


def test_the_true_size_is_inside_in_nineteen_logs_of_twenty():
    rng = np.random.default_rng(3)
    plant, level = linear_plant(rng, 80), NoiseLevel(Noise(0.0, 0.1), 1.0, 0.0)
    J, S, size = rng.standard_normal((80, 2, 3)), rng.standard_normal((80, 2, 1)), 0.3
    inside = []
    for _ in range(300):
        e = rng.standard_normal((80, 2)) + size * S[..., 0]
        some = scored(point_of(plant, e, J), level, np.zeros(3), [sensitivity(S)])
        inside += [h.sizes[n][1] > size for h in list_hidden(some, level, OPTIONS) for n in h.sizes]
    # One side of the interval is asked: 97.5 % of 300, which chance moves by 3 % (3 std).
    assert np.mean(inside) == pytest.approx(0.975, abs=0.03)
