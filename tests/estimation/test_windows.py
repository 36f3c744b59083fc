"""Windows recover what a free run recovers, and what a free run loses."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from estimation_plants import SLIDER, STEP, measured, record, slider, steps

from identification import InputError, ParameterSet
from identification.estimation.estimation import estimate
from identification.model.plant import ModelPlant
from identification.windows.shooting import Tangent
from identification.windows.window_estimate import estimate_windows
from identification.windows.windows import windows

NAMES = ("mass", "damping")
START = {"mass": 2.4, "damping": 2.3}
TRUTH = np.array([2.0, 3.0])


def test_windows_cut_a_log_without_overlap():
    log = record(slider(), ("position",), n=107)
    cut = windows(log, 0.2)
    assert cut.outputs.shape == (10, 10, 1)
    np.testing.assert_array_equal(cut.outputs.ravel(), log.outputs[:100].ravel())
    with pytest.raises(InputError, match="do not fit"):
        windows(log, 0.02)
    with pytest.raises(InputError, match="do not fit"):
        windows(log, 9.0)


@pytest.mark.parametrize("outputs", [("position",), ("position", "rate")])
def test_clean_data_gives_the_truth_either_way(outputs):
    log = record(slider(x0=0.3, v0=-0.2), outputs, n=150)
    free = estimate(slider(), log, (*NAMES, "x0", "v0"), START)
    short = estimate_windows(slider(), log, NAMES, 0.5, START)
    np.testing.assert_allclose([free.values[n] for n in NAMES], TRUTH, rtol=1e-6)
    np.testing.assert_allclose(list(short.values.values()), TRUTH, rtol=1e-6)
    np.testing.assert_allclose(short.states.qpos[0], 0.3, atol=1e-6)
    np.testing.assert_allclose(short.states.qvel[0], -0.2, atol=1e-6)


def disturbed(plant, n, push, seed):
    """Positions of a plant that is pushed by white noise the log does not hold."""
    u = steps(n)
    unseen = u + push * np.random.default_rng(seed).standard_normal(u.shape)
    log = record(plant, ("position",), inputs=unseen)
    noisy = log.outputs + 1e-4 * np.random.default_rng(seed + 1).standard_normal(log.outputs.shape)
    return measured(replace(log, inputs=u), noisy)


def test_windows_beat_a_free_run_where_unseen_pushes_add_up_in_an_integrator():
    """A cart without a spring remembers each push for ever; a window forgets it."""
    records = tuple(p for p in slider().parameters if p.name in NAMES)
    xml = SLIDER.replace('stiffness="20"', 'stiffness="-0.5"')
    plant = ModelPlant(mujoco.MjModel.from_xml_string(xml), ParameterSet("cart", records))
    errors = {"free": [], "windows": []}
    for seed in range(2):
        log = disturbed(plant, 200, 0.5, seed)
        free = estimate(plant, log, NAMES, START).values
        short = estimate_windows(plant, log, NAMES, 0.5, START).values
        errors["free"].append([free[n] for n in NAMES] / TRUTH - 1)
        errors["windows"].append([short[n] for n in NAMES] / TRUTH - 1)
    free, short = (np.sqrt(np.mean(np.square(e))) for e in errors.values())
    assert short < 0.5 * free, (short, free)


def test_what_only_the_start_feels_has_no_place_in_windows():
    log = record(slider(), ("position",), n=100)
    assert log.sampling_time == pytest.approx(STEP)
    with pytest.raises(InputError, match="x0 has no effect"):
        estimate_windows(slider(), log, ("damping", "x0"), 0.5)


def test_a_parameter_that_is_felt_no_more_stays_and_the_others_go_on():
    """A search may make a friction so small that its slope is zero to the bit."""
    rng = np.random.default_rng(3)
    r, S, X = (rng.standard_normal(shape) for shape in ((4, 9), (4, 9, 3), (4, 9, 2)))
    size = np.linalg.norm(X, axis=1)
    U, s, Vt = np.linalg.svd(X / size[:, None], full_matrices=False)
    tangent = Tangent(r=r, S=S, U=U, s=s, Vt=Vt, size=size)
    S[:, :, 1] = 0.0
    moved, states = tangent.step(0.1)
    alone, same = replace(tangent, S=S[:, :, [0, 2]]).step(0.1)
    assert moved[1] == 0
    np.testing.assert_allclose(moved[[0, 2]], alone, rtol=1e-12)
    np.testing.assert_allclose(states, same, rtol=1e-12)
