"""Logs of INCA as built that depart from what a search takes for granted.

    u_k = u⁰_k + K (φ⁰_k - y_k)        under control: u⁰, φ⁰ of a robot as drawn; K by chance

The robot, its effects and their sizes are those of the hidden worlds (`inca_mj.studies.worlds`) of
the same seed; noise and errors are drawn anew.
"""

from __future__ import annotations

from dataclasses import asdict, fields, replace
from typing import Any

import numpy as np
from departures import EITHER_HALF, POWERS, Departure

from identification import Log
from inca_mj.reference import layout as base
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.studies.hidden_worlds import ERROR
from inca_mj.studies.worlds import (
    AS_BUILT,
    CHANGES,
    HIDDEN_EFFECTS,
    UNLISTED,
    HiddenEffect,
    HiddenPlant,
    HiddenSetting,
    Tolerances,
    draw_effect,
    make_plant,
    records,
    simulate_world,
)
from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.integrate import STEP, advance, limited
from inca_mj.studies.worlds.sensor import simulate_angles
from inca_mj.studies.worlds.setting import true_robot

RATIOS = (5.0, 30.0)  # of what cannot be absorbed to the noise, as that of the sensors usually is
WITH_POWERS = ("stribeck_friction", "quadratic_friction", "air_drag")
GAIN = (0.1, 0.5)  # of the controller [A/rad]
WITHIN = (0.1, 1.6)  # its currents stay there [A]


def make_inca(
    departure: Departure, is_null: bool, seed: int, duration: float
) -> tuple[Log, dict[str, Any]]:
    """Returns a log, and what is true of it.

    Raises:
        InputError: no size of the effect shows enough.
        DivergenceError: the effects are so large that the robot breaks.
    """
    rng = np.random.default_rng([seed, 91])
    tolerances = Tolerances(
        **{f.name: departure.spread * getattr(AS_BUILT, f.name) for f in fields(AS_BUILT)}
    )
    setting = HiddenSetting(
        input=str(rng.choice(("prbs", "multisine"))), duration=duration, error_rms=ERROR,
        tolerances=tolerances,
    )  # fmt: skip
    count = 2 if departure.hides == "unlisted" else 1
    drawn = [] if is_null else _drawn(departure, seed, duration, rng)
    ratio = float(np.exp(rng.uniform(*np.log(RATIOS))))
    (made,) = records(
        seed, drawn[:count], n=1, ratio=ratio if drawn else None, setting=setting,
        inputs=(setting.input,), others=drawn[count:],
    )  # fmt: skip
    effects, step, u = made.truth.effects, setting.sampling_time, made.log.inputs
    rms = np.full(u.shape[1], setting.error_rms)
    plant = make_plant(true_robot(seed, setting), INCA, effects)
    std = np.full(u.shape[1], setting.noise)
    noise = departure.noise(u.shape, std, rng)
    error = departure.error(u, step, rms, setting.error_time, rng)
    if departure.is_mistuned:
        ideal = simulate_world(make_plant(parameter_set("trial"), INCA), u, step)[:, base.ANGLES]
        u = _controlled(plant, u, error, ideal, noise, rng.uniform(*GAIN), step)
    _, read = simulate_angles(plant, effects, u + error, step)
    Δ = 2 * np.pi / setting.counts
    log = replace(made.log, inputs=u, outputs=Δ * np.round((read + noise) / Δ))
    names = [] if departure.hides == "unlisted" else [e.name for e in effects]
    return log, {
        "hidden": [{"name": e.name, "where": e.where, "sizes": asdict(e)} for e in effects],
        "names": names, "ratio": ratio if drawn else 0.0,
    }  # fmt: skip


def _drawn(
    departure: Departure, seed: int, duration: float, rng: np.random.Generator
) -> list[HiddenEffect]:
    """Returns the effects of a world, sizes to be found, and those in reserve, in random order."""
    jumps = [n for n in CHANGES if n.endswith("jump")]
    of = {"unlisted": [*UNLISTED], "powers": WITH_POWERS, "jumps": jumps}
    names = rng.permutation(of.get(departure.hides, [*HIDDEN_EFFECTS]))
    drawn: list[Any] = [draw_effect(str(name), seed) for name in names]
    if departure.hides == "powers":
        return [replace(e, exponent=float(rng.uniform(*POWERS))) for e in drawn]
    if departure.hides == "jumps":
        when = round(duration * float(rng.uniform(*EITHER_HALF)), 2)
        return [replace(e, t_s=when) for e in drawn]
    return [replace(e, balanced=True) if hasattr(e, "balanced") else e for e in drawn]


def _controlled(
    plant: HiddenPlant, u: np.ndarray, error: np.ndarray, aim: np.ndarray, noise: np.ndarray,
    gain: float, step: float,
) -> np.ndarray:  # fmt: skip
    """Returns the currents of a controller that holds the angles near an aim (N, 8) [A].

    Currents arrive when `simulate_world` lets them arrive.
    """
    out, x = u.copy(), plant.start.copy()
    late = plant.P[at.DELAY]
    whole = int(late / step + 1e-9)
    rest = late - whole * step if late - whole * step > 1e-9 else 0.0
    come = np.zeros((len(u) + 1, u.shape[1]))
    now = np.zeros(u.shape[1])
    for k in range(len(u) - 1):
        seen = x[base.ANGLES] + noise[k]
        out[k] = np.clip(u[k] + gain * (aim[k] - seen), *WITHIN)
        come[k + 1] = [limited(i, D) for i, D in zip(out[k] + error[k], plant.D, strict=True)]
        if k == 0:
            now[:] = come[1]
        new = max(0, k + 1 - whole)
        if rest > 0.0:
            advance(k * step, rest, x, come[max(0, new - 1)], now, plant.q, plant.D, plant.P, STEP)
        advance(k * step + rest, step - rest, x, come[new], now, plant.q, plant.D, plant.P, STEP)
    out[-1] = out[-2]
    return out
