"""What of a model file is for people: the look of the robot, and what the file says of itself.

Floor, frame, drums, handle, light and cameras are without mass or contact.

A file says three times what it needs, because MuJoCo shows nothing of a model's meaning by itself:
as a comment at its head, for who opens it in an editor; as the custom text `read_me`, for a program
(`model.text_data`); and as the model's name, which is the title of MuJoCo's viewer. MJCF has no
element that prints a warning where the law is missing.
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from identification.model.parameter import ParameterSet
from inca_mj.robot.geometry import ARM_RADIUS, GRIP, GRIP_RADIUS, Geometry

ALUMINIUM = [0.60, 0.62, 0.66, 1.0]
STEEL = [0.30, 0.32, 0.36, 1.0]
MOTOR = [0.12, 0.12, 0.13, 1.0]
HANDLE = [0.93, 0.45, 0.13, 1.0]
# The handle has 15 cm in a frame of 3 m, so its camera moves with it, at a fixed direction [m].
NO_ARM = 1e-3  # length of an arm that is not drawn [m]
HANDLE_EYE, HANDLE_TARGET = [0.18, -0.50, 0.12], [0.0, 0.0, -0.035]
_BOX, _CYLINDER = mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_CYLINDER
_CAPSULE, _SPHERE = mujoco.mjtGeom.mjGEOM_CAPSULE, mujoco.mjtGeom.mjGEOM_SPHERE


def dress_world(spec: mujoco.MjSpec, geometry: Geometry) -> None:
    """Adds floor, aluminium frame around the exit points, light, cameras, frame size of films."""
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 1920, 1080
    spec.visual.quality.shadowsize = 0  # shadows cost a CPU renderer most of its frame rate
    spec.visual.headlight.ambient = [0.55, 0.55, 0.55]
    spec.visual.headlight.diffuse = [0.35, 0.35, 0.35]
    spec.visual.rgba.haze = [0.925, 0.945, 0.965, 1.0]
    spec.visual.headlight.specular = [0.1, 0.1, 0.1]
    spec.stat.center, spec.stat.extent = [0, 0, 1.5], 3.0
    kinds, patterns = mujoco.mjtTexture, mujoco.mjtBuiltin
    for name, kind, pattern, first, second, height in (
        ("sky", kinds.mjTEXTURE_SKYBOX, patterns.mjBUILTIN_GRADIENT, [0.97, 0.98, 0.99],
         [0.88, 0.91, 0.94], 1536),
        ("floor", kinds.mjTEXTURE_2D, patterns.mjBUILTIN_CHECKER, [0.93, 0.94, 0.95],
         [0.895, 0.905, 0.915], 256),
    ):  # fmt: skip
        spec.add_texture(
            name=name, type=kind, builtin=pattern, rgb1=first, rgb2=second, width=256, height=height
        )
    floor = spec.add_material(name="floor", texrepeat=[1, 1], texuniform=True, reflectance=0.0)
    floor.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "floor"

    world = spec.worldbody
    world.add_light(
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        dir=[0.3, 0.5, -1],
        diffuse=[0.35, 0.35, 0.35],
        castshadow=False,
    )
    world.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 0.1], material="floor",
        contype=0, conaffinity=0,
    )  # fmt: skip
    _frame(world, geometry)
    cameras = {
        "front": ([1.2, -6.7, 2.3], [0.0, 0.0, 1.5]),
        "side": ([6.4, -2.4, 2.3], [0.0, 0.0, 1.5]),
    }
    for name, (eye, target) in cameras.items():
        world.add_camera(name=name, pos=eye, xyaxes=_look(eye, target), fovy=38)


def _frame(world: Any, geometry: Geometry) -> None:
    """Adds bars along the edges of the box around the exit points, 8 cm outside of it."""
    low, high = geometry.A.min(0) - [0.12, 0.12, 0.1], geometry.A.max(0) + [0.12, 0.12, 0.06]
    corners = np.array([[(low, high)[i][0], (low, high)[j][1]] for i, j in np.ndindex(2, 2)])
    for x, y in corners:
        _add(world, _BOX, ALUMINIUM, pos=[x, y, high[2] / 2], size=[0.022, 0.022, high[2] / 2])
    centre, half = (low + high) / 2, (high - low) / 2
    for z in (0.022, high[2]):
        for y in (low[1], high[1]):
            _add(world, _BOX, ALUMINIUM, pos=[centre[0], y, z], size=[half[0], 0.022, 0.022])
        for x in (low[0], high[0]):
            _add(world, _BOX, ALUMINIUM, pos=[x, centre[1], z], size=[0.022, half[1], 0.022])


def dress_drum(drum: Any, axis: list[float]) -> None:
    """Adds a roller, a motor behind it, and a mark on the rim that shows the turn."""
    along = np.array(axis)
    ends = np.concatenate([-0.02 * along, 0.02 * along])
    _add(drum, _CYLINDER, STEEL, fromto=ends, size=[0.045, 0, 0])
    behind = np.concatenate([0.02 * along, 0.10 * along])
    _add(drum, _CYLINDER, MOTOR, fromto=behind, size=[0.028, 0, 0])
    mark = np.concatenate([[0, 0, 0.01], [0, 0, 0.045]]) - np.tile(0.022 * along, 2)
    _add(drum, _CAPSULE, HANDLE, fromto=mark, size=[0.006, 0, 0])


def dress_platform(platform: Any, geometry: Geometry) -> None:
    """Adds a hub, an arm to each connector, the handle, and a camera that travels with it."""
    platform.add_camera(
        name="handle",
        pos=HANDLE_EYE,
        xyaxes=_look(HANDLE_EYE, HANDLE_TARGET),
        fovy=38,
        mode=mujoco.mjtCamLight.mjCAMLIGHT_TRACK,
    )
    _add(platform, _SPHERE, STEEL, pos=[0, 0, 0], size=[0.014, 0, 0])
    for connector in np.unique(geometry.B, axis=0):
        if np.linalg.norm(connector) > NO_ARM:
            _add(platform, _CAPSULE, ALUMINIUM, fromto=[0, 0, 0, *connector],
                 size=[ARM_RADIUS, 0, 0])  # fmt: skip
        _add(platform, _SPHERE, STEEL, pos=connector, size=[0.009, 0, 0])
    _add(platform, _CAPSULE, HANDLE, fromto=[*GRIP[0], *GRIP[1]], size=[GRIP_RADIUS, 0, 0])
    _add(platform, _SPHERE, HANDLE, pos=[0, 0, -0.115], size=[0.019, 0, 0])


def _add(body: Any, kind: Any, rgba: list[float], **how: Any) -> None:
    body.add_geom(type=kind, rgba=rgba, contype=0, conaffinity=0, mass=0, **how)


def _look(eye: list[float], target: list[float]) -> list[float]:
    """Returns x and y axes of a camera at `eye` that looks at `target`, z up."""
    back = np.subtract(eye, target)
    x = np.cross([0, 0, 1], back)
    y = np.cross(back, x)
    return [*(x / np.linalg.norm(x)), *(y / np.linalg.norm(y))]


NEEDS_LAW = "inca6d_needs_the_law_of_inca_mj"  # the model's name, the title of MuJoCo's viewer
PLAIN = "inca6d_plain"
# The text `read_me` of a model that needs the law; MJCF keeps it in one line.
SHORT_LAW_NOTE = (
    "The cables pull only with the law of inca_mj (in Python: inca_mj.build_twin()). In MuJoCo"
    " alone the platform falls; inca6d_plain.xml is the approximation that needs MuJoCo only."
)
SHORT_PLAIN_NOTE = (
    "The INCA 6D linearised about its start, for MuJoCo alone; the twin itself is inca6d.xml"
    " with the law of inca_mj."
)
LAW_NOTE = """
  INCA 6D, the twin. Parameter set {set}; geometry: {source}.

  This file needs the law of inca_mj. MuJoCo alone computes the rigid bodies, the torques of the
  currents and the lengths of the cables. The tension of the elastic cables, the drum springs and
  the friction of the motors are computed by callbacks that the Python package inca_mj installs.

  In Python:
      import mujoco, inca_mj
      inca_mj.build_twin()                                  # installs the law in this process
      model = mujoco.MjModel.from_xml_path("{file}")
      data = mujoco.MjData(model)                           # rests, as after every reset
  or, with the parameters at hand: robot = inca_mj.build_twin(); inca_mj.simulate(robot, currents).
  In a viewer: inca view

  In `python -m mujoco.viewer` there is no law: no cable pulls, and the platform falls through the
  floor, since contacts are switched off. For programs without inca_mj there is inca6d_plain.xml: it
  needs MuJoCo only and follows the twin in small motions.

  Actuators current_1 to current_8 take currents [A]; a positive current winds its cable in.
"""
PLAIN_NOTE = """
  INCA 6D for MuJoCo alone. Parameter set {set}; geometry: {source}.

  This file needs nothing but MuJoCo and rests after a reset; drop it on the window of
  `python -m mujoco.viewer`. It is the twin (inca6d.xml) linearised about its start: springs and
  dampers instead of the law of the cables, viscous instead of Coulomb friction. docs/models.md says
  how far it is from the twin.

  A drum is a joint spool_k that slides by R times the motor's angle, because a spatial tendon of
  MuJoCo cannot be wound up. The sensors angle_k and rate_k, and the tendons motor_k, give the
  motor's angle [rad] and rate [rad/s]. Actuators current_1 to current_8 take currents [A]; a
  positive current winds its cable in.

  Written by inca_mj.twin.plain from parameters and geometry; change those, and not this file.
"""


def filled(text: str, parameters: ParameterSet, geometry: Geometry) -> str:
    """Returns the comment of a model file, with what the model is made from."""
    source = geometry.source.replace("--", "- -")  # XML ends a comment at two hyphens
    return text.format(set=parameters.name, source=source, file="inca6d.xml")
