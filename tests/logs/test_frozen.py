"""A sensor that freezes is refused with its time; a joint that rests is not."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from joint_cases import SLIDER, STEP, arm, arm_log, run, slider, slider_log, steps
from records_cases import record
from stuck_cases import joint_log, stuck

from identification import InputError
from identification.effects.axes import axes
from identification.logs.joined import ROW, share_samples
from identification.logs.plausible import BEYOND, FEWEST, SPAN, refuse_frozen
from identification.windows.records import as_records

FROM = 300  # sample of 400
NOISE = 1e-4  # [m]


def moved(u, encoder=0.0):
    y = run(slider(), slider_log(u))
    if encoder:
        return encoder * np.round(y / encoder)
    return y + NOISE * np.random.default_rng(2).standard_normal(y.shape)


def frozen(y, first=FROM, column=0):
    y = y.copy()
    y[first:, column] = y[first, column]
    return y


def seen(u, y):
    return axes(slider().model, slider_log(u, y))


@pytest.mark.parametrize("encoder", [0.0, 1e-3])
def test_a_frozen_sensor_is_told_with_value_and_time(encoder):
    u = steps(400)
    y = frozen(moved(u, encoder))
    with pytest.raises(InputError, match=r"^position of log 'log' repeats .*: a frozen") as refusal:
        seen(u, y)
    first = int(np.flatnonzero(np.diff(y[:, 0]))[-1]) + 1
    assert f"repeats {y[-1, 0]:g} from {first * STEP:g} s to the end" in str(refusal.value)
    assert abs(first - FROM) <= 3
    seen(u[:first], y[:first])  # the cure that is told


def test_a_robot_that_rests_is_not_refused():
    u, still = steps(400), np.arange(400)[:, None] >= FROM - 100
    resting = frozen(moved(u, 1e-3))
    for inputs in (np.where(still, 0.0, u), np.where(still, 1.0, u), np.where(still, 0.4 * u, u)):
        seen(inputs, resting)


def test_what_is_short_or_fades_below_an_encoder_is_not_refused():
    u = steps(400)
    seen(u, frozen(moved(u), 400 - 79))  # of 400 samples 79 are less than a fifth
    few = 150
    seen(u[:few], frozen(moved(u), few - 49)[:few])
    t = STEP * np.arange(400)
    chirp = np.sin(40 * t**2)[:, None]
    fading = 0.01 * np.round(0.1 * np.exp(-t) * chirp[:, 0] / 0.01)[:, None]
    assert not np.ptp(fading[FROM:])
    seen(chirp, fading)


def test_another_sensor_of_the_joint_or_another_joint():
    u, t = steps(400), STEP * np.arange(400)
    model = SLIDER.replace("</sensor>", '<jointvel name="rate" joint="slide"/></sensor>')
    both = np.stack([np.sin(3 * t), 3 * np.cos(3 * t)], axis=1)
    log = replace(slider_log(0 * u + 1.0), outputs=both, output_names=("position", "rate"))
    compiled = mujoco.MjModel.from_xml_string(model)
    axes(compiled, log)
    with pytest.raises(InputError, match="rate of log"):
        axes(compiled, replace(log, outputs=frozen(both, column=1)))
    u = steps(400, 2, hold=5)
    both = np.stack([np.sin(3 * t), np.cos(2 * t)], axis=1)
    with pytest.raises(InputError, match="b of log"):
        axes(arm().model, replace(arm_log(u), outputs=frozen(both, column=1)))
    u[FROM:, 1] = 0.0  # one joint after the other: the second is no longer driven
    axes(arm().model, replace(arm_log(u), outputs=frozen(both, column=1)))


def judged(log):
    refuse_frozen(log, 0, log.inputs, log.outputs[:, 1:])


@pytest.mark.parametrize("encoder", [0.0, 1e-3])
@pytest.mark.parametrize("length", [60, 120])
def test_a_sensor_that_is_stuck_for_a_while_is_told_with_both_times(encoder, length):
    u = steps(400)
    y = moved(u, encoder)
    first = 140
    y[first : first + length] = y[first]
    with pytest.raises(InputError, match=r"a sensor that was stuck") as refusal:
        seen(u, y)
    moves = np.flatnonzero(np.diff(y[:, 0])) + 1
    begin, end = moves[moves <= first][-1], moves[moves > first][0]
    told = f"repeats {y[first, 0]:g} from {begin * STEP:.6g} s to {(end - 1) * STEP:.6g} s"
    assert told in str(refusal.value)
    assert abs(begin - first) <= 3
    assert abs(end - first - length) <= 3
    # Both logs that are told to save are right.
    seen(u[:begin], y[:begin])
    seen(u[end:], y[end:])


def test_other_robots_with_a_sensor_that_is_stuck_are_refused_where_it_jumps_back():
    found = clear = 0
    for seed in range(60):
        log = joint_log(seed)
        outputs, first, last = stuck(log, seed + 7)
        y = log.outputs[:, 0]
        jump = abs(y[last + 1] - y[first])
        moved = np.abs(y[SPAN:] - y[:-SPAN]).max()
        # Varied forces go on, and the place that it jumps to is far away.
        driven = log.inputs[first : last + 1].std() > log.inputs.std()
        try:
            judged(replace(log, outputs=outputs))
        except InputError:
            found += 1
        else:
            assert not (driven and jump > 2 * BEYOND * moved)
        clear += driven and jump > 2 * BEYOND * moved
    assert clear > 10
    assert found >= clear


def test_right_logs_with_rests_stiction_end_stops_and_coarse_encoders_are_not_stuck():
    stopped = 0
    for seed in range(100):
        log = joint_log(seed)
        y = log.outputs[:, 0]
        moves = np.flatnonzero(np.diff(y)) + 1
        stopped += bool(np.any(np.diff(moves) >= FEWEST))
        try:
            judged(log)
        except InputError as error:  # only a joint that its drive cannot move to the end
            assert "to the end" in str(error)  # noqa: PT017
    assert stopped > 30


def test_a_rate_may_jump_and_a_user_may_overrule_it():
    u = steps(400)
    y = moved(u)
    y[140:260] = y[140]
    log = slider_log(u, y)
    refuse_frozen(log, 0, log.inputs, log.outputs[:, :0], is_rate=True)
    axes(slider().model, log, ("sensors",))


def noisy(seed, samples=200, noise=1e-4):
    log = record(seed, samples=samples)
    more = noise * np.random.default_rng(100 + seed).standard_normal(log.outputs.shape)
    return replace(log, outputs=log.outputs + more)


def part(log, first, last, name="part"):
    rows = slice(first, last)
    return replace(
        log, time=log.time[rows], inputs=log.inputs[rows], outputs=log.outputs[rows], name=name
    )  # fmt: skip


@given(st.integers(0, 150), st.integers(ROW, 50))
def test_any_part_of_a_log_shares_its_samples(first, count):
    log = noisy(1)
    assert share_samples(log, part(log, first, first + count))
    assert share_samples(part(log, first, first + count), log)


@given(st.integers(0, 100))
def test_the_same_motion_measured_again_shares_none(seed):
    again = replace(
        noisy(1), outputs=noisy(1).outputs + 1e-9 * np.random.default_rng(seed).random((200, 1))
    )
    assert not share_samples(noisy(1), again)


def test_parts_that_do_not_overlap_share_none_and_few_samples_tell_nothing():
    log = noisy(1)
    assert not share_samples(part(log, 0, 100), part(log, 100, 200))
    assert not share_samples(log, part(log, 0, ROW - 1))


def test_a_record_that_confirms_with_a_part_of_what_was_fitted_is_refused():
    log, other = noisy(1), noisy(2)
    with pytest.raises(InputError, match="'part' and 'record 1' hold the same samples"):
        as_records([log, other], [part(log, 20, 120)])
    assert len(as_records([part(log, 0, 100)], [part(log, 100, 200)])) == 2
