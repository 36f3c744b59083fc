"""Samples that an encoder gave twice are told; steps of an encoder and noise are no repeats."""

import numpy as np
import pytest
from stuck_cases import joint_log

from identification import inspect_log, read_log
from identification.logs.repeats import repeated_share, repeats_told

STEP = 2 * np.pi / 4096


def turning(seed, samples=1500, step=STEP, noise=3e-4):
    """An angle that swings, as an encoder reads it."""
    rng = np.random.default_rng(seed)
    t = 0.01 * np.arange(samples)
    angle = (
        2 * np.sin(2.3 * t + seed) + 0.7 * np.sin(5.1 * t) + noise * rng.standard_normal(samples)
    )
    return step * np.round(angle / step) if step else angle


def read_twice(angle, share, seed=0):
    """The same, some samples of which repeat the one before."""
    at = 1 + np.flatnonzero(np.random.default_rng(seed).random(len(angle) - 1) < share)
    out = angle.copy()
    out[at] = angle[at - 1]
    return out


@pytest.mark.parametrize("step", [0.0, STEP, 4 * STEP])
@pytest.mark.parametrize("share", [0.03, 0.06, 0.1])
def test_repeats_are_told_with_their_share(step, share):
    angle = turning(3, step=step)
    assert repeated_share(angle) == 0
    # A repeat beside another one is not counted, so that the share comes out somewhat too small.
    assert repeated_share(read_twice(angle, share)) == pytest.approx(share, rel=0.35)


@pytest.mark.parametrize("noise", [1e-4, 2e-3, 1e-2, 5e-2])
@pytest.mark.parametrize("step", [STEP, 8 * STEP, 32 * STEP])
def test_steps_of_an_encoder_are_no_repeats(noise, step):
    assert not any(repeated_share(turning(seed, 4000, step, noise)) for seed in range(5))


def test_right_logs_of_joints_that_rest_and_stick_repeat_nothing():
    for seed in range(60):
        log = joint_log(seed)
        assert not any(repeated_share(y) for y in log.outputs.T), seed


def test_a_reading_and_an_inspection_tell_it(tmp_path):
    angle = read_twice(turning(1), 0.05)
    time = 0.01 * np.arange(len(angle)) + np.random.default_rng(0).uniform(0, 2e-3, len(angle))
    path = tmp_path / "log.csv"
    table = np.column_stack([time, angle, np.cos(time)])
    np.savetxt(path, table, "%.9g", ",", header="time,angle,torque", comments="")
    (told,) = repeats_told(read_log(path, ["torque"], ["angle"], lenient=True).remarks)
    assert told[0] in "456"
    assert " % of the samples of angle of log 'log' repeat the one before" in told
    assert told.replace(" of log 'log'", "") in inspect_log(path).remarks
