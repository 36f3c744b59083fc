"""A real servo: a Dynamixel XL330 that swings 0.49 kg on an arm of 0.1 m. What does it lack?

    (m l² + J_a) ẇ = g u - D w - friction + f_0 - m 9.81 l sin q       u = duty × supply [V]

g = K_t/R, and D holds the back-EMF. The 16 records of github.com/Rhoban/bam are 4 trajectories,
each under 4 gains: those of the gains 100 and 400 are fitted, those of 200 and 800 confirm.
Run it: python examples/xl330.py FOLDER [FIGURE.png]
"""

import json
import sys
from pathlib import Path

import numpy as np

from identification import (
    Log,
    discover,
    discovery_text,
    on_a_grid,
    read_robot,
    save_png,
    windows_figure,
)

ROBOT = Path(__file__).parents[1] / "models" / "xl330.toml"
STEP, WIDEST = 0.01, 0.02  # of the grid, and a gap that is still bridged [s]
FULL = 885  # a load of 100 %
FITTED, UNSEEN = (100, 400), (200, 800)  # gains k_p
SHOWN = "sin_time_square, k_p 800"


def read_xl330(path):
    """One record while the torque is on; when it is off, the bridge may be open."""
    raw = json.loads(Path(path).read_text(encoding="utf-8"))
    on = [entry for entry in raw["entries"] if entry["torque_enable"]]
    time, angle, load, volts = (
        np.array([entry[key] for entry in on], float)
        for key in ("timestamp", "position", "load", "input_volts")
    )
    duty = np.where(load > 2**15 - 1, load - 2**16, load) / FULL  # two's complement
    t, on_grid = on_a_grid(time, {"motor": duty * volts, "angle": angle}, STEP, WIDEST)
    return Log(
        time=t, inputs=on_grid["motor"][:, None], outputs=on_grid["angle"][:, None],
        input_names=("motor",), output_names=("angle",), units={"motor": "V", "angle": "rad"},
        name=f"{raw['trajectory']}, k_p {raw['kp']}", hold="foh",
    )  # fmt: skip


def read_all(folder, gains):
    """The records of some gains."""
    logs = [read_xl330(path) for path in sorted(Path(folder).glob("*.json"))]
    return [log for log in logs if int(log.name.split()[-1]) in gains]


def main(folder, figure=None):
    """Discover what is missing, and say it; draw a record that no fit has seen."""
    robot = read_robot(ROBOT, read_all(folder, FITTED), confirm=read_all(folder, UNSEEN))
    found = discover(robot, progress=print)
    print(discovery_text(found))
    for name, value in found.final.values.items():
        before = found.nominal.values.get(name, 0.0)
        print(f"{name}: {before:.4g} -> {value:.4g} ± {found.final.std.get(name, 0.0):.2g}")
    if figure:
        (log,) = (log for log in robot.records if log.name == SHOWN)
        models = {"Coulomb and viscous": found.nominal.values,
                  "with what is named": found.final.values}  # fmt: skip
        save_png(windows_figure(robot.plant, log, robot.file.horizon, models), figure, dpi=100)


if __name__ == "__main__":
    where = Path(sys.argv[1] if len(sys.argv) > 1 else "data/xl330/raw")
    if any(where.glob("*.json")):
        main(where, *sys.argv[2:3])
    else:
        print(f"{where} has no records; get them from github.com/Rhoban/bam and say where")
