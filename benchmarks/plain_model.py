"""How far models/inca6d_plain.xml, which needs MuJoCo only, is from the twin.

    python benchmarks/plain_model.py

The same currents go into both from their common start. Printed is the rms difference of the motor
angles over their rms motion, and the largest difference of the platform's position.
"""

from __future__ import annotations

import argparse

import mujoco
import numpy as np

from inca_mj.files import model_path
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

DURATION = 5.0  # [s]
AMPLITUDES = (0.005, 0.01, 0.02, 0.04, 0.08, 0.16)  # of a PRBS about 0 A [A]


def plain_run(model: mujoco.MjModel, currents: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Motor angles (N, 8) [rad] and positions (N, 3) [m] of the plain model at 100 Hz."""
    data = mujoco.MjData(model)
    R = parameter_set().values()["R"]
    angle, position = [], []
    for current in currents:
        data.ctrl[:] = current
        angle.append(data.qpos[7:] / R)
        position.append(data.qpos[:3].copy())
        mujoco.mj_step(model, data, 10)
    return np.array(angle), np.array(position)


def main() -> None:
    """Print a row for each input."""
    twin, model = build_twin(), mujoco.MjModel.from_xml_path(str(model_path("inca6d_plain.xml")))
    swing = (make_input("prbs", DURATION) - 0.75) / 0.25
    inputs = {f"PRBS of ±{1e3 * a:g} mA": a * swing for a in AMPLITUDES}
    inputs["the thesis' PRBS, 0.5 to 1 A"] = make_input("prbs", DURATION)
    inputs["2 A in motor 1"] = make_input("step", DURATION)
    print(f"{'input':30} largest angle [rad]  fastest [rad/s]  error of angles  of position [mm]")
    for name, currents in inputs.items():
        run = simulate(twin, currents)
        angle, position = plain_run(model, currents)
        error = np.sqrt(np.mean((angle - run.motor_angle) ** 2) / np.mean(run.motor_angle**2))
        off = 1e3 * np.linalg.norm(position - run.position, axis=1).max()
        print(
            f"{name:30} {np.abs(run.motor_angle).max():19.3g} {np.abs(run.motor_rate).max():16.3g}"
            f" {100 * error:14.2f} % {off:17.2g}"
        )


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    main()
