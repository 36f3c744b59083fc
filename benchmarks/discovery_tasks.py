"""Logs whose truth is known, as tasks of a study: labelled files and hidden worlds."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

# Names of sizes in labels, by effect and size here, as far as they mean the same.
LABELS = {
    "stribeck": ("stribeck_friction", "f_s"), "asym": ("asymmetric_friction", "f_a"),
    "load": ("load_dependent_friction", "mu"), "quad": ("quadratic_friction", "c"),
    "isat": ("current_saturation", "i_max"),
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
USUAL = 20.0  # length of a world's log where nothing is said [s]
COUNTS = {1: "single", 2: "pair", 3: "triple"}  # the kind of a world by its hidden effects
RATIOS = (1.0, 3.0, 10.0)  # of what cannot be absorbed to the noise, drawn by chance


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

    from inca_mj.worlds import HIDDEN_EFFECTS, SHAPES, UNLISTED

    for k in range(options.worlds):
        seed = options.seed + k
        rng = np.random.default_rng([seed, 5])
        kind = "null" if options.null or k % 6 == 0 else "unknown" if k % 6 == 3 else "single"
        if kind == "single":
            kind = COUNTS[options.effects]
        known = [*HIDDEN_EFFECTS] if kind != "unknown" else [*UNLISTED]
        count = {"null": 0, "unknown": 1}.get(kind, options.effects)
        names = [str(n) for n in rng.choice(known, count, replace=False)]
        yield {
            "key": f"world/{seed}/{kind}/{options.ratio}/{options.coloured}/{options.wrong_shapes}"
            + "/beside the spread" * options.as_built
            + f"/{options.duration:g} s" * (options.duration != USUAL)
            + f"/{options.records} records" * (options.records > 1),
            "seed": seed, "kind": kind, "names": names,
            "ratio": float(options.ratio or rng.choice(RATIOS)),
            "coloured": options.coloured, "as_built": options.as_built,
            "other_shape": [options.wrong_shapes and n in SHAPES for n in names],
            "duration": options.duration, "records": options.records,
        }  # fmt: skip


def logs_of(task: dict[str, Any]) -> tuple[list[Any], dict[str, Any]]:
    """The logs of a task, and its truth."""
    if "practice" in task:
        from inca_mj.twin.logs import read_inca_log

        return [read_inca_log(task["practice"])], task["truth"]
    from inca_mj.worlds import AS_BUILT, EXACT, HiddenSetting, draw_effect, records
    from inca_mj.worlds.world import INPUTS

    effects = [
        draw_effect(name, task["seed"], other_shape=other)
        for name, other in zip(task["names"], task["other_shape"], strict=True)
    ]  # of a robot that stands with them, as all effects on its geometry do
    effects = [replace(e, balanced=True) if hasattr(e, "balanced") else e for e in effects]
    setting = HiddenSetting(
        input="multisine" if task["seed"] % 2 else "prbs", duration=task["duration"],
        error_rms=5e-4 if task["coloured"] or task["as_built"] else 0.0,
        tolerances=AS_BUILT if task["as_built"] else EXACT,
    )  # fmt: skip
    turn = INPUTS.index(setting.input)
    made = records(
        task["seed"], effects, n=task["records"], inputs=(*INPUTS[turn:], *INPUTS[:turn]),
        ratio=task["ratio"] if effects else None, setting=setting,
    )  # fmt: skip
    truth = made[0].truth
    return [each.log for each in made], {
        "kind": task["kind"], "ratio": task["ratio"] if effects else 0.0,
        "duration": task["duration"], "records": task["records"],
        "other_shape": any(task["other_shape"]),
        "effects": [
            {"name": e.name, "where": e.where,
             "sizes": {WORLDS.get(s, s): float(getattr(e, s)) for s in e.sizes}}
            for e in truth.effects
        ],
    }  # fmt: skip
