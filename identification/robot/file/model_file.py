"""The model of a robot's file: an MJCF as it is, or a URDF that is completed for a log.

An MJCF may lack files that tell only its look (`identification.model.missing_files`). Sensors and
motors that it lacks are added (`completed`), a free joint whose pose is measured becomes slides and
hinges (`measured_base`), and joints whose tendons are measured get sensors (`measured_tendons`).

A URDF has no actuators, no sensors and no integrator, and most often names meshes that lie
elsewhere. Dynamics need no meshes: they are left out. Each joint that moves gets a sensor of its
position, called as the joint, and a motor of gear 1, called joint_torque, or joint_force where it
slides. (A log has a column for each, so one name cannot be that of both.)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from math import ceil
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np

from identification.effects.plant.rows import read_model, read_told_model
from identification.errors import InputError
from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.poses import Pose
from identification.logs.units import refuse_not_si, refuse_other_unit
from identification.model.plant import start_place
from identification.model.rollout import substeps
from identification.robot.file.completed import add_position, motor_of, with_missing
from identification.robot.file.file import RobotFile
from identification.robot.file.measured_base import base_poses, with_free_joints, with_measured_base
from identification.robot.file.measured_tendons import with_measured_joints
from identification.storage.files import MODEL, read_bytes

UNITS = {  # unit for a slide, unit for a hinge
    "damping": ("N s/m", "N m s/rad"), "armature": ("kg", "kg m^2"),
    "stiffness": ("N/m", "N m/rad"), "frictionloss": ("N", "N m"),
    "qpos": ("m", "rad"), "qvel": ("m/s", "rad/s"), "force": ("N", "N m"),
}  # fmt: skip
# A servo is a spring and a damper to its command.
GAINS = {"kp": "stiffness", "kv": "damping", "forcerange": "force"}
HEAD = 4096  # bytes in which the first element of a file stands
FINER = 50  # times as many steps in a sample are tried, to find some that divide several logs
FORM = ("visual", "collision")  # of a link: how it looks, not how it moves
_LARGEST = 2**26  # [bytes]


def robot_spec(file: RobotFile) -> tuple[mujoco.MjSpec, tuple[str, ...]]:
    """Returns the model of a robot, and what was added to it or left out, in sentences."""
    raw = read_bytes(file.model, _LARGEST, MODEL)
    if file.model.suffix.lower() != ".urdf" and b"<robot" not in raw[:HEAD]:
        spec, left_out = read_told_model(file.model)
        said: tuple[str, ...] = (left_out,) if left_out else ()
        said += with_missing(spec, file)
        said += with_measured_joints(spec, file)
        return spec, (*said, *with_measured_base(spec, file))
    try:
        root = ElementTree.fromstring(raw)
    except ElementTree.ParseError as error:
        raise InputError(f"the model {file.model} is no XML ({error}); correct it there") from error
    if b"xmlns:xacro" in raw and b"<xacro:" in raw:
        raise InputError(f"the model {file.model} is a xacro; expand it first: xacro FILE > URDF")
    return _urdf(root, file)


def measured_poses(file: RobotFile) -> tuple[Pose, ...]:
    """Returns the poses of free joints that a robot's file says to be measured."""
    if not file.poses and not file.outputs:
        return ()
    raw = read_bytes(file.model, _LARGEST, MODEL)
    if file.model.suffix.lower() == ".urdf" or b"<robot" in raw[:HEAD]:
        return ()
    return base_poses(with_free_joints(read_told_model(file.model)[0]), file)


def with_step(spec: mujoco.MjSpec, logs: Sequence[Log]) -> tuple[str, ...]:
    """Give a model the largest step up to its own that divides the sampling of logs; say so."""
    given, h = float(spec.option.timestep), logs[0].sampling_time
    if _divides(given, logs):
        return ()
    least = max(1, ceil(h / given - 1e-9))
    steps = (h / n for n in range(least, FINER * least + 1))
    step = next((s for s in steps if _divides(s, logs)), None)
    if step is None:
        times = {log.name: log.sampling_time for log in logs}
        other = max(times, key=lambda name: abs(round(times[name] / h) * h - times[name]))
        raise InputError(
            f"no step of the model divides the sampling times of log {logs[0].name!r}, {h:.6g} s,"
            f" and of log {other!r}, {times[other]:.6g} s; give the TOML beside one of them a"
            " sampling_time that is a whole multiple or part of the other's"
        )
    spec.option.timestep = step
    return (
        f"The model's step of {given:g} s does not divide the sampling time of {h:g} s; simulations"
        f" take steps of {step:.6g} s.",
    )


