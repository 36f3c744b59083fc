"""Records exchange their roles: what holds for all stays, what one lacks is contradicted."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from exchange_cases import MU, NAME, SAMPLES, other_side, pair, unproven
from records_cases import (
    FREE,
    HORIZON,
    NOISE,
    STEP,
    listed,
    nominal_model,
    pendulum,
    record,
    records,
    roles,
    search,
)

from identification.discovery.findings.finding import FindingKind
from identification.discovery.options import DiscoveryOptions
from identification.model.predictor import Predictor
from identification.prediction.discovery import discover_records
from identification.prediction.fits.model import predict_fitted
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.judging.judging import REFUTED
from identification.prediction.judging.trial import Contender, find_doubt
from identification.prediction.scoring.screening import score_all
from identification.prediction.selection.exchange import (
    exchanged,
    is_contradicted,
    missing_chance_alone,
    with_both_roles,
    without_contradicted,
)
from identification.prediction.selection.selection import refit_contenders
from identification.prediction.verdict import remaining
from identification.prediction.verdict.remaining import needed_input_error
from identification.windows.comparison import compare
from identification.windows.fit import solve
from identification.windows.problem import with_scale
from identification.windows.records import as_records
from identification.windows.unseen import HORIZON as ALONE

OFFSET = "offset.f_0@hinge"
OPTIONS = DiscoveryOptions()


def test_the_model_with_roles_exchanged_is_that_of_a_fit_to_the_other_records():
    logs = records(4, samples=SAMPLES)
    model = fit_nominal(nominal_model(), roles(logs))
    reverse = fit_nominal(nominal_model(), as_records(logs[2:], logs[:2]))
    found = exchanged(model, roles(logs), HORIZON)
    for name in FREE:  # some of the windows, and a coarser end of the search
        assert found.values[name] == pytest.approx(reverse.values[name], abs=3 * reverse.std[name])
    assert [p.predictor.log.name for p in found.fit.problem.parts] == ["record 3", "record 4"]
    assert len(found.unseen.at_horizon) == 2


def test_a_law_of_all_records_is_the_same_from_both_sides():
    _, _, with_it = pair("has it")
    without, other = other_side("has it")
    assert other.values[MU] == pytest.approx(with_it.values[MU], abs=4 * with_it.std[MU])
    assert not is_contradicted(without, other, with_it, OPTIONS)


def test_a_curve_is_not_asked_because_a_record_tells_only_the_nodes_that_it_reaches():
    """The same model, called a law or a curve: only the law is contradicted."""
    every, without, with_it = pair("lacks it")
    bare, _ = other_side("lacks it")
    gains = np.zeros(4)
    (c,) = with_it.candidates
    curve = replace(c, effect=replace(c.effect, name="curve_speed"))
    for candidate, doubt in ((c, "exchange"), (curve, None)):
        contender = Contender(
            model=replace(with_it, candidates=(candidate,)), gains=gains, numbers=1, doubt=None,
            prediction=compare(without.unseen, with_it.unseen), criterion=1.0,
            explained=0.0,
        )  # fmt: skip
        tried, _ = without_contradicted([contender], bare, every, HORIZON, OPTIONS, lambda _: None)
        assert [t.doubt for t in tried] == [doubt]


def judged_by_both(second, contender):
    every, *_ = pair(second)
    (found,) = with_both_roles([contender], other_side(second)[0], every, HORIZON, OPTIONS)
    return found


def test_a_law_that_misses_chance_alone_is_proven_by_blocks_of_all_records():
    weak = unproven("has it")
    found = judged_by_both("has it", weak)
    assert found.doubt is None
    assert found.prediction.chance < OPTIONS.significance
    assert found.luck < OPTIONS.significance
    assert found.prediction.records == weak.prediction.records  # told of those that confirm


def test_the_price_of_many_refits_is_asked_of_both_roles_too():
    assert judged_by_both("has it", unproven("has it", refits=10**18)).doubt == "chance"


def test_a_law_that_a_fitted_record_lacks_is_not_proven_by_it():
    assert judged_by_both("lacks it", unproven("lacks it")).doubt is not None


@pytest.mark.parametrize("doubt", [None, "record", "bound", "numbers"])
def test_only_what_misses_chance_alone_is_asked(doubt):
    assert missing_chance_alone([unproven("has it", doubt)], OPTIONS) is None


def test_no_curve_is_asked_in_both_roles():
    assert missing_chance_alone([unproven("has it", is_curve=True)], OPTIONS) is None


def test_a_proven_law_that_is_likelier_leaves_nothing_to_ask():
    weak = unproven("has it")
    best = replace(weak, doubt=None, criterion=100.0)
    assert missing_chance_alone([best, weak], OPTIONS) is None
    assert missing_chance_alone([replace(best, criterion=-100.0), weak], OPTIONS) is weak


def test_a_law_that_one_fitted_record_lacks_is_proven_and_then_contradicted():
    _, without, with_it = pair("lacks it")
    assert find_doubt(compare(without.unseen, with_it.unseen), 1, OPTIONS) is None
    assert is_contradicted(*other_side("lacks it"), with_it, OPTIONS)


@pytest.mark.long
def test_what_is_contradicted_is_told_and_not_named():
    every, *_ = pair("lacks it")
    said = []
    found = search([r.log for r in every], [NAME], progress=said.append)
    assert found.named == ()
    assert found.verdict == "unknown effect"
    assert [r.doubt for r in found.rejected] == ["exchange"]
    assert any("contradicted where the records exchange their roles" in line for line in said)


def fitted():
    """Records that confirm with friction under load, and the model without it."""
    every, without, _ = pair("has it")
    return [r for r in every if r.role == "confirm"], without


def predicted(model, confirm, **lengths):
    return predict_fitted(model.plant, confirm, HORIZON, model.scale, model.fit, {}, **lengths)


def test_a_length_is_predicted_the_same_alone_and_with_others():
    confirm, model = fitted()
    whole, alone = predicted(model, confirm), predicted(model, confirm, lengths=ALONE)
    assert alone.lengths == ALONE
    for mine, other in zip(alone.at_horizon, whole.at_horizon, strict=True):
        np.testing.assert_array_equal(mine, other)
    rest = predicted(model, confirm, lengths=[n for n in whole.lengths if n not in ALONE])
    joined = alone.plus(rest)
    assert joined.lengths == whole.lengths
    for mine, other in zip(joined.squares, whole.squares, strict=True):
        np.testing.assert_array_equal(np.concatenate(mine), np.concatenate(other))
    np.testing.assert_array_equal(joined.fit_percent, whole.fit_percent)


@pytest.mark.parametrize("least", [DiscoveryOptions().min_proof_t, 1e3])
def test_what_the_horizon_refutes_is_predicted_over_no_other_length_and_the_rest_over_all(least):
    confirm, model = fitted()
    few = ("transmitted_load_friction", "quadratic_friction", "offset")
    scores = score_all(model, listed(*few), DiscoveryOptions())
    options = DiscoveryOptions(min_proof_t=least)
    parent, tried = refit_contenders(model, scores, HORIZON, confirm, options, lambda _: None)
    assert tried[0].is_proven == (least < 1e3)
    for c in tried:
        lengths = ALONE if c.doubt in REFUTED else parent.unseen.lengths
        assert c.model.unseen.lengths == lengths
        assert len(c.prediction.falls) == len(lengths)


def disturbed(seed, share):
    """A record whose input errs by a constant over each window, which the log does not have."""
    log, rng = record(seed, samples=300), np.random.default_rng(100 + seed)
    length = round(HORIZON / STEP)
    size = share * np.sqrt(np.mean(log.inputs**2))
    error = np.repeat(size * rng.standard_normal(len(log) // length + 1), length)[: len(log), None]
    y = Predictor(pendulum(), replace(log, inputs=log.inputs + error), ()).predict(np.zeros((1, 0)))
    return replace(log, outputs=y[0] + NOISE * rng.standard_normal(y[0].shape))


@cache
def excused():
    """A fit of records whose inputs err by a tenth."""
    logs = [disturbed(k, 0.1) for k in range(1, 4)]
    return fit_nominal(nominal_model(), roles(logs))


def needed(found, options=None, unseen=()):
    """The error of the inputs that what a model leaves needs."""
    return needed_input_error(
        found.fit, options or DiscoveryOptions(), found.scale, found.unseen.noise, unseen
    )


def test_no_error_of_set_points_excuses_what_is_left(monkeypatch):
    found = excused()
    assert needed(found) == pytest.approx(0.1, rel=0.3)
    monkeypatch.setattr(remaining, "is_set_point", lambda model, control: control == 0)
    assert needed(found) == np.inf
    without = DiscoveryOptions(without=("exact_set_points",))
    assert needed(found, without) == pytest.approx(0.1, rel=0.3)


def test_the_error_of_the_inputs_does_not_depend_on_how_a_fit_weighs_its_errors():
    found, fit = excused(), excused().fit
    task = with_scale(fit.problem, 0.01 * found.scale)
    other = replace(found, fit=solve(task, fit.q, fit.moves))
    assert needed(other) == pytest.approx(needed(found), rel=0.05)


def test_an_error_of_the_inputs_is_found_where_only_unseen_records_have_it():
    logs = [disturbed(1, 0.0), disturbed(2, 0.0), disturbed(3, 0.1)]
    found = fit_nominal(nominal_model(), roles(logs))
    assert needed(found) < 0.005
    assert needed(found, unseen=found.unseen.of_outputs) == pytest.approx(0.1, rel=0.3)


@pytest.mark.parametrize("force", [0.0, 0.05])
def test_a_force_that_comes_after_the_fitted_record_is_something_that_is_missing(force):
    """The fitted record has no trace of it, so that no effect can be proven; the records differ."""
    before, after = (
        record(1, 400, plant=pendulum()),
        record(2, 400, {OFFSET: force}, plant=pendulum()),
    )
    effects = listed("quadratic_friction", "delay")
    found = discover_records(nominal_model(), [before], [after], effects)
    told = [f.evidence for f in found.findings if f.kind is FindingKind.DIFFERENT_RECORD]
    assert found.verdict == ("unknown effect" if force else "nothing missing")
    assert [(e.record, e.others) for e in told] == (
        [("record 2", ("record 1 (fit)",))] if force else []
    )


@pytest.mark.parametrize("share", [0.0, 0.008])
def test_an_error_that_usual_errors_of_inputs_excuse_is_left_all_the_same(share):
    logs = [disturbed(k, share) for k in range(1, 4)]
    found = search(logs, ("hardening", "offset"))
    assert found.verdict == "nothing missing"
    assert found.unexplained == (share > 0)
    assert found.is_good is (None if share else True)
