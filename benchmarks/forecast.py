"""What a discovery said that it would take, and what it took then: memory, time, and time left.

    python benchmarks/forecast.py [--samples 500 1000 2000] [--spread none usual]
    python benchmarks/forecast.py --joints 1 --samples 2000 20000 200000
    python benchmarks/forecast.py --worlds 20 [--seed 1]     the time left, as a search goes on
    python benchmarks/forecast.py --rests                    tables of that, from all rows

Each log is simulated with other values than those of the drawing and with the noise of encoders, so
that nothing is missing: of the twin, or of a chain of bodies with a motor and an encoder at each
joint. Each search is a process of its own, whose memory is what it holds at most beyond what it
held when it began to search. A row is added to results/forecast.jsonl; benchmarks/robustness.py
makes the page.

The worlds of `--worlds` are those of joint_worlds: a pendulum, a cart and a two-link arm that hide
nothing, one effect, several, or a force in no catalogue, on records of 8 to 12 s; every sixth is a
search of the INCA, by a free run. A row holds when each stage began, the time that was told to be
left (`identification/discovery/outlook.py`), and when the search ended. `--rests` prints the
percentiles of what was left over what had passed, from which the tables are written.
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
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from identification.sweep.work import commit

RECORD = Path(__file__).parent / "results" / "forecast.jsonl"
RATE = 100.0  # [Hz]
NOISE = 5e-4  # [rad]
VALUES = {"m": 0.18, "lambda": 24_000.0, "b_c": 0.0055, "K_t": 0.079}
UNIT = 1024 if sys.platform != "darwin" else 1  # [bytes] of ru_maxrss
HELD = 15  # samples for which the motors of a chain keep a torque
TORQUE = 0.6  # [N m], std
BODY = """<body name="body{k}" pos="0 0 {below}">
<joint name="joint{k}" axis="{axis}" damping="0.2" stiffness="3" armature="0.02"/>
<inertial pos="0 0 -0.05" mass="0.2" diaginertia="0.001 0.001 0.0005"/>"""
ROBOT = """model = "chain.xml"
free = ["mass", "damping"]
[parameters.mass]
path = "body/body0.mass"
unit = "kg"
[parameters.damping]
path = "joint/joint0.damping"
unit = "N m s/rad"
"""


def main() -> int:
    """Search, a process after the other, and keep what each tells."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, nargs="*", default=[500, 1000, 2000])
    parser.add_argument("--spread", nargs="*", default=["none"])
    parser.add_argument("--joints", type=int, nargs="*", default=[0], help="of a chain; 0: INCA")
    parser.add_argument("--record", type=Path, default=RECORD)
    parser.add_argument("--worlds", type=int, default=0, help="searches whose time left is kept")
    parser.add_argument("--seed", type=int, default=1, help="of the first world")
    parser.add_argument("--rests", action="store_true", help="print the tables of the time left")
    parser.add_argument("--one", action="store_true", help="search in this process, print the row")
    options = parser.parse_args()
    if options.rests:
        print(rests([*map(json.loads, options.record.read_text().splitlines())]))
        return 0
    if options.worlds:
        for seed in range(options.seed, options.seed + options.worlds):
            row = json.dumps(watched(seed))
            print(row, flush=True)
            with options.record.open("a") as record:
                record.write(row + "\n")
        return 0
    each = [(j, s, n) for j in options.joints for s in options.spread for n in options.samples]
    for joints, spread, samples in each:
        if options.one:
            print(json.dumps(measured(joints, samples, spread)))
            continue
        line = [sys.executable, __file__, "--one", "--joints", str(joints), "--spread", spread]
        alone = {**os.environ, "OMP_NUM_THREADS": "1"}
        done = subprocess.run([*line, "--samples", str(samples)], stdout=subprocess.PIPE,
                              text=True, check=True, env=alone)  # fmt: skip
        row = done.stdout.splitlines()[-1]
        print(row, flush=True)
        with options.record.open("a") as record:
            record.write(row + "\n")
    return 0


def measured(joints: int, samples: int, spread: str) -> dict[str, object]:
    """Forecast and measurement of one search."""
    from identification.innovations import discovery as search
    from identification.innovations.forecast import Forecast
    from identification.innovations.task import DiscoveryTask

    run: Callable[[], Any] = chain(joints, samples) if joints else twin(samples, spread)
    told: list[tuple[Forecast, float, float]] = []
    own = search.forecast

    def forecast(task: DiscoveryTask) -> Forecast:
        told.append((own(task), peak(), time.process_time()))
        return told[-1][0]

    search.forecast = forecast
    found = run()
    needs, before, began = told[0]
    return {
        "joints": joints, "samples": samples, "spread": spread, "verdict": found.verdict,
        "memory": {"forecast": needs.memory, "measured": peak() - before},
        "seconds": {"forecast": needs.seconds, "measured": time.process_time() - began},
        "commit": commit(),
    }  # fmt: skip


def watched(seed: int) -> dict[str, object]:
    """The stages of one search: when each began, what was left then as it was told, and its end."""
    from identification.discovery import moves
    from identification.discovery.outlook import Outlook

    told: list[Outlook] = []
    marks: list[list[object]] = []

    class Kept(Outlook):
        def enter(self, stage: str, effects: int = 0, said: str = "") -> None:
            super().enter(stage, effects, said)
            told.append(self)
            marks.append([stage, effects, self.entered - self.began, self.rest])

    is_free = seed % 6 == 0
    name, run = free_run(seed) if is_free else world(seed)
    moves.Outlook = Kept  # type: ignore[misc]
    found = run()
    return {"world": name, "seed": seed, "kind": "innovations" if is_free else "windows",
            "verdict": found.verdict, "effects": len(found.named), "marks": marks,
            "took": time.monotonic() - told[0].began, "commit": commit()}  # fmt: skip


