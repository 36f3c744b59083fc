"""A small log to make files of."""

from pathlib import Path

import numpy as np

from identification import Log, read_log

INPUTS = ("current_1", "current_2")
OUTPUTS = ("angle_1", "angle_2")
UNITS = {"current": "A", "angle": "rad", "x": "m"}


def wave(n: int = 40, step: float = 0.01) -> Log:
    """Two inputs, two outputs and one extra that are all different."""
    time = step * np.arange(n)
    phase = 2 * np.pi * 0.5 * time[:, None]
    return Log(
        time=time,
        inputs=0.5 + 0.4 * np.sin(phase * [1, 2]),
        outputs=0.3 * np.cos(phase * [1, 3]),
        input_names=INPUTS,
        output_names=OUTPUTS,
        extras={"x": 0.1 * time},
        units={n: "A" for n in INPUTS} | {n: "rad" for n in OUTPUTS} | {"x": "m"},
    )


def read(path: Path, **options) -> Log:
    return read_log(path, INPUTS, OUTPUTS, ("x", "y"), **options)


HEADER = "time,current_1,current_2,angle_1,angle_2\n"
ROWS = [f"{0.01 * k:.2f},1,2,3,{k}\n" for k in range(20)]


def lines(*changes: tuple[int, str]) -> str:
    """The good file with some of its lines, counted from 1, replaced."""
    every = [HEADER, *ROWS]
    for number, text in changes:
        every[number - 1] = text
    return "".join(every)
