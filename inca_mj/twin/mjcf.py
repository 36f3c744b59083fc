"""The MJCF of the INCA 6D, built from parameters and geometry.

Bodies `platform` (free) and `drum_1..8` (hinge `motor_i`), tendons `cable_1..8` from the exit
points to the platform, actuators `current_1..8`, sensors, a keyframe `start`; with the law the
default reset is that start too (see `inca_mj.twin.native`). MuJoCo computes the
rigid bodies, K_t i (gear), b_v (joint damping), J (armature) and the cable lengths. The tension,
the no-load length, the drum spring and the Coulomb friction are computed by `inca_mj.robot.law`;
the builder puts its numbers into `actuator_user` and `tendon_user`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from inca_mj.effects.hooks import KEY, Layout
from inca_mj.effects.values import about_centre, drive_values
from inca_mj.kinematics.rotations import quaternion
from inca_mj.robot import law
from inca_mj.robot.geometry import DRIVES, Geometry
from inca_mj.robot.parameters import GRAVITY, POSE, TIMESTEP
from inca_mj.robot.spread import EACH_DRIVE, at_drives, displaced
from inca_mj.twin.appearance import (
    LAW_NOTE,
    NEEDS_LAW,
    SHORT_LAW_NOTE,
    dress_drum,
    dress_platform,
    dress_world,
    filled,
)
from inca_mj.twin.statics import start, start_state

Points = tuple[tuple[float, float, float], ...]  # rows of a geometry [m]
ROTOR = 2e-15  # inertia MuJoCo demands of the drum's body beside the armature [kg m^2]


def build(
    parameters: ParameterSet, geometry: Geometry, layout: Layout | None = None
) -> mujoco.MjSpec:
    """Returns the robot at its pretensioned start, as an editable `MjSpec`.

    Args:
        parameters: the values, including those of the effects.
        geometry: anchors of the cables.
        layout: the candidate effects; none when None.

    Raises:
        InputError: the start pose admits no pretension (see `inca_mj.twin.statics.pretension`).
    """
    spec = empty_model(NEEDS_LAW, filled(LAW_NOTE, parameters, geometry), SHORT_LAW_NOTE, geometry)
    layout = layout or Layout()
    _settings(spec, layout)
    _platform(spec, parameters, geometry, layout)
    for k in range(1, DRIVES + 1):
        _drive(spec, k, parameters, geometry, layout)
    _sensors(spec)
    at = start_state(start(parameters, geometry, layout))
    spec.add_key(name="start", qpos=at.qpos, act=at.act)
    return spec


def empty_model(name: str, notes: str, short_note: str, geometry: Geometry) -> mujoco.MjSpec:
    """Returns a model with what it says of itself, the usual settings and the look of the room."""
    spec = mujoco.MjSpec()
    spec.modelname, spec.comment = name, notes
    spec.add_text(name="read_me", data=short_note)
    spec.compiler.degree = False
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    spec.option.timestep, spec.option.gravity = TIMESTEP, [0, 0, -GRAVITY]
    # Every other integrator adds inertia to custom forces or leaves out a part of them, and errs in
    # the damping of tendons.
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.disableflags = mujoco.mjtDisableBit.mjDSBL_CONTACT
    dress_world(spec, geometry)
    return spec


def _settings(spec: mujoco.MjSpec, layout: Layout) -> None:
    spec.option.disableflags |= (
        mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
        | mujoco.mjtDisableBit.mjDSBL_AUTORESET  # a divergence must be reported, and not restarted
    )
    spec.nuser_actuator = layout.actuator_columns
    spec.nuser_body = layout.body_columns
    spec.nuser_tendon = law.TENDON_COLUMNS
    spec.nuser_sensor = 1


def add_platform(
    spec: mujoco.MjSpec, values: Mapping[str, float], geometry: Geometry, connectors: Points
) -> Any:
    """Adds the platform at its start pose, with a site at each connector (8 rows of 3) [m].

    Raises:
        InputError: no body has such principal inertias.
    """
    check_inertia(values)
    x, y, z, *angles = (values[name] for name in POSE)
    body = spec.worldbody.add_body(name="platform", pos=[x, y, z], quat=quaternion(*angles))
    body.add_freejoint(name="platform")
    weigh(body, values["m"], [values["I_x"], values["I_y"], values["I_z"]])
    body.add_site(name="platform", pos=[0, 0, 0], size=[0.004, 0.004, 0.004])
    for k, connector in enumerate(connectors, 1):
        body.add_site(name=f"connector_{k}", pos=connector, size=[0.006, 0.006, 0.006])
    dress_platform(body, geometry)
    return body


def _platform(
    spec: mujoco.MjSpec, parameters: ParameterSet, geometry: Geometry, layout: Layout
) -> None:
    p = parameters.values()
    placed = about_centre(displaced(geometry, p), layout.effects, p)
    body = add_platform(spec, p, geometry, placed.connectors)
    by_name = {effect.name: effect for effect in layout.effects}
    body.userdata = np.concatenate(
        [np.zeros(0), *(drive_values(by_name[t.effect], p)[:, 0] for t in layout.on_platform)]
    )


def add_cable(spec: mujoco.MjSpec, k: int, exit_point: Any) -> Any:
    """Adds cable k from its exit point (3,) [m], whose site it adds too, to its connector."""
    spec.worldbody.add_site(name=f"exit_{k}", pos=exit_point, size=[0.012, 0.012, 0.012])
    cable = spec.add_tendon(name=f"cable_{k}", width=0.0025, rgba=[0.2, 0.2, 0.22, 1])
    cable.wrap_site(f"exit_{k}")
    cable.wrap_site(f"connector_{k}")
    return cable


def check_inertia(values: Mapping[str, float]) -> None:
    """Refuses principal inertias of which one exceeds the sum of the other two."""
    I = {name: values[name] for name in ("I_x", "I_y", "I_z")}
    largest = max(I, key=I.__getitem__)
    rest = sum(I.values()) - I[largest]
    if I[largest] > rest:
        raise InputError(
            f"no body has {largest} = {I[largest]:g} kg m^2, more than the {rest:g} kg m^2 of the"
            " other two inertias together; make it smaller, or them larger"
        )


def weigh(body: Any, mass: float, inertia: list[float]) -> None:
    """Sets the mass [kg] and principal inertia [kg m^2] about the body's own frame."""
    body.explicitinertial = True
    body.mass, body.inertia, body.ipos = mass, inertia, [0, 0, 0]


