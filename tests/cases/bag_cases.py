"""Recordings of ROS 2, written by the library that reads them."""

from pathlib import Path

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_HUMBLE)
STAMP, HEADER, STATE, MANY = (
    STORE.types[name]
    for name in (
        "builtin_interfaces/msg/Time", "std_msgs/msg/Header", "sensor_msgs/msg/JointState",
        "std_msgs/msg/Float64MultiArray",
    )
)  # fmt: skip
LAYOUT = STORE.types["std_msgs/msg/MultiArrayLayout"](dim=[], data_offset=0)
BEGIN = 1_748_873_654_316_744_521  # [ns], a stamp that no float holds


def state(ns, joints, position=(), velocity=(), effort=()):
    """A message of sensor_msgs/JointState, with its stamp."""
    header = HEADER(stamp=STAMP(sec=ns // 10**9, nanosec=ns % 10**9), frame_id="")
    numbers = (np.array(x, np.float64) for x in (position, velocity, effort))
    return STATE(header, list(joints), *numbers)


def numbers(data):
    """A message of std_msgs/Float64MultiArray, which has no stamp."""
    return MANY(layout=LAYOUT, data=np.array(data, np.float64))


def write_bag(folder, topics, kind="mcap"):
    """Write messages by topic, each with the time at which it was recorded [ns].

    Returns the path of the one file with the messages; the folder is that of the whole recording.
    """
    plugin = {"mcap": StoragePlugin.MCAP, "db3": StoragePlugin.SQLITE3}[kind]
    with Writer(folder, version=9, storage_plugin=plugin) as writer:
        for topic, messages in topics.items():
            name = messages[0][1].__msgtype__
            connection = writer.add_connection(topic, name, typestore=STORE)
            for recorded, message in messages:
                writer.write(connection, recorded, STORE.serialize_cdr(message, name))
    (file,) = Path(folder).glob(f"*.{kind}")
    return file
