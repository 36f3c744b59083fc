"""Recordings of ROS give the numbers of the same log as CSV, whatever the order of messages."""

from dataclasses import replace

import numpy as np
import pytest
from bag_cases import BEGIN, numbers, state, write_bag
from example_logs import wave

from identification import read_log, write_log

JOINTS = ("shoulder", "elbow")
OUTPUTS = tuple(f"joint_states.position.{joint}" for joint in JOINTS)
INPUTS = tuple(f"joint_states.effort.{joint}" for joint in JOINTS)
COMMANDS = ("commands.data_1", "commands.data_2")
STEP = 10_000_000  # [ns]


def log(names=INPUTS, **changed):
    first = wave(200)
    return replace(first, input_names=names, output_names=OUTPUTS, extras={}, units={}, **changed)


def states(of, late=0, joints=JOINTS, has_effort=True):
    """The states of a log, recorded `late` nanoseconds after they were stamped."""
    return [
        (
            BEGIN + STEP * k + late,
            state(BEGIN + STEP * k, joints, y, effort=u if has_effort else ()),
        )
        for k, (y, u) in enumerate(zip(of.outputs, of.inputs, strict=True))
    ]


def read(path, inputs=INPUTS, **more):
    return read_log(path, inputs, OUTPUTS, lenient=True, **more)


@pytest.mark.parametrize("kind", ["mcap", "db3"])
@pytest.mark.parametrize("whole", [True, False])
def test_a_recording_holds_the_log_that_a_csv_holds(tmp_path, kind, whole):
    first = log()
    write_log(first, tmp_path / "run.csv")
    file = write_bag(tmp_path / "run", {"/joint_states": states(first)}, kind)
    back, csv = read(tmp_path / "run" if whole else file), read(tmp_path / "run.csv")
    assert back.inputs.tobytes() == csv.inputs.tobytes()
    assert back.outputs.tobytes() == csv.outputs.tobytes()
    assert back.time == pytest.approx(csv.time, abs=1e-12)
    assert back.remarks == ()


def test_the_order_of_messages_does_not_matter(tmp_path):
    first = log()
    messages = states(first)
    recorded = [time for time, _ in messages]
    order = np.random.default_rng(0).permutation(len(messages))
    shuffled = [(recorded[k], messages[i][1]) for k, i in enumerate(order)]
    back = read(write_bag(tmp_path / "run", {"/joint_states": shuffled}))
    assert back.outputs.tobytes() == first.outputs.tobytes()
    assert back.inputs.tobytes() == first.inputs.tobytes()


def test_the_names_of_joints_and_not_their_order_say_which_is_which(tmp_path):
    first = log()
    messages = [
        (time, state(BEGIN + STEP * k, JOINTS[::-1], m.position[::-1], effort=m.effort[::-1]))
        if k % 2 else (time, m)
        for k, (time, m) in enumerate(states(first))
    ]  # fmt: skip
    back = read(write_bag(tmp_path / "run", {"/joint_states": messages}))
    assert back.outputs.tobytes() == first.outputs.tobytes()


def test_two_nodes_that_publish_a_joint_each_on_one_topic(tmp_path):
    first = log()
    messages = [
        (time + j, state(BEGIN + STEP * k, JOINTS[j : j + 1], m.position[j : j + 1],
                         effort=m.effort[j : j + 1]))
        for k, (time, m) in enumerate(states(first)) for j in range(2)
    ]  # fmt: skip
    back = read(write_bag(tmp_path / "run", {"/joint_states": messages}))
    assert back.outputs == pytest.approx(first.outputs, abs=1e-9)


def test_topics_are_joined_by_their_stamps_and_not_by_when_they_were_recorded(tmp_path):
    first = log(names=tuple(f"desired.position.{joint}" for joint in JOINTS))
    sent = [(BEGIN + STEP * k + 7_000_000, state(BEGIN + STEP * k, JOINTS, u))
            for k, u in enumerate(first.inputs)]  # fmt: skip
    topics = {"/joint_states": states(first, late=3_000_000, has_effort=False), "/desired": sent}
    back = read(write_bag(tmp_path / "run", topics), first.input_names)
    assert back.outputs.tobytes() == first.outputs.tobytes()
    assert back.inputs.tobytes() == first.inputs.tobytes()


def test_a_command_at_half_the_rate_is_held(tmp_path):
    first = log(names=COMMANDS)
    held = np.repeat(first.inputs[::2], 2, axis=0)
    sent = [(BEGIN + 2 * STEP * k, numbers(u)) for k, u in enumerate(first.inputs[::2])]
    topics = {"/joint_states": states(first, has_effort=False), "/commands": sent}
    back = read(write_bag(tmp_path / "run", topics), COMMANDS)
    assert len(back) >= len(first) - 1
    assert back.sampling_time == pytest.approx(0.01)
    assert back.outputs == pytest.approx(first.outputs[: len(back)], abs=1e-12)
    assert back.inputs == pytest.approx(held[: len(back)], abs=1e-9)
    assert "messages of /commands in run" in back.remarks[0].replace(".mcap", "")
    assert "the time at which it was recorded counts" in back.remarks[0]
    assert "joint_states (200 messages), commands (100 messages) of run" in back.remarks[1]


def test_a_damaged_recording_is_refused_in_one_sentence(tmp_path, refusal):
    file = write_bag(tmp_path / "run", {"/joint_states": states(log())})
    whole = file.read_bytes()
    for part in (b"", whole[:50], b"\0" * 500, whole[200:]):
        file.write_bytes(part)
        assert "cannot be read as a recording of ROS" in refusal(read, file)
