"""What records come to: known intervals, crossings, coverage, and a record there and back."""

import numpy as np
import pytest
from scipy.stats import binomtest

from identification.sweep.answers import judged, nested
from identification.sweep.discovery_findings import discovery_findings
from identification.sweep.log_methods import estimate_findings
from identification.sweep.power import curves, thresholds
from identification.sweep.settings import Heads
from identification.sweep.statistics import calibration_of, crossing, median, said, wilson

NOTHING = {"size_of": [], "sizes": [], "hidden_size_of": [], "hidden_sizes": [], "named": [],
           "where": [], "confidence": [], "one_of": [], "rivals": [], "hidden": [],
           "hidden_where": [], "kind": "null", "ratio": 0.0, "other_shape": False,
           "verdict": "nothing missing", "unexplained": False, "gap_closed": None,
           "run.processor_seconds": 1.0}  # fmt: skip


@pytest.mark.parametrize(("hits", "of"), [(0, 7), (3, 7), (7, 7), (50, 2000)])
def test_wilson_is_that_of_scipy(hits, of):
    theirs = binomtest(hits, of).proportion_ci(0.95, "wilson")
    ours = wilson(hits, of, z=1.959963984540054)
    np.testing.assert_allclose((ours["low"], ours["high"]), theirs, atol=1e-12)
    assert said(wilson(0, 0)) == "-"


def test_a_rate_of_none_or_of_all_ends_exactly_there():
    for of in range(1, 400):
        assert wilson(0, of)["low"] == 0.0
        assert wilson(of, of)["high"] == 1.0
        for hits in (1, of // 2, of - 1):
            assert 0.0 <= wilson(hits, of)["low"] <= wilson(hits, of)["high"] <= 1.0


def test_a_rate_that_rises_crosses_between_two_points():
    assert crossing([1, 10, 100], [0.0, 0.4, 1.2], 0.8) == pytest.approx(10**1.5)
    assert crossing([-1, 0, 1], [0.0, 0.5, 1.0], 0.75) == pytest.approx(0.5)
    assert crossing([1, 2], [0.9, 1.0], 0.8) == 1
    assert crossing([1, 2], [0.1, 0.2], 0.8) is None
    # a dip is levelled: 0.9 and 0.7 become 0.8 twice
    assert crossing([1, 2, 3], [0.0, 0.9, 0.7], 0.8) == pytest.approx(2.0)


def test_power_curves_and_their_thresholds():
    rows = [
        {"set.ratio": ratio, "set.duration": length, "found": k < hits}
        for length, counts in ((5.0, (0, 5, 10)), (20.0, (5, 10, 10)))
        for ratio, hits in zip((1.0, 3.0, 9.0), counts, strict=True)
        for k in range(10)
    ] + [{"set.ratio": 1.0, "set.duration": 5.0, "found": None}]
    short, long = curves(rows, "found", "ratio", ["duration"], Heads({}))
    assert [rate["hits"] for rate in short.rates] == [0, 5, 10]
    assert long.label == "duration 20"
    (line,) = thresholds([short, long], "duration").values()
    assert [t.at for t in line] == [5.0, 20.0]
    assert line[0].value == pytest.approx(3 * 3**0.6)
    assert line[1].value == pytest.approx(3**0.6)
    assert all(t.low < t.value for t in line)


def test_coverage_of_estimates_of_known_std():
    rng = np.random.default_rng(0)
    true = np.array([2.0, -5.0])
    records = []
    for _ in range(400):
        std = np.array([0.1, 0.5])
        found = true * [1.02, 1] + std * rng.normal(size=2)
        records.append({"names": ["a", "b"], "estimated": found.tolist(), "true": true.tolist(),
                        "std": [0.1, float("inf") if rng.random() < 0.5 else 0.5]})  # fmt: skip
    found = estimate_findings(records).record["parameters"]
    assert found["a"]["bias"] == pytest.approx(0.02, abs=3 * 0.05 / 20)
    assert found["a"]["std"] == pytest.approx(0.05, rel=0.1)
    assert found["a"]["claimed_std"] == pytest.approx(0.05)
    assert found["b"]["coverage"]["low"] < 0.95 < found["b"]["coverage"]["high"]
    assert found["b"]["coverage"]["of"] < 300  # an std that is not known counts nowhere


def test_calibration_of_a_perfect_and_of_a_boastful_program():
    assert calibration_of([(1.0, True)] * 4)["ece"] == 0
    boastful = calibration_of([(0.95, k % 2 == 0) for k in range(20)])
    assert boastful["ece"] == pytest.approx(0.45)
    assert boastful["brier"] == pytest.approx((0.05**2 + 0.95**2) / 2)
    assert calibration_of([])["ece"] is None
    assert [median([]), median([3, 1]), median([1, 9, 2])] == [None, 2, 2]


def test_a_record_is_counted_as_the_discovery_that_it_tells():
    record = NOTHING | {
        "kind": "pair", "hidden": ["cogging", "delay"], "hidden_where": ["drive 2", "all drives"],
        "hidden_size_of": ["cogging.a@drive 2", "delay.tau@all drives"], "hidden_sizes": [2.0, 0.1],
        "named": ["cogging", "cogging"], "where": ["drive 2", "drive 3"], "confidence": [0.9, 0.6],
        "one_of": [False, True], "rivals": ["", "backlash|delay"], "verdict": "named",
        "size_of": ["cogging.a@drive 2", "cogging.a@drive 3"], "sizes": [2.1, -1.0],
    }  # fmt: skip
    row = nested(record)
    assert row["truth"]["effects"][1] == {
        "name": "delay", "where": "all drives", "sizes": {"tau": 0.1}
    }  # fmt: skip
    assert [n["sizes"] for n in row["answer"]["named"]] == [{"a": 2.1}, {"a": -1.0}]
    assert row["answer"]["named"][1]["set"] == ["backlash", "delay"]
    found = discovery_findings([record, NOTHING])
    assert found.record["first_name_right"]["hits"] == 1
    assert found.record["pairs_exactly"]["hits"] == 0
    assert found.record["null_nothing_missing"]["of"] == 1
    assert found.record["confusion"] == {
        "cogging+delay": {"cogging": 1}, "nothing": {"nothing missing": 1}
    }  # fmt: skip
    assert {caption for s in found.sections for caption, _ in s.figures} == {
        "Truth and answer", "Reliability of confidence"
    }  # fmt: skip


def test_what_is_right():
    assert judged(["a", "b"], ["a"], "single") == {"right": True, "false_name": True}
    assert judged([], ["a"], "single") == {"right": False, "false_name": False}
    assert judged(["a"], [], "null") == {"right": None, "false_name": True}
    assert judged([], ["x"], "unknown") == {"right": None, "false_name": False}
