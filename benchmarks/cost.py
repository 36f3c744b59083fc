"""Cost of a search against the number of candidates, parameters, records and joints.

    python benchmarks/cost.py [--only joints] [--limit 900]

Each case is a search in a process of its own, on all processors that there are, whose laws were
compiled by a small search before. The rows are added to `benchmarks/results/cost.jsonl`, and
`benchmarks/speed_page.py` draws those of the newest commit.

    candidates   one log of the INCA, all drives alike; fewer effects, or onsets at more times
    parameters   the same log, with all drives alike and with values of their own
    records      records of 8 s of one INCA, all drives alike
    joints       chains of hinges that hang, each driven; judged over a horizon of 0.2 s
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from identification.sweep.work import commit

ROOT = Path(__file__).resolve().parents[1]
ROWS = ROOT / "benchmarks" / "results" / "cost.jsonl"
LOG = ROOT / "examples" / "log.csv"
# Of the catalogue, some two hundred candidates.
FEW = ("stribeck_friction", "cogging", "backlash", "anchor_offset", "drum_spring_jump")
CASES: Mapping[str, Sequence[float]] = {
    "candidates": (200, 800, 3000),
    "parameters": (20, 140),
    "records": (1, 3, 10),
    "joints": (1, 6, 20),
}


def main() -> int:
    """Run the cases one after the other, or the one case of a process."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", choices=CASES, help="one kind of case")
    parser.add_argument("--limit", type=float, default=900.0, help="of one case [s]")
    parser.add_argument("--case", nargs=2, help="what a process of its own does")
    given = parser.parse_args()
    if given.case is not None:
        print(json.dumps(measured(given.case[0], int(given.case[1]))))
        return 0
    for kind in [given.only] if given.only else CASES:
        for count in CASES[kind]:
            row = {"commit": commit(), "against": kind, "of": count}
            row |= of_a_process(kind, count, given.limit)
            with ROWS.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
            print(json.dumps(row), flush=True)
    return 0


def of_a_process(kind: str, count: float, limit: float) -> dict[str, Any]:
    """Returns what a case measured in a process of its own; no seconds where time ran out."""
    command = [sys.executable, str(Path(__file__)), "--case", kind, str(count)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=limit, env=environment, check=True
        )
    except subprocess.TimeoutExpired:
        return {"seconds": None, "limit": limit}
    return dict(json.loads(done.stdout.splitlines()[-1]))


def measured(kind: str, count: int) -> dict[str, Any]:
    """Returns the exact count, seconds, processor seconds and peak memory of one search."""
    exact, search = {
        "candidates": with_candidates, "parameters": with_parameters, "records": with_records,
        "joints": with_joints,
    }[kind](count)  # fmt: skip
    wall, used = time.perf_counter(), time.process_time()
    found = search()
    return {
        "exact": exact,
        "seconds": round(time.perf_counter() - wall, 1),
        "processor_seconds": round(time.process_time() - used, 1),
        "megabytes": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024),
        "verdict": found.verdict,
        "stages": {name: round(seconds, 1) for name, seconds in found.seconds.items()},
    }


Case = tuple[int, Callable[[], Any]]  # what it counts, and its search


def with_candidates(count: int) -> Case:
    """A search of the shipped log among about so many candidates."""
    from identification.discovery.candidates import list_common, list_single
    from inca_mj import CATALOGUE, read_inca_log
    from inca_mj.workflows.discovery import discover
    from inca_mj.workflows.spread import spread_of

    effects = [e for e in CATALOGUE if count >= 800 or e.name in FEW]
    if count > 800:
        effects = [_with_more_onsets(e, 6) for e in effects]
    log, common = read_inca_log(LOG), list_common(effects)
    exact = len(common) + len(list_single(common))
    return exact, lambda: discover(log, spread=spread_of("none"), effects=effects)


def _with_more_onsets(effect: Any, times: int) -> Any:
    """The effect with `times` as many times at which it may begin."""
    if effect.onset is None:
        return effect
    shapes = [
        replace(shape, grid=tuple(np.linspace(shape.grid[0], shape.grid[-1],
                                              times * len(shape.grid)).tolist()))
        if shape.name == effect.onset.shape else shape
        for shape in effect.shapes
    ]  # fmt: skip
    return replace(effect, shapes=tuple(shapes))


