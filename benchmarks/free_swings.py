"""How often a search names what a free swing hides, and how often it errs on short logs.

    python benchmarks/free_swings.py [--count 10] [--seed 1] [--without scatter_of_noise]
                                     [--effects nothing] [--driven] [--processes 2]
    python benchmarks/free_swings.py --only-page              the page anew, from the rows

A pendulum, and a cart between springs, are let go from elsewhere and coast for 10 s at 100 Hz, or
are driven by a sum of sines. One log is given and no horizon, as who begins would; its first half
is fitted, the second one judges. The damping is within a factor 2 of the model's.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from itertools import product
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from rows import ROOT, Row, answered, of_newest, rows_of, write_part

RESULTS = ROOT / "benchmarks" / "results" / "free_swings.jsonl"
PAGE = ROOT / "docs" / "benchmarks.md"
BEGIN, END = "<!-- free swings: begin -->\n", "<!-- free swings: end -->\n"
MJCF = """<mujoco model="{kind}"><option timestep="{step}" integrator="RK4"/><worldbody>
<body name="link"><joint name="swing" axis="{axis}" damping="{damping}"/>
<inertial pos="0 0 {low}" mass="{mass}" diaginertia="0.02 0.02 0.01"/></body></worldbody>{motor}
<sensor><jointpos name="swing" joint="swing"/></sensor></mujoco>"""
MOTOR = '<actuator><motor name="push" joint="swing"/></actuator>'
# By kind: what the model says, the damping that it has, noise of the sensor, usual way and force.
KINDS: dict[str, tuple[dict[str, str], float, float, float, float]] = {
    "pendulum": ({"axis": "0 1 0", "low": "-0.3", "mass": "1.2"}, 0.03, 1e-3, 0.6, 1.5),
    "cart": ({"axis": '1 0 0" type="slide" stiffness="30', "low": "0", "mass": "2"},
             0.6, 3e-4, 0.25, 7.5),
}  # fmt: skip
# Share of the usual force that each effect has at the usual way, or at the usual way per second.
SHARES = {"coulomb_friction": 0.02, "quadratic_friction": 0.02, "hardening": 0.1, "offset": 0.03}
SIZES = (0.6, 2.0)  # times these shares
SAMPLES, STEP, FINE = 1000, 0.01, 10  # samples, their interval [s], steps of the truth in each
SLIPS = 0.01  # of the usual way a second: speed at which Coulomb friction is nearly whole
NULL = "nothing"
HEAD = """## Logs of one joint, without a horizon

    python benchmarks/free_swings.py

A pendulum and a cart between springs, 10 s at 100 Hz, free or driven by a sum of sines; one log,
and no horizon in the robot's file, so that the search takes a part of a swing. An effect of 1.2 to
20 % of the usual force is hidden. *A rival* is a name that the answer tells as one of a set.

"""


def main() -> int:
    """Answer worlds, and write their part of the page."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--without", nargs="*", default=[])
    parser.add_argument("--effects", nargs="*", default=[NULL, *SHARES])
    parser.add_argument("--driven", action="store_true")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--only-page", action="store_true")
    given = parser.parse_args()
    if not given.only_page:
        seeds = range(given.seed, given.seed + given.count)
        left_out = tuple(given.without)
        tasks = {
            "/".join([k, e, str(s), "driven" * given.driven, *left_out]):
                (k, e, s, given.driven, left_out)
            for s, k, e in product(seeds, KINDS, given.effects)
        }  # fmt: skip
        answered(study, tasks, RESULTS, str, given.processes)
    write_part(PAGE, BEGIN, END, page(of_newest(rows_of(RESULTS))))
    return 0


def study(
    kind: str, effect: str, seed: int, is_driven: bool, without: tuple[str, ...]
) -> dict[str, Any]:
    """Returns the row of one world: what was hidden, and what was answered."""
    from identification import DiscoveryOptions, discover, read_robot

    row = {"kind": kind, "effect": effect, "is_driven": is_driven, "without": without}
    with tempfile.TemporaryDirectory() as folder:
        write_world(Path(folder), kind, effect, seed, is_driven)
        try:
            robot = read_robot(Path(folder) / "robot.toml", Path(folder) / "log.csv")
            found = discover(robot, options=DiscoveryOptions(without=without))
        except Exception as error:
            return row | {"error": repr(error)}
    return row | {
        "verdict": found.verdict, "seconds": found.took,
        "named": [(n.name, n.confidence, [r.name for r in n.rivals]) for n in found.named],
    }  # fmt: skip


