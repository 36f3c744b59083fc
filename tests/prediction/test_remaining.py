"""Doubts count where something is left above the sensors' noise, and nowhere else."""

from types import SimpleNamespace

import numpy as np
import pytest

from identification.discovery.findings.finding import FindingKind
from identification.discovery.findings.records_evidence import ShiftedRecord
from identification.discovery.options import DiscoveryOptions
from identification.prediction import remaining

OPTIONS = DiscoveryOptions()
LEAST = 1 + OPTIONS.min_gap_share  # rms over the noise beyond which something is left
DOUBTFUL = SimpleNamespace(
    candidate=SimpleNamespace(
        effect=SimpleNamespace(name="spring", phrase="spring", sizes=()), where="joint"
    ),
    proof=SimpleNamespace(is_everywhere=True, fall=0.07, t=OPTIONS.min_proof_t + 0.4),
    doubt="chance",
)
SHIFT = ShiftedRecord(record="a", shift=7e-4, std=1e-4, fall=0.06, chance=1e-4)


def kinds(monkeypatch, ratio, floor=4e-6, accepted=(), rejected=(DOUBTFUL,)):
    """What is found where the rms on unseen windows is `ratio` times that of the noise."""
    monkeypatch.setattr(remaining, "different_records", lambda state: [])
    squares = ratio**2 * floor * np.array([0.5, 1.5])
    unseen = SimpleNamespace(
        at_horizon=(squares[:1], squares[1:]), floor=floor, noise=np.array([floor]),
        of_outputs=(squares[:1, None], squares[1:, None]),
    )  # fmt: skip
    return [f.kind for f in remaining.find_remaining(state_of(unseen, accepted), rejected, [SHIFT])]


def state_of(unseen, accepted, outputs=("x",)):
    log = SimpleNamespace(output_names=outputs)
    return SimpleNamespace(
        worse_fit=None, accepted=accepted, model=SimpleNamespace(unseen=unseen, plant=None),
        task=SimpleNamespace(options=OPTIONS, records=2 * (SimpleNamespace(log=log),)),
    )  # fmt: skip


@pytest.mark.parametrize(("rms", "output", "told"), [(45.0, "y", 45.0), (1.3, "", 1.16)])
def test_an_output_that_errs_is_told_whatever_the_others_do(monkeypatch, rms, output, told):
    """The others, which were never wrong, have most of the noise in units of their error."""
    monkeypatch.setattr(remaining, "different_records", lambda state: [])
    noise = np.array([1.0, 1e-6])
    each = noise * np.array([1.0, rms**2])
    unseen = SimpleNamespace(
        at_horizon=(np.array([each.mean()]),), noise=noise, of_outputs=(each[None],),
        floor=noise.mean() / (1 if output else told**2),
    )  # fmt: skip
    state = state_of(unseen, ("an effect",), ("x", "y"))
    (found,) = remaining.find_remaining(state, (), ())
    assert found.evidence.output == output
    assert found.evidence.noise_ratio == pytest.approx(told, rel=1e-3)
    np.testing.assert_allclose(remaining.output_ratios(unseen), [1.0, rms])


def test_an_encoder_that_rests_says_nothing_of_its_noise():
    unseen = SimpleNamespace(of_outputs=(np.array([[4.0, 1.0]]),), noise=np.array([1.0, 0.0]))
    assert remaining.output_ratios(unseen).tolist() == [2.0, 0.0]


@pytest.mark.parametrize("ratio", [0.9, 1.0, LEAST - 0.01])
def test_at_the_noise_nothing_is_left_to_explain(monkeypatch, ratio):
    assert kinds(monkeypatch, ratio) == []
    assert kinds(monkeypatch, ratio, accepted=("an effect",)) == []


def test_above_the_noise_a_doubt_and_a_shift_are_told(monkeypatch):
    doubts = [FindingKind.UNPROVEN_EFFECT, FindingKind.SHIFTED_RECORD]
    assert kinds(monkeypatch, LEAST + 0.01) == doubts
    left = kinds(monkeypatch, LEAST + 0.01, accepted=("an effect",))
    assert left == [doubts[0], FindingKind.REMAINING_ERROR, doubts[1]]


def test_an_effect_at_a_place_is_doubted_once(monkeypatch):
    twice = kinds(monkeypatch, LEAST + 0.01, rejected=(DOUBTFUL, DOUBTFUL))
    assert twice == [FindingKind.UNPROVEN_EFFECT, FindingKind.SHIFTED_RECORD]


def test_sensors_without_noise_leave_all_to_be_explained():
    unseen = SimpleNamespace(at_horizon=(np.array([1e-12]),), floor=0.0)
    assert remaining.noise_ratio(SimpleNamespace(model=SimpleNamespace(unseen=unseen))) == np.inf