def with_parameters(count: int) -> Case:
    """A search of the shipped log, with drives that are alike or have values of their own."""
    from inca_mj import read_inca_log
    from inca_mj.workflows.discovery import discover
    from inca_mj.workflows.spread import spread_of

    log, spread = read_inca_log(LOG), spread_of("none" if count < 100 else "usual")
    return count, lambda: discover(log, spread=spread)


def with_records(count: int) -> Case:
    """A search of so many records of 8 s, in which drives have a Stribeck friction."""
    from inca_mj import CATALOGUE, build_twin, parameter_set
    from inca_mj.effects.values import with_effects
    from inca_mj.workflows.discovery import discover
    from inca_mj.workflows.spread import spread_of

    known = with_effects(parameter_set(), CATALOGUE)
    truth = known.with_values({"stribeck_friction.f_s": 3e-3, "stribeck_friction.v_s": 2.0})
    twin = build_twin(truth, effects=CATALOGUE, timestep=2e-3, visual=False)
    logs = [_log_of(twin, seed) for seed in range(count)]
    return count, lambda: discover(logs, spread=spread_of("none"))


def _log_of(twin: Any, seed: int) -> Any:
    """A record of a twin under currents that change every 0.4 s, with 0.5 mrad of noise."""
    from identification import Log
    from inca_mj.twin.run import simulate

    rng, rate, seconds = np.random.default_rng(seed), 100.0, 8.0
    steps = rng.uniform(-0.35, 0.35, (20, 8)).repeat(40, axis=0)
    run = simulate(twin, steps, 1 / rate)
    angles = run.motor_angle + rng.normal(0, 5e-4, run.motor_angle.shape)
    return Log(
        time=np.arange(int(rate * seconds)) / rate, inputs=steps, outputs=angles,
        input_names=tuple(f"current_{k}" for k in range(1, 9)),
        output_names=tuple(f"angle_{k}" for k in range(1, 9)),
        name=f"record {seed}",
    )  # fmt: skip


def with_joints(count: int) -> Case:
    """A search of a chain of hinges, one of which has a torque that turns with its angle."""
    from identification import discover, read_robot

    folder = Path(tempfile.mkdtemp())
    (folder / "chain.xml").write_text(chain(count), encoding="utf-8")
    write_log(folder, count)
    free = [f"joint/j{k}.damping" for k in range(1, count + 1)]
    (folder / "chain.toml").write_text(
        f'model = "chain.xml"\nhorizon = 0.2\nfree = {json.dumps(free)}\n', encoding="utf-8"
    )
    robot = read_robot(folder / "chain.toml", folder / "log.csv")
    return count, lambda: discover(robot)


def chain(count: int) -> str:
    """Returns the MJCF of a chain of so many driven hinges that hangs down."""
    links = "".join(
        f'<body pos="0 0 {0 if k == 1 else -0.2}"><joint name="j{k}" axis="{k % 2} {1 - k % 2} 0"'
        ' damping="0.05" armature="0.01"/>'
        '<geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.2" mass="0.3" contype="0"'
        ' conaffinity="0"/>'
        for k in range(1, count + 1)
    )
    motors = "".join(f'<motor name="u{k}" joint="j{k}"/>' for k in range(1, count + 1))
    sensors = "".join(f'<jointpos name="j{k}" joint="j{k}"/>' for k in range(1, count + 1))
    return (
        '<mujoco><option timestep="0.0025" integrator="RK4"/><worldbody>'
        f"{links}{'</body>' * count}</worldbody><actuator>{motors}</actuator>"
        f"<sensor>{sensors}</sensor></mujoco>"
    )


def write_log(folder: Path, count: int) -> None:
    """Write 20 s of the chain, with 0.2 mrad of noise."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(chain(count))
    data, rng = mujoco.MjData(model), np.random.default_rng(count)
    model.opt.timestep, rows = 1e-3, []
    u = rng.uniform(-1, 1, (67, count)).repeat(30, axis=0)[:2000] * 0.5
    for k, now in enumerate(u):
        rows.append([k / 100, *now, *(data.qpos + rng.normal(0, 2e-4, count))])
        for _ in range(10):
            data.ctrl[:] = now
            data.qfrc_applied[0] = 0.06 * np.sin(7 * data.qpos[0])
            mujoco.mj_step(model, data)
    names = ["time", *(f"{of}{k}" for of in "uj" for k in range(1, count + 1))]
    np.savetxt(folder / "log.csv", rows, delimiter=",", header=",".join(names), comments="")


if __name__ == "__main__":
    sys.exit(main())
