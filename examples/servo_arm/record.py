"""Record the arm of servos into two MCAP files, as a robot with ROS 2 writes them.

    τ = clip(kp (u - q) - kv q', ±2.5 N m) - d q'

The servos of the true arm are stiffer than their data sheet says, and its joints have less
damping. Their steps are large enough to reach the limit of the torque: then only d brakes, so that
it can be told from kv. Run it: python examples/servo_arm/record.py FOLDER
"""

import sys
from pathlib import Path
from shutil import rmtree

import mujoco
import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from identification.effects.plant.rows import read_model

MODEL = Path(__file__).with_name("arm.xml")
JOINTS = ("shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll", "gripper")
KP = (17.0, 17.0, 15.0, 9.0, 9.0, 9.0)  # [N m/rad]; the data sheet says 12
KV = (0.9, 0.9, 0.8, 0.45, 0.45, 0.45)  # [N m s/rad]; the data sheet says 0.6
DAMPING = (0.22, 0.24, 0.2, 0.16, 0.16, 0.14)  # d [N m s/rad]; the drawing says 0.3
COUNTS = 4096  # of the encoder in a turn
SAMPLING = 0.02  # [s], of commands and of states
STEPS = 10  # of 0.1 ms for each of the model's, so that the robot is not the model's steps
BEGIN = 1_767_225_600_000_000_000  # [ns]
NOTE = "simulated by examples/servo_arm/record.py"


def true_arm():
    """The model with the numbers of the true robot."""
    model = read_model(MODEL).compile()
    for k, joint in enumerate(JOINTS):
        servo = model.actuator(f"{joint}_servo")
        servo.gainprm[0], servo.biasprm[1], servo.biasprm[2] = KP[k], -KP[k], -KV[k]
        model.dof_damping[model.joint(joint).dofadr[0]] = DAMPING[k]
    model.opt.timestep /= STEPS
    return model


def record(seed, seconds=20.0):
    """Commands and encoder angles [rad], both shape (N, 6): steps that come at random times."""
    chance = np.random.default_rng(seed)
    samples = round(seconds / SAMPLING)
    commands = np.zeros((samples, len(JOINTS)))
    for k in range(len(JOINTS)):
        begin = 0
        while begin < samples:
            commands[begin:, k] = chance.uniform(-0.9, 0.9)
            begin += int(chance.integers(15, 60))
    model = true_arm()
    data, angles = mujoco.MjData(model), np.zeros_like(commands)
    for n, command in enumerate(commands):
        angles[n], data.ctrl[:] = data.qpos, command
        mujoco.mj_step(model, data, round(SAMPLING / model.opt.timestep))
    count = 2 * np.pi / COUNTS
    return np.round(commands, 3), np.round(angles / count) * count


def write(folder, name, seed):
    """Write one recording as FOLDER/NAME.mcap."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    kind = "sensor_msgs/msg/JointState"
    stamp, header, state = (
        store.types[t] for t in ("builtin_interfaces/msg/Time", "std_msgs/msg/Header", kind)
    )
    draft = Path(folder) / f"{name}_draft"
    writer = Writer(draft, version=9, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    writer.set_custom_data("note", NOTE)
    with writer:
        topics = [writer.add_connection(t, kind, typestore=store)
                  for t in ("/desired", "/joint_states")]  # fmt: skip
        for n, both in enumerate(zip(*record(seed), strict=True)):
            now = BEGIN + round(1e9 * SAMPLING) * n
            for topic, numbers in zip(topics, both, strict=True):
                when = header(stamp(sec=now // 10**9, nanosec=now % 10**9), "")
                message = state(when, list(JOINTS), numbers, np.zeros(0), np.zeros(0))
                writer.write(topic, now, store.serialize_cdr(message, kind))
    next(draft.glob("*.mcap")).replace(Path(folder) / f"{name}.mcap")
    rmtree(draft)


if __name__ == "__main__":
    for place, chosen in (("first", 1), ("second", 2)):
        write(sys.argv[1], place, chosen)
