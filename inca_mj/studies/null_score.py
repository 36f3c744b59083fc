"""Null worlds by score: how often a name is found where nothing is missing.

The nominal model is fitted once to a log of a robot that lacks nothing, and the sensitivities of
all candidates are computed once. Each task is then another draw of the noise: a simulation of that
model, its inputs in error where so asked, seen through encoders. Scores are without refits and
proof, which can only lower the rate. A worker keeps the fit of the last robot, so a sweep names
the robots first in its grid and has as many draws of each as `count` says.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from identification.errors import refuse_negative
from identification.report.page.page import Section, Table
from identification.shares import percent
from identification.sweep.method import Column, Findings, Method, Record, Seed
from identification.sweep.settings import file_setting, setting
from identification.sweep.statistics import said, wilson
from inca_mj.studies.hidden_worlds import ERROR, SPREAD
from inca_mj.studies.scores import fit_nominal, named
from inca_mj.studies.worlds import AS_BUILT, EXACT, HiddenSetting, world
from inca_mj.studies.worlds.sensor import coloured as wander
from inca_mj.studies.worlds.sensor import encode
from inca_mj.workflows.spread import WORDS

LEVEL = 0.05  # of p-values that are counted
TIME = 0.05  # time constant of the error of the currents [s]


@dataclass(frozen=True, kw_only=True)
class NullSettings:
    """A robot in which nothing is missing, and how it is measured; its fields say what they are.

    Raises:
        InputError: a number is out of its range.
    """

    robot: int = setting("number of the robot, 0 or more")
    coloured: bool = setting("whether the currents err, unlogged", False)
    duration: float = setting("length of the log, of which the first half is fitted [s]", 20.0)
    as_built: bool = setting("whether drives and points differ as those of real robots do", False)
    spread: str = file_setting(SPREAD, "none", words=WORDS)

    def __post_init__(self) -> None:
        refuse_negative("robot", self.robot)
        HiddenSetting(duration=self.duration)


def null_score(settings: NullSettings, seed: Seed) -> dict[str, Any]:
    """Score all candidates on one draw of the noise.

    Raises:
        DivergenceError: a simulation left the finite numbers.
    """
    from identification.discovery.options import DiscoveryOptions
    from identification.innovations.scoring.scores import score
    from identification.kalman.noise_fit import fit_noise

    options = DiscoveryOptions()
    fit, sensitivities = _fitted(replace(settings, coloured=False))
    point, setting = fit.point, _setting(settings)
    e = _residual(point, setting, settings.coloured, seed.generator())
    drawn = replace(point, e=e)
    level = fit_noise(point.linear, e, point.J, fit.priors.weight, point.log.sampling_time)
    refit = replace(fit, point=drawn, level=level, priors=replace(fit.priors, mean=point.q))
    scores = score(refit, sensitivities, options)
    names = named(scores)
    p = np.array([s.p_value for s in scores])
    return {
        "false_name": bool(names), "names": names, "candidates": len(scores),
        "smallest_p": float(p.min()), "below_5_percent": float(np.mean(p < LEVEL)),
        "noise_ratio": float(level.noise.ratio), "sigma": float(level.sigma),
        "disturbance": float(np.sqrt(max(0.0, np.mean(e**2) - level.sigma**2))),
    }  # fmt: skip


def _setting(settings: NullSettings) -> HiddenSetting:
    return HiddenSetting(
        duration=settings.duration, tolerances=AS_BUILT if settings.as_built else EXACT
    )


@lru_cache(maxsize=1)  # the sensitivities of all candidates are hundreds of megabytes
def _fitted(settings: NullSettings) -> tuple[Any, Any]:
    """Returns the fit of a robot and sensitivities of all candidates, the same in every worker."""
    log = world(settings.robot, setting=_setting(settings)).log
    fit, sensitivities, _ = fit_nominal(log, settings.spread, settled=False)
    return fit, sensitivities


def _residual(
    point: Any, setting: HiddenSetting, coloured: bool, rng: np.random.Generator
) -> np.ndarray:
    """Returns measured less predicted angles of a model that lacks nothing, shape (N, ny) [rad]."""
    from identification.model.predictor import output_columns
    from identification.model.rollout import rollout

    log = point.log
    y = log.outputs - point.e
    clean = y
    if coloured:
        model = point.predictor.plant.model
        start, numbers = point.predictor.settings(point.space.decode(point.q)[None])
        error = wander(log.inputs.shape, log.sampling_time, ERROR, TIME, rng)
        run = rollout(model, start, (log.inputs + error)[None], log.sampling_time, numbers=numbers,
                      record=("qpos",), hold_kind=log.hold)["qpos"]  # fmt: skip
        clean = run[0][:, [i for _, i in output_columns(model, log.output_names)]]
    return encode(clean, setting.counts, setting.noise, rng) - y


def null_findings(records: Sequence[Record]) -> Findings:
    """Returns the rate of false names, with and without an error of the currents, and the names."""
    found, rows = {}, []
    for coloured in sorted({r["set.coloured"] for r in records}):
        chosen = [r for r in records if r["set.coloured"] is coloured]
        false = wilson(sum(r["false_name"] for r in chosen), len(chosen))
        below = float(np.mean([r["below_5_percent"] for r in chosen]))
        names = Counter(name for r in chosen for name in r["names"])
        words = "and an unlogged error of the currents" if coloured else "encoders only"
        found["coloured" if coloured else "white"] = {
            "a_false_name": false, "below_5_percent": below, "names": dict(names.most_common()),
        }  # fmt: skip
        rows.append((words, said(false), percent(below, 2),
                     ", ".join(f"{n} ({k})" for n, k in names.most_common(8))))  # fmt: skip
    head = ("noise", "a false name", "scores below p = 5 %", "names")
    sentences = [f"{row[0]}: a false name in {row[1]}." for row in rows]
    return Findings(found, [Section("false names", table=Table(head, tuple(rows)))], sentences)


NULL_SCORE = Method(
    about="scores all candidates where nothing is missing, on a draw of the noise",
    settings=NullSettings,
    columns={
        "false_name": Column(bool, "a candidate is beyond chance and plausible"),
        "names": Column(list[str], "those that are, as effect, place"),
        "candidates": Column(int, "how many were scored"),
        "smallest_p": Column(float, "the smallest p-value"),
        "below_5_percent": Column(float, "share of p-values below 5 %"),
        "noise_ratio": Column(float, "of the noise model: input error over sensors' noise"),
        "sigma": Column(float, "noise of the sensors by the noise model [rad]"),
        "disturbance": Column(float, "what else the residual has [rad]"),
    },
    run=null_score,
    summary=null_findings,
)
