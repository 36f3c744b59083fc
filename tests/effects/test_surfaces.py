"""Surfaces: forces of two variables, by which names are judged and which are no candidates."""

import numpy as np
import pytest
from joint_cases import ARM, arm, arm_log, run, steps
from scipy.interpolate import RegularGridInterpolator

from identification.effects.laws.surfaces import X_NODES, Y_NODES, bilinear, surface_effects
from identification.effects.plant.joint_plant import candidates, joint_plant

LOG = arm_log(steps(100, 2))
SURFACES = surface_effects(arm().axes)


def test_a_surface_is_straight_between_its_nodes_and_none_where_x_is_zero():
    c = np.random.default_rng(1).normal(size=X_NODES * Y_NODES)
    rows = c.reshape(Y_NODES, X_NODES)
    below, above = rows[:, :3][:, ::-1], rows[:, 3:]
    grid = np.hstack([below, np.zeros((Y_NODES, 1)), above])
    x, y = np.linspace(-1, 1, 7), np.linspace(-1, 1, Y_NODES)
    exact = RegularGridInterpolator((y, x), grid)
    for at in np.random.default_rng(2).uniform(-1.3, 1.3, (200, 2)):
        want = exact(np.clip(at, -1, 1)[None])[0]
        assert bilinear(at[1], at[0], tuple(c)) == pytest.approx(want, abs=1e-12)


def test_with_sizes_of_zero_nothing_changes_and_with_others_a_joint_feels_a_force():
    plant = arm().with_effects(SURFACES)
    np.testing.assert_array_equal(run(plant, LOG), run(arm(), LOG))
    for effect in SURFACES:
        (where, *_) = effect.places
        moved = run(plant, LOG, **{effect.parameter(s.name, where): 0.1 for s in effect.sizes})
        assert np.abs(moved - run(arm(), LOG)).max() > 1e-6


def test_other_effects_act_in_a_plant_with_surfaces_as_they_do_without():
    plant = arm().with_effects(SURFACES)
    names = {p.name for p in arm().parameters}
    of = {n: 0.2 for n in names if n.startswith("coulomb_friction.f_c")}
    np.testing.assert_array_equal(run(plant, LOG, **of), run(arm(), LOG, **of))


def test_surfaces_are_no_candidates():
    listed = {e.name for e in candidates(joint_plant(ARM, (), LOG), ())}
    assert listed
    assert not listed & {e.name for e in SURFACES}
    assert {e.name for e in SURFACES} == {
        "surface_speed_position",
        "surface_load_position",
        "surface_load_speed",
    }
