"""What torques name of arms in closed loop, whose armatures and masses are free.

    python benchmarks/torques.py [--hides payload nothing cogging ...] [--seeds 20] [--joints 2 6 7]
    python benchmarks/torques.py --measured DATA

An arm of geared hinges (`torque_arms.py`) follows two references of five harmonics; one record is
fitted and one confirms. Positions have noise of 50 µrad, which the controller sees, and the torques
noise of 1 % of their rms. The true masses, armatures and frictions differ from the model's by their
priors (10, 15 and 30 %). An arm hides nothing, a load of 10 to 20 % of its mass at its end, or an
effect at one joint. `--measured` compares the torques of a UR10e instead, by both splits of its
records, with the authors' parameters on the same equations, and those of EMPS. Rows go to
`benchmarks/results/torques.jsonl`; seconds are those of the processor.
"""

from __future__ import annotations

import argparse
import json
import time
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from rows import search_commit
from torque_arms import AXES, LISTED, SPREAD, UNLISTED, UNTOLD, arm, hidden, record

from identification import fit_torques, read_robot
from identification.report.torques.tables import size_words
from identification.torques.equations.bodies import read_numbers

ROWS = Path(__file__).resolve().parent / "results" / "torques.jsonl"
PAYLOAD, NOTHING = "payload", "nothing"
LARGEST = 0.2  # load, of the mass of an arm
DRIVES = ("gain", "delay", "any_gain", "short_delay")  # effects whose place is an input


def world(joints: int, seed: int, hides: str) -> dict[str, Any]:
    """What torques say of one arm, which hides a load, an effect, or nothing."""
    is_effect = hides in (*LISTED, *UNTOLD, *UNLISTED)
    key = [*hides.encode()] if is_effect else []
    rng = np.random.default_rng([seed, joints, hides == PAYLOAD, *key])
    mass = sum(6.0 * 0.6**k for k in range(joints))
    load = LARGEST * mass * float(rng.uniform(0.5, 1.0)) if hides == PAYLOAD else 0.0
    truth = arm(joints, rng, load)
    effect = hidden(hides, joints, truth, rng) if is_effect else None
    first, second = (record(truth, joints, rng, name, effect) for name in ("a", "b"))
    free = {f"joint/j{k}.armature": SPREAD["armature"] for k in range(joints)}
    free |= {f"body/b{k}.mass": SPREAD["mass"] for k in range(joints)}
    with TemporaryDirectory() as folder:
        path = Path(folder)
        (path / "arm.xml").write_text(arm(joints, None), encoding="utf-8")
        names = ", ".join(f'"{name}"' for name in free)
        toml = f'model = "arm.xml"\nfree = [{names}]\nhorizon = 0.2\n'
        toml += "".join(f'[parameters."{n}"]\nknown = {s}\n' for n, s in free.items())
        (path / "arm.toml").write_text(toml, encoding="utf-8")
        robot = read_robot(path / "arm.toml", first, [second], ["wiring", "units", "steps"])
        began = time.process_time()
        found = fit_torques(robot)
        seconds = time.process_time() - began
    payload = next((s for s in found.named if s.missing.name in ("payload", "load")), None)
    place = "input t" if hides in DRIVES else "joint j"
    return {
        "joints": joints, "seed": seed, "hides": hides, "load": load,
        "where": None if effect is None else f"{place}{effect.joint}",
        "s": effect and effect.s, "seconds": round(seconds, 2),
        "named": [s.missing.title for s in found.named],
        "first": found.named[0].missing.title if found.named else None,
        "rivals": [r.missing.title for r in found.found.rivals],
        "falls": [s.fall for s in found.named],
        "mass": None if payload is None else float(payload.size[0]),
        "std": None if payload is None else float(payload.std[0]),
        "scores": [
            [s.missing.title, s.fall / s.share, float(s.gains.sum()), s.t, s.chance, s.is_proven]
            for s in found.found.scores[:6]
        ],
        "nearest_chance": found.found.scores[0].chance, "commit": search_commit(),
    }  # fmt: skip


