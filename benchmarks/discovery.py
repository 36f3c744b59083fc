"""How often a discovery names the right effect; prints one JSON object.

    python benchmarks/discovery.py --practice FOLDER [--only single/1.0/] [--jobs 2]
    python benchmarks/discovery.py --worlds 60 --seed 1000 --ratio 3 --coloured --wrong-shapes
    python benchmarks/discovery.py --null-study 300 [--coloured]

Logs with labels, hidden worlds of the independent reference, or the scores alone where nothing is
missing. Every finished log is one line of `--out`, and `--resume` goes on after the last of them;
progress goes to stderr. Rates have Wilson's 95 % intervals.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
import traceback
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
# Names of sizes in labels, by effect and size here, as far as they mean the same.
LABELS = {
    "stribeck": ("stribeck_friction", "f_s"), "asym": ("asymmetric_friction", "f_a"),
    "load": ("load_dependent_friction", "mu"), "quad": ("quadratic_friction", "c"),
    "bc1": ("friction_mismatch", "delta"), "cog_c": ("cogging", "a"), "cog_s": ("cogging", "b"),
    "tau_e": ("current_lag", "tau"), "delay": ("delay", "tau"),
    "kt_t": ("torque_constant_drift", "alpha"), "kt1": ("torque_constant_mismatch", "delta"),
    "ecc_c": ("drum_eccentricity", "a"), "ecc_s": ("drum_eccentricity", "b"),
    "layer": ("drum_layering", "h"), "R1": ("drum_radius_mismatch", "delta"),
    "back": ("backlash", "h"), "k3": ("spring_hardening", "k_3"),
    "hyst": ("spring_hysteresis", "eta"), "kap": ("cable_hardening", "kappa"),
    "mx": ("cable_creep", "c"), "rp": ("pulley_radius", "r_p"), "rho": ("cable_weight", "rho"),
    "drag": ("air_drag", "c"),
    **{f"{a}{x}": (name, x) for a, name in
       (("a", "anchor_offset"), ("c", "com_offset"), ("f", "external_force")) for x in "xyz"},
}  # fmt: skip
WORLDS = {"delay": "tau", "fraction": "c"}  # the same of the worlds
RATIOS = (1.0, 3.0, 10.0)  # of what cannot be absorbed to the noise, drawn by chance


def pinned(jobs: int) -> None:
    """Few threads in this process: many small matrices, and other processes beside it."""
    for name in THREADS:
        os.environ[name] = "1"
    if jobs > 1 and hasattr(os, "sched_setaffinity"):
        cores = sorted(os.sched_getaffinity(0))
        os.sched_setaffinity(0, {cores[os.getpid() % len(cores)]})


def practice_tasks(folder: Path, only: str) -> Iterator[dict[str, Any]]:
    """The labelled logs of a folder; `only` is kind/ratio/name, where a part may be empty."""
    kind, ratio, name = (*only.split("/"), "", "")[:3]
    labels = json.loads((folder / "labels.json").read_text())
    for key, label in sorted(labels.items()):
        names = [e if isinstance(e, str) else e["name"] for e in label["effects"]]
        if (
            (kind and label["kind"] != kind)
            or (ratio and float(label["ratio"]) != float(ratio))
            or (name and name not in names)
            or not (folder / f"{key}.csv").exists()
        ):
            continue
        yield {"key": f"{folder.name}/{key}", "practice": str(folder / f"{key}.csv"),
               "truth": practice_truth(label, names)}  # fmt: skip


def practice_truth(label: dict[str, Any], names: list[str]) -> dict[str, Any]:
    """A label as the truth of a row."""
    where, drives = label["where"], None
    if where is not None:
        drives = [f"drive {w}" for w in (where if isinstance(where, list) else [where])]
    sizes: dict[str, dict[str, float]] = {name: {} for name in names}
    for key, value in label["size"].items():
        name, size = LABELS.get(key, ("", ""))
        if name in sizes:
            sizes[name][size] = value
    return {
        "kind": label["kind"],
        "ratio": label["ratio"],
        "effects": [
            {"name": n, "where": drives[min(i, len(drives) - 1)] if drives else None,
             "sizes": sizes[n]} for i, n in enumerate(names)
        ],
    }  # fmt: skip


def world_tasks(options: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """Worlds with effects drawn by chance: one in six has none, one in six an unlisted one."""
    import numpy as np

    from inca_mj.worlds import CATALOGUE, SHAPES, UNLISTED

    for k in range(options.worlds):
        seed = options.seed + k
        rng = np.random.default_rng([seed, 5])
        kind = "null" if options.null or k % 6 == 0 else "unknown" if k % 6 == 3 else "single"
        if options.pairs and kind == "single":
            kind = "pair"
        known = [*CATALOGUE] if kind != "unknown" else [*UNLISTED]
        count = {"null": 0, "pair": 2}.get(kind, 1)
        names = [str(n) for n in rng.choice(known, count, replace=False)]
        yield {
            "key": f"world/{seed}/{kind}/{options.ratio}/{options.coloured}/{options.wrong_shapes}",
            "seed": seed, "kind": kind, "names": names,
            "ratio": float(options.ratio or rng.choice(RATIOS)),
            "coloured": options.coloured,
            "other_shape": [options.wrong_shapes and n in SHAPES for n in names],
            "duration": options.duration,
        }  # fmt: skip


def log_of(task: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
    """The log of a task, and its truth."""
    if "practice" in task:
        from inca_mj.logs import read_inca_log

        return read_inca_log(task["practice"]), task["truth"]
    from inca_mj.worlds import Setting, draw_effect, world

    effects = [
        draw_effect(name, task["seed"], other_shape=other)
        for name, other in zip(task["names"], task["other_shape"], strict=True)
    ]
    setting = Setting(
        input="multisine" if task["seed"] % 2 else "prbs", duration=task["duration"],
        error_rms=5e-4 if task["coloured"] else 0.0,
    )  # fmt: skip
    log, truth = world(
        task["seed"], effects, ratio=task["ratio"] if effects else None, setting=setting
    )
    return log, {
        "kind": task["kind"], "ratio": task["ratio"] if effects else 0.0,
        "other_shape": any(task["other_shape"]),
        "effects": [
            {"name": e.name, "where": e.where,
             "sizes": {WORLDS.get(s, s): float(getattr(e, s)) for s in e.sizes}}
            for e in truth.effects
        ],
    }  # fmt: skip


def answer_of(found: Any) -> dict[str, Any]:
    """A discovery as a row keeps it."""
    values = found.final.at.values
    above = found.before.rms**2 - min(found.noise_rms**2 + found.disturbance_rms**2,
                                      found.after.rms**2)  # fmt: skip
    named = [
        {
            "name": n.candidate.effect.name, "where": n.candidate.where,
            "confidence": n.confidence, "one_of": n.one_of,
            "set": [r.candidate.effect.name for r in n.rivals
                    if n.one_of and r.candidate.effect.name != n.candidate.effect.name],
            "sizes": {s.name: values[full] for s, full
                      in zip(n.candidate.effect.sizes, n.candidate.sizes, strict=True)},
            "t": n.proof.t, "share": n.proof.share, "gain": n.gain,
        }
        for n in found.named
    ]  # fmt: skip
    return {
        "verdict": found.verdict, "named": named, "left": list(found.left),
        "before": found.before.rms, "after": found.after.rms, "noise": found.noise_rms,
        "disturbance": found.disturbance_rms,
        "gap_closed": (found.before.rms**2 - found.after.rms**2) / above if above > 0 else None,
        "scores": [[s.candidate.effect.name, s.candidate.where, s.gain] for s in found.scores[:5]],
        "stages": dict(found.seconds),
    }  # fmt: skip


def study(task: dict[str, Any]) -> dict[str, Any]:
    """One log from its making to its answer; an error is a row too."""
    begin = time.perf_counter()
    try:
        log, truth = log_of(task)
        from inca_mj.discover import discover

        answer = answer_of(discover(log))
    except Exception as error:
        return {"key": task["key"], "error": f"{type(error).__name__}: {error}",
                "trace": traceback.format_exc(limit=-3)}  # fmt: skip
    return {"key": task["key"], "truth": truth, "answer": answer,
            "seconds": time.perf_counter() - begin}  # fmt: skip


def null_robot(seed: int, draws: int, coloured: bool, duration: float) -> list[dict[str, Any]]:
    """Scores of one robot in which nothing is missing, under many draws of its noise.

    The nominal model is fitted once to a log without noise's luck, the columns are taken once;
    each draw puts an encoder's noise, and the inputs' error through the linearised plant, on it.
    """
    import numpy as np
    from threadpoolctl import threadpool_limits

    from identification.discovery.columns import columns, common, single
    from identification.discovery.extend import Base, fit_with
    from identification.discovery.noise_fit import fit_noise
    from identification.discovery.score import score
    from identification.discovery.steps import significant
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


def null_task(task: dict[str, Any]) -> list[dict[str, Any]]:
    """A robot of the null study, or the error that it met."""
    try:
        return null_robot(task["seed"], task["draws"], task["coloured"], task["duration"])
    except Exception as error:
        return [{"key": task["key"], "error": f"{type(error).__name__}: {error}"}]


def null_summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Rates of false names over all draws."""
    from discovery_statistics import rate

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


