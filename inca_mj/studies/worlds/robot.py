"""The robot that nobody knows exactly: common values, deviations of its parts, start poses.

common value = value of the `trial` set (1 + spread u),         u uniform in ±1
start        = start of the `trial` set + offset u              by axis; angles with the tilt
parts        by the tolerances                                  `inca_mj.studies.worlds.tolerances`
"""

from __future__ import annotations

import numpy as np

from identification.model.parameter import ParameterSet
from inca_mj.robot.parameters import parameter_set
from inca_mj.studies.worlds.setting import EVERY, HiddenSetting
from inca_mj.studies.worlds.tolerances import as_built

POSITION, ANGLES = ("x", "y", "z"), ("roll", "pitch", "yaw")


def true_robot(seed: int, setting: HiddenSetting) -> ParameterSet:
    """Returns the robot of a seed, at the start of its first record.

    Raises:
        InputError: a value is out of its bounds.
    """
    rng = np.random.default_rng([seed, 1])
    nominal = parameter_set("trial")
    # Every parameter is drawn, so that what varies does not change what another seed gives.
    factor = dict(zip(EVERY, 1 + setting.spread * rng.uniform(-1, 1, len(EVERY)), strict=True))
    values = {name: factor[name] * nominal[name].value for name in setting.varied}
    values |= _start(nominal, setting.offset, setting.tilt, rng)
    return as_built(
        nominal.with_values(values), setting.tolerances, np.random.default_rng([seed, 4])
    )


def elsewhere(
    robot: ParameterSet, offset: float, tilt: float, rng: np.random.Generator
) -> ParameterSet:
    """Returns the same robot at another start, as `HiddenSetting.offset` and `tilt` say it.

    Raises:
        InputError: a value is out of its bounds.
    """
    return robot.with_values(_start(parameter_set("trial"), offset, tilt, rng))


def _start(
    nominal: ParameterSet, offset: float, tilt: float, rng: np.random.Generator
) -> dict[str, float]:
    return {
        name: nominal[name].value + largest * float(part)
        for names, largest in ((POSITION, offset), (ANGLES, tilt))
        for name, part in zip(names, rng.uniform(-1, 1, 3), strict=True)
    }
