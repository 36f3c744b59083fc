"""Records in one batch are simulated as each alone, and work that no answer needs is left out."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from records_cases import AXIS, MJCF, PARAMETERS, record

from identification.effects.plant.joint_plant import joint_plant
from identification.estimation.levenberg_marquardt import SLOPE_ERROR
from identification.estimation.priors import Priors
from identification.model.coordinates import coordinates
from identification.windows.point import linearised, parameters_step
from identification.windows.problem import no_moves, problem
from identification.windows.records import Record
from identification.windows.settling import settle
from identification.windows.shooting import tangent

pytestmark = pytest.mark.usefixtures("few_effects")
SCALE = np.array([1e-3])


@cache
def task():
    """Two records of a pendulum, the model begun 20 % off; each has a damping of its own."""
    plant = joint_plant(MJCF, PARAMETERS, record(seed=0, samples=50), joints=(AXIS,))
    records = [
        Record(record(seed=k, samples=200 + 100 * k, plant=plant), "fit") for k in (1, 2)
    ]  # fmt: skip
    shared, own = (_prior(plant, name, value) for name, value in (("J", 1.6e-3), ("d", 0.024)))
    return problem(plant, records, shared, own, 0.2, {}, SCALE)


def _prior(plant, name, value):
    return Priors(coordinates(plant.parameters, [name], np.array([value])), np.zeros(1), np.ones(1))


def test_records_are_linearised_together_as_each_alone():
    both, q = task(), np.array([0.1, -0.2, 0.3])
    moves = [np.full(d.shape, 1e-3) for d in no_moves(both)]
    for k, t in enumerate(both.tangents(q, moves)):
        at = both.unknowns.columns(k)
        r = both.held(q).residuals(moves)[k]
        alone = both.widened(k, tangent(both.parts[k], q[at], moves[k], known=r))
        for name in ("r", "S", "U", "s", "Vt", "size"):
            np.testing.assert_array_equal(getattr(t, name), getattr(alone, name))


def test_a_rejected_step_is_followed_by_one_that_slopes_tell_from_it():
    both, q = task(), np.zeros(3)
    moves, r = both.settled(q, no_moves(both))
    at = linearised(both, q, moves, 1e-4, r)
    tried = replace(at.step(1e-9), cost=np.inf)

    def change(damping):
        dq, size, _ = parameters_step(both, q, at.tangents, damping)
        far = (tried.q - q) * size
        return np.linalg.norm(dq * size - far) / np.linalg.norm(far)

    next_one = at.apart(tried, 5e-9, 5.0)
    assert change(next_one / 5) < SLOPE_ERROR <= change(next_one)
    assert at.apart(tried, 1e3, 5.0) == 1e3


def test_states_are_sought_as_far_as_they_matter():
    both, q = task(), np.zeros(3)
    held, begun = both.held(q), no_moves(both)

    def squares(**given):
        return sum(float(np.sum(s.r**2)) for s in settle(held, begun, **given))

    best = squares()
    assert squares(most=1.01 * best) == best
    assert squares(most=0.5 * best) > 0.5 * best
