"""A bag of ROS 1 gives the numbers of the same log as CSV."""

from dataclasses import replace

import numpy as np
import pytest
from example_logs import wave
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

from identification import read_log, write_log

STORE = get_typestore(Stores.ROS1_NOETIC)
TIME, HEADER, STATE = (
    STORE.types[name]
    for name in ("builtin_interfaces/msg/Time", "std_msgs/msg/Header", "sensor_msgs/msg/JointState")
)
JOINTS = ("shoulder", "elbow")
OUTPUTS = tuple(f"joint_states.position.{joint}" for joint in JOINTS)
INPUTS = tuple(f"joint_states.effort.{joint}" for joint in JOINTS)
BEGIN, STEP = 1_748_873_654_316_744_521, 10_000_000  # [ns]


def state(seq, ns, position, effort):
    """A message of sensor_msgs/JointState of ROS 1, whose header counts."""
    header = HEADER(seq=seq, stamp=TIME(sec=ns // 10**9, nanosec=ns % 10**9), frame_id="")
    return STATE(header, [*JOINTS], *map(np.array, (position, (), effort)))


def write_bag(path, messages):
    """Write messages of the states of joints, each with the time at which it was recorded [ns]."""
    with Writer(path) as writer:
        kind = STATE.__msgtype__
        connection = writer.add_connection("/joint_states", kind, typestore=STORE)
        for recorded, message in messages:
            writer.write(connection, recorded, STORE.serialize_ros1(message, kind))
    return path


@pytest.fixture
def first():
    return replace(
        wave(200), input_names=INPUTS, output_names=OUTPUTS, extras={}, units={}
    )  # fmt: skip


def states(log):
    """The states of a log."""
    times = [BEGIN + STEP * k for k in range(len(log))]
    rows = zip(times, log.outputs, log.inputs, strict=True)
    return [(ns, state(k, ns, y, u)) for k, (ns, y, u) in enumerate(rows)]


def read(path):
    return read_log(path, INPUTS, OUTPUTS, lenient=True)


def test_it_holds_the_log_that_a_csv_holds(tmp_path, first):
    write_log(first, tmp_path / "run.csv")
    back, csv = read(write_bag(tmp_path / "run.bag", states(first))), read(tmp_path / "run.csv")
    assert back.inputs.tobytes() == csv.inputs.tobytes()
    assert back.outputs.tobytes() == csv.outputs.tobytes()
    assert back.time == pytest.approx(csv.time, abs=1e-12)
    assert back.remarks == ()