def world(seed: int) -> tuple[str, Callable[[], Any]]:
    """A search over a horizon of a robot of joints."""
    import numpy as np
    from joint_worlds.files import write_world
    from joint_worlds.hidden import NULL, THREE, effects_of
    from joint_worlds.motion import ROBOTS
    from joint_worlds.world import UnseenError, make_world

    from identification import discover, read_robot

    rng = np.random.default_rng(seed)
    while True:  # an effect that cannot be seen in the record is replaced
        robot = rng.choice([*ROBOTS], p=[p_of(r) for r in ROBOTS])
        effect = rng.choice([NULL, THREE, "bump", *rng.choice(effects_of(ROBOTS[robot]), 5)])
        try:
            made = make_world(str(robot), str(effect), seed, float(rng.integers(8, 13)))
        except UnseenError:
            continue
        with tempfile.TemporaryDirectory() as folder:
            toml, a, b = write_world(made, Path(folder))
            read = read_robot(toml, a, confirm=[b])
        return f"{robot}, {effect}", partial(discover, read)


def p_of(robot: str) -> float:
    """The chance of a robot: an arm takes minutes to an hour a search."""
    return {"pendulum": 0.5, "cart": 0.4, "two_link": 0.1}.get(robot, 0.0)


def free_run(seed: int) -> tuple[str, Callable[[], Any]]:
    """A search of the INCA by a free run."""
    import numpy as np

    from inca_mj.files import example_path
    from inca_mj.twin.logs import read_inca_log

    samples = int(np.random.default_rng(seed).integers(400, 900))
    if seed % 12:
        return "inca", twin(samples, "none")
    from inca_mj import discover
    from inca_mj.workflows.spread import spread_of

    log = read_inca_log(example_path())
    return "inca, example", lambda: discover(log, spread=spread_of("none"))


def rests(rows: list[dict[str, Any]]) -> str:
    """What was left over what had passed where a stage began: 10th and 90th percentile."""
    import numpy as np

    from identification.discovery.outlook import STAGES

    lines = []
    for kind in ("windows", "innovations"):
        ratios: dict[tuple[int, int], list[float]] = {}
        for row in (r for r in rows if r.get("kind") == kind):
            for stage, effects, at, _ in row["marks"][1:]:
                key = STAGES.index(stage), min(effects, 2)
                ratios.setdefault(key, []).append((row["took"] - at) / at)
        lines.append(f"{kind}:")
        for (k, n), each in sorted(ratios.items()):
            low, high = np.percentile(each, [10, 90])
            lines.append(f"    {STAGES[k]!r}, {n}: ({low:.2f}, {high:.2f})  of {len(each)}")
    return "\n".join(lines)


def twin(samples: int, spread: str) -> Callable[[], Any]:
    """A search of the INCA."""
    import numpy as np

    from inca_mj import build_twin, discover, make_input, simulate
    from inca_mj.twin.logs import run_to_log
    from inca_mj.workflows.spread import spread_of

    robot = build_twin().with_values(VALUES)
    run = simulate(robot, make_input("prbs", duration=(samples - 1) / RATE))
    noise = NOISE * np.random.default_rng(samples).standard_normal((samples, 8))
    clean = run_to_log(run)
    log = replace(clean, outputs=clean.outputs + noise)
    return lambda: discover(log, spread=spread_of(spread))


def chain(joints: int, samples: int) -> Callable[[], Any]:
    """A search of a chain with so many joints, whose files are read as a user's are."""
    import mujoco
    import numpy as np

    from identification import discover, read_robot

    bodies = "".join(
        BODY.format(k=k, below=-0.1 if k else 0, axis=("0 1 0", "1 0 0")[k % 2])
        for k in range(joints)
    )
    motors = "".join(f'<general name="u{k}" joint="joint{k}"/>' for k in range(joints))
    sensors = "".join(f'<jointpos name="y{k}" joint="joint{k}"/>' for k in range(joints))
    text = (
        '<mujoco><option timestep="0.005" integrator="RK4"><flag contact="disable"/></option>'
        f"<worldbody>{bodies}{'</body>' * joints}</worldbody><actuator>{motors}</actuator>"
        f"<sensor>{sensors}</sensor></mujoco>"
    )
    model = mujoco.MjModel.from_xml_string(text)
    model.body_mass[1], model.dof_damping[0] = 0.22, 0.17
    data, rng = mujoco.MjData(model), np.random.default_rng(samples)
    u = np.repeat(TORQUE * rng.standard_normal((samples // HELD + 1, joints)), HELD, axis=0)
    rows = np.empty((samples, 1 + 2 * joints))
    for k, row in enumerate(rows):
        seen = data.qpos + NOISE * rng.standard_normal(joints)
        row[:] = np.concatenate([[k / RATE], u[k], seen])
        data.ctrl[:] = u[k]
        mujoco.mj_step(model, data, round(1 / (RATE * model.opt.timestep)))
    names = ["time", *(f"u{k}" for k in range(joints)), *(f"y{k}" for k in range(joints))]
    with tempfile.TemporaryDirectory() as folder:
        at = Path(folder)
        (at / "chain.xml").write_text(text)
        (at / "chain.toml").write_text(ROBOT)
        np.savetxt(at / "log.csv", rows, "%.9g", ",", header=",".join(names), comments="")
        robot = read_robot(at / "chain.toml", at / "log.csv")
    return lambda: discover(robot)


def peak() -> float:
    """The most memory that this process has held [bytes]."""
    return float(UNIT * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


if __name__ == "__main__":
    sys.exit(main())
