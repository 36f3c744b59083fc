"""Whole searches on logs of known truth: hidden worlds, and logs that `labels.json` describes.

A search takes minutes of one core.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from identification.errors import InputError
from identification.storage.files import read_json
from identification.sweep.answers import (
    ANSWER,
    JUDGED,
    PROOF,
    TRUTH,
    answer,
    judged,
    proof,
    size_name,
)
from identification.sweep.discovery_findings import discovery_findings
from identification.sweep.method import Method, Seed
from identification.sweep.settings import file_setting
from inca_mj.studies.hidden_worlds import SPREAD, WORLD, WorldSettings, make_world
from inca_mj.workflows.spread import WORDS


def world_discovery(settings: WorldSettings, seed: Seed) -> dict[str, Any]:
    """Make a world, and find what the twin lacks to explain it.

    A world stands at rest with what it lacks, as a robot that was let go.

    Raises:
        InputError: the world cannot be made, or the search refuses its logs.
        DivergenceError: a simulation left the finite numbers.
    """
    from inca_mj.workflows.discovery import discover
    from inca_mj.workflows.spread import spread_of

    logs, truth = make_world(settings, seed)
    found = discover(logs, settled=True, spread=spread_of(settings.spread))
    return _record(truth, found)


def _record(truth: dict[str, Any], found: Any) -> dict[str, Any]:
    named = answer(found)
    return {
        **truth, **named, **proof(found),
        **judged(named["named"], truth["hidden"], truth["kind"]),
    }  # fmt: skip


WORLD_DISCOVERY = Method(
    about="makes a hidden world and searches what the twin lacks",
    settings=WorldSettings,
    columns={**WORLD, **TRUTH, **ANSWER, **PROOF, **JUDGED},
    run=world_discovery,
    success="right",
    against="ratio",
    summary=discovery_findings,
)


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


@dataclass(frozen=True, kw_only=True)
class PracticeSettings:
    """A labelled log; every field says what it is in its metadata."""

    log: Path = file_setting("log (CSV) beside labels.json, which tells its truth")
    spread: str = file_setting(SPREAD, "usual", words=WORDS)


def practice_discovery(settings: PracticeSettings, seed: Seed) -> dict[str, Any]:
    """Discover; nothing is left to chance, so the seed is not used. The robot was held.

    Raises:
        InputError: the log or its label cannot be read.
        DivergenceError: the nominal model cannot be simulated.
    """
    from inca_mj.twin.logs import read_inca_log
    from inca_mj.workflows.discovery import discover
    from inca_mj.workflows.spread import spread_of

    truth = truth_of(settings.log)
    return _record(truth, discover(read_inca_log(settings.log), spread=spread_of(settings.spread)))


def truth_of(log: Path) -> dict[str, Any]:
    """Returns the label of a log as the columns `TRUTH`.

    Raises:
        InputError: there is no label of it.
    """
    path = log.parent / "labels.json"
    labels = read_json(path, "JSON file of labels", "write it again")
    if not isinstance(labels, dict) or log.stem not in labels:
        raise InputError(f"{path} has no label of {log.stem}; add one, or leave that log out")
    label = labels[log.stem]
    names = [e if isinstance(e, str) else e["name"] for e in label["effects"]]
    where = label["where"] if isinstance(label["where"], list) else [label["where"]]
    places = ["" if w is None else f"drive {w}" for w in where]
    at = {name: places[min(i, len(places) - 1)] for i, name in enumerate(names)}
    known = [(*LABELS.get(key, ("", "")), value) for key, value in label["size"].items()]
    sizes = {size_name(n, size, at[n]): float(v) for n, size, v in known if n in names}
    return {
        "kind": label["kind"], "ratio": float(label["ratio"] or 0.0), "hidden": names,
        "hidden_where": [at[name] for name in names],
        "hidden_size_of": [*sizes], "hidden_sizes": [*sizes.values()], "other_shape": False,
    }  # fmt: skip


PRACTICE_DISCOVERY = Method(
    about="searches what the twin lacks to explain a log of known truth",
    settings=PracticeSettings,
    columns={**TRUTH, **ANSWER, **PROOF, **JUDGED},
    run=practice_discovery,
    success="right",
    summary=discovery_findings,
)
