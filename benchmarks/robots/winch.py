"""A winch of a real cable robot lifts and lowers 5 kg, and apart from that 1 kg.

    (m + J/r²) ẍ = K_t/r i - m g - f_c sign ẋ - d ẋ + f_0       i [A] -> x = r q [m], x upwards

The drum's radius r and K_t are the authors'. A record is a stroke or several, cut where the cable
is taut and no hand is on it (`examples/winch_strokes.py`). Their bus gives a sample each 24 to
32 ms.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from identification import Log
from robots import needed
from robots.measured_robot import (
    MODELS,
    PROJECT_MODELS,
    Apart,
    Free,
    MeasuredRobot,
    PublishedSize,
    gridded,
)

RADIUS, K_T, G = 0.020, 0.0551, 9.81  # [m], [N m/A], [m/s^2]: the authors'
STEP, WIDEST = 0.03, 0.8  # of the grid, and a gap that is still bridged [s]
# Record, and the seconds that are used. Up1 is the beginning of Down1, and not used twice.
FIT = (("5kg/ODrive2/Down1", 12.6, 44.0), ("5kg/ODrive2/Up05", 6.0, 22.0))
CONFIRM = (
    ("5kg/ODrive2/Down05", 8.0, 24.0), ("5kg/ODrive2/Down25", 7.0, 9.5),
    ("5kg/ODrive0/Down1", 3.0, 30.5), ("5kg/ODrive0/Down05", 6.0, 23.0),
)  # fmt: skip
ONE_KG = (
    ("1kg/ODrive2/Up05", 5.0, 23.5), ("1kg/ODrive2/Down05", 6.0, 25.0),
    ("1kg/ODrive2/Down25", 5.9, 19.0),
)  # fmt: skip
SOURCE = "NTNU, github.com/eliasoa/TTK4900_CDPR"
FREE = (
    Free(name="d", path="joint/cable.damping", value=1.0, known=1.0, unit="N s/m"),
    Free(name="coulomb_friction.f_c@cable", value=2.5, unit="N"),
    Free(name="offset.f_0@cable", value=0.0, known=2.0, unit="N", scale=1.0),
)
PUBLISHED = (
    PublishedSize(name="coulomb_friction.f_c@cable", value=0.0355 / RADIUS, unit="N",
                  source=f"32 to 39 mN m of running friction at the motor, {SOURCE}"),
    PublishedSize(name="winding in, over m g r", value=6.0, unit="%", source=f"5 to 7 %, {SOURCE}"),
    PublishedSize(name="paying out, over m g r", value=-10.5, unit="%",
                  source=f"-10 to -11 %, {SOURCE}"),
)  # fmt: skip


def read_record(folder: Path, record: str, begin: float, end: float) -> Log:
    """A part of a record; lifting is positive, current and angle come in different rows."""
    motor = int(record.split("/")[1][-1])
    table = np.genfromtxt(needed(folder / f"{record}.csv"), delimiter=",", skip_header=1)
    t, turns, amperes = table[:, [0, 1 + motor, 9 + motor]].T
    row = (t >= begin) & (t <= end)
    return gridded(
        t[row], {"motor": -amperes[row]}, {"wound": 2 * np.pi * RADIUS * turns[row]},
        units={"motor": "A", "wound": "m"}, name=record, step=STEP, widest=WIDEST,
    )  # fmt: skip


def read(data: Path) -> MeasuredRobot:
    """The winch from the folder of all data."""
    folder = needed(data / "ttk4900" / "lifting")
    fit, confirm, light = (
        tuple(read_record(folder, *each) for each in part) for part in (FIT, CONFIRM, ONE_KG)
    )
    return MeasuredRobot(
        name="winch", title="Winch of a cable robot that lifts 5 kg", source=SOURCE,
        model=PROJECT_MODELS / "winch.xml", free=FREE, horizon=0.96, fit=fit, confirm=confirm,
        apart=(Apart(what="1 kg instead of 5 kg", logs=light, model=MODELS / "winch_1kg.xml"),),
        published=PUBLISHED,
    )  # fmt: skip
