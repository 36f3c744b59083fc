"""A winch of a cable robot lifts and lowers 5 kg. What does its model lack?

    (m + J/r²) ẍ = K_t/r i - m g - f_c sign ẋ - d ẋ + f_0     i [A] -> x = r q [m], x upwards

Two records are fitted and four confirm, two of them of another motor. Three records of 1 kg show
how far the fitted friction holds. What strokes at constant speed say is in `winch_strokes.py`. The
data are lifting/ of eliasoa/TTK4900_CDPR (NTNU).
Run it: python examples/winch.py FOLDER
"""

import sys
from pathlib import Path

import numpy as np
from winch_strokes import RADIUS, read_winch

from identification import Log, discover, discovery_text, on_a_grid, read_robot, window_error

ROBOT = Path(__file__).parents[1] / "models" / "winch.toml"
STEP, WIDEST = 0.03, 0.8  # of the grid, and a gap that is still bridged [s]
# A record, and the seconds in which the cable is taut and no hand is on it.
FITTED = (("5kg/ODrive2/Down1", 12.6, 44.0), ("5kg/ODrive2/Up05", 6.0, 22.0))
UNSEEN = (
    ("5kg/ODrive2/Down05", 8.0, 24.0), ("5kg/ODrive2/Down25", 7.0, 9.5),
    ("5kg/ODrive0/Down1", 3.0, 30.5), ("5kg/ODrive0/Down05", 6.0, 23.0),
)  # fmt: skip
LIGHT = (
    ("1kg/ODrive2/Up05", 5.0, 23.5), ("1kg/ODrive2/Down05", 6.0, 25.0),
    ("1kg/ODrive2/Down25", 5.9, 19.0),
)  # fmt: skip


def winch_log(folder, record, begin, end):
    """A part of a record on an even grid: metres of cable and amperes, lifting positive."""
    t, q, _, i = read_winch(folder, record)
    row = (t >= begin) & (t <= end)
    columns = {"motor": i[row], "wound": RADIUS * q[row]}
    time, on = on_a_grid(t[row], columns, STEP, WIDEST)
    return Log(
        time=time, inputs=on["motor"][:, None], outputs=on["wound"][:, None],
        input_names=("motor",), output_names=("wound",), units={"motor": "A", "wound": "m"},
        name=record, hold="foh",
    )  # fmt: skip


def main(folder):
    """Discover what is missing with 5 kg, and try the result on 1 kg."""
    fitted, unseen, light = (
        [winch_log(folder / "lifting", *part) for part in parts]
        for parts in (FITTED, UNSEEN, LIGHT)
    )
    robot = read_robot(ROBOT, fitted, confirm=unseen)
    found = discover(robot, progress=print)
    print(discovery_text(found))
    models = found.nominal.values, found.final.values
    for name, value in models[1].items():
        std = found.final.std.get(name, 0.0)
        print(f"{name}: {models[0].get(name, 0.0):.3f} -> {value:.3f} ± {std:.2g}")
    horizon = robot.file.horizon
    for log in light:
        each = (window_error(robot.plant, log, horizon, {**m, "m": 1.0}) for m in models)
        a, b = (1e3 * np.sqrt(np.mean(e**2)) for e in each)
        print(f"{log.name}: {a:.1f} -> {b:.1f} mm over {horizon} s")


if __name__ == "__main__":
    where = Path(sys.argv[1] if len(sys.argv) > 1 else "data/ttk4900")
    if (where / "lifting").exists():
        main(where)
    else:
        print(f"{where} has no folder lifting: see github.com/eliasoa/TTK4900_CDPR")
