"""The share that a law explains of what smooth forces could is one for the law that is missing."""

from functools import cache

import numpy as np
import pytest
from records_cases import FREE, listed, nominal_model, pendulum, records, roles, with_law
from scipy.optimize import lsq_linear

from identification.discovery.candidates import list_common
from identification.discovery.options import DiscoveryOptions
from identification.effects.plant.joint_plant import candidates
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.scoring.scores import condensed, window_scores
from identification.prediction.verdict.neighbours import (
    Explained,
    find_smooth_neighbour,
    has_neighbours_name,
)
from identification.prediction.verdict.yardstick import Yardstick, measure

EFFECTS = candidates(pendulum(), FREE)


@cache
def logs():
    return roles(records(4, {"coulomb_friction.f_c@hinge": 0.02}, samples=300))


@cache
def rubbed():
    return fit_nominal(nominal_model(), logs())


def test_sums_by_blocks_give_the_fall_of_a_curve():
    (candidate,) = list_common(listed("curve_speed"))
    known = condensed(rubbed().fit, [candidate])
    G, a, square = known.G, known.a, known.squares.sum()
    c = lsq_linear(G.sum(axis=0), a.sum(axis=0)).x
    (score,) = window_scores(rubbed().fit, [candidate])
    assert a.sum(axis=0) @ c / square == pytest.approx(score.fall, rel=1e-6)
    np.testing.assert_allclose(G, np.swapaxes(G, 1, 2))


def test_the_law_that_is_missing_leaves_nothing_to_a_smooth_force_and_a_neighbour_does():
    before = rubbed()
    share, left = {}, {}
    for name in ("coulomb_friction", "sublinear_friction"):
        after = with_law(before, name, logs())
        stick = measure(after, EFFECTS)
        share[name] = stick.share(before.fit.cost, after.fit.cost)
        left[name] = stick.every
        fall = 1 - after.fit.cost / before.fit.cost
        of_law = stick.share_of(after.candidates[-1], fall / (1 - fall))
        assert of_law == pytest.approx(share[name], abs=0.02)  # there is one joint
    assert share["coulomb_friction"] > 0.999
    assert left["coulomb_friction"] < 0.01
    assert share["sublinear_friction"] < 0.998
    assert left["sublinear_friction"] > 0.03


@cache
def damped():
    """The fit where a damping grows with the angle: a force of speed and position at once."""
    every = roles(records(4, {"position_dependent_damping.d_q@hinge": 0.002}, samples=400))
    return fit_nominal(nominal_model(), every), every


@cache
def damped_with(name):
    return with_law(damped()[0], name, damped()[1])


def beside(name, is_left):
    """What smooth forces explain beside a law, with surfaces or without them."""
    (model, _), after = damped(), damped_with(name)
    fall = 1 - after.fit.cost / model.fit.cost
    stick = measure(after, EFFECTS, is_left)
    return find_smooth_neighbour(after.candidates[-1], Explained(fall / (1 - fall)), stick)


def test_surfaces_unmask_the_neighbour_of_a_force_of_two_variables_and_no_curve_does():
    near = "position_dependent_friction"
    wrong, plain = beside(near, True), beside(near, False)
    assert has_neighbours_name(wrong, DiscoveryOptions())
    assert wrong.share > 0.8
    assert plain.share < 0.1
    right = beside("position_dependent_damping", True)
    assert not has_neighbours_name(right, DiscoveryOptions())
    assert right.share < 0.01


def test_a_force_of_the_position_that_is_left_speaks_against_no_friction():
    """It is another thing that is missing, and the smooth force of the joint tells it."""
    hidden = {"coulomb_friction.f_c@hinge": 0.05, "hardening.k_3@hinge": 0.02}
    both = roles(records(4, hidden, samples=400))
    after = with_law(fit_nominal(nominal_model(), both), "coulomb_friction", both)
    stick = measure(after, EFFECTS, True)
    (beyond,) = stick.beyond.values()
    assert stick.of_joint["joint hinge"] > 0.5
    assert beyond.share < 0.1 * stick.of_joint["joint hinge"]


def test_a_law_of_a_sensor_is_measured_by_forces_on_the_joint_that_it_measures():
    (law,) = list_common(listed("encoder_offset"))
    stick = Yardstick(every=0.5, of_joint={"joint hinge": 0.25}, beyond={}, curves=())
    assert stick.share_of(law, 0.75) == pytest.approx(0.75)  # of 0.75 and 0.25 more
    (inputs,) = list_common(listed("saturation"))[:1]
    assert stick.share_of(inputs, 0.75) is None
