"""Laws of a search: what must change nothing, what must halve a variance, who is never likelier."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from discovery_cases import EFFECTS, FREE, KNOWN, RECORDS, nominal_model, record, slider
from discovery_cases import task as task_of

from identification.discovery.nominal_model import NominalModel
from identification.effects.effect import Candidate
from identification.innovations.discovery import discover
from identification.innovations.fitted_model import fit_model
from identification.innovations.moves.shapes import BARE_BIC
from identification.logs.joined import join_logs
from identification.model.parameter import ParameterSet, own_name, with_own

HIDDEN = {"mass": 2.2, "damping": 2.7, "spring.k": 5.0}
STARTS = ("x0", "v0")


def records(count):
    """Records of a slider with a spring, each from a start and with noise of its own."""
    starts = [(0.01, 0.02), (-0.03, 0.0), (0.02, -0.05), (0.0, 0.04)][:count]
    return [replace(record(slider(**HIDDEN, x0=x, v0=v), 400, seed=k), name=f"record {k}")
            for k, (x, v) in enumerate(starts)]  # fmt: skip


def robot(count):
    """The slider without a spring, with a start for each of some records."""
    plant = slider()
    known = with_own(ParameterSet("slider", RECORDS), STARTS, count)
    own = [own_name(name, k) for k in range(2, count + 1) for name in STARTS]
    std = np.concatenate([KNOWN, np.tile(KNOWN[2:], count - 1)])
    return NominalModel(replace(plant, parameters=known), (*FREE, *own), std)


def named(answer):
    return [(n.candidate.key, {k: v[:2] for k, v in n.parameters.items()}) for n in answer.named]


def same(one, other, rel):
    """Whether two answers name the same effects, of the same sizes."""
    assert [key for key, _ in one] == [key for key, _ in other]
    for (_, a), (_, b) in zip(one, other, strict=True):
        for size, values in a.items():
            assert values == pytest.approx(b[size], rel=rel)


@pytest.fixture(scope="module")
def answer():
    return discover(nominal_model(), records(1)[0], EFFECTS)


def test_the_order_of_candidates_and_one_that_is_not_taken_change_nothing(answer):
    fewer = [effect for effect in EFFECTS[::-1] if effect.name != "rubbing"]
    same(named(answer), named(discover(nominal_model(), records(1)[0], fewer)), rel=1e-9)


@pytest.mark.long
def test_the_order_of_records_changes_nothing():
    logs = records(2)
    one = named(discover(robot(2), join_logs(logs), EFFECTS))
    same(one, named(discover(robot(2), join_logs(logs[::-1]), EFFECTS)), rel=1e-4)
    assert one


def test_twice_the_records_halve_the_variance():
    logs = records(2)
    # One record twice is refused; what differs by less than the noise's rounding is not.
    more = [replace(log, name=f"{log.name} again", outputs=log.outputs + 1e-9) for log in logs]
    spring = (Candidate(EFFECTS[0], "joint", {}),)
    std = []
    for each in (logs, [*logs, *more]):
        log = join_logs(each)
        fit = fit_model(task_of(log, model=robot(len(each))), spring, {}).refit
        std.append(dict(zip(fit.point.space.names, fit.std, strict=True)))
    for name in ("mass", "damping", "spring.k"):
        # The priors of mass and damping, and those of the starts, are not doubled.
        assert std[0][name] / std[1][name] == pytest.approx(2**0.5, rel=0.05), name


@cache
def parent():
    """A task, and the nominal model that is fitted to its log."""
    task = task_of(record(slider(**HIDDEN), 500, seed=5))
    return task, fit_model(task, (), {})


@pytest.mark.parametrize("candidate", EFFECTS, ids=lambda e: e.name)
def test_a_child_is_never_less_likely_than_its_parent(candidate):
    task, model = parent()
    child = fit_model(task, (Candidate(candidate, "joint", {}),), {}, model)
    assert child.refit.log_posterior > model.refit.log_posterior - BARE_BIC / 2
