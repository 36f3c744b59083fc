"""The catalogue as a whole: its names, nothing when absent, the same on each as on all."""

import numpy as np
import pytest
from effect_cases import CATALOGUE, EVERYWHERE, bare, forward, full, moving, probes, simulate

NAMES = [
    "stribeck_friction",
    "asymmetric_friction",
    "load_dependent_friction",
    "quadratic_friction",
    "friction_mismatch",
    "cogging",
    "current_lag",
    "delay",
    "current_saturation",
    "torque_constant_drift",
    "torque_constant_mismatch",
    "drum_eccentricity",
    "drum_layering",
    "drum_radius_mismatch",
    "backlash",
    "spring_hardening",
    "spring_hysteresis",
    "cable_hardening",
    "cable_creep",
    "pulley_radius",
    "cable_weight",
    "anchor_offset",
    "com_offset",
    "external_force",
    "air_drag",
]


CHANGING = ("cable_elasticity", "cable_damping", "drum_spring", "viscous_friction", "friction")
RULE = [
    *(f"{name}_mismatch" for name in CHANGING),
    *(f"{name}_drift" for name in CHANGING),
    *(f"{name}_jump" for name in (*CHANGING, "drum_radius", "torque_constant")),
    "current_crosstalk",
    "current_offset",
    "encoder_jump",
    "encoder_scale",
    "encoder_eccentricity",
    "encoder_lag",
]


def test_names_are_the_canonical_ones_each_once():
    assert sorted(effect.name for effect in CATALOGUE) == sorted({*NAMES, *RULE})


def test_all_sizes_zero_is_the_bare_robot_to_the_bit():
    assert np.array_equal(simulate(full(), seconds=2), simulate(bare(), seconds=2))


@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)
def test_numbers_make_sense(effect):
    for size in effect.sizes:
        assert 0 < size.probe <= size.largest
    for shape in effect.shapes:
        assert all(shape.lower <= value <= shape.upper for value in shape.grid)
        assert list(shape.grid) == sorted(shape.grid)


@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)
def test_a_probe_shows_and_is_nearly_linear(effect):
    """Half the probe moves the angles half as much."""
    jump = effect.name.endswith("_jump")
    shapes = {"current_saturation.i_max": 0.75} if effect.name == "current_saturation" else {}
    shapes |= {f"{effect.name}.t_s": 0.5} if jump else {}
    names = [*shapes, *probes(effect)]
    values = [[*shapes.values(), *(f * p for p in probes(effect).values())] for f in (0, 0.5, 1)]
    # A drift begins at nothing, and a jump comes after half of the first second.
    seconds = 4 if effect.name.endswith("_drift") else 2 if jump else 1
    none, half, whole = simulate(full(), names, values, seconds=seconds)
    size = np.sqrt(np.mean((whole - none) ** 2))
    assert size > (1e-5 if jump else 1e-4)
    assert np.sqrt(np.mean((whole - none - 2 * (half - none)) ** 2)) < 0.5 * size


def test_an_effect_on_each_drive_is_that_effect_on_all():
    for effect in EVERYWHERE:
        everywhere = probes(effect, "all drives")
        each = {}
        for k in range(1, 9):
            each |= probes(effect, f"drive {k}")
        names = [*everywhere, *each]
        on_all = [*everywhere.values(), *(0.0 for _ in each)]
        on_each = [*(0.0 for _ in everywhere), *each.values()]
        one, other = simulate(full(), names, [on_all, on_each], seconds=0.3)
        assert np.array_equal(one, other), effect.name


def test_effects_on_two_drives_act_on_their_own():
    some = full().with_values(
        {"stribeck_friction.f_s@2": 0.01, "drum_radius_mismatch.delta@7": 0.01}
    )
    at = moving(full())
    change = (forward(some, at).qacc - forward(full(), at).qacc)[6:]
    assert (change != 0).tolist() == [k in (2, 7) for k in range(1, 9)]
