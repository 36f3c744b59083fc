"""A world: a robot nobody knows exactly, with effects nobody named, and logs of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.model.parameter import ParameterSet
from inca_mj.robot.geometry import INCA, each_drive
from inca_mj.studies.worlds.effect import HiddenEffect
from inca_mj.studies.worlds.plant import make_plant
from inca_mj.studies.worlds.ratio import HiddenAbsorbed, UnreachedError, sized
from inca_mj.studies.worlds.sensor import coloured, encode, noise_rms, simulate_angles
from inca_mj.studies.worlds.setting import HiddenSetting, elsewhere, make_currents, true_robot


@dataclass(frozen=True, eq=False, kw_only=True)
class HiddenTruth:
    """The answer to a world."""

    effects: tuple[HiddenEffect, ...]  # what was on
    parameters: Mapping[str, float]  # every true value by name, start pose included
    noise_rms: float  # of the measurement [rad]
    angles: np.ndarray = field(repr=False)  # true angles at the samples, shape (n, 8) [rad]
    error: np.ndarray = field(repr=False)  # the unlogged error of the currents, shape (n, 8) [A]

    def __post_init__(self) -> None:
        object.__setattr__(self, "parameters", MappingProxyType(dict(self.parameters)))
        for array in (self.angles, self.error):
            array.setflags(write=False)


class HiddenWorld(NamedTuple):
    """A log, and the truth about it."""

    log: Log
    truth: HiddenTruth


INPUTS = ("prbs", "multisine", "prbs")  # of the records of one robot
FURTHER = 0.02  # later records begin up to this much farther off than the first [m]


def world(
    seed: int,
    effects: Sequence[HiddenEffect] = (),
    *,
    ratio: float | Sequence[float] | None = None,
    setting: HiddenSetting | None = None,
) -> HiddenWorld:
    """Returns a log of a robot with these effects, and the truth about it.

    One seed gives one robot, input and noise, whatever the effects are; see `records`.
    """
    setting = setting or HiddenSetting()
    (only,) = records(seed, effects, n=1, ratio=ratio, setting=setting, inputs=(setting.input,))
    return only


def records(
    seed: int,
    effects: Sequence[HiddenEffect] = (),
    *,
    n: int = 3,
    ratio: float | Sequence[float] | None = None,
    setting: HiddenSetting | None = None,
    inputs: Sequence[str] = INPUTS,
    others: Sequence[HiddenEffect] = (),
) -> tuple[HiddenWorld, ...]:
    """Returns logs of one robot with these effects, each with its own input, start and noise.

    The first is that of `world` with the first input, to the last bit.

    Args:
        seed: 0 or more.
        effects: frozen records, sizes in physical units.
        n: how many logs.
        ratio: of each effect, or one for all: sizes are changed so that the rms of what the varied
            parameters, the start pose and parts within the tolerances cannot absorb of the first
            log is `ratio` times that of the measurement noise, each effect alone; the sizes given
            are where the search starts.
        setting: of the experiment; its input does not count.
        inputs: "prbs" or "multisine" of each log, taken in turn where there are fewer.
        others: effects that take, in this order, the place of those whose ratio no size that a
            robot may have reaches.

    Raises:
        InputError: a number is bad, an effect is there twice in one place, or a ratio cannot be
            reached.
        DivergenceError: the effects are so large that the robot breaks.
    """
    setting = setting or HiddenSetting()
    places = [(e.name, e.where) for e in (*effects, *others)]
    if len(set(places)) < len(places):
        raise InputError("an effect is named twice in one place; give it once, with its size")
    if seed < 0:
        raise InputError(f"seed {seed} is negative; give 0 or more")
    if n < 1 or not inputs:
        raise InputError("give one record or more, and an input or more")
    settings = [replace(setting, input=inputs[j % len(inputs)]) for j in range(n)]
    robot = true_robot(seed, setting)
    u = make_currents(seed, settings[0])
    chosen, ratios = tuple(effects), _ratios(ratio, len(effects))
    if ratios:
        noise = noise_rms(setting.counts, setting.noise)
        absorbed = HiddenAbsorbed(
            robot, u, setting.sampling_time, setting.absorbed, setting.tolerances, noise
        )
        goals = [r * noise for r in ratios]
        chosen = _sized(effects, others, absorbed, goals)
    made = [_record(seed, (), robot, chosen, settings[0], u)]
    for j in range(1, n):
        rng = np.random.default_rng([seed, 5, j])
        moved = elsewhere(robot, setting.offset + FURTHER, setting.tilt, rng)
        u = make_currents(int(rng.integers(2**31)), settings[j])
        made.append(_record(seed, (j,), moved, chosen, settings[j], u))
    return tuple(made)


def _sized(
    effects: Sequence[HiddenEffect],
    others: Sequence[HiddenEffect],
    absorbed: HiddenAbsorbed,
    goals: Sequence[float],
) -> tuple[HiddenEffect, ...]:
    """Returns as many effects as there are goals, with the sizes that leave these [rad]."""
    chosen: list[HiddenEffect] = []
    refused: UnreachedError | None = None
    for e in (*effects, *others):
        if len(chosen) == len(goals):
            break
        try:
            chosen.append(sized(e, absorbed, goals[len(chosen)]))
        except UnreachedError as error:
            refused = refused or error
    if refused is not None and len(chosen) < len(goals):
        raise refused
    return tuple(chosen)


def _record(
    seed: int,
    number: tuple[int, ...],
    robot: ParameterSet,
    effects: tuple[HiddenEffect, ...],
    setting: HiddenSetting,
    u: np.ndarray,
) -> HiddenWorld:
    """Returns a log of a robot under the currents u; `number` is empty for the first."""
    error = coloured(
        u.shape, setting.sampling_time, setting.error_rms, setting.error_time,
        np.random.default_rng([seed, 2, *number]),
    )  # fmt: skip
    plant = make_plant(robot, INCA, effects)
    angles, read = simulate_angles(plant, effects, u + error, setting.sampling_time)
    noise = np.random.default_rng([seed, 3, *number])
    y = encode(read, setting.counts, setting.noise, noise)
    truth = HiddenTruth(
        effects=effects, parameters=robot.values(), angles=angles, error=error,
        noise_rms=noise_rms(setting.counts, setting.noise),
    )  # fmt: skip
    currents, motors = each_drive("current"), each_drive("angle")
    log = Log(
        time=setting.sampling_time * np.arange(len(u), dtype=np.float64), inputs=u, outputs=y,
        input_names=currents, output_names=motors,
        units={**dict.fromkeys(currents, "A"), **dict.fromkeys(motors, "rad")},
        name="world" if not number else f"world, record {number[0] + 1}",
    )  # fmt: skip
    return HiddenWorld(log, truth)


def _ratios(ratio: float | Sequence[float] | None, n: int) -> tuple[float, ...]:
    if ratio is None:
        return ()
    ratios = tuple(ratio) if isinstance(ratio, Sequence) else (float(ratio),) * n
    if len(ratios) != n or not all(r > 0 for r in ratios):
        raise InputError(f"give {n} positive ratios, one for each effect, got {ratio}")
    return ratios
