"""An effect of which the last fit leaves nothing is no name."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from records_cases import listed, nominal_model, records

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import CURVE, Candidate, Effect
from identification.effects.sizes import Shape, Size
from identification.prediction.discovery import WINDOWS
from identification.prediction.judging.judging import judged
from identification.prediction.moves.add_set import with_one
from identification.prediction.task import RecordsTask
from identification.prediction.verdict import last_fit
from identification.prediction.verdict.last_fit import times_std, with_last_fit
from identification.windows.records import as_records


def candidate(*sizes, shape=None, name="law"):
    """An effect at one place with these sizes, and perhaps a free shape."""
    shapes = () if shape is None else (Shape(shape, "", (1.0,), 0.0, 9.0),)
    every = tuple(Size(s, "N", 1.0, 0.1, about="") for s in sizes)
    effect = Effect(name, "", every, shapes, places={"joint": ""}, hooks={})
    fixed = {effect.parameter(s.name, "joint"): 1.0 for s in shapes}
    return Candidate(effect, "joint", fixed)


def model(values, covariance, slope=1.0, at_bound=()):
    """A fit of values by name; its coordinates are these values over the slope."""
    names, C = [*values], np.array(covariance) / slope**2
    space = SimpleNamespace(slope=lambda q: np.full(len(q), slope))
    fit = SimpleNamespace(
        problem=SimpleNamespace(names=names, prior=SimpleNamespace(space=space)),
        q=np.array([*values.values()]) / slope, values=values, covariance=C,
    )  # fmt: skip
    return SimpleNamespace(fit=fit, at_bound=at_bound)


@given(st.floats(-10, 10), st.floats(0.1, 10), st.floats(0.01, 100))
def test_of_one_size_it_is_the_size_over_its_std_in_any_coordinates(size, std, slope):
    found = times_std(model({"law.c": size}, [[std**2]], slope), candidate("c"))
    assert found == pytest.approx(abs(size) / std, abs=1e-9)


def test_sizes_that_trade_for_one_another_are_known_together():
    """Their sum is known to a hundredth, and neither of them to less than itself."""
    C = np.array([[1.0, -1.0], [-1.0, 1.0]]) + 1e-4 * np.eye(2)
    found = times_std(model({"law.a": 0.5, "law.b": 0.5}, C), candidate("a", "b"))
    assert found > 50


def test_a_size_that_trades_for_a_shape_is_known_beside_it():
    C = np.array([[1.0, 0.9999], [0.9999, 1.0]])
    law = candidate("c", shape="n")
    assert times_std(model({"law.c": 0.5, "law.n": 2.0}, C), law) > 30
    assert times_std(model({"law.c": 0.5}, C[:1, :1]), law) == pytest.approx(0.5)


def test_what_has_no_std_is_not_asked():
    values = {"law.c": 0.0}
    assert times_std(model(values, [[1.0]], at_bound=("law.c",)), candidate("c")) == np.inf
    assert times_std(model({"other": 0.0}, [[1.0]]), candidate("c")) == np.inf
    curve = candidate("c", name=f"{CURVE}speed")
    assert times_std(model({f"{CURVE}speed.c": 0.0}, [[1.0]]), curve) == np.inf


@pytest.mark.parametrize(("true", "times", "without", "kept"), [
    (0.0, 100.0, (), 0),  # the steps of the search made it, and the last fit takes it away
    (0.0, 100.0, ("sizes_of_last_fit",), 1),
    (0.0, 1.0, (), 1),  # its size stays; unseen data had to decide
    (0.01, 100.0, (), 1),  # the last fit leaves much of it
])  # fmt: skip
def test_the_last_fit_takes_out_what_it_leaves_nothing_of(monkeypatch, true, times, without, kept):
    logs = records(2, {"quadratic_friction.c@hinge": true}, samples=200)
    task = RecordsTask(
        nominal_model=nominal_model(), records=as_records(logs[:1], logs[1:]),
        effects=listed("quadratic_friction"), options=DiscoveryOptions(without=without),
    )  # fmt: skip
    state = WINDOWS.begin(task, print)
    drag = next(s.candidate for s in state.scores)
    fitted = with_one(state, state.model, drag)
    found = judged(state.model, fitted, 1, task.options)
    # The search had it that many times as large.
    at = fitted.fit.problem.names.index("quadratic_friction.c@hinge")
    q = np.where(np.arange(len(fitted.fit.q)) == at, times, 1.0) * fitted.fit.q
    begun = replace(fitted, fit=replace(fitted.fit, q=q))
    monkeypatch.setattr(last_fit, "as_last_fit", lambda *given: fitted)
    last = with_last_fit(replace(state, model=begun, accepted=(found,)))
    assert len(last.accepted) == len(last.model.candidates) == kept
    assert [r.doubt for r in last.rejected] == ["size"] * (1 - kept)
