"""The INCA 6D for MuJoCo alone: the twin linearised about its start, as `models/inca6d_plain.xml`.

MuJoCo's spatial tendons cannot be wound up. So each motor is a slide joint with s = R φ, and its
cable is a tendon whose length is that of the cable plus s, L = d + s:

    T    = k (L - L_0) + b L̇                k = λ/d₀(0),  L_0 = L(0) - T(0)/k       (2.24, 2.30)
    F_s  = T(0) - k_s (R_s/R)² s            force of the drum spring at the roller  (2.41)
    τ_c  = b_c clip(β ω, -1, 1)             in place of b_c tanh(β ω)               (2.39)
    J/R² s̈ = K_t/R i - T + F_s - b_v/R² ṡ - τ_c/R                                   (2.40)

What is left out is of second order in the motion, or smaller: d₀ in λ/d₀ and in ḋ₀ stays d₀(0),
where the twin has the present one. A slack cable does not push, but it still damps, and the drum
spring may push, as the twin's may not.

MuJoCo's frictionloss is a constraint that brings the acceleration a of an unconstrained joint to
(1 - δ) a - δ B ω as long as its force is below its limit b_c. With the impedance δ near zero and
δ B = b_c β/J that is the viscous start of the thesis' friction; with MuJoCo's defaults the joint
would stick at rest, which the thesis' friction does not.
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from identification.model.parameter import ParameterSet
from inca_mj.robot.geometry import DRIVES, INCA, Geometry
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import EACH_DRIVE, at_drives, displaced
from inca_mj.twin.appearance import MOTOR, PLAIN, PLAIN_NOTE, SHORT_PLAIN_NOTE, filled
from inca_mj.twin.mjcf import add_cable, add_platform, add_pose_sensors, empty_model, weigh
from inca_mj.twin.statics import Start, start

IMPEDANCE = 1e-4  # δ, the least that MuJoCo admits: the inertia errs by as much
SPOOL = 1.0  # length of the wound part of a tendon at the start [m]; no motor turns so far back


def build_plain(parameters: ParameterSet | None = None, geometry: Geometry = INCA) -> mujoco.MjSpec:
    """Returns the linearised robot at rest, as an editable `MjSpec` that needs MuJoCo only.

    Args:
        parameters: the values; the thesis' Table 3.2 when None.
        geometry: anchors of the cables; assumed ones by default.

    Raises:
        InputError: the start pose admits no pretension.
    """
    parameters = parameters or parameter_set()
    begin = start(parameters, geometry)
    spec = empty_model(PLAIN, filled(PLAIN_NOTE, parameters, geometry), SHORT_PLAIN_NOTE, geometry)
    values = parameters.values()
    add_platform(spec, values, geometry, displaced(geometry, values).connectors)
    for k in range(1, DRIVES + 1):
        _drive(spec, k, parameters, geometry, begin)
    _sensors(spec)
    return spec


def _drive(
    spec: mujoco.MjSpec, k: int, parameters: ParameterSet, geometry: Geometry, begin: Start
) -> None:
    """Adds motor k as a slide joint along a post of the frame, and its cable."""
    p = parameters.values()
    numbers = {name: float(at_drives(name, p)[k - 1]) for name in EACH_DRIVE}
    R, T_0 = numbers["R"], float(begin.tension[k - 1])
    placed = np.array(displaced(geometry, p).exits[k - 1])
    cable = add_cable(spec, k, placed)
    up = 1.0 if placed[2] < geometry.A[:, 2].mean() else -1.0  # the wound part lies along the post
    away = np.array([0.0, 0.0, up])
    spec.worldbody.add_site(name=f"end_{k}", pos=placed, size=[0.004, 0.004, 0.004])

    spool = spec.worldbody.add_body(name=f"spool_{k}", pos=placed + SPOOL * away)
    # MuJoCo scales a friction by the mass of the body and leaves the armature out, so J is a mass.
    weigh(spool, numbers["J"] / R**2, [numbers["J"]] * 3)
    spool.gravcomp = 1.0  # the inertia of a motor has no weight
    spool.add_site(name=f"spool_{k}", pos=[0, 0, 0], size=[0.004, 0.004, 0.004])
    spool.add_geom(
        type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.03, 0.03, 0.05], rgba=MOTOR, contype=0,
        conaffinity=0, mass=0,
    )  # fmt: skip
    k_spring = numbers["k_s"] * (numbers["R_s"] / R) ** 2  # of the drum spring, at the roller [N/m]
    joint: dict[str, Any] = {}
    if k_spring:
        joint = {"stiffness": [k_spring, 0, 0], "springref": T_0 / k_spring}
    spool.add_joint(
        name=f"spool_{k}",
        type=mujoco.mjtJoint.mjJNT_SLIDE,
        axis=away,
        damping=[numbers["b_v"] / R**2, 0, 0],
        frictionloss=numbers["b_c"] / R,
        solref_friction=[0.0, -numbers["b_c"] * numbers["beta"] / numbers["J"]],
        solimp_friction=[IMPEDANCE, IMPEDANCE, 1.0, 0.5, 1.0],
        **joint,
    )

    d_0 = float(begin.no_load_length[k - 1])
    k_cable = numbers["lambda"] / d_0
    length = d_0 * (1 + begin.strain[k - 1]) + SPOOL
    cable.wrap_pulley(1.0)
    cable.wrap_site(f"end_{k}")
    cable.wrap_site(f"spool_{k}")
    cable.stiffness, cable.damping = [k_cable, 0, 0], [numbers["b"], 0, 0]
    cable.springlength = [0.0, length - T_0 / k_cable]  # between them no force: it does not push
    spec.add_tendon(name=f"motor_{k}").wrap_joint(f"spool_{k}", 1 / R)
    spec.add_actuator(
        name=f"current_{k}",
        target=f"spool_{k}",
        trntype=mujoco.mjtTrn.mjTRN_JOINT,
        gear=[numbers["K_t"] / R, 0, 0, 0, 0, 0],
    )


def _sensors(spec: mujoco.MjSpec) -> None:
    sensor, of = mujoco.mjtSensor, mujoco.mjtObj
    kinds = (("angle", sensor.mjSENS_TENDONPOS), ("rate", sensor.mjSENS_TENDONVEL))
    for name, kind in kinds:
        for k in range(1, DRIVES + 1):
            spec.add_sensor(
                name=f"{name}_{k}", type=kind, objtype=of.mjOBJ_TENDON, objname=f"motor_{k}"
            )
    add_pose_sensors(spec)
