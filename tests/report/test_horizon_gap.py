"""Where a model fails over a horizon: the errors that are told, and the force that is missing."""

from dataclasses import replace

import numpy as np
import pytest
from fake_discovery import found as free_run
from gap_cases import LEVEL, named, unknown
from records_cases import HORIZON

from identification.report.discovery import needed_forces
from identification.report.discovery.horizon_gap import APART, WORST, find_gap
from identification.report.discovery.horizon_section import NO_FORCE, horizon_sections
from identification.report.discovery.json import discovery_to_json
from identification.report.discovery.report import discovery_headline, discovery_text
from identification.report.discovery.verdict import discovery_verdict
from identification.report.words.parts import records_words, unseen_of


def test_errors_are_those_that_the_discovery_tells():
    answer, gap = named(), find_gap(named())
    (angle,) = gap.outputs
    assert (angle.name, angle.unit) == ("angle", "rad")
    assert angle.before == pytest.approx(answer.before.rms, rel=1e-9)
    assert angle.after == pytest.approx(answer.after.rms, rel=1e-9)
    assert angle.noise == pytest.approx(answer.noise_rms, rel=1e-9)
    (at_horizon,) = (n for n in gap.lengths if n.length == HORIZON)
    assert at_horizon.before == pytest.approx(answer.times_noise(answer.before), rel=1e-9)
    assert at_horizon.after == pytest.approx(answer.times_noise(answer.after), rel=1e-9)
    assert [n.length for n in gap.lengths] == pytest.approx([HORIZON / 2, HORIZON, 2 * HORIZON])
    for mine, told in zip(gap.records, answer.errors, strict=True):
        assert (mine.name, mine.role) == (told.name, told.role)
        if mine.role == "fit":  # of records that confirm, only untouched windows are told of
            for ratios, rms in ((mine.before, told.before), (mine.after, told.after)):
                assert np.sqrt(np.mean(ratios**2)) * angle.noise == pytest.approx(rms, rel=1e-9)


def test_the_worst_windows_are_as_they_were_predicted_and_not_neighbours():
    answer, gap = unknown(), find_gap(unknown())
    assert 0 < len(gap.windows) <= WORST
    fitted = [r for r in gap.records if r.role == "fit"]
    assert gap.windows[0].ratio == max(r.after.max() for r in fitted)
    logs = {r.log.name: r.log for r in answer.records}
    for w in gap.windows:
        log = logs[w.record]
        rows = np.searchsorted(log.time, w.time)
        np.testing.assert_array_equal(w.measured, log.outputs[rows, 0])
        rms = np.sqrt(np.mean((w.measured - w.predicted) ** 2))
        assert rms == pytest.approx(w.ratio * gap.outputs[0].noise, rel=1e-9)
    for record in logs:
        begun = sorted(float(w.time[0]) for w in gap.windows if w.record == record)
        assert np.all(np.diff(begun) > (APART - 0.5) * HORIZON)


def test_the_force_that_is_needed_is_the_one_that_is_missing():
    """Coulomb friction: a step over the speed, but for a damping, which is free in the model."""
    (needed,) = find_gap(unknown()).needed.forces
    assert (needed.nodes.joint, needed.nodes.depends_on, needed.unit) == ("hinge", "speed", "N m")
    assert needed.fall > 0.8
    (force,), (std,), (known,) = needed.force, needed.std, needed.known
    told = known & (np.abs(needed.nodes.at) > 1.0)
    assert told.sum() >= 4
    v = needed.nodes.at
    off = force + LEVEL * np.sign(v)
    off -= v * (off[told] @ v[told]) / (v[told] @ v[told])
    assert np.all(np.abs(off)[told] < 4 * std[told] + 0.2 * LEVEL)
    assert needed.known[needed.largest]


CHANCE = 0.037  # of one candidate


def fine(answer):
    """The forces at single joints that the final model of a discovery would need."""
    return needed_forces.fine_forces(answer.final.fit, tuple(answer.final.scale.tolist()))


