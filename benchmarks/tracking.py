"""What a hidden effect costs a controller, and what its model with the effect wins back.

    .venv/bin/python benchmarks/tracking.py            rms error on the circle, case by case
    .venv/bin/python benchmarks/tracking.py --discover  the model is found by a discovery first

The robot has one effect. Its controller sees motor angles and follows the circle of
`inca_mj.track`: with the nominal twin as its model (before), and with the twin that has the effect
(after). With --discover the effect is first found in a log of the robot: 10 s of the thesis' PRBS,
white noise on the angles. One record a case is added to benchmarks/results/tracking.jsonl.
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from inca_mj import (
    CATALOGUE,
    build_twin,
    discover,
    make_input,
    named_twin,
    run_to_log,
    simulate,
    spread_of,
    track,
)

RESULTS = Path(__file__).parent / "results" / "tracking.jsonl"
NOISE = 2e-4  # of the encoders [rad]
SECONDS = 10.5  # of the circle: 6.5 s at the full rate count, a whole turn

# The first group has sizes of simulated practice logs, chosen so that a log just shows them; most
# of the second are ten times as large or more, as of a worn or carelessly built robot.
SMALL = (
    {"load_dependent_friction.mu": 0.0038},
    {"spring_hysteresis.eta": 0.013},
    {"stribeck_friction.f_s": 0.0114, "stribeck_friction.v_s": 1.2},
    {"drum_eccentricity.a": 0.0015, "drum_eccentricity.b": 0.0015},
    {"torque_constant_mismatch.delta@5": -0.18},
)
LARGE = (
    {"load_dependent_friction.mu": 0.05},
    {"spring_hysteresis.eta": 0.1},
    {"stribeck_friction.f_s": 0.02, "stribeck_friction.v_s": 5.0},
    {"drum_eccentricity.a": 0.02, "drum_eccentricity.b": 0.02},
    {"drum_radius_mismatch.delta@3": 0.02},
    {"pulley_radius.r_p": 0.02},
    {"cogging.a": 0.01, "cogging.n": 6.0},
    {"delay.tau": 0.01},
)
DISCOVERED = ({"load_dependent_friction.mu": 0.05}, {"torque_constant_mismatch.delta@5": -0.18})


def robot_with(values):
    """A robot with one effect."""
    (name,) = {size.partition(".")[0] for size in values}
    effects = tuple(e for e in CATALOGUE if e.name == name)
    return build_twin(effects=effects).with_values(values)


def measure(robot, model):
    """Errors on the circle [mm], with the nominal twin as model and with another."""
    results = {
        "before": track(robot, duration=SECONDS),
        "after": track(robot, model, duration=SECONDS),
    }
    return {
        f"{name}_{what}_mm": round(1e3 * value, 4)
        for name, result in results.items()
        for what, value in (
            ("rms", result.rms),
            ("largest", result.largest),
            ("seen", result.seen_rms),
        )
    }


def find(robot, seed=0):
    """The twin that a discovery makes of a log of the robot, and what it says."""
    run = simulate(robot, make_input("prbs", 10.0, seed=seed))
    log = run_to_log(run, notes="a simulated robot")
    noise = NOISE * np.random.default_rng(seed).standard_normal(log.outputs.shape)
    log = replace(log, outputs=log.outputs + noise - noise[0])
    begin = time.process_time()
    found = discover(log, spread=spread_of("none"), progress=print)
    names = [
        {"name": n.candidate.effect.name, "where": n.candidate.where, "confidence": n.confidence,
         "parameters": {key: value[:2] for key, value in n.parameters.items()}}
        for n in found.named
    ]  # fmt: skip
    said = {"verdict": found.verdict, "named": names,
            "processor_seconds": round(time.process_time() - begin, 1)}  # fmt: skip
    return named_twin(found), said


def main():
    """Measure all cases, and keep what was measured."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--discover", action="store_true", help="find the model in a log first")
    parser.add_argument("--only", default="", help="cases whose effect begins so")
    parser.add_argument("--save", type=Path, help="folder for the twin that was found last")
    asked = parser.parse_args()
    groups = (("found", DISCOVERED),) if asked.discover else (("small", SMALL), ("large", LARGE))
    if not asked.discover and not asked.only:
        for group, noise in (("nominal", 0.0), (f"nominal, encoder noise {NOISE} rad", NOISE)):
            nominal = track(duration=SECONDS, noise=noise)
            keep({"group": group, "values": {}, "before_rms_mm": round(1e3 * nominal.rms, 4)})
    for group, cases in groups:
        for values in cases:
            if not next(iter(values)).startswith(asked.only):
                continue
            robot = robot_with(values)
            model, said = find(robot) if asked.discover else (robot, {})
            keep({"group": group, "values": values, **said, **measure(robot, model)})
            if asked.save and asked.discover:
                from inca_mj import save_twin

                asked.save.mkdir(parents=True, exist_ok=True)
                save_twin(model, asked.save)


def keep(record):
    """Print a record and add it to the results."""
    line = json.dumps(record, ensure_ascii=False)
    print(line, flush=True)
    with RESULTS.open("a", encoding="utf-8") as stream:
        stream.write(line + "\n")


if __name__ == "__main__":
    main()
