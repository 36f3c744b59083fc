"""The parameters of the INCA 6D: what the thesis says of each, and where it goes in the model.

Two sets: `simulation` is Table 2.1, `trial` is Table 3.2. Both share R, R_s, k_s, the frictions
b_c and beta, and the platform; they differ in lambda, b, J, b_v and K_t.

Columns of `user` data (see `inca_mj.robot.law`): a drive keeps its numbers in the `actuator_user`
row of its current actuator, a cable in the `tendon_user` row of its tendon.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite, pi

from identification.errors import InputError, unknown_name
from identification.model.parameter import Parameter, ParameterSet

GRAVITY = 9.81  # [m/s^2]
PRETENSION = 4.0  # t_0, the tension that the start pretension stays nearest to [N]
TIMESTEP = 1e-3  # [s]; RK4 at 1 ms follows the reference to a few microradians
POSE = ("x", "y", "z", "roll", "pitch", "yaw")

_DRIVE = "actuator/current_*."
_CABLE = "tendon/cable_*."
_MOTOR = "joint/motor_*."

_SIMULATION = ParameterSet(
    "simulation",
    (
        Parameter(name="R", value=0.0175, unit="m", where=_DRIVE + "user[1]",
                  lower=1e-3, upper=0.1,
                  about="roller radius: cable side", source="Table 2.1, datasheet"),
        Parameter(name="R_s", value=0.006, unit="m", where=_DRIVE + "user[2]",
                  lower=1e-4, upper=0.1,
                  about="spring drum radius: spring side", source="Table 2.1, datasheet"),
        Parameter(name="k_s", value=16.0, unit="N/m", where=_DRIVE + "user[3]",
                  lower=0.0, upper=1e4,
                  about="drum spring constant", source="Table 2.1, measured"),
        Parameter(name="lambda", value=32224.0, unit="N", where=_CABLE + "user[1]",
                  lower=1e2, upper=1e7, symbol="λ",
                  about="cable elasticity: elastic modulus, E S", source="Table 2.1, measured"),
        Parameter(name="b", value=10.0, unit="N s/m", where=_CABLE + "user[2]",
                  lower=0.0, upper=1e4,
                  about="cable damping", source="Table 2.1, arbitrary"),
        Parameter(name="J", value=3.0563e-5, unit="kg m^2", where=_MOTOR + "armature",
                  lower=1e-7, upper=1e-2,
                  about="motor inertia: of motor, rollers and cable", source="Table 2.1, computed"),
        Parameter(name="b_v", value=3e-4, unit="N m s/rad", where=_MOTOR + "damping",
                  lower=0.0, upper=1.0,
                  about="viscous friction: of the motor", source="Table 2.1, arbitrary"),
        Parameter(name="b_c", value=0.005, unit="N m", where=_DRIVE + "user[4]",
                  lower=0.0, upper=1.0,
                  about="Coulomb friction: of the motor", source="Table 2.1, arbitrary"),
        Parameter(name="beta", value=0.8, unit="s/rad", where=_DRIVE + "user[5]",
                  lower=1e-3, upper=1e3, symbol="β",
                  about="friction smoothness: of Coulomb friction", source="Table 2.1, arbitrary"),
        Parameter(name="K_t", value=0.0603, unit="N m/A", where=_DRIVE + "gear[0]",
                  lower=1e-4, upper=10.0,
                  about="torque constant: of the motor", source="Table 2.1, datasheet"),
        Parameter(name="m", value=0.1725, unit="kg", where="body/platform.mass",
                  lower=1e-3, upper=100.0,
                  about="platform mass", source="Table 2.1, datasheet"),
        Parameter(name="I_x", value=0.8e-4, unit="kg m^2", where="body/platform.inertia[0]",
                  lower=1e-8, upper=10.0,
                  about="platform inertia: about its x", source="Table 2.1, datasheet"),
        Parameter(name="I_y", value=1.5e-4, unit="kg m^2", where="body/platform.inertia[1]",
                  lower=1e-8, upper=10.0,
                  about="platform inertia: about its y", source="Table 2.1, datasheet"),
        Parameter(name="I_z", value=1.8e-4, unit="kg m^2", where="body/platform.inertia[2]",
                  lower=1e-8, upper=10.0,
                  about="platform inertia: about its z", source="Table 2.1, datasheet"),
        Parameter(name="x", value=0.0, unit="m", where="start",
                  lower=-1.4, upper=1.4,
                  about="start position: of the platform", source="section 2.4"),
        Parameter(name="y", value=0.0, unit="m", where="start",
                  lower=-1.4, upper=1.4,
                  about="start position: of the platform", source="section 2.4"),
        Parameter(name="z", value=1.43, unit="m", where="start",
                  lower=0.15, upper=2.95,
                  about="start position: of the platform", source="section 2.4"),
        Parameter(name="roll", value=0.0, unit="rad", where="start",
                  lower=-pi / 3, upper=pi / 3, symbol="φ_p",
                  about="start roll: angle of the platform about x", source="section 2.4"),
        Parameter(name="pitch", value=0.0, unit="rad", where="start",
                  lower=-pi / 3, upper=pi / 3, symbol="θ_p",
                  about="start pitch: angle of the platform about y", source="section 2.4"),
        Parameter(name="yaw", value=0.0, unit="rad", where="start",
                  lower=-pi / 3, upper=pi / 3, symbol="ψ_p",
                  about="start yaw: angle of the platform about z", source="section 2.4"),
    ),
)  # fmt: skip
_TRIAL = {"lambda": 25000.0, "b": 8.0, "J": 8e-5, "b_v": 2e-4, "K_t": 0.08}
SETS = ("simulation", "trial")
UNKNOWN = ("lambda", "b", "J", "b_v", "b_c", "beta")  # "arbitrary" or re-estimated in the thesis


def parameter_set(name: str = "trial", values: Mapping[str, float] | None = None) -> ParameterSet:
    """Returns a named parameter set, with some values replaced.

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


def pose_values(pose: Sequence[float]) -> Mapping[str, float]:
    """Returns a pose of six finite numbers by the names of the robot's parameters."""
    try:
        numbers = [float(number) for number in pose]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != len(POSE) or not all(map(isfinite, numbers)):
        raise InputError(
            f"a pose is six finite numbers, x y z [m] roll pitch yaw [rad]; got {pose!r}"
        )
    return dict(zip(POSE, numbers, strict=True))


def refuse_step(step: float) -> None:
    """Refuses a largest step [s] with which no simulation makes sense."""
    if not 1e-6 <= step <= 0.1:
        raise InputError(f"a step of {step:g} s is not between 1e-6 and 0.1 s; try {TIMESTEP:g}")
