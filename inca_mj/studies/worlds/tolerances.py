"""The deviations from its drawing of a robot that was built.

    value at drive k = common value (1 + δ_k),      δ_k uniform in ± the half-width of the parameter
    exit point       = nominal place + e,           e ~ N(0, s²) in each coordinate
    connector        = nominal place + e            likewise, with an s of its own
    I_x, I_y, I_z, m = value (1 + δ),               δ uniform in ± the half-width, each by itself

The common value is that of `VARIED` and `HiddenSetting.spread`.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.spread import AXES, EACH_DRIVE, POINTS, with_spread

INERTIAS = ("I_x", "I_y", "I_z")
_FIELDS = {"lambda": "lambda_"}  # a word of Python's own cannot be a field


@dataclass(frozen=True, kw_only=True)
class Tolerances:
    """Differences of drives, points and platform of a robot from what they should be.

    Raises:
        InputError: a number is negative, or not less than 1 (0.1 m for points).
    """

    # Of drives, up to K_t: largest relative deviation of the parameter from the common value.
    R: float = 0.0
    R_s: float = 0.0
    k_s: float = 0.0
    lambda_: float = 0.0
    b: float = 0.0
    J: float = 0.0
    b_v: float = 0.0
    b_c: float = 0.0
    beta: float = 0.0
    K_t: float = 0.0
    exit: float = 0.0  # std of each coordinate of an exit point [m]
    connector: float = 0.0  # std of each coordinate of a connector [m]
    inertia: float = 0.0  # largest relative deviation of each inertia of the platform
    m: float = 0.0  # largest relative deviation of its mass

    def __post_init__(self) -> None:
        for field in fields(self):
            most = 0.1 if field.name in POINTS else 1.0
            if not 0 <= getattr(self, field.name) < most:
                raise InputError(
                    f"tolerances: {field.name} = {getattr(self, field.name)} must be 0 or more, and"
                    f" less than {most:g}"
                )

    @property
    def drives(self) -> dict[str, float]:
        """Largest relative deviation of a drive, by the name of each parameter."""
        return {name: getattr(self, _FIELDS.get(name, name)) for name in EACH_DRIVE}

    @property
    def points(self) -> dict[str, float]:
        """Std of each coordinate [m], by kind of point."""
        return {point: getattr(self, point) for point in POINTS}


def usual_std(parameters: ParameterSet, tolerances: Tolerances) -> dict[str, float]:
    """Returns the std of each parameter that tolerances move, by name; empty for `EXACT`.

    A uniform deviation has the half-width over √3 as its std; inertias and mass have it times their
    value.
    """
    of_drives = {name: largest / np.sqrt(3) for name, largest in tolerances.drives.items()}
    of_points = {f"{p}_{axis}": std for p, std in tolerances.points.items() for axis in AXES}
    out = {
        f"{name}@{k}": std
        for name, std in {**of_drives, **of_points}.items()
        for k in range(1, DRIVES + 1)
    }
    for name in (*INERTIAS, "m"):
        largest = tolerances.inertia if name in INERTIAS else tolerances.m
        out[name] = largest * parameters[name].value / np.sqrt(3)
    return {name: float(std) for name, std in out.items() if std > 0}


EXACT = Tolerances()  # all drives alike, all points where the drawing has them
AS_BUILT = Tolerances(
    R=0.005, R_s=0.01, k_s=0.03, lambda_=0.05, b=0.2, J=0.05, b_v=0.15, b_c=0.15, K_t=0.02,
    exit=0.003, connector=0.0005, inertia=0.1, m=0.02,
)  # fmt: skip


def as_built(
    parameters: ParameterSet, tolerances: Tolerances, rng: np.random.Generator
) -> ParameterSet:
    """Returns a robot within its tolerances; the same parameters where these are `EXACT`.

    Everything is drawn, so that no tolerance changes what another one gives.

    Raises:
        InputError: a point is farther from its place than a displacement may be.
    """
    if tolerances == EXACT:
        return parameters
    values = {}
    for name, largest in tolerances.drives.items():
        for k, part in enumerate(rng.uniform(-1, 1, DRIVES), 1):
            values[f"{name}@{k}"] = largest * float(part)
    for point, std in tolerances.points.items():
        for k, row in enumerate(rng.normal(size=(DRIVES, len(AXES))), 1):
            for axis, part in zip(AXES, row, strict=True):
                values[f"{point}_{axis}@{k}"] = std * float(part)
    for name in (*INERTIAS, "m"):
        largest = tolerances.inertia if name in INERTIAS else tolerances.m
        values[name] = parameters[name].value * (1 + largest * float(rng.uniform(-1, 1)))
    return with_spread(parameters).with_values(values)