def measured(data: Path, turned: bool) -> dict[str, Any]:
    """What torques say of the UR10e, and what its authors' parameters leave of them."""
    from robots import ur10e
    from robots.ur10e_evidence import published

    folder = data / "ur10e"
    fit, confirm = (
        [ur10e.read_record(folder / f"{name}.csv", 0.01) for name in names]
        for names in ((ur10e.CONFIRM, ur10e.FIT) if turned else (ur10e.FIT, ur10e.CONFIRM))
    )
    robot = read_robot(folder / "full1.toml", fit, confirm, ["wiring", "units"])
    began = time.process_time()
    found = fit_torques(robot)
    seconds, e = time.process_time() - began, found.found
    theirs = published(folder / "ur10e.xml").compile()
    left, count = np.zeros(6), np.zeros(6)
    for rows in e.equations.rows[len(fit) :]:
        friction = np.array(ur10e.FRICTION).T
        predicted = np.einsum("kjbn,bn->kj", rows.bodies, read_numbers(theirs))
        predicted += theirs.dof_armature * rows.a
        predicted += friction[0] * rows.v + friction[1] * rows.sign + friction[2]
        left += np.where(rows.used, (rows.y - predicted) ** 2, 0.0).sum(axis=0)
        count += rows.used.sum(axis=0)
    return {
        "robot": "ur10e", "fitted": [log.name for log in fit], "seconds": round(seconds, 1),
        "named": [f"{s.missing.title}: {size_words(s)}" for s in found.named],
        "joints": list(ur10e.JOINTS), "torque": np.sqrt(np.mean(np.concatenate(
            [r.drives.sum(axis=2) ** 2 for r in e.equations.rows[len(fit) :]]), axis=0)).tolist(),
        "base_fit": e.unseen[0].tolist(), "model": e.unseen[1].tolist(),
        "final": e.unseen[2].tolist(), "authors": np.sqrt(left / count).tolist(),
        "commit": search_commit(),
    }  # fmt: skip


def measured_axis(data: Path) -> dict[str, Any]:
    """What torques say of EMPS, an axis with a ball screw, of which values are published."""
    from robots import emps

    axis = emps.read(data)
    model = ROWS.parents[2] / "models" / "emps.toml"
    robot = read_robot(model, [*axis.fit], [*axis.confirm], ["wiring", "units"])
    began = time.process_time()
    found = fit_torques(robot)
    return {
        "robot": "emps", "seconds": round(time.process_time() - began, 1),
        "values": {n: [v, found.std[n]] for n, v in found.values.items()},
        "published": [95.11, 203.5, 20.39, 3.16],
        "named": [f"{s.missing.title}: {size_words(s)}" for s in found.named],
        "model": found.found.unseen[1].tolist(), "final": found.found.unseen[2].tolist(),
        "commit": search_commit(),
    }  # fmt: skip


def main() -> None:
    """Make the rows of all worlds."""
    every = (PAYLOAD, NOTHING, *LISTED, *UNTOLD, *UNLISTED)
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--hides", nargs="+", default=every, choices=every)
    parser.add_argument("--seeds", type=int, default=20, help="arms of each kind")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--joints", type=int, nargs="+", default=[2, 6], choices=AXES)
    parser.add_argument("--measured", type=Path, help="folder of the measured robots")
    parser.add_argument("--out", type=Path, default=ROWS)
    given = parser.parse_args()
    if given.measured is not None:
        with given.out.open("a", encoding="utf-8") as stream:
            for turned in (False, True):
                stream.write(json.dumps(measured(given.measured, turned)) + "\n")
            stream.write(json.dumps(measured_axis(given.measured)) + "\n")
        return
    seeds = range(given.first, given.first + given.seeds)
    with given.out.open("a", encoding="utf-8") as stream:
        for seed, joints, hides in product(seeds, given.joints, given.hides):
            row = world(joints, seed, hides)
            stream.write(json.dumps(row) + "\n")
            stream.flush()
            print(hides, row["where"], row["named"], row["rivals"][:3], row["seconds"], flush=True)


if __name__ == "__main__":
    main()
