"""How a world is made and measured: its robot, which nobody knows exactly, and its currents.

common value = value of the `trial` set (1 + spread u),         u uniform in ±1
start        = start of the `trial` set + offset u              by axis; angles with the tilt
parts        by the tolerances                                  `inca_mj.studies.worlds.tolerances`
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from identification.errors import refuse_number, unknown_name
from identification.model.parameter import ParameterSet
from inca_mj.robot.inputs import multisine, prbs
from inca_mj.robot.parameters import parameter_set
from inca_mj.studies.worlds.tolerances import EXACT, Tolerances, as_built

POSITION, ANGLES = ("x", "y", "z"), ("roll", "pitch", "yaw")


def true_robot(seed: int, setting: HiddenSetting) -> ParameterSet:
    """Returns the robot of a seed, at the start of its first record."""
    rng = np.random.default_rng([seed, 1])
    nominal = parameter_set("trial")
    # Every parameter is drawn, so that what varies does not change what another seed gives.
    factor = dict(zip(EVERY, 1 + setting.spread * rng.uniform(-1, 1, len(EVERY)), strict=True))
    values = {name: factor[name] * nominal[name].value for name in VARIED}
    values |= _start(nominal, setting.offset, setting.tilt, rng)
    robot = nominal.with_values(values)
    return as_built(robot, setting.tolerances, np.random.default_rng([seed, 4]))


def elsewhere(
    robot: ParameterSet, offset: float, tilt: float, rng: np.random.Generator
) -> ParameterSet:
    """Returns the same robot at another start, as `HiddenSetting.offset` and `tilt` say it."""
    return robot.with_values(_start(parameter_set("trial"), offset, tilt, rng))


def _start(
    nominal: ParameterSet, offset: float, tilt: float, rng: np.random.Generator
) -> dict[str, float]:
    return {
        name: nominal[name].value + largest * float(part)
        for names, largest in ((POSITION, offset), (ANGLES, tilt))
        for name, part in zip(names, rng.uniform(-1, 1, 3), strict=True)
    }


VARIED = ("lambda", "b", "J", "b_v", "b_c", "K_t")  # what a user would estimate
EVERY = ("R", "R_s", "k_s", *VARIED, "beta", "m", "I_x", "I_y", "I_z")

_INPUTS = ("prbs", "multisine")


@dataclass(frozen=True, kw_only=True)
class HiddenSetting:
    """The making and the measuring of a world.

    Raises:
        InputError: the input is unknown, or a number is out of its range.
    """

    input: str = "prbs"  # "prbs" or "multisine"
    duration: float = 20.0  # of the log [s]; its samples are those of [0, duration)
    sampling_time: float = 0.01  # [s]
    spread: float = 0.1  # the `VARIED` lie within ± this of the `trial` set, relative
    offset: float = 0.01  # largest error of the start position, by axis [m]
    tilt: float = 0.0  # largest error of the start angles, by axis [rad]
    counts: int = 4000  # of an encoder a turn; 0 for one without steps
    noise: float = 5e-4  # white, before the encoder rounds [rad]
    error_rms: float = 0.0  # of the unlogged coloured error of the currents [A]
    error_time: float = 0.05  # its time constant [s]; 0 for white
    # how much its drives, points and platform differ from the common values; they do not by
    # default, and `AS_BUILT` is a usual robot
    tolerances: Tolerances = EXACT

    def __post_init__(self) -> None:
        if self.input not in _INPUTS:
            raise unknown_name("input", self.input, _INPUTS)
        for name in ("spread", "offset", "tilt", "counts", "noise", "error_rms", "error_time"):
            value = getattr(self, name)
            refuse_number(name, value, 0 <= value < inf, "0 or more")
        T_s, least = self.sampling_time, 2 * self.sampling_time
        refuse_number("sampling_time", T_s, 0 < T_s < inf, "a time above 0 [s]")
        is_long = least <= self.duration < inf
        refuse_number("duration", self.duration, is_long, f"two samples, {least:g} s, or more")

    @property
    def absorbed(self) -> tuple[str, ...]:
        """Parameters whose common value a model may tune as it likes, when sizes are chosen.

        Of a robot whose drives differ nobody knows the common radius, spring or slope at rest
        either: a hysteresis of the drum springs is mostly a friction and a stiffness.
        """
        free = () if self.tolerances == EXACT else ("R", "k_s", "beta")
        return (*VARIED, *free)

    @property
    def samples(self) -> int:
        """Number of samples."""
        return round(self.duration / self.sampling_time)


def make_currents(seed: int, setting: HiddenSetting) -> np.ndarray:
    """Returns the commanded currents of a world, shape (n, 8) [A]."""
    draw = prbs if setting.input == "prbs" else multisine
    return draw(setting.samples, setting.sampling_time, seed=seed)
