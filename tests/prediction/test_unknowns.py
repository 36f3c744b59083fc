"""Parameters that records share, and those that each has for itself."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from records_cases import listed, nominal_model, pendulum, record, records, roles

from identification.discovery.candidates import list_common
from identification.discovery.options import DiscoveryOptions
from identification.estimation.priors import Priors
from identification.model.coordinates import Coordinates
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.judging.extension import with_effect
from identification.prediction.scoring.first_fit import begin
from identification.prediction.scoring.scores import window_scores
from identification.prediction.task import RecordsTask
from identification.prediction.verdict.clocks import record_shifts, told_shifts
from identification.windows.records import as_records
from identification.windows.unknowns import Unknowns

SAMPLES = 300  # of each record
SHIFTS = (0.02, -0.015, 0.01)  # of three records' inputs [s]


def prior(*names):
    p = len(names)
    space = Coordinates(names, np.zeros(p, bool), *(np.full(p, x) for x in (-9.0, 9.0, 1.0)))
    return Priors(space, np.arange(p, dtype=float), np.ones(p))


@given(st.integers(0, 3), st.integers(0, 3), st.integers(1, 4))
def test_every_entry_is_felt_by_all_records_or_by_one(p, m, count):
    shared, own = (prior(*(f"{w}{k}" for k in range(n))) for w, n in (("a", p), ("b", m)))
    unknowns = Unknowns(shared, own, tuple(f"r{k}" for k in range(count)))
    felt = np.zeros(p + m * count, int)
    for r in range(count):
        columns = unknowns.columns(r)
        felt[columns] += 1
        names = [unknowns.all.names[k].partition(" ")[0] for k in columns]
        assert tuple(names) == unknowns.local.names
    assert np.all(felt[:p] == count)
    assert np.all(felt[p:] == 1)


def shifted(shift, seed):
    log = record(seed, samples=SAMPLES, plant=pendulum(), values={"time_shift.tau@drive": shift})
    return replace(log, name=f"record {seed}")


@pytest.mark.long
def test_records_whose_clocks_differ_have_a_shift_each():
    base = replace(nominal_model(), horizon=0.26)  # the inputs jump within windows
    logs = [shifted(s, k) for k, s in enumerate(SHIFTS, 1)]
    every = roles(logs)
    parent = fit_nominal(base, every)
    (effect,) = listed("time_shift")
    assert effect.own
    score = window_scores(parent.fit, list_common([effect]))[0]
    assert score.size.shape == (2,)
    child = with_effect(parent, begin(parent, [score]), base.horizon, every[2:])
    found = [child.fit.values[f"time_shift.tau@drive [record {k}]"] for k in (1, 2)]
    np.testing.assert_allclose(found, SHIFTS[:2], atol=1e-3)
    value, _ = child.unseen.own["record 3"]["time_shift.tau@drive"]
    assert value == pytest.approx(SHIFTS[2], abs=1e-3)
    assert np.mean(child.unseen.at_horizon[0]) < 0.1 * np.mean(parent.unseen.at_horizon[0])


def test_a_record_that_is_late_is_told_and_the_others_are_not():
    """What is asked of each record alone: its clock. The fit has seen none that is late."""
    base = replace(nominal_model(), horizon=0.26)
    logs = [shifted(s, k) for k, s in enumerate((0.0, 0.0, 0.0, 0.02), 1)]
    every = roles(logs)
    task = RecordsTask(
        nominal_model=base, records=every, effects=listed("time_shift"), options=DiscoveryOptions()
    )
    model = fit_nominal(base, every)
    shifts = record_shifts(task, model)
    (told,) = told_shifts(shifts, len(every), task.options)
    assert told.record == "record 4"
    assert told.shift == pytest.approx(0.02, abs=1e-3)
    assert told.std < 2e-3
    assert told.fall > 0.5
    assert record_shifts(replace(task, effects=()), model) == ()


def with_offset(base):
    """Std of the priors, that of an offset 0.1 N m."""
    return np.append(base.std, 0.1 / pendulum().parameters["offset.f_0@hinge"].scale)


def test_offsets_of_their_own_leave_what_is_shared_as_it_is():
    offset = "offset.f_0@hinge"
    logs = [
        replace(record(k, SAMPLES, {offset: f}, plant=pendulum()), name=f"record {k}")
        for k, f in enumerate((0.05, -0.05, 0.02), 1)
    ]
    base = nominal_model()
    own = replace(base, names=(*base.names, offset), std=with_offset(base), own=(offset,))
    found = fit_nominal(own, roles(logs)).fit
    assert found.values[f"{offset} [record 1]"] == pytest.approx(0.05, abs=2e-3)
    assert found.values[f"{offset} [record 2]"] == pytest.approx(-0.05, abs=2e-3)
    assert found.shared["J"] == pytest.approx(2e-3, rel=0.03)
    assert found.of_record(1)[offset] == found.values[f"{offset} [record 2]"]


def test_one_record_with_a_parameter_of_its_own_is_a_record_with_a_shared_one():
    offset, base, logs = "offset.f_0@hinge", nominal_model(), records(2, samples=SAMPLES)
    more = replace(base, names=(*base.names, offset), std=with_offset(base))
    every = as_records(logs[:1], logs[1:])
    shared, own = (fit_nominal(replace(more, own=o), every) for o in ((), (offset,)))
    np.testing.assert_allclose(own.fit.q, shared.fit.q, rtol=1e-9)
    assert own.fit.cost == pytest.approx(shared.fit.cost, rel=1e-9)


def test_without_records_that_confirm_the_second_half_of_each_log_does():
    logs = [record(1), record(2, samples=400)]
    made = as_records(logs)
    assert [r.role for r in made] == ["fit", "fit", "confirm", "confirm"]
    for log, first, second in zip(logs, made[:2], made[2:], strict=True):
        np.testing.assert_array_equal(
            np.concatenate([first.log.outputs, second.log.outputs]), log.outputs
        )


def test_records_that_confirm_leave_the_others_whole():
    a, b = record(1), replace(record(2), values={"J": 1.0})
    made = as_records([a], [b])
    assert [(r.log, r.role, dict(r.values)) for r in made] == [
        (a, "fit", {}), (b, "confirm", {"J": 1.0}),
    ]  # fmt: skip


def test_what_cannot_be_one_robot_is_refused(refusal):
    a = record(1)
    assert "given twice" in refusal(as_records, [a], [a])
    assert "no log" in refusal(as_records, [])
    other = record(2)
    foreign = type(other)(
        time=other.time, inputs=other.inputs, outputs=other.outputs, input_names=("drive",),
        output_names=("elbow",),
    )  # fmt: skip
    assert "elbow" in refusal(as_records, [a], [foreign])


def test_what_a_log_says_of_itself_holds_for_its_record():
    a, b = replace(record(1), values={"J": 1.0, "d": 2.0}), replace(record(2), name="record 1")
    made = as_records([a, b])
    assert [dict(r.values) for r in made] == 2 * [{"J": 1.0, "d": 2.0}, {}]
    assert [r.log.name for r in made[:2]] == ["record 1 [estimation]", "record 1 (2) [estimation]"]


@pytest.mark.parametrize("hold", ["zoh", "foh"])
def test_one_hold_is_for_all_records(hold, refusal):
    a, b = replace(record(1), hold=hold), replace(record(2), hold="zoh")
    if hold == "zoh":
        assert len(as_records([a], [b])) == 2
    else:
        assert "hold" in refusal(as_records, [a], [b])
