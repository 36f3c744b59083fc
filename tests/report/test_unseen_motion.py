"""Where only unseen data show what is missing, this is said, where they go, and what to fit."""

from types import SimpleNamespace

import numpy as np
import pytest

from identification.logs.log import Log
from identification.report.discovery.unseen_motion import unseen_motion

TIME = 0.01 * np.arange(100)
FLOOR = {"m": 1e-3}


def log(name, reach, angle=1.0):
    y = np.column_stack([reach * np.sin(TIME * 6), angle * np.cos(TIME * 6)])
    return Log(
        time=TIME, inputs=np.zeros((100, 0)), outputs=y, input_names=(), output_names=("x", "q"),
        units={"x": "m", "q": "rad"}, name=name,
    )  # fmt: skip


def found(fitted, unseen, reach=(0.2, 0.3), horizon=0.3, floor=FLOOR, names=("a", "b")):
    each = [(names[0], "fit", fitted), (names[1], "confirm", unseen)]
    return SimpleNamespace(
        horizon=horizon, floor=floor,
        errors=[
            SimpleNamespace(name=n, role=role, before=e * 1e-3,
                            before_by_unit={u: e * s for u, s in floor.items()})
            for n, role, e in each
        ],
        records=[SimpleNamespace(log=log(n, r)) for n, r in zip(names, reach, strict=True)],
    )  # fmt: skip


@pytest.mark.parametrize(("fitted", "unseen", "is_told"), [
    (1.0, 30.0, True), (1.2, 3.5, True), (1.0, 2.0, False), (5.0, 30.0, False), (1.0, 1.0, False),
])  # fmt: skip
@pytest.mark.parametrize("floor", [FLOOR, {"m": 1e-3, "rad": 1e-2}])
def test_it_is_told_where_the_fitted_data_are_at_the_noise(fitted, unseen, is_told, floor):
    assert bool(unseen_motion(found(fitted, unseen, floor=floor))) == is_told


def test_the_outputs_that_go_farther_are_told_with_their_ranges():
    (said, advice) = unseen_motion(found(1.0, 30.0))
    assert "in a the model errs by no more than the noise, and in b by up to 30 times" in said
    assert "x from -0.300 m to 0.300 m, where the fitted data have -0.200 m to 0.200 m" in said
    assert "q from" not in said
    assert advice.startswith("Fit b too")
    assert "farther" not in unseen_motion(found(1.0, 30.0, reach=(0.2, 0.2)))[0]


def test_of_the_halves_of_one_log_no_other_record_can_be_fitted():
    halves = unseen_motion(found(1.0, 30.0, names=("a [estimation]", "a [validation]")))
    assert halves[1] == "Record a log whose two halves both go there."


def test_a_free_run_says_it_in_its_own_way():
    assert unseen_motion(found(1.0, 30.0, horizon=None)) == []
