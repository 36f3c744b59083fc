"""Records of BAM's bench as logs: a Dynamixel XL330 that swings a weight (see `xl330`)."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from identification import Log, on_a_grid

STEP, WIDEST = 0.01, 0.02  # of the grid, and a gap that is still bridged [s]
FULL = 885  # a load of 100 %


def read_xl330(path: Path, step: float = STEP) -> Log:
    """One record while its torque is on, on an even grid, straight lines between samples.

    When it is off, the bridge may be open: u is then not 0 V, and the back-EMF has no current.
    """
    raw = json.loads(Path(path).read_text(encoding="utf-8"))
    on = [entry for entry in raw["entries"] if entry["torque_enable"]]
    time, angle, load, volts = (
        np.array([entry[key] for entry in on], float)
        for key in ("timestamp", "position", "load", "input_volts")
    )
    duty = np.where(load > 2**15 - 1, load - 2**16, load) / FULL
    t, on_grid = on_a_grid(time, {"motor": duty * volts, "angle": angle}, step, WIDEST)
    return Log(
        time=t, inputs=on_grid["motor"][:, None], outputs=on_grid["angle"][:, None],
        input_names=("motor",), output_names=("angle",),
        units={"motor": "V", "angle": "rad"}, name=f"{raw['trajectory']}, k_p {raw['kp']}",
        hold="foh",
    )  # fmt: skip


def read_all(folder: Path, gains: Sequence[int]) -> list[Log]:
    """The records of some gains."""
    logs = [read_xl330(path) for path in sorted(folder.glob("*.json"))]
    return [log for log in logs if int(log.name.split()[-1]) in gains]
