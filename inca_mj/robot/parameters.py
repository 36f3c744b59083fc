"""The parameters of the INCA 6D: what the thesis says of each, and where it goes in the model.

Two sets: `simulation` is Table 2.1, `trial` is Table 3.2. Both share R, R_s, k_s, the frictions
b_c and beta, and the handle; they differ in lambda, b, J, b_v and K_t.

Columns of `user` data (see `inca_mj.robot.law`): a drive keeps its numbers in the `actuator_user`
row of its current actuator, a cable in the `tendon_user` row of its tendon.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import pi

from identification.errors import unknown_name
from identification.model.parameter import Parameter, ParameterSet

GRAVITY = 9.81  # [m/s^2]
PRETENSION = 4.0  # t_0, the tension that the start pretension stays nearest to [N]

_DRIVE = "actuator/current_*."
_CABLE = "tendon/cable_*."
_MOTOR = "joint/motor_*."

_SIMULATION = ParameterSet(
    "simulation",
    (
        Parameter("R", 0.0175, "m", _DRIVE + "user[1]", 1e-3, 0.1,
                  about="roller radius, cable side", source="Table 2.1, datasheet"),
        Parameter("R_s", 0.006, "m", _DRIVE + "user[2]", 1e-4, 0.1,
                  about="drum radius, spring side", source="Table 2.1, datasheet"),
        Parameter("k_s", 16.0, "N/m", _DRIVE + "user[3]", 0.0, 1e4,
                  about="constant of the drum spring", source="Table 2.1, measured"),
        Parameter("lambda", 32224.0, "N", _CABLE + "user[1]", 1e2, 1e7, "λ",
                  about="elastic modulus of the cable, E S", source="Table 2.1, measured"),
        Parameter("b", 10.0, "N s/m", _CABLE + "user[2]", 0.0, 1e4,
                  about="damping of the cable", source="Table 2.1, arbitrary"),
        Parameter("J", 3.0563e-5, "kg m^2", _MOTOR + "armature", 1e-7, 1e-2,
                  about="inertia of motor, rollers and cable", source="Table 2.1, computed"),
        Parameter("b_v", 3e-4, "N m s/rad", _MOTOR + "damping", 0.0, 1.0,
                  about="viscous friction of the motor", source="Table 2.1, arbitrary"),
        Parameter("b_c", 0.005, "N m", _DRIVE + "user[4]", 0.0, 1.0,
                  about="Coulomb friction of the motor", source="Table 2.1, arbitrary"),
        Parameter("beta", 0.8, "s/rad", _DRIVE + "user[5]", 1e-3, 1e3, "β",
                  about="smoothness of the Coulomb friction", source="Table 2.1, arbitrary"),
        Parameter("K_t", 0.0603, "N m/A", _DRIVE + "gear[0]", 1e-4, 10.0,
                  about="torque constant of the motor", source="Table 2.1, datasheet"),
        Parameter("m", 0.1725, "kg", "body/platform.mass", 1e-3, 100.0,
                  about="mass of the platform", source="Table 2.1, datasheet"),
        Parameter("I_x", 0.8e-4, "kg m^2", "body/platform.inertia[0]", 1e-8, 10.0,
                  about="inertia of the platform about its x", source="Table 2.1, datasheet"),
        Parameter("I_y", 1.5e-4, "kg m^2", "body/platform.inertia[1]", 1e-8, 10.0,
                  about="inertia of the platform about its y", source="Table 2.1, datasheet"),
        Parameter("I_z", 1.8e-4, "kg m^2", "body/platform.inertia[2]", 1e-8, 10.0,
                  about="inertia of the platform about its z", source="Table 2.1, datasheet"),
        Parameter("x", 0.0, "m", "start", -1.4, 1.4,
                  about="start position of the platform", source="section 2.4"),
        Parameter("y", 0.0, "m", "start", -1.4, 1.4,
                  about="start position of the platform", source="section 2.4"),
        Parameter("z", 1.43, "m", "start", 0.15, 2.95,
                  about="start position of the platform", source="section 2.4"),
        Parameter("roll", 0.0, "rad", "start", -pi / 3, pi / 3, "φ_p",
                  about="start angle of the platform about x", source="section 2.4"),
        Parameter("pitch", 0.0, "rad", "start", -pi / 3, pi / 3, "θ_p",
                  about="start angle of the platform about y", source="section 2.4"),
        Parameter("yaw", 0.0, "rad", "start", -pi / 3, pi / 3, "ψ_p",
                  about="start angle of the platform about z", source="section 2.4"),
    ),
)  # fmt: skip

_TRIAL = {"lambda": 25000.0, "b": 8.0, "J": 8e-5, "b_v": 2e-4, "K_t": 0.08}

SETS = ("simulation", "trial")


def parameter_set(name: str = "trial", values: Mapping[str, float] | None = None) -> ParameterSet:
    """A named parameter set, with some values replaced.

    Args:
        name: "simulation" (thesis Table 2.1) or "trial" (thesis Table 3.2).
        values: new values by parameter name, in each parameter's unit.

    Raises:
        InputError: the set or a parameter is unknown, or a value is outside its bounds.
    """
    if name not in SETS:
        raise unknown_name("parameter set", name, SETS)
    chosen = _SIMULATION if name == "simulation" else _trial()
    return chosen.with_values(values or {})


def _trial() -> ParameterSet:
    records = (
        replace(p, value=_TRIAL.get(p.name, p.value),
                source=p.source.replace("Table 2.1", "Table 3.2").split(",")[0])
        for p in _SIMULATION
    )  # fmt: skip
    return ParameterSet("trial", tuple(records))