@pytest.mark.parametrize("is_fine", [True, False])
@pytest.mark.parametrize(("share", "told"), [
    (0.42, "is one on hinge that depends on the rate of hinge: 42 % of the fitted error. This may"
           " be luck: one of the {} candidates that were tried explains as much by luck with a"
           " chance of {} %, and 1 % is the most that counts as proof."),
    (0.09, NO_FORCE),
])  # fmt: skip
def test_a_force_that_may_be_luck_is_told_with_the_chance_of_all_that_were_tried(
    monkeypatch, share, told, is_fine
):
    """Also where no force has a linear response, so that the scores of curves tell it."""
    answer, ((force,), tried) = unknown(), fine(unknown())
    luck = (replace(force, fall=share, chance=CHANCE),), tried
    monkeypatch.setattr(needed_forces, "fine_forces", lambda *_: luck if is_fine else None)
    falls = {"curve_speed": share, "curve_position": share / 2}
    scores = [replace(s, fall=falls.get(s.candidate.effect.name, 0.9), p_value=CHANCE)
              for s in answer.remaining]  # fmt: skip
    (section,) = horizon_sections(replace(answer, remaining=tuple(scores)))
    count, chance = (4, CHANCE) if is_fine else (len(scores), CHANCE * len(scores))
    told = told.format(count, f"{100 * chance:.2g}")
    assert told in section.plain
    assert told in section.text
    assert (NO_FORCE in section.plain) == (told == NO_FORCE)


def test_where_no_force_was_tried_none_is_said_to_explain_nothing(monkeypatch):
    answer = unknown()
    monkeypatch.setattr(needed_forces, "fine_forces", lambda *_: None)
    laws = [s for s in answer.remaining if not s.candidate.effect.is_curve]
    (section,) = horizon_sections(replace(answer, remaining=tuple(laws)))
    assert NO_FORCE not in section.plain


def test_each_ratio_to_the_noise_names_its_records():
    answer = unknown()
    confirm = "record 3 and record 4"
    (verdict, *_) = discovery_verdict(answer)
    assert f"on unseen data ({confirm}) is " in verdict
    text = discovery_text(answer)
    for line in text.splitlines():
        if "times the noise" in line and "window" not in line and not line.startswith("  before"):
            assert f"unseen data ({confirm})" in line
    assert "the median of all windows of record 1, record 2, record 3 and record 4 is " in text
    (answer,) = discovery_headline(answer).answers
    assert f"on unseen data ({confirm})" in [tile.note for tile in answer.tiles]
    assert unseen_of(free_run()) == ""
    assert records_words([f"r{k}" for k in range(7)]) == "7 records"


def test_once_the_friction_is_named_no_force_is_needed():
    assert find_gap(named()).needed.forces == ()
    (section,) = horizon_sections(named())
    assert NO_FORCE not in section.plain  # nothing is far above the noise
    assert "where the model with what is named fails" in section.plain


def test_a_model_that_lacks_nothing_does_not_fail():
    (section, *_) = horizon_sections(replace(unknown(), verdict="nothing missing"))
    assert "where the errors of the fitted model are" in section.plain
    assert "fails" not in section.plain.partition(":")[0]
    assert "where the fitted model fails" in horizon_sections(unknown())[0].plain


def test_json_has_the_place_and_both_directions(monkeypatch):
    answer, ((force,), tried) = unknown(), fine(unknown())
    bump = np.zeros((2, 64))
    bump[:, 30:33] = [[-0.05], [0.04]]
    two = replace(force, depends_on="position", at=np.linspace(-1, 1, 64), force=bump,
                  std=np.full((2, 64), 0.002))  # fmt: skip
    monkeypatch.setattr(needed_forces, "fine_forces", lambda *_: ((two,), tried))
    record = discovery_to_json(answer)
    (told,), place = record["fails"]["forces"], record["missing_place"]
    assert told["force"] == bump[0].tolist()
    assert told["falling"] == {"force": bump[1].tolist(), "std": [0.002] * 64}
    assert (place["joint"], place["moves"], place["force"]) == ("hinge", "against", 0.05)
    assert place["low"] == pytest.approx(-1 + 2 * 29.5 / 63)
    assert place["high"] == pytest.approx(-1 + 2 * 32.5 / 63)


def test_a_free_run_tells_it_otherwise():
    assert find_gap(free_run()) is None
    assert horizon_sections(free_run()) == []
    assert discovery_to_json(free_run())["fails"] is None
