"""The model of a robot's file: an MJCF as it is, or a URDF that is completed for a log.

A URDF has no actuators, no sensors and no integrator, and most often names meshes that lie
elsewhere. Dynamics need no meshes: they are left out. Each joint that moves gets a sensor of its
position, called as the joint, and a motor of gear 1, called joint_torque, or joint_force where it
slides. (A log has a column for each, so one name cannot be that of both.)
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from xml.etree import ElementTree

import mujoco

from identification.effects.rows import read_model
from identification.errors import InputError
from identification.files import MODEL, read_bytes
from identification.logs.log import Log
from identification.logs.names import listed
from identification.model.rollout import substeps
from identification.robot.file import RobotFile

HEAD = 4096  # bytes in which the first element of a file stands
FINER = 50  # times as many steps in a sample are tried, to find some that divide several logs
FORM = ("visual", "collision")  # of a link: how it looks, not how it moves
_LARGEST = 2**26  # [bytes]


def robot_spec(file: RobotFile) -> tuple[mujoco.MjSpec, tuple[str, ...]]:
    """Returns the model of a robot, and what was added to it, in sentences."""
    raw = read_bytes(file.model, _LARGEST, MODEL)
    if file.model.suffix.lower() != ".urdf" and b"<robot" not in raw[:HEAD]:
        return read_model(file.model), ()
    try:
        root = ElementTree.fromstring(raw)
    except ElementTree.ParseError as error:
        raise InputError(f"the model {file.model} is no XML ({error}); correct it there") from error
    if b"xmlns:xacro" in raw and b"<xacro:" in raw:
        raise InputError(f"the model {file.model} is a xacro; expand it first: xacro FILE > URDF")
    return _urdf(root, file)


def with_step(spec: mujoco.MjSpec, logs: Sequence[Log]) -> tuple[str, ...]:
    """Give a model the largest step up to its own that divides the sampling of logs; say so.

    Returns:
        A sentence, or nothing where its own step divides them.
    """
    own, h = float(spec.option.timestep), logs[0].sampling_time
    if _divides(own, logs):
        return ()
    least = max(1, ceil(h / own - 1e-9))
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
        f"The model's step of {own:g} s does not divide the sampling time of {h:g} s; simulations"
        f" take steps of {step:.6g} s.",
    )


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
        slides = kind == mujoco.mjtJoint.mjJNT_SLIDE
        motors.append(f"{name}_{'force' if slides else 'torque'}")
        motor = spec.add_actuator(name=motors[-1], target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_motor()
        spec.add_sensor(
            name=name, type=mujoco.mjtSensor.mjSENS_JOINTPOS,
            objtype=mujoco.mjtObj.mjOBJ_JOINT, objname=name,
        )  # fmt: skip
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
