"""A log with very many columns is compared with a bounded number of other readings of it."""

from itertools import combinations

import numpy as np
import pytest

from identification.logs.log import Log
from identification.progress import watched
from identification.refusals.columns import (
    MOST_PAIRS,
    Doubt,
    column_pairs,
    input_exchanges,
    output_exchanges,
)
from identification.refusals.readings import misread

SAMPLES = 20


def log_of(columns):
    rng = np.random.default_rng(columns)
    return Log(
        time=0.01 * np.arange(SAMPLES),
        inputs=rng.standard_normal((SAMPLES, columns)),
        outputs=rng.standard_normal((SAMPLES, columns)),
        input_names=tuple(f"u{k}" for k in range(columns)),
        output_names=tuple(f"y{k}" for k in range(columns)),
    )


def exchanges(columns):
    log = log_of(columns)
    doubt = Doubt.of(log, {n: n for n in (*log.input_names, *log.output_names)})
    return [[*kind(doubt)] for kind in (input_exchanges, output_exchanges)]


@pytest.mark.parametrize("columns", [2, 7, 12])
def test_all_pairs_of_a_usual_robot_are_tried_in_order(columns):
    assert column_pairs(range(columns)) == [*combinations(range(columns), 2)]
    assert [len(kind) for kind in exchanges(columns)] == 2 * [columns * (columns - 1) // 2]


@pytest.mark.parametrize("columns", [13, 50])
def test_of_many_columns_the_nearest_are_exchanged(columns):
    pairs = column_pairs(range(columns))
    assert [len(kind) for kind in exchanges(columns)] == 2 * [MOST_PAIRS]
    assert {(k, k + 1) for k in range(columns - 1)} < {*pairs}
    left_out = {*combinations(range(columns), 2)} - {*pairs}
    assert max(j - i for i, j in pairs) <= min(j - i for i, j in left_out)


def test_whoever_watches_sees_that_other_readings_are_compared():
    seen = []

    class Counting:
        def __init__(self, what, steps):
            seen.append(what)

        def __enter__(self):
            return lambda: seen.append("one")

        def __exit__(self, *error):
            return None

    readings = exchanges(4)[0]
    with watched(Counting):
        misread(log_of(4), np.ones(4), readings, lambda log: None)
    assert seen == ["other readings of the log", *["one"] * len(readings)]
