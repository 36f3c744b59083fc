"""The table of what massless straight cables get wrong."""

import numpy as np
import pytest
from statics_cases import ROBOT

from inca_mj.kinematics.cables import inverse
from inca_mj.robot.parameters import GRAVITY
from inca_mj.statics.cable_mass import NOISE, line_errors
from inca_mj.statics.equilibrium import equilibrium


def test_errors_grow_with_the_mass_and_fall_with_the_tension():
    rows = line_errors(ROBOT, ROBOT.start, (3e-4, 1e-3), (1.0, 4.0))
    light_1, light_4, heavy_1, heavy_4 = rows
    assert [(e.rho, e.tension) for e in rows] == [(3e-4, 1), (3e-4, 4), (1e-3, 1), (1e-3, 4)]
    for more, less in ((light_1, light_4), (heavy_1, heavy_4), (heavy_1, light_1)):
        assert more.length > less.length
        assert more.force_half > less.force_half
        assert more.stiffness_lost > less.stiffness_lost
    # sag goes with (ρ/T)²
    assert heavy_1.length / light_1.length == pytest.approx((1 / 0.3) ** 2, rel=0.05)
    for e in rows:
        assert e.force_half < 0.02 * e.force
        assert e.line_is_enough == (e.length / ROBOT.R[0] < NOISE)
        assert not e.massless_is_enough


def test_the_weight_moves_the_handle_as_a_load_does():
    rho = 1e-5  # so light that the answer is linear
    (e,) = line_errors(ROBOT, ROBOT.start, (rho,), (4.0,))
    at = inverse(ROBOT.start, ROBOT.geometry)
    half = -rho * GRAVITY * at.lengths / 2
    load = np.zeros(6)
    for k in range(8):
        F = np.array([0, 0, half[k]])
        load += np.r_[F, np.cross(at.arms[k], F)]
    rest = equilibrium(ROBOT, load=load)
    assert e.moved == pytest.approx(np.linalg.norm(rest.pose[:3] - ROBOT.start[:3]), rel=1e-3)
    assert e.moved_angle == pytest.approx(np.abs(rest.angle).max(), rel=1e-2)
