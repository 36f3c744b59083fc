"""How often a name is found where nothing is missing, under many draws of the noise."""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from typing import Any

from discovery_statistics import rate


def null_robot(seed: int, draws: int, coloured: bool, duration: float) -> list[dict[str, Any]]:
    """Scores of one robot in which nothing is missing, under many draws of its noise.

    The nominal model is fitted once, to a log of it, and the columns are taken once; each draw is a
    simulation of that model, its inputs in error where so asked, seen through an encoder's noise.
    """
    import numpy as np
    from threadpoolctl import threadpool_limits

    from identification.discovery.nominal_model import NominalModel, fit_with_effects
    from identification.discovery.options import DiscoveryOptions
    from identification.discovery.scoring.scores import score
    from identification.discovery.scoring.sensitivities import (
        compute_sensitivities,
        list_common,
        list_single,
    )
    from identification.discovery.scoring.significance import select_significant
    from identification.kalman.noise_fit import fit_noise
    from inca_mj.effects.catalogue import CATALOGUE
    from inca_mj.twin.twin import build_twin
    from inca_mj.workflows.comparison import timestep_for
    from inca_mj.workflows.discovery import KNOWN, TIMESTEP
    from inca_mj.worlds import HiddenSetting, world

    begin = time.perf_counter()
    whole = world(seed, setting=HiddenSetting(duration=duration)).log
    plant = build_twin(timestep=timestep_for(whole.sampling_time, TIMESTEP), effects=CATALOGUE)
    options = DiscoveryOptions()
    nominal_model = NominalModel(plant, tuple(KNOWN), np.array([*KNOWN.values()]))
    fit = fit_with_effects(nominal_model, whole.part("estimation"), (), {}, options)
    point, prior = fit.point, fit.prior
    sensitivities = compute_sensitivities(point, list_common(CATALOGUE))
    best: dict[str, Any] = {}
    for s in score(fit, sensitivities, options):
        best.setdefault(s.candidate.effect.name, s.candidate)
    sensitivities += compute_sensitivities(point, list_single([*best.values()]))
    rng = np.random.default_rng([seed, 9])
    rows = []
    for k, e in enumerate(residuals(point, draws, coloured, rng)):
        drawn = replace(point, e=e)
        with threadpool_limits(1, "blas"):
            level = fit_noise(point.linear, e, point.J, prior, point.log.sampling_time, options)
            refit = replace(fit, point=drawn, level=level, mean=point.q)
            scores = score(refit, sensitivities, options)
        false = [f"{s.candidate.effect.name}, {s.candidate.where}"
                 for s in select_significant(scores, options)]  # fmt: skip
        smallest = [min(getattr(s, n) for s in scores) for n in ("p_value", "block_p_value")]
        rows.append({
            "key": f"null/{seed}/{coloured}/{k}", "false": false, "candidates": len(scores),
            "smallest_p": smallest[0], "smallest_block_p": smallest[1],
            "below_5_percent": float(np.mean([s.p_value < 0.05 for s in scores])),
            "below_5_percent_blocks": float(np.mean([s.block_p_value < 0.05 for s in scores])),
            "ratio": float(level.noise.ratio), "sigma": level.sigma,
            "disturbance": float(np.sqrt(max(0.0, np.mean(e**2) - level.sigma**2))),
            "seconds": (time.perf_counter() - begin) / (k + 1),
        })  # fmt: skip
    return rows


def residuals(point: Any, draws: int, coloured: bool, rng: Any) -> Any:
    """Measured less predicted of a model that lacks nothing, shape (draws, N, ny)."""
    import numpy as np

    from identification.model.predictor import output_columns
    from identification.model.rollout import rollout
    from inca_mj.worlds.measure import coloured as wander

    y, inputs, log = point.log.outputs - point.e, point.log.inputs, point.log
    clean = np.broadcast_to(y, (draws, *y.shape))
    if coloured:
        model = point.predictor.plant.model
        values = np.tile(point.space.decode(point.q), (draws, 1))
        start, numbers = point.predictor.settings(values)
        errors = [wander(inputs.shape, log.sampling_time, 5e-4, 0.05, rng) for _ in range(draws)]
        run = rollout(model, start, inputs + np.array(errors), log.sampling_time, numbers=numbers,
                      record=("qpos",), hold_kind=log.hold)["qpos"]  # fmt: skip
        clean = run[..., [i for _, i in output_columns(model, log.output_names)]]
    step = 2 * np.pi / 4000
    return step * np.round((clean + 5e-4 * rng.normal(size=clean.shape)) / step) - y


def null_tasks(options: argparse.Namespace, draws: int) -> list[dict[str, Any]]:
    """Robots, each with its share of the draws."""
    return [
        {"key": f"null/{seed}/{options.coloured}", "seed": seed, "draws": draws,
         "coloured": options.coloured, "duration": options.duration}
        for seed in range(options.seed, options.seed + options.robots)
    ]  # fmt: skip


def null_task(task: dict[str, Any]) -> list[dict[str, Any]]:
    """A robot of the null study, or the error that it met."""
    try:
        return null_robot(task["seed"], task["draws"], task["coloured"], task["duration"])
    except Exception as error:
        return [{"key": task["key"], "error": f"{type(error).__name__}: {error}"}]


def null_summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Rates of false names over all draws."""
    out: dict[str, Any] = {"failed": sum("error" in r for r in rows)}
    for name, flag in (("white", "False"), ("coloured", "True")):
        some = [r for r in rows if "error" not in r and r["key"].split("/")[2] == flag]
        if some:
            out[name] = {
                "a_false_name": rate(some, lambda r: bool(r["false"])),
                "below_5_percent": sum(r["below_5_percent"] for r in some) / len(some),
                "below_5_percent_blocks": sum(r["below_5_percent_blocks"] for r in some)
                / len(some),
                "names": sorted({n for r in some for n in r["false"]}),
            }
    return out
