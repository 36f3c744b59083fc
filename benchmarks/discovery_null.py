"""How often a name is found where nothing is missing, under many draws of the noise."""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from typing import Any

from discovery_statistics import rate


def null_robot(seed: int, draws: int, coloured: bool, duration: float) -> list[dict[str, Any]]:
    """Scores of one robot in which nothing is missing, under many draws of its noise.

    The nominal model is fitted once to a log without noise's luck, the columns are taken once;
    each draw puts an encoder's noise, and the inputs' error through the linearised plant, on it.
    """
    import numpy as np
    from threadpoolctl import threadpool_limits

    from identification.discovery.columns import columns, common, single
    from identification.discovery.extend import Base, fit_with
    from identification.discovery.score import score
    from identification.discovery.steps import significant
    from identification.kalman.noise_fit import fit_noise
    from inca_mj.comparison import timestep_for
    from inca_mj.discover import KNOWN, TIMESTEP
    from inca_mj.effects.catalogue import CATALOGUE
    from inca_mj.twin import build_twin
    from inca_mj.worlds import Setting, world
    from inca_mj.worlds.measure import coloured as wander

    begin = time.perf_counter()
    whole = world(seed, setting=Setting(duration=duration)).log
    plant = build_twin(timestep=timestep_for(whole.sampling_time, TIMESTEP), effects=CATALOGUE)
    base = Base(plant, tuple(KNOWN), np.array([*KNOWN.values()]))
    fit = fit_with(base, whole.part("estimation"), (), {})
    at, prior = fit.at, fit.prior
    effects = [e.effect for e in CATALOGUE]
    sensed = columns(at, common(effects))
    best: dict[str, Any] = {}
    for s in score(fit, sensed):
        best.setdefault(s.candidate.effect.name, s.candidate)
    sensed += columns(at, single([*best.values()]))
    y = at.log.outputs - at.e
    rng = np.random.default_rng([seed, 9])
    rows = []
    for k in range(draws):
        clean = y.copy()
        if coloured:
            w = wander((len(y), at.linear.B.shape[2]), at.log.sampling_time, 5e-4, 0.05, rng)
            x = np.zeros(at.linear.A.shape[1])
            for i in range(len(y) - 1):
                x = at.linear.A[i] @ x + at.linear.B[i] @ w[i]
                clean[i + 1] += at.linear.C @ x
        step = 2 * np.pi / 4000
        e = step * np.round((clean + 5e-4 * rng.normal(size=y.shape)) / step) - y
        point = type(at)(at.predictor, at.space, at.q, e, at.J, at.linear)
        with threadpool_limits(1, "blas"):
            level = fit_noise(at.linear, e, at.J, prior, at.log.sampling_time)
            scores = score(replace(fit, at=point, level=level, mean=at.q), sensed)
        false = [f"{s.candidate.effect.name}, {s.candidate.where}" for s in significant(scores)]
        smallest = [min(getattr(s, n) for s in scores) for n in ("p_value", "block_p_value")]
        rows.append({
            "key": f"null/{seed}/{coloured}/{k}", "false": false, "candidates": len(scores),
            "smallest_p": smallest[0], "smallest_block_p": smallest[1],
            "below_5_percent": float(np.mean([s.p_value < 0.05 for s in scores])),
            "below_5_percent_blocks": float(np.mean([s.block_p_value < 0.05 for s in scores])),
            "ratio": float(level.noise.ratio), "sigma": level.sigma,
            "seconds": (time.perf_counter() - begin) / (k + 1),
        })  # fmt: skip
    return rows


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
