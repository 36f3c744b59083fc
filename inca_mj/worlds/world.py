"""A world: a robot nobody knows exactly, with effects nobody named, and a log of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError, unknown_name
from identification.logs.log import Log
from identification.model.parameter import ParameterSet
from inca_mj.reference import layout as base
from inca_mj.robot.geometry import DRIVES, INCA, Geometry
from inca_mj.robot.inputs import multisine, prbs
from inca_mj.robot.parameters import parameter_set
from inca_mj.worlds.effect import HiddenEffect
from inca_mj.worlds.measure import coloured, encode, noise_rms
from inca_mj.worlds.plant import make_plant, simulate_world
from inca_mj.worlds.ratio import HiddenAbsorbed, sized
from inca_mj.worlds.truth import HiddenTruth, HiddenWorld

VARIED = ("lambda", "b", "J", "b_v", "b_c", "K_t")  # what a user would estimate
EVERY = ("R", "R_s", "k_s", *VARIED, "beta", "m", "I_x", "I_y", "I_z")

_INPUTS = {"prbs": prbs, "multisine": multisine}


@dataclass(frozen=True, kw_only=True)
class HiddenSetting:
    """How a world is made and measured.

    Attributes:
        input: "prbs" or "multisine".
        low: smallest current [A].
        high: largest current [A].
        duration: of the log [s]; its samples are those of [0, duration).
        sampling_time: [s].
        varied: parameters that differ from the `trial` set, uniformly within ± `spread`.
        spread: relative.
        offset: largest error of the start position, by axis [m].
        tilt: largest error of the start angles, by axis [rad].
        counts: of an encoder a turn; 0 for one without steps.
        noise: white, before the encoder rounds [rad].
        error_rms: of the unlogged coloured error of the currents [A].
        error_time: its time constant [s]; 0 for white.

    Raises:
        InputError: the input is unknown, or a number is out of its range.
    """

    input: str = "prbs"
    low: float = 0.5
    high: float = 1.0
    duration: float = 20.0
    sampling_time: float = 0.01
    varied: tuple[str, ...] = VARIED
    spread: float = 0.1
    offset: float = 0.01
    tilt: float = 0.0
    counts: int = 4000
    noise: float = 5e-4
    error_rms: float = 0.0
    error_time: float = 0.05

    def __post_init__(self) -> None:
        if self.input not in _INPUTS:
            raise unknown_name("input", self.input, _INPUTS)
        for name in ("spread", "offset", "tilt", "counts", "noise", "error_rms", "error_time"):
            if not getattr(self, name) >= 0:
                raise InputError(f"setting: {name} must not be negative")
        if not (0 < 2 * self.sampling_time <= self.duration and self.low <= self.high):
            raise InputError("setting: give two samples or more, and low no more than high")

    @property
    def samples(self) -> int:
        """Number of samples."""
        return round(self.duration / self.sampling_time)


def make_currents(seed: int, setting: HiddenSetting) -> np.ndarray:
    """The commanded currents of a world, shape (n, 8) [A]."""
    n, T_s, low, high = setting.samples, setting.sampling_time, setting.low, setting.high
    if setting.input == "prbs":
        return prbs(n, T_s, seed=seed, low=low, high=high)
    return multisine(n, T_s, seed=seed, mean=(low + high) / 2, amplitude=(high - low) / 2)


def world(
    seed: int,
    effects: Sequence[HiddenEffect] = (),
    *,
    ratio: float | Sequence[float] | None = None,
    setting: HiddenSetting | None = None,
    geometry: Geometry = INCA,
) -> HiddenWorld:
    """A log of a robot with these effects, and the truth about it.

    One seed gives one robot, input and noise, whatever the effects are.

    Args:
        seed: 0 or more.
        effects: frozen records, sizes in physical units.
        ratio: of each effect, or one for all: sizes are changed so that the rms of what the varied
            parameters and the start pose cannot absorb is `ratio` times that of the measurement
            noise, each effect alone; the sizes given are where the search starts.
        setting: of the experiment.
        geometry: nominal exit points and connectors.

    Raises:
        InputError: a number is bad, an effect is there twice in one place, or a ratio cannot be
            reached.
        DivergenceError: the effects are so large that the robot breaks.
    """
    setting = setting or HiddenSetting()
    places = [(e.name, e.where) for e in effects]
    if len(set(places)) < len(places):
        raise InputError("an effect is named twice in one place; give it once, with its size")
    if seed < 0:
        raise InputError(f"seed {seed} is negative; give 0 or more")
    draws = np.random.default_rng([seed, 1])
    robot = _true_robot(draws, setting)
    u = make_currents(seed, setting)
    noise = noise_rms(setting.counts, setting.noise)
    chosen, ratios = tuple(effects), _ratios(ratio, len(effects))
    if ratios:
        absorbed = HiddenAbsorbed(robot, geometry, u, setting.sampling_time, setting.varied)
        chosen = tuple(sized(e, absorbed, r * noise) for e, r in zip(chosen, ratios, strict=True))
    error = coloured(
        u.shape, setting.sampling_time, setting.error_rms, setting.error_time,
        np.random.default_rng([seed, 2]),
    )  # fmt: skip
    plant = make_plant(robot, geometry, chosen)
    angles = simulate_world(plant, u + error, setting.sampling_time)[:, base.ANGLES].copy()
    y = encode(angles, setting.counts, setting.noise, np.random.default_rng([seed, 3]))
    truth = HiddenTruth(
        seed=seed,
        effects=chosen,
        ratios=ratios,
        parameters=robot.values(),
        noise_rms=noise,
        error_rms=setting.error_rms,
        angles=angles,
        error=error,
    )
    return HiddenWorld(_log(u, y, setting), truth)


def _true_robot(rng: np.random.Generator, setting: HiddenSetting) -> ParameterSet:
    nominal = parameter_set("trial")
    # Every parameter is drawn, so that what varies does not change what another seed gives.
    factor = dict(zip(EVERY, 1 + setting.spread * rng.uniform(-1, 1, len(EVERY)), strict=True))
    values = {name: factor[name] * nominal[name].value for name in setting.varied}
    for names, largest in (
        (("x", "y", "z"), setting.offset),
        (("roll", "pitch", "yaw"), setting.tilt),
    ):
        for name, part in zip(names, rng.uniform(-1, 1, 3), strict=True):
            values[name] = nominal[name].value + largest * float(part)
    return nominal.with_values(values)


def _ratios(ratio: float | Sequence[float] | None, n: int) -> tuple[float, ...]:
    if ratio is None:
        return ()
    ratios = tuple(ratio) if isinstance(ratio, Sequence) else (float(ratio),) * n
    if len(ratios) != n or not all(r > 0 for r in ratios):
        raise InputError(f"give {n} positive ratios, one for each effect, got {ratio}")
    return ratios


def _log(u: np.ndarray, y: np.ndarray, setting: HiddenSetting) -> Log:
    names = [tuple(f"{kind}_{k}" for k in range(1, DRIVES + 1)) for kind in ("current", "angle")]
    units = {**dict.fromkeys(names[0], "A"), **dict.fromkeys(names[1], "rad")}
    time = setting.sampling_time * np.arange(len(u), dtype=np.float64)
    return Log(
        time=time,
        inputs=u,
        outputs=y,
        input_names=names[0],
        output_names=names[1],
        units=units,
        name="world",
    )
