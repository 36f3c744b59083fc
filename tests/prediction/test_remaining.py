"""Doubts count where something is left above the sensors' noise, and nowhere else."""

from types import SimpleNamespace

import numpy as np
import pytest

from identification.discovery.findings.finding import FindingKind
from identification.discovery.findings.records_evidence import ShiftedRecord
from identification.discovery.fitted import StepShift
from identification.discovery.options import DiscoveryOptions
from identification.logs.noise import noise_floor
from identification.prediction.judging.trial import CONTRADICTED, OWN_SHARE, find_rivals
from identification.prediction.verdict import remaining
from identification.windows.unseen import Unseen

OPTIONS = DiscoveryOptions()
LEAST = 1 + OPTIONS.min_gap_share  # rms over the noise beyond which something is left
DOUBTFUL = SimpleNamespace(
    candidate=SimpleNamespace(
        effect=SimpleNamespace(name="spring", phrase="spring", sizes=()), where="joint"
    ),
    proof=SimpleNamespace(
        is_everywhere=True, t=OPTIONS.min_proof_t + 0.4, told=SimpleNamespace(fall=0.07, t=2.0)
    ),
    doubt="chance",
    luck=0.02,
)
SHIFT = ShiftedRecord(record="a", shift=7e-4, std=1e-4, fall=0.06, chance=1e-4)


def kinds(
    monkeypatch, ratio, floor=4e-6, accepted=(), rejected=(DOUBTFUL,), finer=np.nan, needed=np.inf
):
    """What is found where the rms on unseen windows is `ratio` times that of the noise.

    Finer steps leave the share `finer` of it. Inputs that err by `needed` would make it.
    """
    monkeypatch.setattr(remaining, "different_records", lambda *_: [])
    squares = ratio**2 * floor * np.array([0.5, 1.5])
    unseen = SimpleNamespace(
        at_horizon=(squares[:1], squares[1:]), floor=floor, floor_std=0.0, noise=np.array([floor]),
        of_outputs=(squares[:1, None], squares[1:, None]),
    )  # fmt: skip
    state = state_of(unseen, accepted, finer=finer)
    return [f.kind for f in remaining.find_remaining(state, rejected, [SHIFT], needed)]


def state_of(unseen, accepted, outputs=("x",), finer=np.nan):
    units, steps = dict.fromkeys(outputs, "rad"), StepShift(np.zeros(0), finer)
    log = SimpleNamespace(output_names=outputs, units=units, name="c")
    told = SimpleNamespace(report=unseen, noise=unseen.noise)
    return SimpleNamespace(
        worse_fit=None, accepted=accepted, cut_short=(),
        model=SimpleNamespace(unseen=told, plant=None, finer=steps, scale=np.ones(len(outputs))),
        task=SimpleNamespace(
            options=OPTIONS, records=2 * (SimpleNamespace(log=log),),
            confirm=[SimpleNamespace(log=log)],
        ),
    )  # fmt: skip


@pytest.mark.parametrize(("rms", "output", "told"), [(45.0, "y", 45.0), (1.3, "", 1.16)])
def test_an_output_that_errs_is_told_whatever_the_others_do(monkeypatch, rms, output, told):
    """The others, which were never wrong, have most of the noise in units of their error."""
    monkeypatch.setattr(remaining, "different_records", lambda *_: [])
    noise = np.array([1.0, 1e-6 if output else 1.0])
    each = noise * np.array([1.0, rms**2])
    unseen = SimpleNamespace(
        at_horizon=(np.array([each.mean()]),), noise=noise, of_outputs=(each[None],),
        floor=noise.mean(), floor_std=0.0,
    )  # fmt: skip
    state = state_of(unseen, ("an effect",), ("x", "y"))
    (found,) = remaining.find_remaining(state, (), (), np.inf)
    assert found.evidence.output == output
    assert found.evidence.noise_ratio == pytest.approx(told, rel=1e-3)
    assert found.evidence.records == ("c",)
    np.testing.assert_allclose(remaining.output_ratios(unseen), [1.0, rms])


def test_much_is_left_where_one_output_errs_by_much(monkeypatch):
    monkeypatch.setattr(remaining, "needed_input_error", lambda *given: np.inf)
    noise = np.array([1.0, 1e-6])
    for rms, is_much in ((1.4, False), (1.6, True)):
        each = noise * np.array([1.0, rms**2])
        select = SimpleNamespace(
            at_horizon=(np.array([each.mean()]),), noise=noise, of_outputs=(each[None],),
            floor=noise.mean(), floor_std=0.0,
        )  # fmt: skip
        steps = StepShift(np.zeros(0), np.nan)
        told = SimpleNamespace(select=select, report=select, floor=select.floor, floor_std=0.0)
        model = SimpleNamespace(unseen=told, fit=None, scale=np.ones(2), finer=steps)
        assert remaining.is_much_left(model, OPTIONS) == is_much
        assert remaining.is_off(model, OPTIONS) == is_much


@pytest.mark.parametrize("ratio", [0.9, 1.0, LEAST - 0.01])
def test_at_the_noise_nothing_is_left_to_explain(monkeypatch, ratio):
    assert kinds(monkeypatch, ratio) == []
    assert kinds(monkeypatch, ratio, accepted=("an effect",)) == []


def test_what_usual_errors_of_inputs_make_is_no_reason_to_believe_an_effect(monkeypatch):
    usual = OPTIONS.max_input_error
    told = [kinds(monkeypatch, 4.0, needed=times * usual) for times in (0.9, 1.1)]
    assert FindingKind.UNPROVEN_EFFECT not in told[0]
    assert FindingKind.UNPROVEN_EFFECT in told[1]
    assert [FindingKind.UNPROVEN_EFFECT, *told[0]] == told[1]  # shifts of records do not change


