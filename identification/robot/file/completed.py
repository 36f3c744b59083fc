"""Sensors and motors that an MJCF lacks of a log, added to it and told.

An MJCF of a robot often has no sensors, and that of an arm may have no actuators. Without any
sensor, each hinge and slide gets one of its position, called as the joint; beside sensors, a joint
that `outputs` or `[columns]` of the robot's file names. A log has a column for each actuator and
each sensor, so that one name cannot be that of both: a sensor that would bear the name of an
actuator is called JOINT_position, and one of the model that does is called so too. A joint without
a drive gets a motor of gear 1 where `[columns]` of the robot's file names the column of its torque,
as JOINT_torque, or JOINT_force where it slides. Neither stands on a guess: the file says so.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from itertools import chain, count

import mujoco

from identification.logs.names import listed
from identification.robot.file.file import RobotFile

_SLIDE = mujoco.mjtJoint.mjJNT_SLIDE
_KINDS = {  # sensors that may be outputs of a log, and what they are called beside an actuator
    mujoco.mjtSensor.mjSENS_JOINTPOS: "position",
    mujoco.mjtSensor.mjSENS_JOINTVEL: "velocity",
    mujoco.mjtSensor.mjSENS_TENDONPOS: "length",
}
_MOVING = (_SLIDE, mujoco.mjtJoint.mjJNT_HINGE)
JOINT = (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT)


def with_missing(spec: mujoco.MjSpec, file: RobotFile) -> tuple[str, ...]:
    """Add sensors and motors that a model lacks and the robot's file asks for; say so."""
    asked = {*file.outputs, *file.columns}
    actuators = {actuator.name for actuator in spec.actuators}
    renamed = _with_own_names(spec)
    known = {sensor.name for sensor in spec.sensors} | actuators
    # a sensor of another kind may be meant for an output: that is told, and not passed over
    has_any = bool(list(spec.sensors))
    sensors, motors = [], []
    joints = [(j.name, j.type) for j in spec.joints if j.type in _MOVING and j.name]
    for joint, kind in joints:
        name = position_of(joint, actuators)
        if name not in known and (name in asked or not has_any):
            add_position(spec, joint, name)
            sensors.append(name)
        motor = motor_of(joint, kind == _SLIDE)
        if motor in asked and motor not in known and joint in _undriven(spec, [joint]):
            added = spec.add_actuator(name=motor, target=joint, trntype=JOINT[0])
            added.set_to_motor()
            motors.append(motor)
    said = []
    if sensors:
        said.append(f"sensors of joint positions, {listed(sensors)}")
    if motors:
        said.append(f"motors of gear 1, {listed(motors)}")
    told = [f"{file.model.name} lacks and got {' and '.join(said)}."] if said else []
    if renamed:
        told.append(
            f"{file.model.name} has sensors with the names of actuators, and a log has a column for"
            f" each; they are called {listed(renamed)}."
        )
    return tuple(told)


def position_of(joint: str, actuators: Collection[str], kind: str = "position") -> str:
    """Returns the name of the sensor of a joint, which is that of its output: no actuator's."""
    plain = (joint, f"{joint}_{kind}")
    names = chain(plain, (f"{joint}_{kind}_{k}" for k in count(2)))
    return next(name for name in names if name not in actuators)


def _with_own_names(spec: mujoco.MjSpec) -> list[str]:
    """Give sensors that have the name of an actuator one of their own; returns these names."""
    actuators = {actuator.name for actuator in spec.actuators}
    taken = actuators | {sensor.name for sensor in spec.sensors}
    renamed = []
    for sensor in spec.sensors:
        if sensor.name and sensor.name in actuators and sensor.type in _KINDS:
            sensor.name = position_of(sensor.name, taken, _KINDS[sensor.type])
            taken.add(sensor.name)
            renamed.append(sensor.name)
    return renamed


def positions_without_sensor(spec: mujoco.MjSpec) -> dict[str, str]:
    """Returns the joints whose position no sensor measures, by the sensors that they may get."""
    actuators = {actuator.name for actuator in spec.actuators}
    known = actuators | {sensor.name for sensor in spec.sensors}
    seen = {s.objname for s in spec.sensors if s.type == mujoco.mjtSensor.mjSENS_JOINTPOS}
    joints = [j.name for j in spec.joints if j.type in _MOVING and j.name and j.name not in seen]
    names = {position_of(joint, actuators): joint for joint in joints}
    return {name: joint for name, joint in names.items() if name not in known}


def motor_of(joint: str, slides: bool) -> str:
    """Returns the name of the motor that is added to a joint, which is that of its input."""
    return f"{joint}_{'force' if slides else 'torque'}"


def motors_to_add(spec: mujoco.MjSpec) -> dict[str, str]:
    """Returns the motors that joints without a drive may get, by joint.

    A motor is called as its input: a column of that name is the torque of its joint.
    """
    known = {thing.name for thing in (*spec.actuators, *spec.sensors)}
    joints = {j.name: j.type == _SLIDE for j in spec.joints if j.type in _MOVING and j.name}
    motors = {joint: motor_of(joint, joints[joint]) for joint in _undriven(spec, joints)}
    return {joint: motor for joint, motor in motors.items() if motor not in known}


def add_position(spec: mujoco.MjSpec, joint: str, name: str) -> None:
    """Add a sensor of the position of a joint."""
    spec.add_sensor(
        name=name, type=mujoco.mjtSensor.mjSENS_JOINTPOS, objtype=mujoco.mjtObj.mjOBJ_JOINT,
        objname=joint,
    )  # fmt: skip


def _undriven(spec: mujoco.MjSpec, joints: Iterable[str]) -> list[str]:
    """Returns those joints on which no actuator acts directly."""
    driven = {a.target for a in spec.actuators if a.trntype in JOINT}
    return [joint for joint in joints if joint not in driven]
