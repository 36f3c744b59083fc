"""Notes in the model files on the files themselves.

A file says it three times, because MuJoCo shows nothing of a model's meaning by itself: as a
comment at its head, for who opens it in an editor; as the custom text `read_me`, for a program
(`model.text_data`); and as the model's name, which is the title of MuJoCo's viewer. MJCF has no
element that prints a warning where the law is missing.
"""

from __future__ import annotations

from identification.model.parameter import ParameterSet
from inca_mj.robot.geometry import Geometry

NEEDS_LAW = "inca6d_needs_the_law_of_inca_mj"  # the model's name, the title of MuJoCo's viewer
PLAIN = "inca6d_plain"

_LAW = """
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

_PLAIN = """
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


def law_notes(parameters: ParameterSet, geometry: Geometry) -> str:
    """Returns the comment of a model file that needs the law."""
    return _filled(_LAW, parameters, geometry)


def plain_notes(parameters: ParameterSet, geometry: Geometry) -> str:
    """Returns the comment of a model file that needs MuJoCo only."""
    return _filled(_PLAIN, parameters, geometry)


def short_law_note() -> str:
    """Returns the text `read_me` of a model that needs the law; MJCF keeps it in one line."""
    return (
        "The cables pull only with the law of inca_mj (in Python: inca_mj.build_twin()). In MuJoCo"
        " alone the platform falls; inca6d_plain.xml is the approximation that needs MuJoCo only."
    )


def short_plain_note() -> str:
    """Returns the text `read_me` of the model that needs MuJoCo only."""
    return (
        "The INCA 6D linearised about its start, for MuJoCo alone; the twin itself is inca6d.xml"
        " with the law of inca_mj."
    )


def _filled(text: str, parameters: ParameterSet, geometry: Geometry) -> str:
    source = geometry.source.replace("--", "- -")  # XML ends a comment at two hyphens
    return text.format(set=parameters.name, source=source, file="inca6d.xml")