def test_above_the_noise_a_doubt_and_a_shift_are_told(monkeypatch):
    doubts = [FindingKind.UNPROVEN_EFFECT, FindingKind.SHIFTED_RECORD]
    assert kinds(monkeypatch, LEAST + 0.01) == doubts
    left = kinds(monkeypatch, LEAST + 0.01, accepted=("an effect",))
    assert left == [doubts[0], FindingKind.REMAINING_ERROR, doubts[1]]


def test_an_effect_that_takes_away_next_to_nothing_is_no_doubt(monkeypatch):
    told = SimpleNamespace(fall=0.9 * OPTIONS.min_fall)
    proof = SimpleNamespace(**{**vars(DOUBTFUL.proof), "told": told})
    little = SimpleNamespace(**{**vars(DOUBTFUL), "proof": proof})
    assert FindingKind.UNPROVEN_EFFECT in kinds(monkeypatch, 4.0)
    assert FindingKind.UNPROVEN_EFFECT not in kinds(monkeypatch, 4.0, rejected=(little,))


def test_what_the_steps_of_the_simulation_make_is_nothing_that_is_left(monkeypatch):
    doubts = [FindingKind.UNPROVEN_EFFECT, FindingKind.SHIFTED_RECORD]
    assert kinds(monkeypatch, 1.2 * LEAST, finer=0.8) == []
    assert kinds(monkeypatch, 1.2 * LEAST, finer=0.9) == doubts
    assert kinds(monkeypatch, LEAST - 0.01, finer=1.5) == []  # they make no more than there is
    made = SimpleNamespace(**{**vars(DOUBTFUL), "doubt": "steps"})
    assert kinds(monkeypatch, 1.2 * LEAST, rejected=(made,)) == doubts[1:]


BEFORE, AFTER = (SimpleNamespace(fitted_power=power) for power in (100.0, 50.0))


def law(doubt=None, t=3.0, key=("other", "joint")):
    return SimpleNamespace(
        candidate=SimpleNamespace(key=key), doubt=doubt, prediction=SimpleNamespace(t=t)
    )


def scores(fall, key=("other", "joint")):
    return [SimpleNamespace(candidate=SimpleNamespace(key=key), fall=fall)]


def rivals(other, still=0.0):
    return find_rivals([other], BEFORE, scores(0.4), AFTER, scores(still))


@pytest.mark.parametrize("doubt", [None, "chance", "numbers", "little", "size"])
def test_a_law_that_is_not_proven_is_a_rival_all_the_same(doubt):
    other = law(doubt)
    assert rivals(other) == (other,)


@pytest.mark.parametrize("doubt", CONTRADICTED)
def test_a_law_that_windows_or_records_contradict_is_no_rival(doubt):
    assert rivals(law(doubt)) == ()


@pytest.mark.parametrize("t", [0.0, -0.7])
def test_a_law_that_predicts_unseen_records_no_better_is_no_rival_however_well_it_fits(t):
    assert rivals(law("chance", t)) == ()


def test_what_explains_as_much_beside_the_name_is_missing_too_and_no_rival():
    other = law()
    least = OWN_SHARE * 0.4 * BEFORE.fitted_power / AFTER.fitted_power
    assert rivals(other, 0.9 * least) == (other,)
    assert rivals(other, 1.1 * least) == ()


@pytest.mark.parametrize("known", ["rejected", "failed", ""])
def test_what_was_fitted_before_the_time_limit_is_not_untried(known, monkeypatch):
    score = SimpleNamespace(candidate=SimpleNamespace(key=("spring", "joint")))
    monkeypatch.setattr(remaining, "beyond_chance", lambda *_: [score])
    of = {"rejected": [score], "failed": [score.candidate]}
    state = SimpleNamespace(
        cut_short=("add_set",), scores=[score], task=SimpleNamespace(options=OPTIONS),
        rejected=of["rejected"] if known == "rejected" else [],
        failed=of["failed"] if known == "failed" else [],
    )  # fmt: skip
    found = [f.evidence.score for f in remaining._untried(state)]
    assert found == ([] if known else [score])


def is_off_by_chance(outputs, samples, without=()):
    """How often a right model errs by more than the noise that its own log tells."""
    rng, off = np.random.default_rng(outputs + samples), []
    options, steps = DiscoveryOptions(without=without), StepShift(np.zeros(0), np.nan)
    for _ in range(1000):
        y = rng.standard_normal((samples, outputs))
        unseen = Unseen(
            lengths=(1.0,), powers=((np.mean(y.reshape(-1, 25, outputs) ** 2, axis=1),),), moves=(),
            noise=noise_floor(y) ** 2, samples=samples, fit_percent=np.zeros(outputs), places=(),
            parts=(None,),
        )  # fmt: skip
        model = SimpleNamespace(unseen=SimpleNamespace(report=unseen), finer=steps)
        off.append(remaining.is_off(model, options))
    return np.mean(off)


@pytest.mark.parametrize(("outputs", "samples"), [(1, 250), (1, 500), (1, 2000), (6, 500)])
def test_noise_that_is_itself_estimated_is_seldom_taken_for_an_error(outputs, samples):
    assert is_off_by_chance(outputs, samples) < 0.06


def test_without_its_scatter_every_fourth_short_log_has_an_error():
    assert is_off_by_chance(1, 500, without=("scatter_of_noise",)) > 0.2