def unit_of(model: mujoco.MjModel, path: str) -> str:
    """Returns the unit of a number of a model, "" where none is known.

    Known are those of a body's mass, a place, a joint's number, an entry of the start and a servo's
    gain.
    """
    place = start_place(path, model)
    thing, _, attribute = path.partition("[")[0].rpartition(".")
    kind, _, name = thing.partition("/")
    joints: list[int] = []
    if place is not None:
        attribute = place[0]
        at = model.jnt_qposadr if attribute == "qpos" else model.jnt_dofadr
        joints = np.flatnonzero(at <= place[1])[-1:].tolist()
    elif kind == "joint":
        joints = [j for j in range(model.njnt) if fnmatchcase(model.joint(j).name, name)]
    elif kind == "actuator" and attribute == "timeconst":
        return "s"
    elif kind == "actuator" and attribute in GAINS:
        units = {_unit_at(model, i, GAINS[attribute]) for i in range(model.nu)
                 if fnmatchcase(model.actuator(i).name, name)}  # fmt: skip
        return units.pop() if len(units) == 1 else ""
    if not joints or attribute not in UNITS:
        of_bodies = {"mass": "kg", "inertia": "kg m^2", "spread": "kg m^2", "ipos": "m"}
        if attribute == "pos":
            return "m"
        return of_bodies.get(attribute, "") if kind == "body" else ""
    return _by_joint(model, joints[0], attribute)


def refuse_unit(said: Mapping[str, Any], expected: str, whose: str) -> None:
    """Refuse a parameter's unit in which the model reads no numbers; any where "" is expected."""
    unit = said.get("unit", expected)
    if expected:
        refuse_other_unit(unit, expected, whose)
    refuse_not_si(unit, whose)


def _unit_at(model: mujoco.MjModel, actuator: int, like: str) -> str:
    """Returns the unit of a spring or damper that acts where an actuator does."""
    # Another gear may turn an angle into a way: it has then a unit that no file tells.
    if abs(model.actuator_gear[actuator, 0]) != 1:
        return ""
    kind, at = int(model.actuator_trntype[actuator]), int(model.actuator_trnid[actuator, 0])
    if kind == int(mujoco.mjtTrn.mjTRN_TENDON):  # of joints, or a way through space
        is_fixed = model.wrap_type[model.tendon_adr[at]] == int(mujoco.mjtWrap.mjWRAP_JOINT)
        return "" if is_fixed else UNITS[like][0]
    if kind not in (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT)):
        return ""
    return _by_joint(model, at, like)


def _by_joint(model: mujoco.MjModel, joint: int, like: str) -> str:
    """Returns the unit of a number of a slide or a hinge, "" of another joint."""
    types = (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE))
    found = int(model.jnt_type[joint])
    return UNITS[like][types.index(found)] if found in types else ""


def _divides(step: float, logs: Sequence[Log]) -> bool:
    try:
        return all(substeps(log.sampling_time, step) > 0 for log in logs)
    except InputError:
        return False


def _urdf(root: ElementTree.Element, file: RobotFile) -> tuple[mujoco.MjSpec, tuple[str, ...]]:
    """Returns the model of a URDF without meshes, with motors and sensors, and what was added."""
    _refuse_massless(root, file)
    forms = 0
    for link in root.iter("link"):
        for part in [part for tag in FORM for part in link.findall(tag)]:
            link.remove(part)
            forms += 1
    try:
        spec = read_model(ElementTree.tostring(root, encoding="unicode"))
    except InputError as error:
        raise InputError(f"{file.model}: {error}") from error
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    motors = []
    for name, kind in [(joint.name, joint.type) for joint in spec.joints]:
        motors.append(motor_of(name, kind == mujoco.mjtJoint.mjJNT_SLIDE))
        motor = spec.add_actuator(name=motors[-1], target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_motor()
        add_position(spec, name, name)
    return spec, (
        f"{file.model.name} is a URDF: {forms} visual and collision shapes were left out, and"
        f" each joint got a sensor of its position, called as the joint, and a motor of gear 1:"
        f" {listed(motors)}; the integrator is RK4.",
    )


def _refuse_massless(root: ElementTree.Element, file: RobotFile) -> None:
    """Refuse links that move and have no mass, alone or with what is fixed to them."""
    heavy = {str(link.get("name")) for link in root.iter("link")
             if link.find("inertial/mass") is not None}  # fmt: skip
    below: dict[str, list[str]] = {}
    moved = []
    for joint in root.iter("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is None or child is None:
            continue  # of a transmission
        if joint.get("type") == "fixed":
            below.setdefault(str(parent.get("link")), []).append(str(child.get("link")))
        else:
            moved.append(str(child.get("link")))

    def weighs(link: str) -> bool:
        return link in heavy or any(weighs(child) for child in below.get(link, []))

    light = [link for link in moved if not weighs(link)]
    if light:
        raise InputError(
            f"{file.model}: {listed(light)} move{'s' * (len(light) == 1)} and"
            f" ha{'s' if len(light) == 1 else 've'} no <inertial> with a mass; give"
            f" {'it' if len(light) == 1 else 'them'} mass, centre and inertia"
        )
