"""Sensors and motors that an MJCF lacks of a log, added to it and told.

An MJCF of a robot often has no sensors, and that of an arm may have no actuators. Without any
sensor, each hinge and slide gets one of its position, called as the joint; beside sensors, a joint
that `outputs` or `[columns]` of the robot's file names. A joint without a
drive gets a motor of gear 1 where `[columns]` of the robot's file names the column of its torque,
as JOINT_torque, or JOINT_force where it slides. Neither stands on a guess: the file says so.
"""

from __future__ import annotations

from collections.abc import Iterable

import mujoco

from identification.errors import InputError
from identification.logs.log import Log
from identification.logs.names import listed
from identification.robot.file.file import RobotFile
from identification.storage.files import toml_key, toml_value

_SLIDE = mujoco.mjtJoint.mjJNT_SLIDE
_MOVING = (_SLIDE, mujoco.mjtJoint.mjJNT_HINGE)
_JOINT = (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT)


def with_missing(spec: mujoco.MjSpec, file: RobotFile) -> tuple[str, ...]:
    """Add sensors and motors that a model lacks and the robot's file asks for; say so."""
    asked = {*file.outputs, *file.columns}
    actuators = {actuator.name for actuator in spec.actuators}
    known = {sensor.name for sensor in spec.sensors} | actuators
    # a sensor of another kind may be meant for an output: that is told, and not passed over
    has_any = bool(list(spec.sensors))
    sensors, motors = [], []
    joints = [(j.name, j.type) for j in spec.joints if j.type in _MOVING and j.name]
    for joint, kind in joints:
        name = joint if joint not in actuators else f"{joint}_position"
        if name not in known and (name in asked or not has_any):
            add_position(spec, joint, name)
            sensors.append(name)
        motor = motor_of(joint, kind == _SLIDE)
        if motor in asked and motor not in known and joint in _undriven(spec, [joint]):
            added = spec.add_actuator(name=motor, target=joint, trntype=_JOINT[0])
            added.set_to_motor()
            motors.append(motor)
    said = []
    if sensors:
        said.append(f"sensors of joint positions, {listed(sensors)}")
    if motors:
        said.append(f"motors of gear 1, {listed(motors)}")
    return (f"{file.model.name} lacks and got {' and '.join(said)}.",) if said else ()


def motor_of(joint: str, slides: bool) -> str:
    """Returns the name of the motor that is added to a joint, which is that of its input."""
    return f"{joint}_{'force' if slides else 'torque'}"


def torques_without_motor(spec: mujoco.MjSpec) -> tuple[str, ...]:
    """Returns the names of columns that are the torques of joints without a drive."""
    known = {thing.name for thing in (*spec.actuators, *spec.sensors)}
    joints = {j.name: j.type == _SLIDE for j in spec.joints if j.type in _MOVING and j.name}
    names = (motor_of(joint, joints[joint]) for joint in _undriven(spec, joints))
    return tuple(name for name in names if name not in known)


def refuse_unread_torques(file: RobotFile, log: Log) -> None:
    """Refuse a log whose extras are torques that would move the robot, and that nothing reads."""
    moving = [name for name, column in log.extras.items() if column.any()]
    if moving:
        lines = ", ".join(f"{toml_key(n)} = {toml_value(n)}" for n in moving)
        raise InputError(
            f"log {log.name!r} has {listed(moving)}, and {file.model.name} has no actuator that"
            f" takes {'it' if len(moving) == 1 else 'them'}; write {lines} under [columns] in"
            f" {file.path}, which gives each such joint a motor, or name them under ignore in the"
            " TOML beside the log if they do not drive it"
        )


def add_position(spec: mujoco.MjSpec, joint: str, name: str) -> None:
    """Add a sensor of the position of a joint."""
    spec.add_sensor(
        name=name, type=mujoco.mjtSensor.mjSENS_JOINTPOS, objtype=mujoco.mjtObj.mjOBJ_JOINT,
        objname=joint,
    )  # fmt: skip


def _undriven(spec: mujoco.MjSpec, joints: Iterable[str]) -> list[str]:
    """Returns those joints on which no actuator acts directly."""
    driven = {a.target for a in spec.actuators if a.trntype in _JOINT}
    return [joint for joint in joints if joint not in driven]