def run(work: Any, tasks: list[dict[str, Any]], jobs: int, out: Path) -> None:
    """Every task in its turn; each result is written down at once."""
    begin = time.perf_counter()
    with (
        ProcessPoolExecutor(
            jobs, get_context("spawn"), initializer=pinned, initargs=(jobs,)
        ) as pool,
        out.open("a") as file,
    ):
        futures = {pool.submit(work, task): task for task in tasks}
        for n, future in enumerate(as_completed(futures), 1):
            try:
                rows = future.result()
            except Exception as error:  # a process died
                rows = {"key": futures[future]["key"], "error": f"{type(error).__name__}: {error}"}
            for row in rows if isinstance(rows, list) else [rows]:
                file.write(json.dumps(row) + "\n")
            file.flush()
            said = rows if isinstance(rows, dict) else rows[-1]
            print(f"{n}/{len(tasks)} {time.perf_counter() - begin:.0f} s {line(said)}",
                  file=sys.stderr, flush=True)  # fmt: skip


def line(row: dict[str, Any]) -> str:
    """A row in a line."""
    if "error" in row:
        return f"{row['key']}: {row['error']}"
    if "answer" not in row:
        return f"{row['key']}: {', '.join(row['false']) or 'no name'}"
    true = " + ".join(e["name"] for e in row["truth"]["effects"]) or "nothing"
    named = " + ".join(
        f"{n['name']}, {n['where']} ({n['confidence']:.2f})" for n in row["answer"]["named"]
    )
    return f"{row['key']}: {true} -> {named or row['answer']['verdict']} ({row['seconds']:.0f} s)"


