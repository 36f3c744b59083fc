"""A real axis: EMPS, a carriage of 95 kg on a ball screw. What do its published values lack?

    M v̇ = g u - F_v v - f_c sign v + f_0           u [V] -> x [m]; g = 35.15 N/V is known

The first half of DATA_EMPS.mat is fitted; its second half and DATA_EMPS_PULSES.mat confirm. The
data are of Janot, Gautier, Brunot (2019), nonlinearbenchmark.org.
Run it: python examples/emps.py FOLDER [FIGURE.png]
"""

import sys
from pathlib import Path

import numpy as np
from scipy.io import loadmat

from identification import (
    Log,
    decimate,
    discover,
    discovery_text,
    read_robot,
    save_png,
    window_error,
    windows_figure,
)

ROBOT = Path(__file__).parents[1] / "models" / "emps.toml"
PUBLISHED = {
    "M": 95.11, "F_v": 203.5, "coulomb_friction.f_c@slide": 20.39,
    "offset.f_0@slide": 3.16,  # ours pushes: theirs is -3.16
    "asymmetric_viscous_friction.d_a@slide": (166.7 - 240.4) / 2,
}  # fmt: skip
EVERY = 10  # samples of 1 ms
SHOWN = 5.0  # of the figure [s]


def read_emps(path):
    """Every tenth sample of a record; the voltage between samples as straight lines."""
    data = loadmat(path)
    log = Log(
        time=np.arange(len(data["qm"])) * 1e-3, inputs=data["vir"], outputs=data["qm"],
        input_names=("drive",), output_names=("position",), units={"drive": "V", "position": "m"},
        name=Path(path).stem,
    )  # fmt: skip
    return decimate(log, EVERY)


def main(folder, figure=None):
    """Discover what is missing; compare both models on the record with pulses."""
    log, pulses = (read_emps(folder / f"DATA_EMPS{s}.mat") for s in ("", "_PULSES"))
    unseen = [log.part("validation"), pulses]
    robot = read_robot(ROBOT, log.part("estimation"), confirm=unseen)
    found = discover(robot, progress=print)
    print(discovery_text(found))
    before, after = found.nominal.values, found.final.values
    for name, value in after.items():
        then, said = before.get(name, 0.0), PUBLISHED.get(name, 0.0)
        print(f"{name}: {then:.2f} -> {value:.2f} ± {found.final.std[name]:.2f}; {said:.2f}")
    for horizon in (0.1, 0.2, 0.5):
        a, b = (np.mean(window_error(robot.plant, pulses, horizon, values) ** 2)
                for values in (before, after))  # fmt: skip
        print(f"pulses, {horizon} s ahead: {1e6 * a**0.5:.1f} -> {1e6 * b**0.5:.1f} µm,"
              f" mean square {100 * (b / a - 1):+.0f} %")  # fmt: skip
    if figure:
        models = {"symmetric friction": before, "with what is named": after}
        part = pulses.between(0.0, SHOWN)
        save_png(windows_figure(robot.plant, part, robot.file.horizon, models), figure, dpi=100)


if __name__ == "__main__":
    where = Path(sys.argv[1] if len(sys.argv) > 1 else "data/emps")
    if (where / "DATA_EMPS.mat").exists():
        main(where, *sys.argv[2:3])
    else:
        print(f"{where} has no DATA_EMPS.mat; get it from nonlinearbenchmark.org and say where")
