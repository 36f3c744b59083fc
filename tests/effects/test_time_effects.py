"""What changes with time: analytic motions, and a time that is searched and found."""

import numpy as np
import pytest
from joint_cases import DAMPING, MASS, SLIDER, run, slider, slider_log, steps

from identification.effects.axes import Axis
from identification.effects.catalogue import joint_effects
from identification.effects.joint_plant import joint_plant
from identification.model.rollout import State
from identification.windows.window_estimate import estimate_windows

TIMED = ("friction_drift", "viscous_friction_drift", "friction_jump", "viscous_friction_jump",
         "push")  # fmt: skip


def coasting(**values):
    """Position of the slider (m = 2, d = 3) that begins at 1 m/s and is not driven, (N,)."""
    log = slider_log(steps(400))
    start = State(np.zeros(1), np.ones(1), np.zeros(0))
    plant = joint_plant(SLIDER, (MASS, DAMPING), log, start=start)
    return run(plant, slider_log(np.zeros((400, 1))), **values)[:, 0]


def test_a_viscous_friction_that_drifts_and_jumps_slows_as_its_integral_says():
    t = 0.01 * np.arange(400)
    v = np.gradient(coasting(**{"viscous_friction_drift.d_t@slide": 2.0}), t)
    np.testing.assert_allclose(v[1:-1], np.exp(-(3 * t + t**2) / 2)[1:-1], atol=1e-4)
    jump = {"viscous_friction_jump.d_j@slide": 4.0, "viscous_friction_jump.t_j": 0.5,
            "viscous_friction_jump.w": 0.02}  # fmt: skip
    v = np.gradient(coasting(**jump), t)
    expected = np.exp(-(3 * t + 4 * np.clip(t - 0.5, 0, None)) / 2)
    np.testing.assert_allclose(v[1:-1], expected[1:-1], atol=5e-3)


def test_a_push_gives_its_impulse():
    values = {"push.f_p@slide": 6.0, "push.t_0": 0.5, "push.t_p": 0.25, "push.w": 0.05}
    far = coasting(**values)[-1] - coasting()[-1]
    assert far == pytest.approx(6 * 0.25 / 3, rel=0.01)  # impulse over damping, when all is at rest


def test_the_time_of_a_jump_is_found():
    u = steps(400, hold=15)
    name = "viscous_friction_jump.d_j@slide"
    true = {name: 2.0, "viscous_friction_jump.t_j": 1.37}
    y = run(slider(), slider_log(u), **true)
    log = slider_log(u, y + 1e-5 * np.random.default_rng(1).standard_normal(y.shape))
    free = ("damping", name, "viscous_friction_jump.t_j")
    begun = {name: 1.0, "viscous_friction_jump.t_j": 1.25}  # of the grid, the nearest one
    fit = estimate_windows(slider(), log, free, 0.2, begun)
    assert abs(fit.values[free[2]] - 1.37) < 4 * fit.std[2] < 0.05
    assert fit.values[name] == pytest.approx(2.0, rel=0.02)


def test_effects_of_time_are_listed_where_the_duration_of_the_records_is_known():
    axis = Axis("s", "slide", 1.0, 1.0, 1.0)
    assert not {e.name for e in joint_effects((axis,))} & {*TIMED}
    timed = Axis("s", "slide", 1.0, 1.0, 1.0, duration=10.0)
    effects = {e.name: e for e in joint_effects((timed,))}
    assert effects.keys() >= {*TIMED}
    (size,) = effects["friction_drift"].sizes
    assert size.largest * 10.0 == pytest.approx(0.3)
    two = joint_effects((timed, Axis("b", "slide", 1.0, 1.0, 1.0)))
    (push,) = (e for e in two if e.name == "push")
    assert "" not in push.places.values()
    assert len(push.shapes[0].grid) == 8
