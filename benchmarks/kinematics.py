"""How near the pose from motor angles is to the twin's, and the time of each call.

    python benchmarks/kinematics.py [FIGURE.png]

Prints one JSON object. Times are the processor's, the least of some calls.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from identification import Log
from inca_mj import log_poses, make_input, pose_at_rest, run_to_log, simulate
from inca_mj.kinematics import (
    accelerations,
    inverse,
    jacobian,
    jacobian_rate,
    pose_from_lengths,
    rates,
)
from inca_mj.robot.geometry import INCA
from inca_mj.twin.twin import build_twin

POSE = np.array([0.1, -0.2, 1.4, 0.0, 0.2, 0.1])
START = np.array([0, 0, 1.43, 0, 0, 0])
COUNT, NOISE = 2 * np.pi / 4000, 5e-4  # of an encoder [rad]


def noisy_log(kind: str, seed: int) -> Log:
    """10 s of the twin, seen by encoders."""
    run = simulate(build_twin(), make_input(kind, 10.0, 0.01, seed=seed), 0.01)
    rng = np.random.default_rng(0)
    angles = run.motor_angle + rng.normal(0, NOISE, run.motor_angle.shape)
    return replace(run_to_log(run), outputs=np.round(angles / COUNT) * COUNT)


def accuracy(log: Log) -> dict[str, object]:
    """Error against the pose of the twin, which is in the log."""
    begin = time.process_time()
    found = log_poses(log)
    seconds = time.process_time() - begin
    error = found.pose - found.measured
    inside = np.abs(error) < 1.96 * found.std
    return {
        "rms": np.sqrt(np.mean(error**2, axis=0)).round(7).tolist(),
        "mean_std": found.std.mean(axis=0).round(7).tolist(),
        "inside_95": inside.mean(axis=0).round(3).tolist(),
        "worst_in_std": round(float(np.abs(error / found.std).max()), 1),
        "milliseconds_a_sample": round(1e3 * seconds / len(log), 3),
    }


def least(function: Callable[[], object], calls: int = 200) -> float:
    """Least processor time of one of some calls [µs]."""
    best = np.inf
    for _ in range(calls):
        begin = time.process_time()
        function()
        best = min(best, time.process_time() - begin)
    return round(1e6 * best, 1)


def timings() -> dict[str, float]:
    """Processor time of each call [µs]."""
    cables, twist = inverse(POSE, INCA), np.ones(6)
    many = np.tile(POSE, (1000, 1))
    return {
        "inverse": least(lambda: inverse(POSE, INCA)),
        "inverse, of 1000 poses, each": round(least(lambda: inverse(many, INCA), 20) / 1000, 2),
        "rates": least(lambda: rates(cables, twist)),
        "accelerations": least(lambda: accelerations(cables, twist, twist)),
        "jacobian": least(lambda: jacobian(cables)),
        "jacobian_rate": least(lambda: jacobian_rate(cables, twist)),
        "pose_from_lengths": least(lambda: pose_from_lengths(cables.lengths, INCA, START), 30),
        "pose_at_rest": least(lambda: pose_at_rest(np.full(8, 0.2), np.full(8, 0.5)), 10),
    }


def main() -> None:
    """Measure, draw, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("picture", nargs="?", help="is drawn there, such as poses.png")
    given = parser.parse_args()
    logs = {(k, s): noisy_log(k, s) for k, s in (("prbs", 0), ("prbs", 3), ("multisine", 0),
                                                 ("step", 0))}  # fmt: skip
    if given.picture:
        from identification.report.page.style import save_png
        from inca_mj.report.poses import poses_figure

        save_png(poses_figure(log_poses(logs["prbs", 0])), given.picture, dpi=110)
    result = {
        "accuracy": {f"{kind}, seed {seed}": accuracy(log) for (kind, seed), log in logs.items()},
        "microseconds": timings(),
    }
    print(json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