def write_world(folder: Path, kind: str, effect: str, seed: int, is_driven: bool) -> None:
    """Write model, robot's file and log of a world."""
    said, damping, noise, way, usual = KINDS[kind]
    chance = np.random.default_rng([seed, is_driven, *map(ord, kind + effect)])
    low, high = np.log(SIZES)
    true, size = damping * 2 ** chance.uniform(-1, 1), float(np.exp(chance.uniform(low, high)))
    motor = MOTOR if is_driven else ""
    times = 5 if is_driven else 1  # a driven joint is damped more, as geared ones are

    def xml(value: float, step: float) -> str:
        return MJCF.format(kind=kind, damping=times * value, step=step, motor=motor, **said)

    model = mujoco.MjModel.from_xml_string(xml(true, STEP / FINE))
    data, time = mujoco.MjData(model), STEP * np.arange(SAMPLES)
    u = np.zeros(SAMPLES)
    if is_driven:
        waves = chance.uniform((0.15, 0), (2.0, 2 * np.pi), (5, 2))
        u = 0.25 * usual * sum(np.sin(2 * np.pi * f * time + phase) for f, phase in waves)
    else:
        data.qpos[0] = way * chance.uniform(0.5, 1.5) * chance.choice([-1, 1])
        data.qvel[0] = way * chance.uniform(-2, 2)
    y = []
    for drive in u:
        y.append(data.qpos[0])
        for _ in range(FINE):
            hidden = force(effect, data.qpos[0] / way, data.qvel[0] / way)
            data.qfrc_applied[0] = drive + size * SHARES.get(effect, 0.0) * usual * hidden
            mujoco.mj_step(model, data)
    rows = np.column_stack([time, y + noise * chance.normal(size=SAMPLES), u])[:, : 2 + is_driven]
    (folder / "robot.xml").write_text(xml(damping, STEP))
    (folder / "robot.toml").write_text('model = "robot.xml"\nfree = ["joint/swing.damping"]\n')
    head = "time,swing,push" if is_driven else "time,swing"
    np.savetxt(folder / "log.csv", rows, "%.7f", ",", header=head, comments="")


def force(effect: str, q: float, v: float) -> float:
    """Returns the hidden force over its size, at a position and a speed over the usual way."""
    laws = {"coulomb_friction": -np.tanh(v / SLIPS), "quadratic_friction": -v * abs(v),
            "hardening": -(q**3), "offset": 1.0}  # fmt: skip
    return float(laws.get(effect, 0.0))


def answer_of(row: Row) -> str:
    """Returns what an answer is worth, in a word or two."""
    names, truth = [name for name, *_ in row.get("named", [])], row["effect"]
    if "error" in row:
        return "error"
    if truth == NULL and row["verdict"] == "nothing missing":
        return "right"
    if truth in names:
        return "right" if len(names) == 1 else "wrong"
    if names and any(truth in rivals for *_, rivals in row["named"]):
        return "a rival"
    if names:
        return "wrong"
    return "nothing missing" if row["verdict"] == "nothing missing" else "unknown"


def page(rows: Sequence[Row]) -> str:
    """Returns the part of the page."""
    columns = ("right", "a rival", "nothing missing", "unknown", "wrong", "error")
    lines = ["| log | hidden | " + " | ".join(columns) + " |", "|---|---|" + "---|" * len(columns)]
    groups: dict[tuple[bool, str, tuple[str, ...]], Counter[str]] = {}
    for row in rows:
        at = (row["is_driven"], row["effect"], tuple(row["without"]))
        groups.setdefault(at, Counter())[answer_of(row)] += 1
    for (is_driven, effect, without), count in sorted(groups.items()):
        left = f", without {', '.join(without)}" if without else ""
        cells = " | ".join(str(count[c] or "") for c in columns)
        lines.append(f"| {'driven' if is_driven else 'free'}{left} | {effect} | {cells} |")
    commit = rows[-1]["commit"] if rows else "none"
    return HEAD + "\n".join(lines) + f"\n\nAll rows are of commit {commit}.\n"


if __name__ == "__main__":
    sys.exit(main())