def _drive(
    spec: mujoco.MjSpec, k: int, parameters: ParameterSet, geometry: Geometry, layout: Layout
) -> None:
    """Adds drum, motor, cable and current actuator of drive k."""
    p = parameters.values()
    numbers = {name: float(at_drives(name, p)[k - 1]) for name in EACH_DRIVE}
    exit_point = np.array(geometry.exits[k - 1])
    cable = add_cable(spec, k, displaced(geometry, p).exits[k - 1])
    cable_row = np.zeros(law.TENDON_COLUMNS)
    cable_row[[law.TENDON_TAG, law.LAMBDA, law.B]] = law.TAG, numbers["lambda"], numbers["b"]
    cable.userdata = cable_row

    # The roller turns beside the nominal exit point, where it is only drawn; its inertia is J.
    outward = np.array([exit_point[0], exit_point[1], 0.0])
    outward = outward / np.linalg.norm(outward) if outward.any() else np.array([1.0, 0.0, 0.0])
    drum = spec.worldbody.add_body(name=f"drum_{k}", pos=exit_point + 0.08 * outward)
    weigh(drum, ROTOR, [ROTOR, ROTOR, ROTOR])
    axis = [-outward[1], outward[0], 0.0]
    drum.add_joint(
        name=f"motor_{k}",
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=axis,
        armature=numbers["J"],
        damping=numbers["b_v"],
    )
    dress_drum(drum, axis)

    row = np.zeros(layout.actuator_columns)
    row[KEY:][:1] = layout.key
    by_name = {effect.name: effect for effect in layout.effects}
    for term in layout.on_drives:
        values = drive_values(by_name[term.effect], p)[:, k - 1]
        row[term.column : term.column + len(values)] = values
    row[law.ACTUATOR_TAG], row[law.CABLE] = law.TAG, k - 1
    row[[law.R, law.R_S, law.K_S]] = numbers["R"], numbers["R_s"], numbers["k_s"]
    row[[law.B_C, law.BETA]] = numbers["b_c"], numbers["beta"]
    row[law.T_0] = start(parameters, geometry, layout).balance[k - 1]
    spec.add_actuator(
        name=f"current_{k}",
        target=f"motor_{k}",
        trntype=mujoco.mjtTrn.mjTRN_JOINT,
        gear=[numbers["K_t"], 0, 0, 0, 0, 0],
        dyntype=mujoco.mjtDyn.mjDYN_USER,  # activation: the no-load length d₀
        actdim=layout.states,
        gaintype=mujoco.mjtGain.mjGAIN_FIXED,
        gainprm=[0.0] * 10,
        biastype=mujoco.mjtBias.mjBIAS_USER,  # force: the current
        userdata=row,
    )


def _sensors(spec: mujoco.MjSpec) -> None:
    sensor, of = mujoco.mjtSensor, mujoco.mjtObj
    per_drive = (
        ("angle", sensor.mjSENS_JOINTPOS, of.mjOBJ_JOINT, "motor", None),
        ("rate", sensor.mjSENS_JOINTVEL, of.mjOBJ_JOINT, "motor", None),
        ("length", sensor.mjSENS_TENDONPOS, of.mjOBJ_TENDON, "cable", None),
        ("tension", sensor.mjSENS_USER, of.mjOBJ_ACTUATOR, "current", law.TENSION),
        ("no_load_length", sensor.mjSENS_USER, of.mjOBJ_ACTUATOR, "current", law.NO_LOAD_LENGTH),
    )
    for name, kind, object_type, target, shown in per_drive:
        for k in range(1, DRIVES + 1):
            added = spec.add_sensor(
                name=f"{name}_{k}", type=kind, objtype=object_type, objname=f"{target}_{k}"
            )
            if shown is not None:
                added.dim, added.userdata = 1, [shown]
                added.needstage = mujoco.mjtStage.mjSTAGE_VEL
                added.datatype = mujoco.mjtDataType.mjDATATYPE_REAL
    add_pose_sensors(spec)
    for name, kind in (
        ("velocity", sensor.mjSENS_FRAMELINVEL),
        ("angular_velocity", sensor.mjSENS_FRAMEANGVEL),
    ):
        spec.add_sensor(name=name, type=kind, objtype=of.mjOBJ_SITE, objname="platform")


def add_pose_sensors(spec: mujoco.MjSpec) -> None:
    """Adds sensors of position and orientation of the platform."""
    sensor, site = mujoco.mjtSensor, mujoco.mjtObj.mjOBJ_SITE
    kinds = {"position": sensor.mjSENS_FRAMEPOS, "orientation": sensor.mjSENS_FRAMEQUAT}
    for name, kind in kinds.items():
        spec.add_sensor(name=name, type=kind, objtype=site, objname="platform")