def kept(out: Path, keys: set[str]) -> list[dict[str, Any]]:
    """Rows of a file whose keys (or robots) are asked for, the last of each."""
    rows = {}
    for text in out.read_text().splitlines() if out.exists() else ():
        try:
            row = json.loads(text)
        except json.JSONDecodeError:  # an interrupted line
            continue
        if row["key"] in keys or row["key"].rpartition("/")[0] in keys:
            rows[row["key"]] = row
    return list(rows.values())


def main() -> None:
    """Run the study that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    add = parser.add_argument
    add("--practice", type=Path, nargs="+", default=[], help="folders with labels.json")
    add("--only", default="", help="kind/ratio/name, each may be empty")
    add("--worlds", type=int, default=0)
    add("--null-study", type=int, default=0)
    add("--robots", type=int, default=10, help="of the null study")
    add("--seed", type=int, default=1000)
    add("--ratio", type=float, default=None, help="1, 3 or 10 by chance when not given")
    add("--duration", type=float, default=20.0, help="of a world [s]")
    for flag in ("--coloured", "--wrong-shapes", "--pairs", "--null", "--resume"):
        add(flag, action="store_true")
    add("--limit", type=int, default=None, help="logs at most")
    add("--jobs", type=int, default=1)
    add("--out", type=Path, default=Path("out/discovery.jsonl"))
    options = parser.parse_args()
    tasks = [t for folder in options.practice for t in practice_tasks(folder, options.only)]
    tasks += world_tasks(options)
    work: Any = study
    if options.null_study:
        work, draws = null_task, max(1, options.null_study // options.robots)
        tasks = [
            {"key": f"null/{seed}/{options.coloured}", "seed": seed, "draws": draws,
             "coloured": options.coloured, "duration": options.duration}
            for seed in range(options.seed, options.seed + options.robots)
        ]  # fmt: skip
    tasks = tasks[: options.limit]
    options.out.parent.mkdir(parents=True, exist_ok=True)
    if not options.resume:
        options.out.unlink(missing_ok=True)
    keys = {t["key"] for t in tasks}
    done = {r["key"] for r in kept(options.out, keys) if "error" not in r}
    done |= {key.rpartition("/")[0] for key in done}
    for name in THREADS:  # before the processes start: libraries read them once
        os.environ[name] = "1"
    run(partial(work), [t for t in tasks if t["key"] not in done], options.jobs, options.out)
    rows = kept(options.out, keys)
    if options.null_study:
        print(json.dumps(null_summary(rows)))
    else:
        from discovery_statistics import summary

        print(json.dumps({"summary": summary(rows), "logs": rows}))


if __name__ == "__main__":
    main()
